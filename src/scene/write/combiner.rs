//! Writes programs of the combiners.

use super::node::{Fields, Node};
use ninebit::state::*;

/// Returns a program in the scene's own words; `None` for the one that a draw has if it names none.
pub(super) fn program(combiners: &Combiners) -> Option<Node> {
    if *combiners == Combiners::default() {
        return None;
    }
    let Combiners { stages, mux_select, final_combiner: last } = combiners;
    let shared = most_frequent(stages.iter().map(|stage| stage.constants).chain([last.constants]));
    let mut fields = Fields::new("Combiners");
    if shared != [[0; 4]; 2] {
        fields.put("constants", constants(shared));
    }
    fields.word("mux_select", *mux_select, MuxSelect::Msb);
    fields.put("stages", Node::list(stages.iter().map(|of| stage(of, shared))));
    if *last != FinalCombiner::initial(shared) {
        fields.put("final_combiner", final_combiner(last, shared));
    }
    Some(fields.into())
}

/// Returns the value that occurs most often, of several the first.
fn most_frequent<T: PartialEq + Copy + Default>(values: impl Iterator<Item = T>) -> T {
    let values: Vec<T> = values.collect();
    let count = |value: T| values.iter().filter(|other| **other == value).count();
    // Of equal maxima the last one counts.
    values.iter().rev().copied().max_by_key(|value| count(*value)).unwrap_or_default()
}

fn constants([first, second]: [[u8; 4]; 2]) -> Node {
    let written = if second == [0; 4] { vec![first] } else { vec![first, second] };
    Node::call("", written.into_iter().map(Node::color))
}

fn stage(stage: &GeneralStage, shared: [[u8; 4]; 2]) -> Node {
    let mut fields = Fields::new("");
    for (name, of, plain) in [("rgb", &stage.rgb, Component::Rgb), ("alpha", &stage.alpha, Component::Alpha)] {
        if *of != Portion::idle(plain) {
            fields.put(name, portion(of, plain));
        }
    }
    if stage.constants != shared {
        fields.put("constants", constants(stage.constants));
    }
    fields.into()
}

/// Returns a portion whose inputs read the component `plain` where none is written.
fn portion(portion: &Portion, plain: Component) -> Fields {
    let mut fields = Fields::new("");
    for (name, input) in ["a", "b", "c", "d"].into_iter().zip(portion.inputs) {
        if input != CombinerInput::zero(plain) {
            let mapping = (input.mapping != InputMapping::UnsignedIdentity).then(|| input.mapping.name());
            fields.put(name, self::input(mapping, input.register.name(), input.component, plain));
        }
    }
    let outputs = [("ab", portion.ab_output), ("cd", portion.cd_output), ("sum", portion.sum_output)];
    for (name, register) in outputs.into_iter().filter(|(_, register)| *register != Register::DISCARD) {
        fields.put(name, Node::word(register.destination()));
    }
    for (name, flag) in [
        ("ab_dot_product", portion.ab_dot_product),
        ("cd_dot_product", portion.cd_dot_product),
        ("mux", portion.mux),
        ("ab_blue_to_alpha", portion.ab_blue_to_alpha),
        ("cd_blue_to_alpha", portion.cd_blue_to_alpha),
    ] {
        fields.flag(name, flag, false);
    }
    fields.word("scale", portion.scale, Scale::One);
    fields.word("bias", portion.bias, Bias::None);
    fields
}

/// Returns an input: `Register`, `(Register, Component)`, or either behind a mapping.
fn input(mapping: Option<&str>, register: &str, component: Component, plain: Component) -> Node {
    let mut parts = vec![Node::word(register)];
    parts.extend((component != plain).then(|| Node::word(component.name())));
    match (mapping, parts.len()) {
        (None, 1) => Node::word(register),
        _ => Node::call(mapping.unwrap_or(""), parts),
    }
}

fn final_combiner(last: &FinalCombiner, shared: [[u8; 4]; 2]) -> Fields {
    let default = FinalCombiner::default();
    let mut fields = Fields::new("");
    let names = ["a", "b", "c", "d", "e", "f"];
    let inputs = names.into_iter().zip(last.inputs.iter().zip(&default.inputs)).chain([("g", (&last.g, &default.g))]);
    for (name, (input, default)) in inputs.filter(|(_, (input, default))| input != default) {
        let mapping = input.invert.then_some(InputMapping::UnsignedInvert.name());
        fields.put(name, self::input(mapping, input.register.name(), input.component, default.component));
    }
    fields.flag("color_sum_clamp", last.color_sum_clamp, default.color_sum_clamp);
    fields.flag("invert_spare0", last.invert_spare0, default.invert_spare0);
    fields.flag("invert_secondary", last.invert_secondary, default.invert_secondary);
    if last.constants != shared {
        fields.put("constants", constants(last.constants));
    }
    fields
}
