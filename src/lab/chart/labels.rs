//! Rectangles of drawings, and the widths of texts.

/// A rectangle, in pixels from the top left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rect {
    /// Column of the left edge.
    pub(crate) x: f64,
    /// Row of the upper edge.
    pub(crate) y: f64,
    /// Width in pixels.
    pub(crate) width: f64,
    /// Height in pixels.
    pub(crate) height: f64,
}

/// Estimates the width of a text in a sans-serif font of the given size. The estimate is rather too large than too small.
pub fn text_width(text: &str, size: f64) -> f64 {
    let advance = |c: char| match c {
        'i' | 'j' | 'l' | '.' | ',' | ':' | '\'' | '|' | ' ' => 0.33,
        'f' | 'r' | 't' | '-' | '(' | ')' | '/' => 0.43,
        'm' | 'w' | 'M' | 'W' => 0.99,
        c if c.is_uppercase() => 0.74,
        _ => 0.64,
    };
    text.chars().map(advance).sum::<f64>() * size
}
