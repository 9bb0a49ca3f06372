//! Register combiners: programs as written, checked against the chip (CMB-12).

use super::input::{Place, final_input, general_input, on_chip};
use super::names::Names;
use super::*;
use crate::scene::raw::Tuple;
use crate::state::{
    Bias, CombinerInput, Combiners, Component, FinalCombiner, FinalInput, FinalRegister, GeneralStage, InputMapping,
    MuxSelect, Named, Portion, Register, Scale,
};

/// A program, and what only a draw can judge.
pub(super) enum ProgramData {
    /// Written for the combiners, with the first place that reads each texture unit.
    Combiners(Combiners, [Option<Range<usize>>; 4]),
    /// Written for an API: what it becomes depends on the draw.
    Api(api_program::ApiProgram),
}

/// OpenGL's initial program: the colours of the vertices, with fog.
pub(super) fn default_program() -> Combiners {
    let one = |component| CombinerInput { register: Register::Zero, component, mapping: InputMapping::UnsignedInvert };
    let primary = |component| CombinerInput {
        register: Register::PrimaryColor,
        component,
        mapping: InputMapping::UnsignedIdentity,
    };
    let portion = |component| {
        let mut portion = Portion::idle(component);
        portion.inputs[0] = primary(component);
        portion.inputs[1] = one(component);
        portion.sum_output = Register::Spare0;
        portion
    };
    let stage = GeneralStage { rgb: portion(Component::Rgb), alpha: portion(Component::Alpha), constants: [[0; 4]; 2] };
    Combiners { stages: vec![stage], mux_select: MuxSelect::Msb, final_combiner: default_final([[0; 4]; 2]) }
}

/// OpenGL's initial final combiner: fog over SPARE0 + SECONDARY, alpha of SPARE0.
fn default_final(constants: [[u8; 4]; 2]) -> FinalCombiner {
    let input = |register, component| FinalInput { register, component, invert: false };
    let zero = FinalInput::zero(Component::Rgb);
    FinalCombiner {
        inputs: [
            input(FinalRegister::Fog, Component::Alpha),
            input(FinalRegister::Spare0PlusSecondary, Component::Rgb),
            input(FinalRegister::Fog, Component::Rgb),
            zero,
            zero,
            zero,
        ],
        g: input(FinalRegister::Spare0, Component::Alpha),
        color_sum_clamp: true,
        invert_spare0: false,
        invert_secondary: false,
        constants,
    }
}

const KINDS: &[&str] =
    &["Combiners", "TextureStages", "TextureEnvironment", "CombinerText", "PixelShader", "RegisterWords"];

/// Reads a pixel program.
pub(super) fn program<'a>(
    reader: &mut Reader<'a>,
    names: &Names<'a>,
    raw: &Raw<'a, source::Program>,
) -> Option<ProgramData> {
    let (kind, rest) = reader.variant(raw, "pixel program", KINDS)?;
    if kind == 1 {
        return texture_stages::texture_stages(reader, names, rest).map(ProgramData::Api);
    }
    if kind == 2 {
        return texture_environment::texture_environment(reader, names, rest).map(ProgramData::Api);
    }
    if kind > 0 {
        let what = ["", "", "", "the combiner text language", "pixel shader text", "raw register words"][kind];
        reader.not_built(reader.range(&raw.text[..KINDS[kind].len()]), what);
        return None;
    }
    let raw = Raw::<source::Combiners<'a>>::new(rest);
    let fields = reader.read(&raw)?;
    let mut walk = Walk { reads: [None, None, None, None], written: [false; 4], textures_written: [[false; 2]; 4] };
    // SPARE0.a starts as texture 0's alpha.
    walk.written[SPARE0_ALPHA] = true;
    let shared = fields.constants.as_ref().map(|raw| color::constants(reader, names, raw)).unwrap_or_default();
    let stages = stages(reader, names, &fields, shared, reader_opening(rest, reader), &mut walk)?;
    let final_combiner = match &fields.final_combiner {
        Some(raw) => final_combiner(reader, names, raw, shared, &mut walk)?,
        None => default_final(shared),
    };
    let mux_select = reader.name_or(&fields.mux_select, MuxSelect::Msb);
    Some(ProgramData::Combiners(Combiners { stages, mux_select, final_combiner }, walk.reads))
}

fn reader_opening<'a>(text: &'a str, reader: &Reader<'a>) -> Range<usize> {
    reader.range(text.get(..1).unwrap_or(text))
}

const SPARE0_RGB: usize = 0;
const SPARE0_ALPHA: usize = 1;
const SPARE1_RGB: usize = 2;

