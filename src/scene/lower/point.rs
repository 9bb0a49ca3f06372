//! Lowers the sizes of points that the vertex side computes (PNT-3).
#![allow(clippy::float_arithmetic, reason = "the vertex side is f32 by rule")]

use super::geometry::{Geometry, Objects};
use super::*;
use ninebit::vertex::point::PointParameters;
use ninebit::vertex::{EyeVertex, ModelView, Viewer};

/// Returns the size of the point at each vertex, if a draw has parameters for it, or vertices have their own; `size` is that of the others.
pub(super) fn sizes<'a>(
    reader: &mut Reader<'a>,
    raw: &Option<Raw<'a, source::PointParameters<'a>>>,
    geometry: &Geometry,
    size: u16,
) -> Option<Arc<[u16]>> {
    let own = match &geometry.objects {
        Objects::Listed(data) => &data.extras[..],
        Objects::Mesh(..) | Objects::Program { .. } => &[],
    };
    let first = own.iter().position(|extra| extra.point_size.is_some());
    let Some(raw) = raw else {
        return first.map(|_| own.iter().map(|extra| extra.point_size.unwrap_or(size)).collect());
    };
    if let Some(vertex) = first {
        let message = "points have sizes at their vertices, and by their distance";
        let help = "keep one of `point_size` of the vertices and `point_parameters`";
        let place = DrawSpans { vertices: geometry.spans.clone(), ..DrawSpans::default() }.vertex(vertex);
        let found = finding("NB0238", reader.span(raw), message, "by their distance", help).rule("PNT-3");
        return reader.refuse(found.related(place, "has a size"));
    }
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
