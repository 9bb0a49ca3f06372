//! Lowers the sizes of points that the vertex side computes (PNT-3).
#![allow(clippy::float_arithmetic, reason = "the vertex side is f32 by rule")]

use super::geometry::{Geometry, Objects};
use super::*;
use ninebit::vertex::point::PointParameters;
use ninebit::vertex::{EyeVertex, ModelView, Viewer};

/// Returns the size of the point at each vertex, if a draw has parameters for it.
pub(super) fn sizes<'a>(
    reader: &mut Reader<'a>,
    raw: &Option<Raw<'a, source::PointParameters<'a>>>,
    geometry: &Geometry,
) -> Option<Arc<[u16]>> {
    let raw = raw.as_ref()?;
    let fields = reader.read(raw)?;
    if let Objects::Program { point_sizes, .. } = &geometry.objects {
        let Some(sizes) = point_sizes else {
            let message = "the sizes of points are those in oPts, which nothing writes";
            let help = "write it, `mov oPts.x, c4.x`; or leave `point_parameters` out";
            return reader.refuse(finding("NB0389", reader.span(raw), message, "needs them", help).rule("PNT-3"));
        };
        return Some(sizes.as_slice().into());
    }
    let [a, b, c, _] = fields.attenuation(reader);
    let (bias, range, smallest) = (fields.bias(reader), fields.range(reader), fields.smallest(reader));
    let parameters = PointParameters { attenuation: [a, b, c], bias, range, smallest };
    let model_view = ModelView::new(&geometry.model_view);
    let size = |(index, vertex): (usize, Vertex)| {
        let object = geometry.objects.at(index, &vertex);
        let [x, y, z] = EyeVertex::new(&object, &model_view, Viewer::Local).point();
        parameters.size((x * x + y * y + z * z).sqrt())
    };
    Some(geometry.vertices.iter().enumerate().map(size).collect())
}
