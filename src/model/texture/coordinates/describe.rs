//! Operands of steps that tell how coordinates came about.

use super::*;

impl VertexCoordinates<'_> {
    /// Returns what a sprite's coordinate is computed from.
    pub(super) fn sprite_inputs(
        &self,
        of: ([i64; 2], u16),
        pixel: (i64, i64),
        axis: usize,
        size: Operand,
    ) -> Vec<Operand> {
        let at = plain(["point.x", "point.y"][axis], of.0[axis]);
        let pixel = if axis == 0 { plain("x", pixel.0) } else { plain("y", pixel.1) };
        vec![pixel, at, plain("point.size", of.1), size]
    }

    /// Reports the components that the coordinates are computed from, at a sample whose weights have names that begin with `prefix`, and returns
    /// them as operands.
    pub(super) fn tell_numbers<O: Observer>(
        &self,
        report: &Report<'_>,
        prefix: &str,
        at: &Sample<'_>,
        observer: &mut O,
    ) -> Vec<Operand> {
        let components: &[usize] = match self.coordinates {
            Coordinates::Plane(_) => &[0, 1],
            Coordinates::Ratio(_) => &[0, 1, 3],
            Coordinates::Direction(_) => &[0, 1, 2],
            Coordinates::Sprite { .. } => &[],
        };
        let set = wrapped(self.unit, self.vertices.coordinates(self.unit.stage.coordinate_set));
        let each = components.iter().map(|&n| {
            let values = set.map(|vertex| vertex[n]);
            report.component(n, prefix, values, at, observer)
        });
        each.collect()
    }

    /// Reports r, and q if it is not 1 at all vertices, and returns them as operands.
    pub(super) fn tell_third<O: Observer>(&self, report: &Report<'_>, observer: &mut O) -> Vec<Operand> {
        let components: &[usize] = if self.r_and_q().1.is_some() { &[2, 3] } else { &[2] };
        components.iter().map(|&n| report.component(n, "", self.component(n), self.at, observer)).collect()
    }

    /// Reports the face that a direction meets, and returns it as an operand. Does nothing for other coordinates.
    pub(super) fn tell_face<O: Observer>(
        &self,
        report: &Report<'_>,
        name: &str,
        (at, numbers): (&Sample<'_>, &[Operand]),
        observer: &mut O,
    ) -> Option<Operand> {
        let Coordinates::Direction(direction) = self.coordinates else { return None };
        let face = Self::face_at(direction, at);
        let step = Step::plain(&report.block(), "TEX-12", report.name(name), face as i64);
        Some(observer.tell(step.by("cube_face", numbers.to_vec()).note(Named::name(face).to_string())))
    }
}
