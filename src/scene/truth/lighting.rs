//! Computes the lighting equation at a point, in float64 with vectors of unit length.
//!
//! It uses only + - * / and square roots, so every machine gets the same bits.

use super::{Eye, Light, Material, Model, Place};
use crate::generate::power_table::power;
use crate::vector::{Vector, dot, minus, plus, scaled, unit_or_zero};

/// Returns the unit vector from a point of a surface toward a light or an eye.
fn toward(place: &Place, point: Vector) -> Vector {
    unit_or_zero(match place {
        Place::Position(position) => minus(*position, point),
        Place::Direction(direction) => *direction,
    })
}

/// Returns R, G and B that a light adds at a point with the given unit normal.
pub(super) fn light(light: &Light, eye: Option<&Eye>, material: &Material, point: Vector, normal: Vector) -> [f64; 3] {
    let to_light = toward(&light.place, point);
    let facing = dot(normal, to_light);
    let mut terms = material.diffuse.map(|c| c * facing.max(0.0));
    if let Some(Eye(eye)) = eye
        && (facing > 0.0 || !material.self_shadowing)
    {
        let to_eye = toward(eye, point);
        let cosine = match material.model {
            Model::Blinn => dot(normal, unit_or_zero(plus(to_light, to_eye))),
            Model::Phong => dot(minus(scaled(normal, 2.0 * facing), to_light), to_eye),
        };
        let highlight = power(cosine.max(0.0), material.exponent);
        for (term, specular) in terms.iter_mut().zip(material.specular) {
            *term += specular * highlight;
        }
    }
    [0, 1, 2].map(|n| terms[n] * light.color[n])
}

#[cfg(test)]
mod tests {
    use super::*;

    const MATTE: Material = Material {
        ambient: [0.0; 3],
        diffuse: [1.0; 3],
        specular: [0.0; 3],
        exponent: 1,
        model: Model::Blinn,
        self_shadowing: false,
    };
    const UP: Vector = [0.0, 0.0, 1.0];

    fn sun(direction: Vector) -> Light {
        Light { place: Place::Direction(direction), color: [1.0, 0.5, 0.25] }
    }

    #[test]
    fn diffuse_light_is_the_cosine() {
        let material = Material { diffuse: [0.8, 1.0, 1.0], ..MATTE };
        // 3-4-5: cosine 0.8, whatever the length.
        let lit = light(&sun([6.0, 0.0, 8.0]), None, &material, [0.0; 3], UP);
        assert_eq!(lit.map(|c| (c * 1e9).round() / 1e9), [0.64, 0.4, 0.2]);
        assert_eq!(light(&sun([0.0, 0.0, -1.0]), None, &material, [0.0; 3], UP), [0.0; 3]);
    }

    #[test]
    fn lamps_and_eyes_have_places() {
        let material = Material { diffuse: [0.0; 3], specular: [1.0; 3], exponent: 2, ..MATTE };
        let lamp = Light { place: Place::Position([1.0, 0.0, 1.0]), color: [1.0; 3] };
        // Light and eye mirror each other, so the half vector is the normal, and the reflected light meets the eye.
        let eye = Eye(Place::Position([-1.0, 0.0, 1.0]));
        for model in [Model::Blinn, Model::Phong] {
            let lit = light(&lamp, Some(&eye), &Material { model, ..material }, [0.0; 3], UP);
            assert!((lit[0] - 1.0).abs() < 1e-12, "{model:?}: {lit:?}");
        }
        // The eye is straight above and the light at 60 degrees: Blinn gives cos^2 30, Phong cos^2 60.
        let (eye, sun) = (Eye(Place::Direction(UP)), sun([3.0_f64.sqrt(), 0.0, 1.0]));
        let lit = |model| light(&sun, Some(&eye), &Material { model, ..material }, [0.0; 3], UP)[0];
        assert!((lit(Model::Blinn) - 0.75).abs() < 1e-12 && (lit(Model::Phong) - 0.25).abs() < 1e-12);
    }

    #[test]
    fn surfaces_that_shade_themselves_have_no_highlight_behind() {
        let material = Material { diffuse: [0.0; 3], specular: [1.0; 3], exponent: 1, ..MATTE };
        let (eye, behind) = (Eye(Place::Direction(UP)), sun([1.0, 0.0, -0.1]));
        assert!(light(&behind, Some(&eye), &material, [0.0; 3], UP)[0] > 0.6);
        let shading = Material { self_shadowing: true, ..material };
        assert_eq!(light(&behind, Some(&eye), &shading, [0.0; 3], UP)[0], 0.0);
    }
}
