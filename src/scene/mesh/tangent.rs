//! Computes the tangent bases of a mesh from its positions and texture coordinates (VTX-4).
#![allow(clippy::float_arithmetic, reason = "vertices are floats for the chip, too; the order is fixed")]

use std::collections::HashMap;

use super::{Mesh, narrow};
use crate::vector::{Vector, cross, dot, minus, scaled, unit, wide};

/// Vertices and triangles without tangent bases. All lists of vertices have the same length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Positions x, y, z in object space.
    pub positions: Vec<[f32; 3]>,
    /// Normals of any length. Zero normals are computed from the triangles around.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates s and t, along which the tangents run.
    pub texture_coordinates: Vec<[f32; 2]>,
    /// Three indices for each triangle, each below the number of vertices.
    pub indices: Vec<u32>,
}

fn add(to: &mut Vector, v: Vector) {
    for (sum, c) in to.iter_mut().zip(v) {
        *sum += c;
    }
}

/// A triangle's contribution to the bases of its corners.
struct Face {
    corners: [usize; 3],
    /// Weight at each corner: the sine of the angle there, divided by the lengths of both edges. The weighted mean of normals on a
    /// sphere is then the sphere's normal, and the way in which a flat polygon is cut makes no difference.
    weights: [f64; 3],
    /// Unit normal of the triangle.
    normal: Vector,
    /// Unit vector along s; `None` where the texture has no direction.
    tangent: Option<Vector>,
    /// Whether the texture is seen from behind.
    mirrored: bool,
}

fn face(surface: &Surface, corners: [usize; 3]) -> Option<Face> {
    let [a, b, c] = corners.map(|corner| wide(surface.positions[corner]));
    let (first, second) = (minus(b, a), minus(c, a));
    let normal = cross(first, second);
    let area = dot(normal, normal).sqrt();
    // A triangle whose corners lie in a line, to the precision of f32, has no normal.
    let longest = dot(first, first).max(dot(second, second));
    if area <= longest * 1e-9 {
        return None;
    }
    let third = minus(c, b);
    let [ab, ac, bc] = [first, second, third].map(|edge| dot(edge, edge));
    // Two corners of a thin triangle may coincide.
    let weights = [ab * ac, ab * bc, ac * bc].map(|squares| if squares > 0.0 { area / squares } else { 0.0 });
    let [a, b, c] = corners.map(|corner| surface.texture_coordinates[corner].map(f64::from));
    let ([s1, t1], [s2, t2]) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
    let turn = s1 * t2 - s2 * t1;
    // Position is a function of s and t; this is its derivative along s, times `turn`.
    let mut along = scaled(first, t2);
    add(&mut along, scaled(second, -t1));
    let largest = s1.abs().max(s2.abs()) * t1.abs().max(t2.abs());
    let direction = unit(scaled(along, turn.signum()), 0.0).filter(|_| turn.abs() > largest * 1e-9);
    // t grows downward, so a texture seen from the front turns clockwise in s and t.
    Some(Face { corners, weights, normal: scaled(normal, 1.0 / area), tangent: direction, mirrored: turn > 0.0 })
}

/// Returns the bits of a coordinate's fraction, which is what a repeated texture depends on.
fn fraction(c: f32) -> u32 {
    let part = c - c.floor();
    if part == 1.0 || part == 0.0 { 0 } else { part.to_bits() }
}

/// Returns the bits of a vector, the same for 0 and -0.
fn bits(v: [f32; 3]) -> [u32; 3] {
    v.map(|c| if c == 0.0 { 0 } else { c.to_bits() })
}

