//! Raster operations of a draw.

use super::names::Names;
use super::target::Targets;
use super::*;
use crate::raw::{Numbers, Tuple};
use ninebit::number::convert::constant;
use ninebit::rop::surface;
use ninebit::state::{AlphaTest, Blend, BlendEquation, BlendFactor, CompareFunction, DepthTest, Draw, Rectangle};

/// Reads a blend function.
pub(super) fn blend_function<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::BlendSource>) -> Option<Blend> {
    let fields = reader.read(&raw.as_other::<source::Blend<'a>>())?;
    let equation = reader.name_or(&fields.equation, BlendEquation::Add);
    if let Some(raw) = &fields.equation
        && equation.is_nv2a_only()
        && reader.profile == Profile::Nv10
    {
        reader.push(target::only_nv2a("NB0315", reader.span(raw), "this blend equation", "ROP-3"));
    }
    Some(Blend {
        equation,
        source: reader.name_or(&fields.source, BlendFactor::One),
        destination: reader.name_or(&fields.destination, BlendFactor::Zero),
    })
}

/// Reads everything behind the combiners into `draw`, whose target is set.
pub(super) fn operations<'a>(
    reader: &mut Reader<'a>,
    names: &Names<'a>,
    targets: &Targets,
    fields: &source::Draw<'a>,
    draw: &mut Draw,
) {
    let Some(target) = targets.list.get(draw.target) else { return };
    draw.alpha_test = fields.alpha_test.as_ref().and_then(|raw| alpha_test(reader, raw));
    if let Some(raw) = &fields.depth_test {
        draw.depth_test = depth_test(reader, raw);
        if target.depth.is_none() {
            let mut finding = Diagnostic::error(
                "NB0216",
                reader.span(raw),
                format!("target \"{}\" has no depth buffer", target.name),
            )
            .label("tests depth")
            .rule("DEP-2")
            .help("add `depth: Z24S8` (or `Z16`) to the target");
            let place = targets.place(draw.target);
            if !place.is_empty() {
                finding = finding.related(place, "the target");
            }
            reader.push(finding);
        }
    }
    if let Some(raw) = &fields.blend {
        draw.blend = names.blend(reader, raw);
        if !surface::blends(target.format) {
            let message = format!("surface format {:?} cannot be blended", target.format);
            reader.push(
                Diagnostic::error("NB0316", reader.span(raw), message)
                    .label("blending")
                    .rule("ROP-5")
                    .help("leave `blend` out, or draw into a target with a colour format"),
            );
        }
    }
    draw.blend_constant = color::constant_or(reader, names, &fields.blend_constant, [0; 4]);
    if let Some(raw) = &fields.color_mask {
        draw.color_mask = four_flags(reader, raw, "color_mask", true);
    }
    if let Some(raw) = &fields.dither
        && reader.read(raw) == Some(true)
    {
        reader.push(
            Diagnostic::error("NB0402", reader.span(raw), "what dithering does is not known")
                .label("cannot be modelled")
                .rule("ROP-7")
                .note("no document and no capture gives the dither matrix")
                .help("leave it out, or write `dither: false`"),
        );
    }
    reader.reserve(&fields.stencil_test, "the stencil test");
    reader.reserve(&fields.logic_op, "logic operations");
}

fn alpha_test<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::AlphaTest<'a>>) -> Option<AlphaTest> {
    let fields = reader.read(raw)?;
    let opening = reader.range(raw.text.get(..1).unwrap_or(raw.text));
    let function = reader.required(&fields.function, "function", "alpha test", opening);
    let reference = match &fields.reference {
        Some(raw) => alpha_reference(reader, raw),
        None => Some(0),
    };
    Some(AlphaTest { function: reader.name(&function?)?, reference: reference? })
}

/// `Float(0.5)`, or the low eight bits of a number: APIs hold either, the number in a word of 32.
fn alpha_reference<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::Word>) -> Option<u8> {
    if let ("Float", rest) = raw.split() {
        let [value, ..] = reader.numbers(&Raw::<Numbers>::new(rest), "an alpha reference", 1, 1, [0.0; 4])?;
        return Some(constant(value));
    }
    let Some(word) = reader.attempt::<u32>(raw.text) else {
        let place = reader.span(raw);
        reader.push(
            Diagnostic::error("NB0205", place, format!("expected an alpha reference, found `{}`", shorten(raw.text)))
                .label("wrong kind of value")
                .help("write a byte, `128`, or a float, `Float(0.5)`"),
        );
        return None;
    };
    let byte = word as u8;
    if u32::from(byte) != word {
        let place = reader.span(raw);
        reader.push(
            Diagnostic::warning(
                "NB0914",
                place,
                format!("an alpha reference has eight bits: {word:#x} counts as {byte}"),
            )
            .label("more than eight bits")
            .rule("ROP-1")
            .help(format!("write {byte} if that is what is meant")),
        );
    }
    Some(byte)
}

fn depth_test<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::DepthTest<'a>>) -> Option<DepthTest> {
    let fields = reader.read(raw)?;
    let function = reader.name_or(&fields.function, CompareFunction::Less);
    Some(DepthTest { function, write: reader.or(&fields.write, true) })
}

/// Four flags for R, G, B, A.
pub(super) fn four_flags<'a>(
    reader: &mut Reader<'a>,
    raw: &Raw<'a, Tuple<'a, bool>>,
    field: &str,
    default: bool,
) -> [bool; 4] {
    let mut flags = [default; 4];
    let Some(parts) = reader.read(raw) else { return flags };
    if parts.0.len() != 4 {
        let place = reader.span(raw);
        reader.push(
            Diagnostic::error("NB0211", place, format!("`{field}` has four flags, not {}", parts.0.len()))
                .label(format!("{} here", parts.0.len()))
                .help("they stand for red, green, blue and alpha: `(true, true, true, false)`"),
        );
        return flags;
    }
    for (flag, part) in flags.iter_mut().zip(&parts.0) {
        *flag = reader.read(part).unwrap_or(default);
    }
    flags
}

/// Reads the scissor: a part of the target.
pub(super) fn scissor<'a>(
    reader: &mut Reader<'a>,
    targets: &Targets,
    target: usize,
    raw: &Option<Raw<'a, source::Rectangle<'a>>>,
) -> Option<Rectangle> {
    let raw = raw.as_ref()?;
    let fields = reader.read(raw)?;
    let opening = reader.range(raw.text.get(..1).unwrap_or(raw.text));
    let (x, y) = (reader.or(&fields.x, 0), reader.or(&fields.y, 0));
    let width = reader.required(&fields.width, "width", "scissor", opening.clone());
    let height = reader.required(&fields.height, "height", "scissor", opening);
    let width = width.and_then(|raw| reader.whole(&raw, "the width of a scissor", 1..=65535));
    let height = height.and_then(|raw| reader.whole(&raw, "the height of a scissor", 1..=65535));
    let (width, height) = (width?, height?);
    let target = targets.list.get(target)?;
    let inside = |at: u32, size: u32, whole: u32| at.checked_add(size).is_some_and(|end| end <= whole);
    if !inside(x, width, target.width) || !inside(y, height, target.height) {
        reader.push(
            Diagnostic::error("NB0215", reader.span(raw), "the scissor reaches outside the target")
                .label(format!("target \"{}\" is {} x {}", shorten(&target.name), target.width, target.height))
                .help("x + width and y + height must not exceed the target"),
        );
    }
    Some(Rectangle { x, y, width, height })
}
