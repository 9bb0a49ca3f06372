//! Render targets.
#![allow(clippy::float_arithmetic, reason = "DEP-2: the depth that a clear stores is given as a float")]

use std::collections::HashMap;
use std::sync::Arc;

use super::names::Names;
use super::texture::Textures;
use super::*;
pub(super) use ninebit::diagnostic::only_nv2a;
use ninebit::number::convert;
use ninebit::raster::depth;
use ninebit::state::{DepthBuffer, DepthFormat, Named, Target, TextureImage, TextureKind};

/// The targets, and where they were named.
pub(super) struct Targets<'s> {
    pub(super) list: Vec<Target>,
    by_name: HashMap<String, usize>,
    places: Vec<Range<usize>>,
    /// There are too many: none is known.
    unread: bool,
    /// Targets that begin as a texture, which are read later.
    begins: Vec<(usize, Raw<'s, String>)>,
}

impl<'s> Targets<'s> {
    /// The target of that name; `None` once the reason has been recorded.
    pub(super) fn find<'a>(&self, reader: &mut Reader<'a>, raw: &Raw<'a, String>) -> Option<usize> {
        let name = reader.read(raw)?;
        match self.by_name.get(&name).copied() {
            None if !self.unread => {
                let known = self.list.iter().map(|target| target.name.as_str());
                let define = "define it in `targets: [(name: \"...\")]`";
                unknown_name(reader, reader.span(raw), "target", &name, known, define)
            }
            found => found,
        }
    }

    /// A finding with the target's place beside it.
    pub(super) fn beside(&self, index: usize, finding: Diagnostic) -> Diagnostic {
        let place = self.place(index);
        if place.is_empty() { finding } else { finding.related(place, "the target") }
    }

    /// Where the target is described.
    pub(super) fn place(&self, index: usize) -> Range<usize> {
        self.places.get(index).cloned().unwrap_or_default()
    }
}

/// The name of the first target that has no other.
const FRAME: &str = "frame";

/// Reads the targets; one of 640 x 480 named "frame" if the scene has none.
pub(super) fn targets<'a>(
    reader: &mut Reader<'a>,
    names: &Names<'a>,
    raw: &Option<Raw<'a, source::List<'a, source::Target<'a>>>>,
) -> Targets<'a> {
    let mut targets =
        Targets { list: Vec::new(), by_name: HashMap::new(), places: Vec::new(), unread: false, begins: Vec::new() };
    let list = match raw {
        Some(raw) => {
            let list = reader.read(raw).unwrap_or_default();
            let place = reader.span(raw);
            if list.len() > reader.limits.targets {
                let most = reader.limits.targets;
                reader.push(too_many("NB0608", place, list.len(), "render targets", "targets", most));
                targets.unread = true;
                return targets;
            }
            if list.is_empty() {
                let help = "leave `targets` out to get one of 640 x 480, or write `[(width: 256, height: 256)]`";
                reader.push(finding("NB0202", place, "a scene needs a render target", "empty", help));
            }
            list
        }
        None => {
            let target = target(reader, names, &source::Target::default(), FRAME.to_owned());
            targets.add(FRAME.to_owned(), 0..0, target);
            return targets;
        }
    };
    let mut bytes = 0;
    for raw in &list {
        let place = reader.opening(raw.text);
        let Some(fields) = reader.read(raw) else { continue };
        let (name, place) = match &fields.name {
            Some(raw) => (reader.read(raw), reader.span(raw)),
            None if targets.list.is_empty() => (Some(FRAME.to_owned()), place),
            None => {
                reader.required(&fields.name, "name", "target", place.clone());
                (None, place)
            }
        };
        let Some(name) = name else { continue };
        if let Some(first) = targets.by_name.get(&name) {
            let first = targets.place(*first);
            reader.push(crate::wording::twice("target", &name, place, first));
            continue;
        }
        let target = target(reader, names, &fields, name.clone());
        bytes += u64::from(target.width) * u64::from(target.height) * if target.depth.is_some() { 8 } else { 4 };
        if let Some(raw) = fields.contents {
            targets.begins.push((targets.list.len(), raw));
        }
        targets.add(name, place, target);
    }
    if let Some(raw) = raw
        && bytes > reader.limits.surface_bytes
    {
        let message = format!("the targets take {bytes} bytes; {} are allowed", reader.limits.surface_bytes);
        let place = reader.span(raw);
        let help = "make the targets smaller, or fewer; `ninebit limits` prints what is allowed";
        reader.push(finding("NB0607", place, message, "too large together", help));
    }
    targets
}

impl Targets<'_> {
    fn add(&mut self, name: String, place: Range<usize>, target: Target) {
        self.by_name.insert(name, self.list.len());
        self.list.push(target);
        self.places.push(place);
    }
}

