//! Lowers the raster operations of a draw.

use super::*;
use crate::clear::Clear;
use ninebit::legality;
use ninebit::raster::depth;
use ninebit::rop::surface;

/// Largest number of columns or rows of a rectangle.
const MAX_CLIP_COORDINATE: u32 = 65535;

pub(super) fn blend_function<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::BlendSource>) -> Option<Blend> {
    let fields = reader.read(&raw.as_other::<source::Blend<'a>>())?;
    let equation = fields.equation(reader);
    let place = reader.place(&fields.equation);
    reader.accept(legality::surface::blend_equation(equation, reader.profile, place));
    Some(Blend { equation, source: fields.source(reader), destination: fields.destination(reader) })
}

/// Reads all state behind the combiners into `draw`, whose target is set.
pub(super) fn operations<'a>(reader: &mut Reader<'a>, fields: &source::Draw<'a>, draw: &mut Draw) {
    let Some(target) = reader.targets.list.get(draw.target).cloned() else { return };
    draw.alpha_test = fields.alpha_test.as_ref().and_then(|raw| alpha_test(reader, raw));
    if let Some(raw) = &fields.depth_test {
        draw.depth_test = depth_test(reader, raw);
        let place = Some(reader.span(raw));
        let checked = |test: &DepthTest| legality::draw::vertex_depths(test, &draw.positions, place.clone());
        if let Some(finding) = draw.depth_test.as_ref().and_then(checked) {
            reader.push(finding);
            draw.depth_test = None;
        }
        if let Some(finding) = legality::draw::depth_test(&target, place) {
            reader.push(reader.targets.beside(draw.target, finding));
        }
    }
    if let Some(raw) = &fields.stencil_test {
        draw.stencil_test = reader.read(raw).map(|fields| stencil_test(reader, &fields));
        if let Some(finding) = legality::draw::stencil_test(&target, Some(reader.span(raw))) {
            reader.push(reader.targets.beside(draw.target, finding));
        }
    }
    draw.window_clip = fields.window_clip.as_ref().and_then(|raw| window_clip(reader, raw));
    if let Some(raw) = &fields.blend {
        draw.blend = reader.value(raw);
        reader.accept(legality::surface::blending(target.format, Some(reader.span(raw))));
    }
    draw.blend_constant = color::bytes(fields.blend_constant(reader));
    draw.color_mask = fields.color_mask(reader);
    if fields.dither(reader) {
        let (message, help) = ("what dithering does is not known", "leave it out, or write `dither: false`");
        let found = finding("NB0402", reader.place(&fields.dither), message, "cannot be modelled", help);
        reader.push(found.rule("ROP-7").note("no document and no capture gives the dither matrix"));
    }
    reader.reserve(&fields.logic_op, "logic operations");
}

fn alpha_test<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::AlphaTest<'a>>) -> Option<AlphaTest> {
    let fields = reader.read(raw)?;
    let function = fields.function(reader);
    let reference = fields.reference(reader);
    Some(AlphaTest { function: reader.name(&function?)?, reference })
}

fn depth_test<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::DepthTest<'a>>) -> Option<DepthTest> {
    let fields = reader.read(raw)?;
    let function = fields.function(reader);
    let vertex_depths = fields.vertex_depths(reader);
    let range = fields.range.as_ref().and_then(|raw| depth_range(reader, raw));
    let offset = fields.offset.as_ref().and_then(|raw| polygon_offset(reader, raw)).unwrap_or_default();
    let w_buffer = fields.w_buffer(reader);
    Some(DepthTest { vertex_depths, range, offset, w_buffer, ..DepthTest::new(function, fields.write(reader)) })
}

fn depth_range<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::DepthRange<'a>>) -> Option<DepthRange> {
    let fields = reader.read(raw)?;
    let (lowest, highest) = (fields.lowest(reader)?, fields.highest(reader)?);
    let (low, high) = (reader.finite(&lowest)?, reader.finite(&highest)?);
    if low > high {
        let message = format!("the highest depth, {high}, is below the lowest");
        return reader.refuse(
            finding("NB0206", reader.span(&highest), message, "below `lowest`", "exchange the two")
                .related(reader.span(&lowest), "the lowest")
                .rule("DEP-4"),
        );
    }
    let (clamps, drops_triangles) = (fields.clamp(reader), fields.drop_triangles(reader));
    Some(DepthRange { lowest: low, highest: high, clamps, drops_triangles })
}

fn polygon_offset<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::PolygonOffset<'a>>) -> Option<PolygonOffset> {
    let fields = reader.read(raw)?;
    Some(PolygonOffset { bias: fields.bias(reader), factor: fields.factor(reader) })
}

