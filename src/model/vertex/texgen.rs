//! TSH-11: generated texture coordinates and texture matrices.
#![allow(clippy::float_arithmetic, reason = "the vertex side is f32 by rule")]

use super::vector::{cross, dot3, dot4, length};
use super::{EyeVertex, Rows};
use crate::state::Profile;

/// The source of a generated component of a coordinate set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Generator {
    /// The distance of the given position from a plane in object space.
    ObjectLinear([f32; 4]),
    /// The distance of the position in eye space from a plane in eye space.
    EyeLinear([f32; 4]),
    /// The coordinates s, t of the reflection on a mirroring sphere.
    SphereMap,
    /// The components s, t, r of the normal in eye space.
    NormalMap,
    /// The components s, t, r of the reflected line of sight in eye space.
    ReflectionMap,
}

/// Emboss bump mapping of nv10: coordinate set 1 is set 0 displaced along the surface toward a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emboss {
    /// Vector toward the light in eye space. Its length matters.
    pub light: [f32; 3],
    /// Scale of the displacement of s and t.
    pub scale: [f32; 2],
}

/// How one coordinate set is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoordinateSet {
    /// Index of the given set that provides components without a generator.
    pub input: usize,
    /// Generators of s, t, r and q. `None` keeps the component that was given.
    pub generators: [Option<Generator>; 4],
    /// Emboss state, which replaces the generators.
    pub emboss: Option<Emboss>,
    /// Texture matrix, which is applied last.
    pub matrix: Option<Rows>,
    /// How the matrix is applied by Direct3D's rules. `None` applies it to all four components.
    pub transform: Option<StageTransform>,
}

/// Direct3D's D3DTSS_TEXTURETRANSFORMFLAGS of a texture stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StageTransform {
    /// COUNT2 to COUNT4 apply the matrix and use this many components of the result. 0 and 1 do not apply it.
    pub count: usize,
    /// Whether the coordinates are divided by the last component that counts (PROJECTED).
    pub projected: bool,
}

impl CoordinateSet {
    /// Returns the state that passes set `index` as it was given.
    pub fn given(index: usize) -> CoordinateSet {
        CoordinateSet { input: index, generators: [None; 4], emboss: None, matrix: None, transform: None }
    }

    /// Computes the set of a vertex whose given sets are `given`.
    pub fn at(&self, vertex: &EyeVertex<'_>, given: &[[f32; 4]; 4], profile: Profile) -> [f32; 4] {
        let coordinates = match &self.emboss {
            Some(emboss) => embossed(emboss, vertex, given[0], given[1]),
            None => std::array::from_fn(|component| match self.generators[component] {
                None => given[self.input][component],
                Some(generator) => generate(generator, component, vertex),
            }),
        };
        match (&self.transform, &self.matrix) {
            (Some(transform), matrix) => {
                // Generated coordinates have four components, the last of which is 1.
                let made = self.generators.iter().any(Option::is_some);
                let [s, t, r, _] = coordinates;
                let (coordinates, dimensions) =
                    if made { ([s, t, r, 1.0], 4) } else { (coordinates, vertex.object.dimensions[self.input]) };
                transform.of(coordinates, dimensions, matrix.as_ref())
            }
            (None, Some(matrix)) => multiplied(matrix, coordinates, profile),
            (None, None) => coordinates,
        }
    }
}

impl StageTransform {
    /// Transforms coordinates of which `dimensions` components were given. With a matrix, the first component that was
    /// not given is 1. The other missing components, or all of them without a matrix, are 0. q becomes the divisor. It
    /// is 1 unless projected, and without a matrix it is the last component that was given.
    fn of(&self, coordinates: [f32; 4], dimensions: usize, matrix: Option<&Rows>) -> [f32; 4] {
        let transformed = self.count >= 2;
        let input: [f32; 4] = std::array::from_fn(|n| match n {
            _ if n < dimensions => coordinates[n],
            _ if n == dimensions && transformed => 1.0,
            _ => 0.0,
        });
        let (result, last) = match matrix.filter(|_| transformed) {
            Some(matrix) => (super::transform(matrix, input), self.count),
            None if transformed => (input, self.count),
            None => (input, dimensions),
        };
        let divisor = result.get(last.saturating_sub(1)).copied().unwrap_or(1.0);
        [result[0], result[1], result[2], if self.projected { divisor } else { 1.0 }]
    }
}

fn generate(generator: Generator, component: usize, vertex: &EyeVertex<'_>) -> f32 {
    let of = |v: [f32; 3]| v.get(component).copied().unwrap_or(0.0);
    match generator {
        Generator::ObjectLinear(plane) => dot4(plane, vertex.object.position),
        Generator::EyeLinear(plane) => dot4(plane, vertex.position),
        Generator::SphereMap => of(sphere(vertex.reflection())),
        Generator::NormalMap => of(vertex.normal),
        Generator::ReflectionMap => of(vertex.reflection()),
    }
}

