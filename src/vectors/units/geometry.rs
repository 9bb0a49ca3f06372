//! Primitives: the triangles that they are made of.

use std::sync::Arc;

use super::{Column, Conditions, Kind, Reach, Unit, named, put};
use ninebit::raster::triangles::Triangles;
use ninebit::state::{Profile, ProvokingVertex, Topology};

/// The vertices of one triangle of a primitive.
pub(super) struct PrimitiveSplit;

/// Returns the triangles of a row's primitive.
fn triangles(inputs: &[i64]) -> Triangles {
    let indices: Arc<[u32]> = (0..inputs[2] as u32).collect();
    Triangles::split(&indices, named(inputs[0]), named(inputs[1]))
}

impl Unit for PrimitiveSplit {
    known_as!(
        "primitive-split", &["RAS-4", "RAS-5"],
        "the vertices of one triangle of a primitive, in order, and the provoking vertex", Geometry;
        takes [
            Column::choice::<Topology>("cfg.topology"),
            Column::choice::<ProvokingVertex>("cfg.provoking_vertex"),
            ["in.vertices", "in.triangle"].map(|name| Column::unsigned(name, 6, 63)),
        ];
        gives [Column::results(["out.first", "out.second", "out.third", "out.provoking"], Kind::Unsigned(6))]
    );

    fn accepts(&self, inputs: &[i64], _: Profile) -> bool {
        inputs[3] < triangles(inputs).len() as i64
    }

    fn fit(&self, inputs: &mut [i64]) {
        inputs[3] %= (triangles(inputs).len() as i64).max(1);
    }

    fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
        let found = triangles(inputs).at(inputs[3] as usize);
        put(results, found.vertices.into_iter().chain([found.provoking]));
    }
}