/// Makes a mesh with tangent bases. A vertex that is shared by triangles with a mirrored and an unmirrored texture is split: vertices for the
/// mirrored triangles are added at the end.
///
/// Returns `None` if the lists of vertices differ in length or an index is past them.
pub fn mesh(surface: &Surface) -> Option<Mesh> {
    let (count, lists) = (surface.positions.len(), [surface.normals.len(), surface.texture_coordinates.len()]);
    if lists != [count; 2] || surface.indices.iter().any(|index| *index as usize >= count) {
        return None;
    }
    let corners =
        surface.indices.chunks_exact(3).map(|three| [three[0] as usize, three[1] as usize, three[2] as usize]);
    let faces: Vec<Option<Face>> = corners.map(|corners| face(surface, corners)).collect();
    let normals = normals(surface, &faces);
    let (split, indices) = split(surface, &faces);
    // Vertices at the same place of the same texture share a tangent, even if whole repetitions of the texture lie between them.
    let mut sums: HashMap<_, Vector> = HashMap::new();
    let key = |vertex: usize, mirrored: bool| {
        let place = bits(surface.positions[vertex]);
        (place, bits(normals[vertex]), surface.texture_coordinates[vertex].map(fraction), mirrored)
    };
    for face in faces.iter().flatten() {
        let Some(tangent) = face.tangent else { continue };
        for (corner, weight) in face.corners.into_iter().zip(face.weights) {
            add(sums.entry(key(corner, face.mirrored)).or_default(), scaled(tangent, weight));
        }
    }
    let mut mesh = Mesh { indices: indices.into(), ..Mesh::default() };
    for (vertex, mirrored) in split {
        let normal = normals[vertex];
        let sum = sums.get(&key(vertex, mirrored)).copied().unwrap_or_default();
        let (tangent, binormal) = basis(wide(normal), sum, mirrored);
        mesh.push(surface.positions[vertex], [tangent, binormal, normal], surface.texture_coordinates[vertex]);
    }
    Some(mesh)
}

/// Returns unit normals: the given ones, or else the weighted mean of the triangles at the same place.
fn normals(surface: &Surface, faces: &[Option<Face>]) -> Vec<[f32; 3]> {
    let mut sums: HashMap<[u32; 3], Vector> = HashMap::new();
    for face in faces.iter().flatten() {
        for (corner, weight) in face.corners.into_iter().zip(face.weights) {
            add(sums.entry(bits(surface.positions[corner])).or_default(), scaled(face.normal, weight));
        }
    }
    let places = surface.positions.iter().zip(&surface.normals);
    let normal = |(position, given): (&[f32; 3], &[f32; 3])| {
        let sum = sums.get(&bits(*position)).copied().unwrap_or_default();
        let found = unit(wide(*given), 0.0).or_else(|| unit(sum, 0.0));
        found.unwrap_or([0.0, 0.0, 1.0]).map(|c| c as f32)
    };
    places.map(normal).collect()
}

/// Returns the vertices of the mesh, as indices into the surface and whether the texture is mirrored there, and the triangles' indices into them.
fn split(surface: &Surface, faces: &[Option<Face>]) -> (Vec<(usize, bool)>, Vec<u32>) {
    // Whether triangles around each vertex have the texture seen from the front, and from behind.
    let mut seen = vec![[false; 2]; surface.positions.len()];
    for face in faces.iter().flatten().filter(|face| face.tangent.is_some()) {
        for corner in face.corners {
            seen[corner][usize::from(face.mirrored)] = true;
        }
    }
    let mut vertices: Vec<(usize, bool)> =
        (0..seen.len()).map(|vertex| (vertex, seen[vertex] == [false, true])).collect();
    let mut second = HashMap::new();
    for (vertex, _) in seen.iter().enumerate().filter(|(_, seen)| **seen == [true, true]) {
        second.insert(vertex, vertices.len() as u32);
        vertices.push((vertex, true));
    }
    let triangles = surface.indices.chunks_exact(3).zip(faces);
    let indices = triangles.flat_map(|(three, face)| {
        let mirrored = face.as_ref().is_some_and(|face| face.mirrored && face.tangent.is_some());
        let second = &second;
        three.iter().map(move |index| match second.get(&(*index as usize)) {
            Some(other) if mirrored => *other,
            _ => *index,
        })
    });
    let indices = indices.collect();
    (vertices, indices)
}