fn target<'a>(reader: &mut Reader<'a>, names: &Names<'a>, fields: &source::Target<'a>, name: String) -> Target {
    let (width, height, format) = (fields.width(reader), fields.height(reader), fields.format(reader));
    let mut target =
        Target { name, width, height, format, clear_color: [0; 4], contents: None, depth: None, clip: None };
    reader.needs_nv2a(&fields.format, format.is_nv2a_only(), "NB0314", ("this surface format", "ROP-5"));
    let depth = fields.depth.as_ref().and_then(|raw| reader.name(raw));
    let float = depth.is_some_and(DepthFormat::is_float);
    reader.needs_nv2a(&fields.depth, float, "NB0314", ("this depth format", "DEP-3"));
    let clear = fields.clear.as_ref().and_then(|raw| reader.read(raw)).unwrap_or_default();
    target.depth = depth.map(|format| DepthBuffer { format, clear: format.largest(), clear_stencil: 0 });
    target.clear_color = color::bytes(clear.color(reader, names));
    if let Some(raw) = &clear.depth
        && let (Some(depth), Some(buffer)) = (clear_depth(reader, &target, raw), &mut target.depth)
    {
        buffer.clear = if buffer.format.is_float() {
            depth::word(buffer.format, depth::Binary::new(depth))
        } else {
            convert::depth(depth, buffer.format.bits()) as u32
        };
    }
    if let Some(raw) = &clear.stencil
        && let (Some(stencil), Some(buffer)) = (clear_stencil(reader, &target, raw), &mut target.depth)
    {
        buffer.clear_stencil = stencil;
    }
    target.clip = fields.clip.as_ref().and_then(|raw| raster::clip(reader, &target, "clip of a target", raw));
    target
}

/// Gives targets the textures that they begin as.
pub(super) fn contents<'a>(reader: &mut Reader<'a>, targets: &mut Targets<'a>, textures: &mut Textures) {
    for (index, raw) in std::mem::take(&mut targets.begins) {
        let Some(texture) = textures.find(reader, &raw) else { continue };
        let (target, texture) = (&mut targets.list[index], &textures.list[texture]);
        let Target { name, width, height, format, .. } = target;
        let refused = match &texture.image {
            TextureImage::Target { .. } | TextureImage::Depth { .. } => Some("is a render target".to_owned()),
            TextureImage::Texels(texels) => {
                let size = (texels.width, texels.height);
                if size != (*width, *height) {
                    Some(format!("has {} x {} texels, the target {width} x {height} pixels", size.0, size.1))
                } else if texture.format.is_compressed()
                    || texture.format.depth().is_some()
                    || texture.format.bytes() != format.bytes()
                {
                    Some(format!(
                        "is of format {}, whose texels are no pixels of {}",
                        texture.format.name(),
                        format.name()
                    ))
                } else if matches!(texture.kind, TextureKind::Cube | TextureKind::ThreeDimensional)
                    || texels.levels > 1
                    || texels.border
                {
                    Some("has faces, layers, levels or border texels".to_owned())
                } else {
                    target.contents = Some(Arc::clone(&texels.words));
                    None
                }
            }
        };
        if let Some(why) = refused {
            let message = format!("target \"{}\" cannot begin as this texture: it {why}", shorten(name));
            let help = "take one picture of as many columns and rows, in a format whose texels have as many bytes";
            reader.push(finding("NB0226", reader.span(&raw), message, "does not fit", help));
        }
    }
}

/// The depth that a clear stores, 0 to 1, of a float buffer any that is not negative, into a target that has a depth buffer.
pub(super) fn clear_depth<'a>(reader: &mut Reader<'a>, target: &Target, raw: &Raw<'a, f32>) -> Option<f32> {
    let (place, value) = (reader.span(raw), reader.finite(raw)?);
    let Some(buffer) = target.depth else {
        let help = "add `depth: Z24S8` (or `Z16`) to the target, or leave this out";
        let message = "this target has no depth buffer to clear";
        return reader.refuse(finding("NB0216", place, message, "no depth buffer", help));
    };
    let highest = if buffer.format.is_float() { f32::MAX } else { 1.0 };
    if !(0.0..=highest).contains(&value) {
        let range = if buffer.format.is_float() { "write 0.0 or more" } else { "write 0.0 (near) to 1.0 (far)" };
        return reader.refuse(finding("NB0206", place, format!("a depth cannot be {value}"), "out of range", range));
    }
    Some(value)
}

/// The stencil that a clear stores, into a target that has one.
pub(super) fn clear_stencil<'a>(reader: &mut Reader<'a>, target: &Target, raw: &Raw<'a, u8>) -> Option<u8> {
    let stencil = reader.read(raw)?;
    if !target.depth.is_some_and(|depth| depth.format.has_stencil()) {
        let message = "this target has no stencil to clear";
        let help = "give the target `depth: Z24S8`, or leave this out";
        return reader.refuse(finding("NB0216", reader.span(raw), message, "no stencil", help).rule("STN-1"));
    }
    Some(stencil)
}