fn stencil_test<'a>(reader: &mut Reader<'a>, fields: &source::StencilTest<'a>) -> StencilTest {
    StencilTest {
        function: fields.function(reader),
        reference: fields.reference(reader),
        mask: fields.mask(reader),
        write_mask: fields.write_mask(reader),
        fail: fields.fail(reader),
        depth_fail: fields.depth_fail(reader),
        pass: fields.pass(reader),
    }
}

fn window_clip<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::WindowClip<'a>>) -> Option<WindowClip> {
    let fields = reader.read(raw)?;
    let list = fields.rectangles(reader)?;
    let rectangles = reader.read(&list)?;
    reader.accept(legality::draw::window_clip(rectangles.len(), Some(reader.span(&list))))?;
    let rectangles = rectangles.iter().map(|raw| rectangle(reader, raw, ("window clip's rectangle", 1)));
    let rectangles = rectangles.collect::<Vec<_>>().into_iter().collect::<Option<Vec<_>>>()?;
    Some(WindowClip { rectangles, exclusive: fields.exclusive(reader) })
}

/// Reads a clipping rectangle, which has to lie in the target.
pub(super) fn clip<'a>(
    reader: &mut Reader<'a>,
    target: &Target,
    what: &'static str,
    raw: &Raw<'a, source::Rectangle<'a>>,
) -> Option<Rectangle> {
    let clip = rectangle(reader, raw, (what, 0))?;
    let inside = |at: u32, size: u32, whole: u32| at.checked_add(size).is_some_and(|end| end <= whole);
    if !inside(clip.x, clip.width, target.width) || !inside(clip.y, clip.height, target.height) {
        let label = format!("target \"{}\" is {} x {}", shorten(&target.name), target.width, target.height);
        let help = "x + width and y + height must not exceed the target";
        reader.push(finding("NB0215", reader.span(raw), format!("the {what} reaches outside the target"), label, help));
    }
    Some(clip)
}

/// Reads a rectangle of pixels with at least `least` columns and rows.
fn rectangle<'a>(
    reader: &mut Reader<'a>,
    raw: &Raw<'a, source::Rectangle<'a>>,
    (what, least): (&'static str, u32),
) -> Option<Rectangle> {
    let fields = source::Rectangle { called: what, ..reader.read(raw)? };
    let (x, y, width, height) = (fields.x(reader), fields.y(reader), fields.width(reader), fields.height(reader));
    let mut side = |raw: Option<Raw<'a, u32>>, side: &str| {
        reader.within(&raw?, &format!("the {side} of a {what}"), least..=MAX_CLIP_COORDINATE, |finding| finding)
    };
    let (width, height) = (side(width, "width"), side(height, "height"));
    Some(Rectangle { x, y, width: width?, height: height? })
}

/// Returns the depth, in steps of the buffer, that is stored as a word.
fn stored_depth<'a>(reader: &mut Reader<'a>, target: &Target, raw: &Raw<'a, u32>) -> Option<f32> {
    let (word, format) = (target::clear_depth_word(reader, target, raw)?, target.depth?.format);
    let depth = depth::of_word(format, word);
    if depth.is_none() {
        let message = "a draw stores no float depth whose exponent is 0";
        let help = "give it in the `clear` of the target, which stores any word";
        reader.push(finding("NB0402", reader.span(raw), message, "0 would be stored", help).rule("DEP-3"));
    }
    depth
}

/// Reads a clear among the draws, into a target.
pub(super) fn clear<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, source::ClearDraw<'a>>, target: usize) -> Option<Clear> {
    let fields = reader.read(raw)?;
    let target = &reader.targets.list.get(target)?.clone();
    let whole = Rectangle { x: 0, y: 0, width: target.width, height: target.height };
    let area =
        fields.rectangle.as_ref().map_or(Some(whole), |raw| clip(reader, target, "rectangle of a clear", raw))?;
    let mut color = fields.color.as_ref().map(|raw| color::constant(reader, raw).unwrap_or_default());
    if let Some(raw) = target::once(reader, &fields.color, &fields.word, "word") {
        color = Some(reader.read(raw).map_or([0; 4], |word| surface::read(target.format, word)));
    }
    let color_mask = fields.color_mask(reader);
    let fraction = |raw| (VertexDepths::Fractions, target::clear_depth(reader, target, raw).unwrap_or(0.0));
    let mut depth = fields.depth.as_ref().map(fraction);
    if let Some(raw) = target::once(reader, &fields.depth, &fields.depth_word, "depth_word") {
        depth = Some((VertexDepths::Steps, stored_depth(reader, target, raw).unwrap_or(0.0)));
    }
    let stencil = fields.stencil.as_ref().map(|raw| target::clear_stencil(reader, target, raw).unwrap_or_default());
    Some(Clear { area, color, color_mask, depth, stencil })
}