/// Returns tangent and binormal at right angles to the normal. If no triangle gives a direction, the tangent is arbitrary.
fn basis(normal: Vector, sum: Vector, mirrored: bool) -> ([f32; 3], [f32; 3]) {
    // Divided, because a normal that was rounded to f32 is not quite as long as 1, and the sum may be nearly parallel to it.
    let flat = minus(sum, scaled(normal, dot(sum, normal) / dot(normal, normal)));
    let length = dot(sum, sum).sqrt();
    // What remains beside the normal has to be more than rounding.
    let tangent = unit(flat, length * 1e6).or_else(|| {
        let smallest = (0..3).min_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs())).unwrap_or(0);
        let axis = std::array::from_fn(|k| if k == smallest { 1.0 } else { 0.0 });
        unit(cross(axis, normal), 0.0)
    });
    let tangent = tangent.unwrap_or([1.0, 0.0, 0.0]);
    let binormal = cross(normal, tangent);
    let binormal = if mirrored { scaled(binormal, -1.0) } else { binormal };
    (narrow(tangent), narrow(binormal))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Recomputes the bases of a mesh.
    pub(in crate::mesh) fn again(mesh: &Mesh) -> Mesh {
        super::mesh(&Surface {
            positions: mesh.positions.clone(),
            normals: mesh.normals.clone(),
            texture_coordinates: mesh.texture_coordinates.clone(),
            indices: mesh.indices.to_vec(),
        })
        .expect("a complete surface")
    }

    fn near(a: [f32; 3], b: [f32; 3]) -> bool {
        (0..3).all(|k| (a[k] - b[k]).abs() < 1e-5)
    }

    fn vector() -> impl Strategy<Value = [f32; 3]> {
        prop::array::uniform3(-4.0_f32..4.0)
    }

    /// Checks that bases are orthonormal. They are right-handed unless the texture is mirrored.
    fn check(mesh: &Mesh) -> Result<(), TestCaseError> {
        for vertex in 0..mesh.positions.len() {
            let [t, b, n] = [mesh.tangents[vertex], mesh.binormals[vertex], mesh.normals[vertex]].map(wide);
            for (v, w, product) in [(t, t, 1.0), (b, b, 1.0), (n, n, 1.0), (t, b, 0.0), (t, n, 0.0), (b, n, 0.0)] {
                prop_assert!((dot(v, w) - product).abs() < 1e-5, "{vertex}: {t:?} {b:?} {n:?}");
            }
        }
        prop_assert!(mesh.indices.iter().all(|index| (*index as usize) < mesh.positions.len()));
        Ok(())
    }

    /// Tangents of which hardly anything remains beside the normal, whose length is 1 but for rounding.
    #[test]
    fn nearly_parallel_tangents_are_at_right_angles() {
        let normal = wide([0.463_048_7, -0.722_368_1, 0.513_585_7]);
        let beside = unit(cross(normal, [1.0, 0.0, 0.0]), 0.0).expect("a direction");
        for part in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 3e-6] {
            let mut sum = normal;
            add(&mut sum, scaled(beside, part));
            let [tangent, binormal] = <[_; 2]>::from(basis(normal, sum, false)).map(wide);
            assert!(dot(tangent, normal).abs() < 1e-7 && dot(binormal, normal).abs() < 1e-7, "{part}: {tangent:?}");
            assert!(dot(tangent, beside) > 0.999, "{part}: {tangent:?}");
        }
    }

    proptest! {
        /// Holds for any input: degenerate triangles, textures without area, zero normals.
        #[test]
        fn bases_are_orthonormal(
            positions in prop::collection::vec(prop_oneof![vector(), Just([0.0; 3]), Just([1.0, 0.0, 0.0])], 3..12),
            coordinates in prop::collection::vec(prop::array::uniform2(prop_oneof![-2.0_f32..2.0, Just(0.0), Just(1.0)]), 12),
            normals in prop::collection::vec(prop_oneof![vector(), Just([0.0; 3])], 12),
            corners in prop::collection::vec(0..12_u32, 30),
        ) {
            let count = positions.len();
            let indices = corners.into_iter().map(|corner| corner % count as u32).collect();
            let surface = Surface {
                normals: normals[..count].to_vec(), texture_coordinates: coordinates[..count].to_vec(), positions, indices,
            };
            let mesh = mesh(&surface).expect("a complete surface");
            check(&mesh)?;
            prop_assert_eq!(mesh.indices.len(), surface.indices.len());
            for (index, given) in mesh.indices.iter().zip(&surface.indices) {
                let (vertex, given) = (*index as usize, *given as usize);
                prop_assert_eq!(mesh.positions[vertex], surface.positions[given]);
                prop_assert_eq!(mesh.texture_coordinates[vertex], surface.texture_coordinates[given]);
            }
        }

        /// The per-pixel-lighting papers' formulas for a triangle V1, V2, V3 whose texture is not sheared:
        /// DirectionV = |DeltaU2 Vec1 - DeltaU1 Vec2|, DirectionU = |DirectionV x N|, each up to its sign.
        #[test]
        fn one_triangle_is_as_the_papers_compute_it(
            corner in vector(), u in vector(), v in vector(), coordinates in prop::array::uniform3(prop::array::uniform2(-1.0_f32..1.0)),
        ) {
            let n = cross(wide(u), wide(v));
            prop_assume!(dot(n, n) > 0.5);
            // v is at right angles to u, and of another length.
            let v = narrow(scaled(cross(n, wide(u)), 0.3 / dot(n, n).sqrt()));
            let place = |[s, t]: [f32; 2]| std::array::from_fn(|k| corner[k] + s * u[k] + t * v[k]);
            let [s1, s2] = [1, 2].map(|k: usize| [0, 1].map(|c: usize| f64::from(coordinates[k][c] - coordinates[0][c])));
            prop_assume!((s1[0] * s2[1] - s1[1] * s2[0]).abs() > 0.1);
            let positions: Vec<[f32; 3]> = coordinates.iter().map(|c| place(*c)).collect();
            let [p1, p2, p3] = [0, 1, 2].map(|k| wide(positions[k]));
            let (vec1, vec2) = (minus(p3, p2), minus(p1, p2));
            let (delta1, delta2) = (f64::from(coordinates[2][0] - coordinates[1][0]), f64::from(coordinates[0][0] - coordinates[1][0]));
            let mut direction_v = scaled(vec1, delta2);
            add(&mut direction_v, scaled(vec2, -delta1));
            let direction_v = unit(direction_v, 0.0).expect("a direction");
            let surface = Surface {
                positions, normals: vec![[0.0; 3]; 3], texture_coordinates: coordinates.to_vec(), indices: vec![0, 1, 2],
            };
            let mesh = mesh(&surface).expect("a complete surface");
            check(&mesh)?;
            let direction_u = unit(cross(direction_v, wide(mesh.normals[0])), 0.0).expect("a direction");
            let parallel = |a: [f32; 3], b: Vector| (dot(wide(a), b).abs() - 1.0).abs() < 1e-3;
            prop_assert!(parallel(mesh.tangents[0], direction_u) && parallel(mesh.binormals[0], direction_v));
            // The signs follow the texture: s grows along the tangent, t against the binormal.
            prop_assert!(dot(wide(mesh.tangents[0]), wide(u)) > 0.0 && dot(wide(mesh.binormals[0]), wide(v)) < 0.0);
        }
    }

    fn square(coordinates: [[f32; 2]; 6]) -> Surface {
        // Two squares side by side in the plane z = 0, seen from +z, sharing the vertices 1 and 4.
        Surface {
            positions: vec![
                [0.0, 1.0, 0.0],
                [1.0, 1.0, 0.0],
                [2.0, 1.0, 0.0],
                [0.0; 3],
                [1.0, 0.0, 0.0],
                [2.0, 0.0, 0.0],
            ],
            normals: vec![[0.0; 3]; 6],
            texture_coordinates: coordinates.to_vec(),
            indices: vec![0, 3, 4, 0, 4, 1, 1, 4, 5, 1, 5, 2],
        }
    }

    #[test]
    fn mirrored_textures_split_their_vertices() {
        // s runs to the middle and back.
        let mesh = mesh(&square([[0.0, 0.0], [1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.0, 1.0]]))
            .expect("a complete surface");
        assert_eq!(mesh.positions.len(), 8);
        assert_eq!(mesh.indices[..], [0, 3, 4, 0, 4, 1, 6, 7, 5, 6, 5, 2]);
        for (vertex, tangent) in [(0, 1.0), (1, 1.0), (4, 1.0), (2, -1.0), (5, -1.0), (6, -1.0), (7, -1.0)] {
            assert!(near(mesh.tangents[vertex], [tangent, 0.0, 0.0]), "{vertex}: {:?}", mesh.tangents[vertex]);
            // Green still points up.
            assert!(near(mesh.binormals[vertex], [0.0, 1.0, 0.0]), "{vertex}");
        }
        let plain = self::mesh(&square([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0]]))
            .expect("a complete surface");
        assert_eq!(plain.positions.len(), 6);
        assert!(
            plain.tangents.iter().all(|t| near(*t, [1.0, 0.0, 0.0]))
                && plain.normals.iter().all(|n| near(*n, [0.0, 0.0, 1.0]))
        );
    }

    #[test]
    fn a_wrapped_texture_has_no_seam() {
        // A tent of two sides. The texture goes around it once; its first and last column are the same place.
        let surface = Surface {
            positions: vec![
                [0.0, 1.0, 1.0],
                [1.0, 1.0, 0.0],
                [0.0, 0.0, 1.0],
                [1.0, 0.0, 0.0],
                [0.0, 1.0, 1.0],
                [-1.0, 1.0, 0.0],
                [0.0, 0.0, 1.0],
                [-1.0, 0.0, 0.0],
            ],
            normals: vec![[0.0; 3]; 8],
            texture_coordinates: vec![
                [0.0, 0.0],
                [0.5, 0.0],
                [0.0, 1.0],
                [0.5, 1.0],
                [1.0, 0.0],
                [0.5, 0.0],
                [1.0, 1.0],
                [0.5, 1.0],
            ],
            indices: vec![0, 2, 3, 0, 3, 1, 5, 7, 6, 5, 6, 4],
        };
        let mesh = mesh(&surface).expect("a complete surface");
        assert_eq!(mesh.positions.len(), 8);
        for (first, last) in [(0, 4), (2, 6)] {
            assert_eq!(mesh.tangents[first], mesh.tangents[last]);
            assert!(near(mesh.tangents[first], [1.0, 0.0, 0.0]), "{:?}", mesh.tangents[first]);
        }
    }

    #[test]
    fn incomplete_surfaces_are_refused() {
        assert_eq!(super::mesh(&Surface { normals: Vec::new(), ..square([[0.0; 2]; 6]) }), None);
        assert_eq!(super::mesh(&Surface { indices: vec![0, 1, 6], ..square([[0.0; 2]; 6]) }), None);
    }

    #[test]
    fn triangles_without_area_say_nothing() {
        let mut surface = square([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0]]);
        let before = mesh(&surface).expect("a complete surface");
        surface.indices.extend([0, 0, 4, 3, 4, 5]);
        let after = mesh(&surface).expect("a complete surface");
        assert_eq!((before.tangents, before.normals), (after.tangents, after.normals));
    }

    #[test]
    fn generated_spheres_agree() {
        let sphere = super::super::sphere(24, 12, 2.0, [2.0, 1.0]).expect("mesh");
        let mesh = again(&sphere);
        assert_eq!(mesh.positions.len(), sphere.positions.len());
        for vertex in 0..mesh.positions.len() {
            // Poles have triangle fans of their own.
            if sphere.positions[vertex][1].abs() < 1.99 {
                assert!(dot(wide(mesh.tangents[vertex]), wide(sphere.tangents[vertex])) > 0.999, "{vertex}");
            }
        }
    }
}
