//! Lowers render targets: sizes, formats, clears.
#![allow(clippy::float_arithmetic, reason = "DEP-2: the depth that a clear stores is given as a float")]

use super::*;
use crate::names::{Index, Targets};
pub(super) use ninebit::diagnostic::needs_nv2a;
use ninebit::legality;
use ninebit::number::convert;
use ninebit::raster::binary::Binary;
use ninebit::raster::depth;
use ninebit::rop::surface;

impl Targets<'_> {
    /// Adds the place of the target to a finding.
    pub(super) fn beside(&self, index: usize, finding: Diagnostic) -> Diagnostic {
        let place = self.index.span_of(index);
        if place.is_empty() { finding } else { finding.related(place, "the target") }
    }
}

/// Finds the target of a name. Returns `None` after recording what is wrong.
pub(super) fn find<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, String>) -> Option<usize> {
    Index::find(reader, |reader| &mut reader.targets.index, raw)
}

/// Name of the first target if it is not named.
const FRAME: &str = "frame";

/// Reads the targets. If the scene has none, adds one of 640 x 480 named "frame".
pub(super) fn targets<'a>(reader: &mut Reader<'a>, raw: &Option<Raw<'a, source::List<'a, source::Target<'a>>>>) {
    reader.targets.index = Index::new("target", "define it in `targets: [(name: \"...\")]`");
    let Some(raw) = raw else {
        let target = target(reader, &source::Target::default(), FRAME.to_owned());
        return reader.targets.add(0..0, target);
    };
    let list = reader.read(raw).unwrap_or_default();
    let (place, most) = (reader.span(raw), reader.limits.targets);
    if list.len() > most {
        reader.targets.index.unread = true;
        return reader.push(too_many("NB0608", place, list.len(), "render targets", "targets", most));
    }
    if list.is_empty() {
        let help = "leave `targets` out to get one of 640 x 480, or write `[(width: 256, height: 256)]`";
        reader.push(finding("NB0202", place.clone(), "a scene needs a render target", "empty", help));
    }
    let mut bytes = 0;
    for raw in &list {
        let opening = reader.opening(raw.text);
        let Some(fields) = reader.read(raw) else { continue };
        let (name, place) = match &fields.name {
            Some(raw) => (reader.read(raw), reader.span(raw)),
            None if reader.targets.list.is_empty() => (Some(FRAME.to_owned()), opening),
            None => {
                reader.required(&fields.name, "name", "target", opening, &fields.faults);
                continue;
            }
        };
        let Some(name) = name else { continue };
        if let Some(first) = reader.targets.index.place_of(&name) {
            reader.push(crate::wording::twice("target", &name, place, first));
            continue;
        }
        let target = target(reader, &fields, name);
        bytes += u64::from(target.width) * u64::from(target.height) * if target.depth.is_some() { 8 } else { 4 };
        for (raw, of) in [(fields.contents, Buffer::Color), (fields.depth_contents, Buffer::Depth)] {
            reader.targets.begins.extend(raw.map(|raw| (reader.targets.list.len(), of, raw)));
        }
        reader.targets.add(place, target);
    }
    if bytes > reader.limits.surface_bytes {
        let message = format!("the targets take {bytes} bytes; {} are allowed", reader.limits.surface_bytes);
        let help = "make the targets smaller, or fewer; `ninebit limits` prints what is allowed";
        reader.push(finding("NB0607", place, message, "too large together", help));
    }
}

impl Targets<'_> {
    fn add(&mut self, place: Span, target: Target) {
        self.index.add(target.name.clone(), place, Some(self.list.len()));
        self.list.push(target);
    }
}

fn target<'a>(reader: &mut Reader<'a>, fields: &source::Target<'a>, name: String) -> Target {
    let (width, height, format) = (fields.width(reader), fields.height(reader), fields.format(reader));
    let mut target = Target { name, clear_color: [0; 4], ..Target::new(width, height, format) };
    reader.accept(legality::surface::format(format, reader.profile, reader.place(&fields.format)));
    let depth: Option<DepthFormat> = fields.depth.as_ref().and_then(|raw| reader.name(raw));
    let place = reader.place(&fields.depth);
    reader.accept(depth.and_then(|depth| legality::surface::depth_format(depth, reader.profile, place)));
    let clear = fields.clear.as_ref().and_then(|raw| reader.read(raw)).unwrap_or_default();
    target.depth = depth.map(|format| DepthBuffer { format, clear: format.largest(), clear_stencil: 0 });
    target.clear_color = color::bytes(clear.color(reader));
    if let Some(raw) = once(reader, &clear.color, &clear.word, "word") {
        target.clear_color = reader.read(raw).map_or([0; 4], |word| surface::read(format, word));
    }
    if let Some(raw) = once(reader, &clear.depth, &clear.depth_word, "depth_word")
        && let (Some(word), Some(buffer)) = (clear_depth_word(reader, &target, raw), &mut target.depth)
    {
        buffer.clear = word;
    }
    if let Some(raw) = &clear.depth
        && let (Some(depth), Some(buffer)) = (clear_depth(reader, &target, raw), &mut target.depth)
    {
        buffer.clear = depth_word(buffer.format, depth);
    }
    if let Some(raw) = &clear.stencil
        && let (Some(stencil), Some(buffer)) = (clear_stencil(reader, &target, raw), &mut target.depth)
    {
        buffer.clear_stencil = stencil;
    }
    target.clip = fields.clip.as_ref().and_then(|raw| raster::clip(reader, &target, "clip of a target", raw));
    target
}

/// Returns the word that a clear stores for a depth, which is not negative.
pub(crate) fn depth_word(format: DepthFormat, depth: f32) -> u32 {
    if format.is_float() {
        depth::word(format, Binary::new(depth))
    } else {
        convert::depth(depth, format.bits()) as u32
    }
}