/// Returns (r + (0, 0, 1)) / (2 |r + (0, 0, 1)|) + 1/2, or the middle for a reflection straight away from the viewer.
fn sphere([x, y, z]: [f32; 3]) -> [f32; 3] {
    let m = 2.0 * length([x, y, z + 1.0]);
    if m == 0.0 { [0.5; 3] } else { [x / m + 0.5, y / m + 0.5, 0.0] }
}

/// Returns s + q Ks (L . B) and t - q Kt (L . T). The tangent is given by set 1; B = N x T and T = B x N are of unit
/// length.
fn embossed(emboss: &Emboss, vertex: &EyeVertex<'_>, [s, t, r, q]: [f32; 4], tangent: [f32; 4]) -> [f32; 4] {
    let tangent = vertex.model_view.direction([tangent[0], tangent[1], tangent[2]]);
    let binormal = super::unit(cross(vertex.normal, tangent));
    let tangent = cross(binormal, vertex.normal);
    let [ks, kt] = emboss.scale;
    [s + q * (ks * dot3(emboss.light, binormal)), t - q * (kt * dot3(emboss.light, tangent)), r, q]
}

/// Returns M t. On nv10 the row of q multiplies the s that the first row has computed.
fn multiplied(matrix: &Rows, coordinates: [f32; 4], profile: Profile) -> [f32; 4] {
    let mut result = super::transform(matrix, coordinates);
    if profile == Profile::Nv10 {
        let [_, t, r, q] = coordinates;
        result[3] = dot4(matrix[3], [result[0], t, r, q]);
    }
    result
}

#[cfg(test)]
mod tests {
    use super::super::{ModelView, ObjectVertex, Viewer};
    use super::*;
    use proptest::prelude::*;

    const IDENTITY: Rows = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
    const GIVEN: [[f32; 4]; 4] =
        [[0.25, 0.5, 0.75, 2.0], [1.0, 0.0, 0.0, 1.0], [3.0, 4.0, 5.0, 6.0], [7.0, 8.0, 9.0, 10.0]];

    fn set(generators: [Option<Generator>; 4]) -> CoordinateSet {
        CoordinateSet { generators, ..CoordinateSet::given(2) }
    }

    fn at(set: &CoordinateSet, view: &Rows, position: [f32; 4], normal: [f32; 3], profile: Profile) -> [f32; 4] {
        let object = ObjectVertex { position, normal, fog_coordinate: 0.0, dimensions: [4; 4] };
        let view = ModelView::new(view);
        set.at(&EyeVertex::new(&object, &view, Viewer::Local), &GIVEN, profile)
    }

    #[test]
    fn planes_and_inputs() {
        let mut view = IDENTITY;
        view[0][3] = 10.0;
        let made = set([
            Some(Generator::ObjectLinear([1.0, 2.0, 3.0, 4.0])),
            Some(Generator::EyeLinear([1.0, 2.0, 3.0, 4.0])),
            None,
            None,
        ]);
        assert_eq!(at(&made, &view, [1.0, 1.0, 1.0, 1.0], [0.0; 3], Profile::Nv2a), [10.0, 20.0, 5.0, 6.0]);
        assert_eq!(at(&CoordinateSet::given(0), &view, [9.0; 4], [0.0; 3], Profile::Nv2a), GIVEN[0]);
    }

    #[test]
    fn without_normals_the_reflection_is_the_line_of_sight() {
        let made =
            set([Some(Generator::ReflectionMap), Some(Generator::ReflectionMap), Some(Generator::ReflectionMap), None]);
        let r = at(&made, &IDENTITY, [0.0, 3.0, -4.0, 1.0], [0.0; 3], Profile::Nv2a);
        assert!((r[1] - 0.6).abs() < 1e-6 && (r[2] + 0.8).abs() < 1e-6 && r[0] == 0.0);
    }

    #[test]
    fn sphere_maps_in_the_middle() {
        let made = set([Some(Generator::SphereMap), Some(Generator::SphereMap), None, None]);
        // Straight at a mirror, straight ahead without a normal, and at the viewer's own place.
        for (position, normal) in [
            ([0.0, 0.0, -5.0, 1.0], [0.0, 0.0, 1.0]),
            ([0.0, 0.0, -5.0, 1.0], [0.0; 3]),
            ([0.0, 0.0, 0.0, 1.0], [0.0; 3]),
        ] {
            assert_eq!(at(&made, &IDENTITY, position, normal, Profile::Nv2a), [0.5, 0.5, 5.0, 6.0]);
        }
        // At a grazing angle the reflection continues to the rim.
        let rim = at(&made, &IDENTITY, [0.0, 0.0, -5.0, 1.0], [0.999_999, 0.001, 0.0], Profile::Nv2a);
        assert!(rim.iter().all(|c| c.is_finite()));
    }

    #[test]
    fn the_first_chip_mixes_up_its_last_row() {
        let matrix = [[2.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, 1.0]];
        let made = CoordinateSet { matrix: Some(matrix), ..CoordinateSet::given(2) };
        // s' = 2 * 3 + 6 = 12, and q' = 3 + 6 or 12 + 6.
        assert_eq!(at(&made, &IDENTITY, [0.0; 4], [0.0; 3], Profile::Nv2a), [12.0, 4.0, 5.0, 9.0]);
        assert_eq!(at(&made, &IDENTITY, [0.0; 4], [0.0; 3], Profile::Nv10), [12.0, 4.0, 5.0, 18.0]);
    }

