//! Lowers `TextureStages(...)`: Direct3D texture stage states.

use super::api_program::{ApiProgram, name_at};
use super::program::{Asides, calls, pasted};
use super::*;
use ninebit_program::Spanned;
use ninebit_program::texture_stages::{
    self, ArgumentSource, CoordinateIndex, Generation, Half, PROJECTED, STAGES, StageArgument, TextureStage,
    TextureStages,
};

/// Reads the fields in the parentheses.
pub(super) fn read<'a>(reader: &mut Reader<'a>, text: &'a str, asides: &mut Asides) -> Option<ApiProgram> {
    let fields = reader.read(&Raw::<source::TextureStages<'a>>::new(text))?;
    let stages = reader.place(&fields.stages);
    let written = calls(reader, stages, &fields.text, &fields.file, ("texture stages are", "stages"))?;
    let mut program = match &written {
        None => TextureStages::default(),
        Some(written) => pasted(reader, written, texture_stages::parse(&written.text), asides)?,
    };
    if let Some(raw) = &fields.stages {
        let list = reader.read(raw)?;
        if let Some(extra) = list.get(STAGES) {
            let place = reader.opening(extra.text);
            let help = format!("the API has stages 0 to {}", STAGES - 1);
            reader.push(finding("NB0206", place, format!("there is no texture stage {STAGES}"), "one too many", help));
        }
        for (index, raw) in list.iter().enumerate().take(STAGES) {
            let Some(fields) = reader.read(raw) else { continue };
            if let Some(stage) = program.stage_mut(index) {
                stage.span = reader.opening(raw.text);
                self::stage(reader, &fields, stage);
            }
        }
    }
    if let Some(color) = fields.texture_factor.and_then(|raw| color::constant(reader, &raw)) {
        program.texture_factor = color;
    }
    if let Some(enable) = fields.specular_enable.and_then(|raw| reader.read(&raw)) {
        program.specular_enable = enable;
    }
    Some(ApiProgram::Stages(program, written))
}

fn stage<'a>(reader: &mut Reader<'a>, fields: &source::TextureStage<'a>, stage: &mut TextureStage) {
    name_at(reader, &fields.color_op, &mut stage.color.operation);
    name_at(reader, &fields.alpha_op, &mut stage.alpha.operation);
    arguments(reader, [&fields.color_arg0, &fields.color_arg1, &fields.color_arg2], &mut stage.color);
    arguments(reader, [&fields.alpha_arg0, &fields.alpha_arg1, &fields.alpha_arg2], &mut stage.alpha);
    stage.result = fields.result_arg(reader);
    stage.constant = color::bytes(fields.constant(reader));
    coordinates(reader, fields, stage);
    if let Some(matrix) = fields.bump_matrix(reader) {
        stage.bump_matrix = matrix;
    }
    if let Some([scale, offset, ..]) = fields.bump_luminance(reader) {
        stage.bump_luminance = [scale, offset];
    }
}

fn arguments<'a>(reader: &mut Reader<'a>, fields: [&Option<Raw<'a, source::StageArgument>>; 3], half: &mut Half) {
    for (slot, field) in half.arguments.iter_mut().zip(fields) {
        if let Some(raw) = field
            && let Some(value) = argument(reader, raw)
        {
            *slot = Spanned { value, span: reader.span(raw) };
        }
    }
}

const MODIFIERS: &[&str] = &["Complement", "AlphaReplicate"];

/// Reads `Texture`, or `(Texture, Complement, AlphaReplicate)`.
fn argument<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::StageArgument>) -> Option<StageArgument> {
    let (head, rest) = raw.split();
    if !head.is_empty() || !rest.starts_with('(') {
        return reader.name(&raw.as_other()).map(StageArgument::new);
    }
    let list = reader.read(&raw.as_other::<Tuple<'a, source::Word>>())?.0;
    let Some((first, modifiers)) = list.split_first() else {
        return reader.unknown_variant(raw, "texture argument", ArgumentSource::NAMES);
    };
    let mut argument = StageArgument::new(reader.name(&first.as_other())?);
    for modifier in modifiers {
        match reader.variant(modifier, "argument modifier", MODIFIERS)? {
            (0, _) => argument.complement = true,
            _ => argument.alpha_replicate = true,
        }
    }
    Some(argument)
}

const TRANSFORMS: &[&str] = &["Disable", "Count1", "Count2", "Count3", "Count4"];

/// Reads `Count3`, or `(Count3, Projected)`.
fn transform_flags<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::TransformFlags>) -> Option<u32> {
    let (head, rest) = raw.split();
    if !head.is_empty() || !rest.starts_with('(') {
        return reader.variant(raw, "transform flag", TRANSFORMS).map(|(count, _)| count as u32);
    }
    let list = reader.read(&raw.as_other::<Tuple<'a, source::Word>>())?.0;
    let [count, projected] = &list[..] else {
        return reader.unknown_variant(raw, "transform flag", TRANSFORMS);
    };
    let (count, _) = reader.variant(count, "transform flag", TRANSFORMS)?;
    reader.variant(projected, "transform flag beside a count", &["Projected"])?;
    Some(count as u32 | PROJECTED)
}

fn coordinates<'a>(reader: &mut Reader<'a>, fields: &source::TextureStage<'a>, stage: &mut TextureStage) {
    if let Some(raw) = &fields.texture_coordinate_index {
        let place = reader.span(raw);
        let value = if raw.split().0.is_empty() {
            let set = reader.within(&raw.as_other(), "a set of texture coordinates", 0..=3, |finding| finding);
            set.map(|set| CoordinateIndex { set, generation: 0 })
        } else {
            let generation = reader.variant(raw, "source of coordinates", Generation::NAMES);
            generation.map(|(index, _)| CoordinateIndex { set: 0, generation: 1 + index as u32 })
        };
        stage.coordinate_index = value.map(|value| Spanned { value, span: place });
    }
    if let Some(raw) = &fields.texture_transform_flags
        && let Some(value) = transform_flags(reader, raw)
    {
        stage.transform_flags = Spanned { value, span: reader.span(raw) };
    }
}