/// What is known while the stages are read in order.
pub(super) struct Walk {
    reads: [Option<Range<usize>>; 4],
    /// SPARE0.rgb, SPARE0.a, SPARE1.rgb, SPARE1.a hold something defined.
    written: [bool; 4],
    /// A stage has written TEXTURE0 to TEXTURE3: RGB, alpha.
    textures_written: [[bool; 2]; 4],
}

impl Walk {
    fn write(&mut self, register: Register, alpha: bool) {
        match register {
            Register::Spare0 => self.written[SPARE0_RGB + usize::from(alpha)] = true,
            Register::Spare1 => self.written[SPARE1_RGB + usize::from(alpha)] = true,
            Register::Texture0 => self.textures_written[0][usize::from(alpha)] = true,
            Register::Texture1 => self.textures_written[1][usize::from(alpha)] = true,
            Register::Texture2 => self.textures_written[2][usize::from(alpha)] = true,
            Register::Texture3 => self.textures_written[3][usize::from(alpha)] = true,
            _ => {}
        }
    }

    /// Notes a read, and warns if nothing defines what it gives.
    pub(super) fn read(&mut self, reader: &mut Reader<'_>, register: FinalRegister, alpha: bool, place: Range<usize>) {
        let unit = match register {
            FinalRegister::Texture0 => 0,
            FinalRegister::Texture1 => 1,
            FinalRegister::Texture2 => 2,
            FinalRegister::Texture3 => 3,
            FinalRegister::Spare0 | FinalRegister::Spare0PlusSecondary => {
                return self.spare(reader, SPARE0_RGB + usize::from(alpha), place);
            }
            FinalRegister::Spare1 => return self.spare(reader, SPARE1_RGB + usize::from(alpha), place),
            _ => return,
        };
        if !self.textures_written[unit][usize::from(alpha)] {
            self.reads[unit].get_or_insert(place);
        }
    }

    fn spare(&mut self, reader: &mut Reader<'_>, index: usize, place: Range<usize>) {
        if !self.written[index] {
            // Once is enough for each.
            self.written[index] = true;
            let name = ["Spare0's RGB", "Spare0's alpha", "Spare1's RGB", "Spare1's alpha"][index];
            reader.push(
                Diagnostic::warning("NB0903", place, format!("{name} is read before a stage writes it"))
                    .label("no document says what this is; the model takes 0")
                    .rule("CMB-13")
                    .help("write the register in an earlier stage, or read another"),
            );
        }
    }
}

fn stages<'a>(
    reader: &mut Reader<'a>,
    names: &Names<'a>,
    fields: &source::Combiners<'a>,
    shared: [[u8; 4]; 2],
    opening: Range<usize>,
    walk: &mut Walk,
) -> Option<Vec<GeneralStage>> {
    let list_raw = reader.required(&fields.stages, "stages", "program", opening)?;
    let list = reader.read(&list_raw)?;
    let most = reader.profile.general_stages();
    if list.is_empty() {
        reader.push(
            Diagnostic::error("NB0323", reader.span(&list_raw), "the combiners have at least one general stage")
                .label("none here")
                .rule("CMB-12")
                .help("write `[()]` for a stage that changes nothing"),
        );
    }
    if let Some(extra) = list.get(most) {
        let count = list.len();
        let place = reader.range(extra.text.get(..1).unwrap_or(extra.text));
        let mut finding =
            Diagnostic::error("NB0301", place, format!("{count} general stages; {:?} has {most}", reader.profile))
                .label(format!("stage {most} is the first too many"))
                .rule("CMB-12");
        finding = if count <= 8 {
            finding.help("profile Nv2a has 8: write `profile: Nv2a`, or use fewer stages")
        } else {
            finding.help("use fewer stages")
        };
        reader.push(finding);
        return None;
    }
    let mut stages = Vec::with_capacity(list.len());
    for raw in &list {
        let Some(fields) = reader.read(raw) else { continue };
        let rgb = fields.rgb.as_ref().and_then(|raw| reader.read(raw));
        let alpha = fields.alpha.as_ref().and_then(|raw| reader.read(raw));
        // Both portions read what the stages before have written.
        let rgb_state = rgb.as_ref().map(|fields| portion(reader, fields, false, walk));
        let alpha_state = alpha.as_ref().map(|fields| portion(reader, fields, true, walk));
        let rgb_state = rgb_state.unwrap_or(Portion::idle(Component::Rgb));
        let alpha_state = alpha_state.unwrap_or(Portion::idle(Component::Alpha));
        if let Some(fields) = &rgb {
            blue_to_alpha(reader, fields, &rgb_state, alpha.as_ref(), &alpha_state);
        }
        for (portion, is_alpha) in [(&rgb_state, false), (&alpha_state, true)] {
            for output in [portion.ab_output, portion.cd_output, portion.sum_output] {
                walk.write(output, is_alpha);
            }
        }
        for (blue, output) in
            [(rgb_state.ab_blue_to_alpha, rgb_state.ab_output), (rgb_state.cd_blue_to_alpha, rgb_state.cd_output)]
        {
            if blue {
                walk.write(output, true);
            }
        }
        let constants = own_constants(reader, names, &fields.constants, "general stages").unwrap_or(shared);
        stages.push(GeneralStage { rgb: rgb_state, alpha: alpha_state, constants });
    }
    Some(stages)
}

