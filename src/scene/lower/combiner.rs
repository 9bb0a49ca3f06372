//! Lowers `Combiners(...)`: register combiners, given field by field.

use super::input::{final_input, general_input};
use super::*;
use ninebit::legality::{Help, Notation, stage_count};
use ninebit_program::{Part, Place, Places};

/// The notation of combiners as fields of a scene.
pub(super) struct Fields;

impl Notation for Fields {
    fn help(&self, help: Help) -> &'static str {
        match help {
            Help::EmptyStage => "write `[()]` for a stage that changes nothing",
            Help::SharedConstants => {
                "write `constants` beside `stages`, for the whole program; profile Nv2a allows them here"
            }
            Help::OtherRegister => "send one of them to another register, or to `Discard`",
            Help::FogBlue => "write `(Fog, Blue)` for the fog colour's blue",
            Help::SecondaryAlpha => "profile Nv2a defines it: write `profile: Nv2a`, or read the alpha of PrimaryColor",
            Help::RgbComponents => "take Rgb (the default here) or Alpha",
            Help::AlphaComponents => "take Alpha (the default here) or Blue",
            Help::FinalComponents => "inputs A to F read Rgb (the default) or Alpha",
            Help::FinalAlphaComponents => "G reads Alpha (the default) or Blue",
            Help::BiasScale | Help::FogColor | Help::Writable | Help::OtherInput => help.text(),
        }
    }
}

/// Reads a program and the places of its parts. Returns `None` if that fails, with the reason recorded.
pub(super) fn combiners<'a>(reader: &mut Reader<'a>, text: &'a str) -> Option<(Combiners, Places)> {
    let fields = reader.read(&Raw::<source::Combiners<'a>>::new(text))?;
    let shared = fields.constants.as_ref().map(|raw| color::constants(reader, raw)).unwrap_or_default();
    let mut places = Places::default();
    let stages = stages(reader, &fields, shared, &mut places)?;
    let final_combiner = match &fields.final_combiner {
        Some(raw) => final_combiner(reader, raw, shared, &mut places),
        None => Some(FinalCombiner::initial(shared)),
    };
    let final_combiner = final_combiner.unwrap_or(FinalCombiner::initial(shared));
    let mux_select = fields.mux_select(reader);
    Some((Combiners { stages, mux_select, final_combiner }, places))
}

fn stages<'a>(
    reader: &mut Reader<'a>,
    fields: &source::Combiners<'a>,
    shared: [[u8; 4]; 2],
    places: &mut Places,
) -> Option<Vec<GeneralStage>> {
    let list_raw = fields.stages(reader)?;
    let list = reader.read(&list_raw)?;
    places.set(Place::Stages, reader.span(&list_raw));
    let place = |index: usize| list.get(index).map(|raw| reader.opening(raw.text));
    if let Some(finding) = stage_count(list.len(), reader.profile, place) {
        return reader.refuse(finding);
    }
    let mut stages = Vec::with_capacity(list.len());
    for raw in &list {
        let Some(fields) = reader.read(raw) else { continue };
        let stage = stages.len();
        let rgb = fields.rgb.as_ref().and_then(|raw| reader.read(raw));
        let alpha = fields.alpha.as_ref().and_then(|raw| reader.read(raw));
        let rgb = rgb.map(|fields| portion(reader, &fields, stage, false, places));
        let alpha = alpha.map(|fields| portion(reader, &fields, stage, true, places));
        let constants = own_constants(reader, &fields.constants, Place::StageConstants(stage), places);
        stages.push(GeneralStage {
            rgb: rgb.unwrap_or(Portion::idle(Component::Rgb)),
            alpha: alpha.unwrap_or(Portion::idle(Component::Alpha)),
            constants: constants.unwrap_or(shared),
        });
    }
    Some(stages)
}

/// Reads the constants of one stage or of the final combiner, if it has its own.
fn own_constants<'a>(
    reader: &mut Reader<'a>,
    raw: &Option<Raw<'a, Tuple<'a, source::Color>>>,
    place: Place,
    places: &mut Places,
) -> Option<[[u8; 4]; 2]> {
    let raw = raw.as_ref()?;
    places.set(place, reader.span(raw));
    Some(color::constants(reader, raw))
}