    /// Direct3D's flags for one to four given components, with a matrix that reverses their order.
    #[test]
    fn flags_count_and_project() {
        let matrix = [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]];
        let of = |given: usize, count, projected| {
            let transform = StageTransform { count, projected };
            transform.of([0.8, 0.2, 0.4, 0.5], given, Some(&matrix))
        };
        // 0 and 1 are alike: the matrix is not applied, and the last given component divides.
        for count in [0, 1] {
            assert_eq!(of(1, count, false), [0.8, 0.0, 0.0, 1.0]);
            assert_eq!(of(1, count, true), [0.8, 0.0, 0.0, 0.8]);
            assert_eq!(of(3, count, true), [0.8, 0.2, 0.4, 0.4]);
            assert_eq!(of(4, count, true), [0.8, 0.2, 0.4, 0.5]);
        }
        assert_eq!(of(1, 2, false), [0.0, 0.0, 1.0, 1.0]);
        assert_eq!(of(2, 2, true), [0.0, 1.0, 0.2, 1.0]);
        assert_eq!(of(2, 3, true), [0.0, 1.0, 0.2, 0.2]);
        assert_eq!(of(3, 4, true), [1.0, 0.4, 0.2, 0.8]);
        assert_eq!(of(4, 4, false), [0.5, 0.4, 0.2, 1.0]);
        assert_eq!(of(4, 3, true), [0.5, 0.4, 0.2, 0.2]);
        // Without a matrix it is the identity.
        assert_eq!(
            StageTransform { count: 3, projected: true }.of([0.8, 0.2, 9.0, 9.0], 2, None),
            [0.8, 0.2, 1.0, 1.0]
        );
    }

    #[test]
    fn embossing_moves_along_the_surface() {
        let emboss = Some(Emboss { light: [0.5, 0.25, 7.0], scale: [0.1, 0.2] });
        let made = CoordinateSet { emboss, ..CoordinateSet::given(1) };
        // n = z and tangent = x yield B = y and T = x. q is 2.
        let moved = at(&made, &IDENTITY, [0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0], Profile::Nv10);
        let expected = [0.25 + 2.0 * 0.1 * 0.25, 0.5 - 2.0 * 0.2 * 0.5, 0.75, 2.0];
        assert!((0..4).all(|k| (moved[k] - expected[k] as f32).abs() < 1e-6), "{moved:?}");
        // Without a normal nothing moves.
        assert_eq!(at(&made, &IDENTITY, [0.0; 4], [0.0; 3], Profile::Nv10), GIVEN[0]);
    }

    proptest! {
        /// Compares with the usual formulas in float64.
        #[test]
        fn sphere_and_reflection_as_in_the_text(
            p in proptest::array::uniform3(-9.0_f64..9.0), n in proptest::array::uniform3(-1.0_f64..1.0),
        ) {
            let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let direction = |v: [f64; 3]| v.map(|c| c / dot(v, v).sqrt());
            prop_assume!(dot(p, p) > 0.1 && dot(n, n) > 0.1);
            let (u, n64) = (direction(p), direction(n));
            let r: [f64; 3] = std::array::from_fn(|k| u[k] - 2.0 * n64[k] * dot(n64, u));
            let m = 2.0 * (r[0] * r[0] + r[1] * r[1] + (r[2] + 1.0) * (r[2] + 1.0)).sqrt();
            prop_assume!(m > 0.1);
            let position = [p[0] as f32, p[1] as f32, p[2] as f32, 1.0];
            let normal = n.map(|c| c as f32);
            let all = |g| set([Some(g); 4]);
            let sphere = at(&all(Generator::SphereMap), &IDENTITY, position, normal, Profile::Nv2a);
            prop_assert!((f64::from(sphere[0]) - (r[0] / m + 0.5)).abs() < 1e-5);
            prop_assert!((f64::from(sphere[1]) - (r[1] / m + 0.5)).abs() < 1e-5);
            let mirrored = at(&all(Generator::ReflectionMap), &IDENTITY, position, normal, Profile::Nv2a);
            prop_assert!((0..3).all(|k| (f64::from(mirrored[k]) - r[k]).abs() < 1e-5));
        }

        #[test]
        fn nothing_becomes_nan(
            bits in proptest::array::uniform4(any::<u32>()), normal in proptest::array::uniform3(any::<u32>()), divide in any::<bool>(),
        ) {
            let number = |bits: u32| { let f = f32::from_bits(bits); if f.is_finite() { f } else { 0.0 } };
            let mut position = bits.map(number);
            if divide { position[3] = 0.0; }
            for generator in [Generator::SphereMap, Generator::NormalMap, Generator::ReflectionMap] {
                let made = at(&set([Some(generator); 4]), &IDENTITY, position, normal.map(number), Profile::Nv2a);
                prop_assert!(made.iter().all(|c| c.is_finite() && c.abs() <= 4.0), "{made:?}");
            }
        }
    }
}