/// Constants of one stage or of the final combiner: not on nv10.
fn own_constants<'a>(
    reader: &mut Reader<'a>,
    names: &Names<'a>,
    raw: &Option<Raw<'a, Tuple<'a, source::Color>>>,
    owner: &str,
) -> Option<[[u8; 4]; 2]> {
    let raw = raw.as_ref()?;
    if reader.profile == Profile::Nv10 {
        reader.push(
            Diagnostic::error("NB0303", reader.span(raw), format!("Nv10 has no own constants for {owner}"))
                .label("not on this chip")
                .rule("CMB-12")
                .help("write `constants` beside `stages`, for the whole program; profile Nv2a allows them here"),
        );
    }
    Some(color::constants(reader, names, raw))
}

/// Legality of blue-to-alpha within a stage.
fn blue_to_alpha<'a>(
    reader: &mut Reader<'a>,
    fields: &source::Portion<'a>,
    rgb: &Portion,
    alpha_fields: Option<&source::Portion<'a>>,
    alpha: &Portion,
) {
    for (on, field, output) in [
        (rgb.ab_blue_to_alpha, &fields.ab_blue_to_alpha, rgb.ab_output),
        (rgb.cd_blue_to_alpha, &fields.cd_blue_to_alpha, rgb.cd_output),
    ] {
        let (true, Some(raw)) = (on, field) else { continue };
        let place = reader.span(raw);
        if reader.profile == Profile::Nv10 {
            reader.push(target::only_nv2a("NB0304", place.clone(), "blue-to-alpha", "CMB-11"));
        }
        let Some(alpha_fields) = alpha_fields else { continue };
        for (written, field) in [
            (alpha.ab_output, &alpha_fields.ab),
            (alpha.cd_output, &alpha_fields.cd),
            (alpha.sum_output, &alpha_fields.sum),
        ] {
            if let Some(raw) = field
                && written == output
                && output != Register::Zero
            {
                reader.push(
                    Diagnostic::error("NB0305", place.clone(), format!("two results go to the alpha of {output:?}"))
                        .label("blue goes there")
                        .related(reader.span(raw), "the alpha portion writes it, too")
                        .rule("CMB-12")
                        .help("send one of them to another register"),
                );
            }
        }
    }
}

fn portion<'a>(reader: &mut Reader<'a>, fields: &source::Portion<'a>, alpha: bool, walk: &mut Walk) -> Portion {
    let mut portion = Portion::idle(if alpha { Component::Alpha } else { Component::Rgb });
    portion.ab_output = output(reader, &fields.ab);
    portion.cd_output = output(reader, &fields.cd);
    portion.sum_output = output(reader, &fields.sum);
    distinct(
        reader,
        [(&fields.ab, portion.ab_output), (&fields.cd, portion.cd_output), (&fields.sum, portion.sum_output)],
    );
    let writes = [portion.ab_output, portion.cd_output, portion.sum_output].iter().any(|r| *r != Register::Zero);
    for (slot, field) in portion.inputs.iter_mut().zip([&fields.a, &fields.b, &fields.c, &fields.d]) {
        if let Some(raw) = field
            && let Some(input) = general_input(reader, raw, alpha)
        {
            *slot = input;
            if writes && let Some(register) = FinalRegister::from_name(input.register.name()) {
                walk.read(reader, register, input.component == Component::Alpha, reader.span(raw));
            }
        }
    }
    portion.ab_dot_product = reader.or(&fields.ab_dot, false);
    portion.cd_dot_product = reader.or(&fields.cd_dot, false);
    portion.ab_blue_to_alpha = reader.or(&fields.ab_blue_to_alpha, false);
    portion.cd_blue_to_alpha = reader.or(&fields.cd_blue_to_alpha, false);
    portion.mux = reader.or(&fields.mux, false);
    portion.scale = reader.name_or(&fields.scale, Scale::One);
    portion.bias = reader.name_or(&fields.bias, Bias::None);
    if alpha {
        for (on, field, what) in [
            (portion.ab_dot_product, &fields.ab_dot, "dot products"),
            (portion.cd_dot_product, &fields.cd_dot, "dot products"),
            (portion.ab_blue_to_alpha, &fields.ab_blue_to_alpha, "blue-to-alpha"),
            (portion.cd_blue_to_alpha, &fields.cd_blue_to_alpha, "blue-to-alpha"),
        ] {
            if let (true, Some(raw)) = (on, field) {
                reader.push(
                    Diagnostic::error("NB0306", reader.span(raw), format!("the alpha portion has no {what}"))
                        .label("not here")
                        .rule("CMB-12")
                        .help("write it in the `rgb` portion"),
                );
            }
        }
    }
    if portion.bias == Bias::NegativeHalf
        && matches!(portion.scale, Scale::Four | Scale::Half)
        && let Some(raw) = &fields.bias
    {
        let mut finding = Diagnostic::error(
            "NB0307",
            reader.span(raw),
            format!("bias NegativeHalf does not go with scale {:?}", portion.scale),
        )
        .label("this bias")
        .rule("CMB-9")
        .help("with this bias the scale is One or Two");
        if let Some(raw) = &fields.scale {
            finding = finding.related(reader.span(raw), "this scale");
        }
        reader.push(finding);
    }
    portion
}

