//! Takes a printed function's inputs, and the expected results, from the trace of a fragment.

use std::collections::HashMap;

use ninebit::combiner::registers::channel_name;
use ninebit::engine::DrawTrace;
use ninebit::state::Draw;
use ninebit_lower::{Input, Weight};

/// The values of a trace by name, each with its operation.
pub struct Traced<'t> {
    /// The last value of each name.
    last: HashMap<&'t str, (i64, &'t str)>,
    /// The value of each name before stages write to it.
    first: HashMap<&'t str, (i64, &'t str)>,
}

impl<'t> Traced<'t> {
    pub fn from_fragment(fragment: &'t DrawTrace) -> Traced<'t> {
        let last = fragment.steps.iter().map(|step| (step.name.as_str(), (step.value, step.operation))).collect();
        let mut first: HashMap<&str, (i64, &str)> = HashMap::new();
        let mut combines = false;
        for step in &fragment.steps {
            combines |= step.block.starts_with("general stage") || step.block == "final combiner";
            if !combines || !first.contains_key(step.name.as_str()) {
                first.insert(&step.name, (step.value, step.operation));
            }
        }
        Traced { last, first }
    }

    pub fn said(&self, name: &str) -> Option<i64> {
        self.last.get(name).map(|(value, _)| *value)
    }

    /// Returns whether the alpha test dropped the fragment.
    pub fn dropped(&self) -> bool {
        self.said("alpha_test.passed") == Some(0)
    }

    /// Returns the value of an input; 0 if the trace does not have it, since nothing depends on it then.
    pub fn given(&self, draw: &Draw, input: Input) -> i64 {
        let said = |name: String| self.first.get(name.as_str()).map_or(0, |(value, _)| *value);
        let texel = |n: usize, at: usize| {
            let next = if at < 4 { "" } else { "next." };
            let of = |suffix: &str| self.first.get(format!("unit{n}.{next}texel{suffix}.word").as_str()).copied();
            // A single texel is the first.
            of(["00", "10", "01", "11"][at % 4]).or_else(|| of("").filter(|_| at.is_multiple_of(4))).unwrap_or((0, ""))
        };
        match input {
            Input::Primary(c) => said(format!("primary.{}", channel_name(c))),
            Input::Secondary(c) => said(format!("secondary.{}", channel_name(c))),
            Input::Fog(c) => said(format!("fog.{}", channel_name(c))),
            Input::Texture(n, c) => said(format!("texture{n}.{}", channel_name(c))),
            Input::Texel(n, at) => texel(n, at).0,
            Input::Outside(n) => (0..8).filter(|at| texel(n, *at).1 == "border_color").map(|at| 1 << at).sum(),
            Input::Weight(n, of) => said(match of {
                Weight::U => format!("unit{n}.weight_u"),
                Weight::V => format!("unit{n}.weight_v"),
                Weight::NextU => format!("unit{n}.next.weight_u"),
                Weight::NextV => format!("unit{n}.next.weight_v"),
                Weight::Level => format!("unit{n}.weight_lod"),
            }),
            Input::Destination => said("destination.word".to_string()).max(said("surface.word".to_string())),
            Input::StageConstant(stage, n, c) => draw.combiners.stages[stage].constants[n][c].into(),
            Input::FinalConstant(n, c) => draw.combiners.final_combiner.constants[n][c].into(),
            Input::FogColor(c) => draw.fog.color[c].into(),
            Input::BlendConstant(c) => draw.blend_constant[c].into(),
            Input::AlphaReference => draw.alpha_test.unwrap().reference.into(),
            Input::BorderColor(n, c) => draw.textures[n].unwrap().border_color[c].into(),
            input => panic!("this function does not read {input:?}"),
        }
    }
}
