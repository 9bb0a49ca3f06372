//! Makes tori and cylinders.
#![allow(clippy::float_arithmetic, reason = "vertices are floats for the chip, too; the order is fixed")]

use super::{Mesh, MeshError, across, at_least, cells, circle, narrow, with_room};

/// Makes a torus about the y axis: `slices` around the axis, `sides` around the tube. The middle of the tube is at distance `radius` from the
/// axis, and the tube's own radius is `tube`.
///
/// s is as on a [sphere](super::sphere); t is 0 along the top and grows downward on the outside, up to `repeat[1]` back at the top.
///
/// # Errors
/// Fewer than 3 slices or sides, or too many vertices.
pub(crate) fn torus(slices: u32, sides: u32, radius: f32, tube: f32, repeat: [f32; 2]) -> Result<Mesh, MeshError> {
    at_least("torus", "slices", 3, slices)?;
    at_least("torus", "sides", 3, sides)?;
    let mut mesh = with_room("torus", slices, sides)?;
    let (radius, tube) = (f64::from(radius), f64::from(tube));
    for side in 0..=sides {
        let [sin_side, cos_side] = circle(side, sides);
        for slice in 0..=slices {
            let [sin_azimuth, cos_azimuth] = circle(slice, slices);
            let out = radius + tube * sin_side;
            let normal = [sin_side * sin_azimuth, cos_side, sin_side * cos_azimuth];
            let binormal = [-cos_side * sin_azimuth, sin_side, -cos_side * cos_azimuth];
            let basis = [[cos_azimuth, 0.0, -sin_azimuth], binormal, normal].map(narrow);
            let position = narrow([out * sin_azimuth, tube * cos_side, out * cos_azimuth]);
            mesh.push(position, basis, across([slice, side], [slices, sides], repeat));
        }
    }
    mesh.indices = cells(slices, sides).collect();
    Ok(mesh)
}

/// Makes a cylinder about the y axis, centred on the origin: `slices` around the axis, `stacks` from top to bottom, closed by two discs if `caps`.
///
/// s is as on a [sphere](super::sphere), t is 0 at the top and `repeat[1]` at the bottom. Each disc shows the texture once, upright
/// to a viewer who looks along the axis.
///
/// # Errors
/// Fewer than 3 slices or 1 stack, or too many vertices.
pub(crate) fn cylinder(
    slices: u32,
    stacks: u32,
    radius: f32,
    height: f32,
    caps: bool,
    repeat: [f32; 2],
) -> Result<Mesh, MeshError> {
    at_least("cylinder", "slices", 3, slices)?;
    at_least("cylinder", "stacks", 1, stacks)?;
    // The vertices of the two discs take up to four more rows.
    let mut mesh = with_room("cylinder", slices, stacks.saturating_add(if caps { 4 } else { 0 }))?;
    for stack in 0..=stacks {
        let y = (stacks as f32 - 2.0 * stack as f32) / (2.0 * stacks as f32) * height;
        for slice in 0..=slices {
            let [sin_azimuth, cos_azimuth] = circle(slice, slices).map(|c| c as f32);
            let basis = [[cos_azimuth, 0.0, -sin_azimuth], [0.0, 1.0, 0.0], [sin_azimuth, 0.0, cos_azimuth]];
            let position = [radius * sin_azimuth, y, radius * cos_azimuth];
            mesh.push(position, basis, across([slice, stack], [slices, stacks], repeat));
        }
    }
    let mut indices: Vec<u32> = cells(slices, stacks).collect();
    for up in [1.0, -1.0].into_iter().filter(|_| caps) {
        indices.extend(disc(&mut mesh, slices, radius, up * (height / 2.0), up));
    }
    mesh.indices = indices.into();
    Ok(mesh)
}

/// Adds the vertices of a disc at height `y` that faces up (1) or down (-1). Returns the indices of its triangles.
fn disc(mesh: &mut Mesh, slices: u32, radius: f32, y: f32, up: f32) -> impl Iterator<Item = u32> + use<> {
    let first = mesh.positions.len() as u32;
    // The middle comes first, then the rim.
    for at in 0..=slices {
        let [x, z] = if at == 0 { [0.0; 2] } else { circle(at - 1, slices).map(|c| c as f32) };
        let basis = [[1.0, 0.0, 0.0], [0.0, 0.0, -up], [0.0, up, 0.0]];
        mesh.push([radius * x, y, radius * z], basis, [0.5 + 0.5 * x, 0.5 + 0.5 * up * z]);
    }
    (0..slices).flat_map(move |slice| {
        let (here, next) = (first + 1 + slice, first + 1 + (slice + 1) % slices);
        // The rim runs counter-clockwise seen from above.
        if up > 0.0 { [first, here, next] } else { [first, next, here] }
    })
}

#[cfg(test)]
mod tests {
    use super::super::tests::check;
    use super::*;

    #[test]
    fn tori_are_round() {
        for (slices, sides) in [(3, 3), (24, 12), (7, 30)] {
            let mesh = torus(slices, sides, 2.0, 0.5, [4.0, 1.0]).expect("mesh");
            check(&mesh);
            assert_eq!(mesh.indices.len() as u32, slices * sides * 6);
            for [x, y, z] in &mesh.positions {
                let out = (x * x + z * z).sqrt() - 2.0;
                assert!((out * out + y * y - 0.25).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn cylinders_are_closed_or_not() {
        for caps in [false, true] {
            let mesh = cylinder(12, 3, 1.5, 4.0, caps, [2.0, 1.0]).expect("mesh");
            check(&mesh);
            assert_eq!(mesh.indices.len(), 12 * 3 * 6 + if caps { 2 * 12 * 3 } else { 0 });
            let edge = mesh.positions.iter().map(|p| p[1].abs()).fold(0.0_f32, f32::max);
            assert_eq!(edge, 2.0);
        }
        assert!(matches!(cylinder(3, 0, 1.0, 1.0, true, [1.0; 2]), Err(MeshError::TooCoarse { .. })));
        assert!(matches!(torus(3, u32::MAX, 1.0, 0.1, [1.0; 2]), Err(MeshError::TooFine { .. })));
        assert!(matches!(cylinder(3, u32::MAX, 1.0, 1.0, true, [1.0; 2]), Err(MeshError::TooFine { .. })));
    }

    /// The bases that these shapes know are those that VTX-4 computes.
    #[test]
    fn bases_agree_with_what_the_texture_says() {
        for mesh in
            [torus(24, 16, 2.0, 0.5, [1.0; 2]), cylinder(24, 2, 1.0, 2.0, true, [1.0; 2])].map(|m| m.expect("mesh"))
        {
            let found = super::super::tangent::tests::again(&mesh);
            for (a, b) in mesh.tangents.iter().chain(&mesh.binormals).zip(found.tangents.iter().chain(&found.binormals))
            {
                let product: f32 = (0..3).map(|k| a[k] * b[k]).sum();
                assert!(product > 0.99, "{a:?} {b:?}");
            }
        }
    }
}