/// No two results of a portion go to the same register.
fn distinct<'a>(reader: &mut Reader<'a>, outputs: [(&Option<Raw<'a, source::Output>>, Register); 3]) {
    for (second, (field, register)) in outputs.iter().enumerate() {
        for (first_field, first) in &outputs[..second] {
            if let (Some(raw), Some(first_raw)) = (field, first_field)
                && register == first
                && *register != Register::Zero
            {
                reader.push(
                    Diagnostic::error("NB0310", reader.span(raw), format!("two results go to {register:?}"))
                        .label("again here")
                        .related(reader.span(first_raw), "first here")
                        .rule("CMB-12")
                        .help("send one of them to another register, or to `Discard`"),
                );
                return;
            }
        }
    }
}

fn output<'a>(reader: &mut Reader<'a>, field: &Option<Raw<'a, source::Output>>) -> Register {
    let Some(raw) = field else { return Register::Zero };
    let (head, rest) = raw.split();
    if head == "Discard" && rest.is_empty() {
        return Register::Zero;
    }
    let Some(register) = Register::from_name(head).filter(|_| rest.is_empty()) else {
        let known: Vec<&str> = [&["Discard"], &Register::NAMES[4..]].concat();
        reader.unknown_variant(raw, "destination", &known);
        return Register::Zero;
    };
    let place = reader.span(raw);
    if matches!(register, Register::ConstantColor0 | Register::ConstantColor1 | Register::Fog) {
        reader.push(
            Diagnostic::error("NB0312", place, format!("{head} cannot be written"))
                .label("read only")
                .rule("CMB-12")
                .help("write to Spare0, Spare1, PrimaryColor, SecondaryColor or a texture register"),
        );
        return Register::Zero;
    }
    on_chip(reader, head, place);
    register
}

fn final_combiner<'a>(
    reader: &mut Reader<'a>,
    names: &Names<'a>,
    raw: &Raw<'a, source::FinalCombiner<'a>>,
    shared: [[u8; 4]; 2],
    walk: &mut Walk,
) -> Option<FinalCombiner> {
    let fields = reader.read(raw)?;
    let mut inputs = [FinalInput::zero(Component::Rgb); 6];
    let all = [&fields.a, &fields.b, &fields.c, &fields.d, &fields.e, &fields.f];
    for (index, (slot, field)) in inputs.iter_mut().zip(all).enumerate() {
        if let Some(raw) = field {
            *slot =
                final_input(reader, raw, if index < 4 { Place::Sum } else { Place::Product }, walk).unwrap_or(*slot);
        }
    }
    let spare0_alpha = FinalInput { register: FinalRegister::Spare0, component: Component::Alpha, invert: false };
    let g = match &fields.g {
        Some(raw) => final_input(reader, raw, Place::Alpha, walk).unwrap_or(spare0_alpha),
        None => spare0_alpha,
    };
    Some(FinalCombiner {
        inputs,
        g,
        color_sum_clamp: reader.or(&fields.color_sum_clamp, true),
        invert_spare0: reader.or(&fields.invert_spare0, false),
        invert_secondary: reader.or(&fields.invert_secondary, false),
        constants: own_constants(reader, names, &fields.constants, "the final combiner").unwrap_or(shared),
    })
}