/// Fills targets with the textures that they begin as.
pub(super) fn contents(reader: &mut Reader<'_>) {
    for (index, buffer, raw) in std::mem::take(&mut reader.targets.begins) {
        let Some(texture) = texture::find(reader, &raw) else { continue };
        let (target, texture) = (&mut reader.targets.list[index], &reader.textures.list[texture]);
        match words(target, buffer, texture) {
            Ok(words) if buffer == Buffer::Color => target.contents = Some(words),
            Ok(words) => target.depth_contents = Some(words),
            Err((why, help)) => {
                let what = if buffer == Buffer::Color { "" } else { "the depths of " };
                let message =
                    format!("{what}target \"{}\" cannot begin as this texture: it {why}", shorten(&target.name));
                reader.push(finding("NB0226", reader.span(&raw), message, "does not fit", help));
            }
        }
    }
}

/// Returns the words that a buffer takes from a texture, or why it cannot and what to do.
fn words(target: &Target, buffer: Buffer, texture: &Texture) -> Result<Arc<[u32]>, (String, &'static str)> {
    let Target { width, height, format, .. } = target;
    let help = match buffer {
        Buffer::Color => "take one picture of as many columns and rows, in a format whose texels have as many bytes",
        Buffer::Depth => "take one picture of as many columns and rows, in the depth buffer's own format",
    };
    let refused = |why: String| Err((why, help));
    let texels = match &texture.image {
        TextureImage::Target { .. } | TextureImage::Depth { .. } => return refused("is a render target".to_owned()),
        TextureImage::Texels(texels) => texels,
    };
    if (texels.width, texels.height) != (*width, *height) {
        let (columns, rows) = (texels.width, texels.height);
        return refused(format!("has {columns} x {rows} texels, the target {width} x {height} pixels"));
    }
    let (name, depth) = (texture.format.name(), texture.format.depth());
    match (buffer, target.depth) {
        (Buffer::Color, _) => {
            if texture.format.is_compressed()
                || texture.format.is_paired()
                || depth.is_some()
                || texture.format.bytes() != format.bytes()
            {
                return refused(format!("is of format {name}, whose texels are no pixels of {}", format.name()));
            }
        }
        (Buffer::Depth, None) => {
            return Err((
                "has no place, for there is no depth buffer".to_owned(),
                "add `depth: Z24S8` (or `Z16`) to the target",
            ));
        }
        (Buffer::Depth, Some(buffer)) => {
            if depth != Some(buffer.format) {
                return refused(format!("is of format {name}, the depth buffer of {}", buffer.format.name()));
            }
        }
    }
    let has_several = matches!(texture.kind, TextureKind::Cube | TextureKind::ThreeDimensional);
    if has_several || texels.levels > 1 || texels.border {
        return refused("has faces, layers, levels or border texels".to_owned());
    }
    Ok(Arc::clone(&texels.words))
}

/// Reads the depth that a clear stores into a target with a depth buffer: 0 to 1, or for a float buffer any depth that is not negative.
pub(super) fn clear_depth<'a>(reader: &mut Reader<'a>, target: &Target, raw: &Raw<'a, f32>) -> Option<f32> {
    let (place, value) = (reader.span(raw), reader.finite(raw)?);
    let Some(buffer) = target.depth else { return without_depth(reader, place) };
    let highest = if buffer.format.is_float() { f32::MAX } else { 1.0 };
    if !(0.0..=highest).contains(&value) {
        let range = if buffer.format.is_float() { "write 0.0 or more" } else { "write 0.0 (near) to 1.0 (far)" };
        return reader.refuse(finding("NB0206", place, format!("a depth cannot be {value}"), "out of range", range));
    }
    Some(value)
}

/// Reads the word that a clear stores as the depth of a target with a depth buffer.
pub(super) fn clear_depth_word<'a>(reader: &mut Reader<'a>, target: &Target, raw: &Raw<'a, u32>) -> Option<u32> {
    let Some(buffer) = target.depth else { return without_depth(reader, reader.span(raw)) };
    reader.within(raw, "the word of a depth", 0..=buffer.format.largest(), |finding| finding.rule("CLR-1"))
}

/// Refuses to clear the depths of a target without a depth buffer.
fn without_depth<T>(reader: &mut Reader<'_>, place: Span) -> Option<T> {
    let help = "add `depth: Z24S8` (or `Z16`) to the target, or leave this out";
    reader.refuse(finding("NB0216", place, "this target has no depth buffer to clear", "no depth buffer", help))
}

/// Returns a word of a clear, unless the value that it takes the place of is written too.
pub(super) fn once<'b, 'a, T>(
    reader: &mut Reader<'a>,
    value: &Option<Raw<'a, T>>,
    word: &'b Option<Raw<'a, u32>>,
    name: &str,
) -> Option<&'b Raw<'a, u32>> {
    let word = word.as_ref()?;
    if value.is_some() {
        let message = format!("`{name}` takes the place of what is written beside it");
        let help = "keep one of the two";
        return reader.refuse(finding("NB0225", reader.span(word), message, "not both", help).rule("CLR-1"));
    }
    Some(word)
}

/// Reads the stencil that a clear stores into a target with a stencil.
pub(super) fn clear_stencil<'a>(reader: &mut Reader<'a>, target: &Target, raw: &Raw<'a, u8>) -> Option<u8> {
    let stencil = reader.read(raw)?;
    if !target.depth.is_some_and(|depth| depth.format.has_stencil()) {
        let message = "this target has no stencil to clear";
        let help = "give the target `depth: Z24S8`, or leave this out";
        return reader.refuse(finding("NB0216", reader.span(raw), message, "no stencil", help).rule("STN-1"));
    }
    Some(stencil)
}
