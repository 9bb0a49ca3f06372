//! The vertices of a draw: attributes from arrays, vertex programs as microcode, and the fixed-function pipe.
