//! Half components of normals: the positive or the negative part of one component, as an unsigned texture.
//!
//! Without signed arithmetic a product f g is f+ g+ + f- g- - f+ g- - f- g+, where f+ is f where it is positive, else 0, and f- is -f where it is
//! negative, else 0. All four channels of a texel hold the half component.
#![allow(clippy::float_arithmetic, reason = "input data: f64, + - * / in a fixed order, rounded")]

use super::normal_map::decode;
use super::*;

/// Returns the half component of each texel of a normal map. `axis` is 0 for x, 1 for y, 2 for z.
pub fn of_normals(normals: &Rgba, axis: usize, negative: bool) -> Rgba {
    let texel = |[r, g, b, _]: &[u8; 4]| {
        let component = decode([*r, *g, *b]).get(axis).copied().unwrap_or(0.0);
        [byte(if negative { -component } else { component }); 4]
    };
    Rgba { width: normals.width, height: normals.height, pixels: normals.pixels.iter().map(texel).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_component_is_in_one_of_the_halves() {
        let normals = Rgba { width: 2, height: 1, pixels: vec![[255, 1, 128, 255], [64, 191, 0, 255]] };
        let half =
            |axis, negative| of_normals(&normals, axis, negative).pixels.iter().map(|p| p[0]).collect::<Vec<_>>();
        assert_eq!((half(0, false), half(0, true)), (vec![255, 0], vec![0, 129]));
        assert_eq!((half(1, false), half(1, true)), (vec![0, 126], vec![255, 0]));
        assert_eq!((half(2, false), half(2, true)), (vec![0, 0], vec![0, 255]));
    }
}