fn portion<'a>(
    reader: &mut Reader<'a>,
    fields: &source::Portion<'a>,
    stage: usize,
    alpha: bool,
    places: &mut Places,
) -> Portion {
    let mut portion = Portion::idle(if alpha { Component::Alpha } else { Component::Rgb });
    let at = |part| Place::General { stage, alpha, part };
    let outputs = [&mut portion.ab_output, &mut portion.cd_output, &mut portion.sum_output];
    for (n, (slot, field)) in outputs.into_iter().zip([&fields.ab, &fields.cd, &fields.sum]).enumerate() {
        if let Some(raw) = field {
            places.set(at(Part::Output(n)), reader.span(raw));
            *slot = output(reader, raw);
        }
    }
    for (n, field) in [&fields.a, &fields.b, &fields.c, &fields.d].into_iter().enumerate() {
        if let Some(raw) = field
            && let Some((input, component)) = general_input(reader, raw, alpha)
        {
            portion.inputs[n] = input;
            places.set(at(Part::Input(n)), reader.span(raw));
            if let Some(component) = component {
                places.set(at(Part::Component(n)), component);
            }
        }
    }
    for (name, text) in fields.written() {
        let part = match name {
            "ab_dot_product" => Part::Dot(0),
            "cd_dot_product" => Part::Dot(1),
            "ab_blue_to_alpha" => Part::BlueToAlpha(0),
            "cd_blue_to_alpha" => Part::BlueToAlpha(1),
            "bias" => Part::Bias,
            "scale" => Part::Scale,
            _ => continue,
        };
        places.set(at(part), reader.range(text));
    }
    portion.ab_dot_product = fields.ab_dot_product(reader);
    portion.cd_dot_product = fields.cd_dot_product(reader);
    portion.ab_blue_to_alpha = fields.ab_blue_to_alpha(reader);
    portion.cd_blue_to_alpha = fields.cd_blue_to_alpha(reader);
    portion.mux = fields.mux(reader);
    portion.scale = fields.scale(reader);
    portion.bias = fields.bias(reader);
    portion
}

fn output<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Output>) -> Register {
    let (head, rest) = raw.split();
    let register = Register::from_destination(head).filter(|_| rest.is_empty()).or_else(|| {
        let known: Vec<&str> = [&[Register::DISCARD.destination()], &Register::NAMES[4..]].concat();
        reader.unknown_variant(raw, "destination", &known)
    });
    register.unwrap_or(Register::DISCARD)
}

fn final_combiner<'a>(
    reader: &mut Reader<'a>,
    raw: &Raw<'a, source::FinalCombiner<'a>>,
    shared: [[u8; 4]; 2],
    places: &mut Places,
) -> Option<FinalCombiner> {
    let fields = reader.read(raw)?;
    let mut inputs = [FinalInput::zero(Component::Rgb); 7];
    inputs[6] = FinalInput { register: FinalRegister::Spare0, component: Component::Alpha, invert: false };
    let all = [&fields.a, &fields.b, &fields.c, &fields.d, &fields.e, &fields.f, &fields.g];
    for (n, field) in all.into_iter().enumerate() {
        if let Some(raw) = field
            && let Some((input, component)) = final_input(reader, raw, n == 6)
        {
            inputs[n] = input;
            places.set(Place::FinalInput(n), reader.span(raw));
            if let Some(component) = component {
                places.set(Place::FinalComponent(n), component);
            }
        }
    }
    let [a, b, c, d, e, f, g] = inputs;
    let constants = own_constants(reader, &fields.constants, Place::FinalConstants, places);
    Some(FinalCombiner {
        inputs: [a, b, c, d, e, f],
        g,
        color_sum_clamp: fields.color_sum_clamp(reader),
        invert_spare0: fields.invert_spare0(reader),
        invert_secondary: fields.invert_secondary(reader),
        constants: constants.unwrap_or(shared),
    })
}
