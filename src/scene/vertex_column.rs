//! Columns of a file of vertices.

use ninebit::state::named;

named! {
    /// What a vertex in a file has in one or several 32-bit words. All but the bytes of colours and the size are floats.
    pub enum VertexColumn =>
    /// Returns the number of words.
    words: usize {
        /// x, y, z, w.
        Position => 4,
        /// Red, green, blue, alpha of the primary colour.
        Diffuse => 4,
        /// The same as bytes, red first.
        DiffuseBytes => 1,
        /// Red, green, blue, alpha of the secondary colour.
        Specular => 4,
        /// The same as bytes, red first.
        SpecularBytes => 1,
        /// The fog factor.
        Fog => 1,
        /// Where a fog function is evaluated.
        FogCoordinate => 1,
        /// What the vertex passes on as its fog.
        PassedFog => 1,
        /// The size of its point in 1/8 pixel, a whole number.
        PointSize => 1,
        /// s, t, r, q of coordinate set 0.
        T0 => 4,
        /// s, t, r, q of coordinate set 1.
        T1 => 4,
        /// s, t, r, q of coordinate set 2.
        T2 => 4,
        /// s, t, r, q of coordinate set 3.
        T3 => 4,
    }
}
