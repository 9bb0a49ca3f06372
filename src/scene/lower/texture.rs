//! Lowers textures: their kind and format, and how they are made of faces and levels.

use super::texture_levels::LevelCount;
use super::texture_source::{Request, SourceTexels, Variant, only};
use super::*;
use crate::names::{Index, Textures};
use crate::reader::Entry;
use ninebit::legality;
use ninebit::rop::surface;

impl Textures {
    pub(super) fn warn_unused(&self, reader: &mut Reader<'_>) {
        self.index.warn_unused(reader);
        self.palettes.index.warn_unused(reader);
    }
}

/// Finds the texture of a name. Returns `None` after recording what is wrong.
pub(super) fn find<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, String>) -> Option<usize> {
    Index::find(reader, |reader| &mut reader.textures.index, raw)
}

/// Reads every palette and texture, including their files.
pub(super) fn textures<'a>(reader: &mut Reader<'a>, file: &source::Scene<'a>) {
    palette::palettes(reader, &file.palettes);
    reader.textures.index = Index::new("texture", "define it in `textures: { \"...\": (source: ...) }`");
    reader.textures.left = reader.limits.texture_bytes;
    let entries = reader.table("texture", &file.textures);
    if let Some(raw) = &file.textures
        && entries.len() > reader.limits.textures
    {
        let (place, count, most) = (reader.span(raw), entries.len(), reader.limits.textures);
        reader.push(too_many("NB0605", place, count, "textures", "textures", most));
        // Their names are registered nevertheless, so that uses of them are no further errors.
        return reader.textures.index.without(entries.into_iter().map(|entry| entry.name));
    }
    for entry in entries {
        let read = texture(reader, &entry);
        let textures = &mut reader.textures;
        let index = read.map(|(texture, palette)| {
            textures.list.push(texture);
            textures.palette_of.push(palette);
            textures.list.len() - 1
        });
        textures.index.add(entry.name, entry.place, index);
    }
}

/// Reads one texture and the index of its palette.
fn texture<'a>(reader: &mut Reader<'a>, entry: &Entry<'a, source::Texture<'a>>) -> Option<(Texture, Option<usize>)> {
    let fields = reader.read(&entry.value)?;
    let kind = reader.perhaps(&fields.kind, |reader, raw| reader.name(&raw.as_other()))?;
    let format = reader.perhaps(&fields.format, |reader, raw| Some((format(reader, raw)?, reader.span(raw))))?;
    let palette = fields.palette.as_ref().and_then(|raw| palette::find(reader, raw));
    let border = fields.border(reader);
    let levels = fields.levels.as_ref().map_or(Some(LevelCount::Own), |raw| texture_levels::requested(reader, raw))?;
    let source = fields.source(reader)?;
    let (variant, rest) = reader.variant(&source, "texture source", Variant::ALL_NAMES)?;
    let (texture, palette) = if matches!(Variant::ALL[variant], Variant::Target | Variant::Depth) {
        let depth = Variant::ALL[variant] == Variant::Depth;
        (of_target(reader, (rest, depth), kind, format, &fields, &entry.name)?, palette)
    } else {
        let request = Request {
            format: format.as_ref().map(|(format, _)| *format),
            faces: if kind == Some(TextureKind::Cube) { CUBE_FACES } else { 1 },
            volume: kind == Some(TextureKind::ThreeDimensional),
            levels,
            border,
        };
        let mut given = texture_source::read(reader, Variant::ALL[variant], &source, rest, &request)?;
        if fields.mips.is_some() && levels != LevelCount::Own {
            let place = reader.place(&fields.levels);
            let help = "keep `levels`, or `mips`, whose sources are levels 1, 2 and so on";
            let message = "levels are counted and listed at once";
            return reader.refuse(finding("NB0230", place, message, "counted here", help));
        }
        let made = given.palette.take().map(|entries| reader.textures.palettes.add(&entry.name, entries));
        let place = given.place.clone();
        let kind = settled_kind(reader, kind, &given)?;
        let format_place = format.map_or_else(|| place.clone(), |(_, place)| place);
        let checks = reader.texture_checks();
        reader.accept(checks.format(given.format, Some(format_place)))?;
        if border {
            let place = fields.border.as_ref().map_or(place.clone(), |raw| reader.span(raw));
            reader.accept(checks.border(kind, given.format, Some(place)))?;
        }
        let (width, height) = interior(reader, &given, border)?;
        reader.accept(checks.sides(kind, given.format, [width, height], Some(place)))?;
        let layers = if kind == TextureKind::ThreeDimensional { given.faces.len() as u32 } else { 1 };
        reader.accept(checks.layers(kind, layers, Some(given.place.clone())))?;
        match &fields.mips {
            Some(raw) => texture_levels::listed(reader, &mut given, raw, kind, &request)?,
            None => texture_levels::resize_chain(reader, &mut given, levels, &request)?,
        }
        let levels = given.levels();
        reader.accept(checks.levels(kind, levels, Some(given.place.clone())))?;
        let first =
            reader.perhaps(&fields.first_level, |reader, raw| texture_levels::first(reader, &mut given, raw))?;
        let first = first.unwrap_or(0);
        let levels = levels - first;
        let [width, height] = [width, height].map(|side| (side >> first).max(1));
        let format = given.format;
        let words: Vec<u32> = given.faces.into_iter().flatten().flatten().collect();
        let texels = Texels { width, height, levels, layers, border, words: words.into() };
        let image = TextureImage::Texels(texels);
        (Texture { name: entry.name.clone(), kind, format, image }, palette.or(made))
    };
    match &fields.palette {
        Some(raw) if texture.format != TextureFormat::P8 => {
            reader.refuse(legality::texture::unread_palette(texture.format, Some(reader.span(raw))))
        }
        // What is wrong with the palette itself has been recorded.
        Some(_) if palette.is_none() => None,
        _ => Some((texture, palette)),
    }
}

fn format<'a>(reader: &mut Reader<'a>, raw: &Raw<'a, crate::reader::Name<TextureFormat>>) -> Option<TextureFormat> {
    if let (name, "") = raw.split()
        && let Some((own, _)) =
            DEPTH_FORMATS.iter().find(|(_, names)| names.iter().any(|known| known.eq_ignore_ascii_case(name)))
    {
        let help = if own.is_empty() { "take Z16, Z24S8, Z16F or Z24S8F" } else { own };
        let message = format!("`{name}` is not a texture format here");
        let help = format!("write `{help}`, and give the unit a `shadow` comparison");
        return reader.refuse(finding("NB0204", reader.span(raw), message, "a format of depths", help).rule("SHD-1"));
    }
    reader.name(raw)
}

/// Names of depth formats: our name, then those of the chip's registers and of both APIs. Formats that the state lacks have no name of ours.
const DEPTH_FORMATS: [(&str, &[&str]); 5] = [
    ("Z16", &["D16", "D16_LOCKABLE", "LIN_D16", "DEPTH_COMPONENT16", "DEPTH_Y16_FIXED"]),
    ("Z24S8", &["Z24X8", "D24S8", "D24X8", "LIN_D24S8", "DEPTH_COMPONENT24", "DEPTH_X8_Y24_FIXED"]),
    ("Z16F", &["F16", "LIN_F16", "DEPTH_Y16_FLOAT"]),
    ("Z24S8F", &["F24S8", "LIN_F24S8", "DEPTH_X8_Y24_FLOAT"]),
    ("", &["D15S1", "D32"]),
];

/// Determines the kind of a texture: the one that is written, or the one that its source suggests; the two have to agree.
fn settled_kind(reader: &mut Reader<'_>, written: Option<TextureKind>, given: &SourceTexels) -> Option<TextureKind> {
    use TextureKind::{Cube, ThreeDimensional, TwoDimensional};
    let own = match given.volume {
        true => ThreeDimensional,
        false if given.faces.len() == CUBE_FACES as usize => Cube,
        false => TwoDimensional,
    };
    let kind = written.unwrap_or(own);
    let of_kind = |what: &str| format!("{what} do not make a texture of kind {}", kind.name());
    let (message, help, rule) = match (own, kind) {
        _ if kind == own => return Some(kind),
        (ThreeDimensional, _) => (of_kind("layers"), "write `kind: ThreeDimensional`, or leave `kind` out", "VOL-1"),
        (_, ThreeDimensional) => {
            let help = "write `Layers([..., ...])`, or name a DDS file of a volume, or `Raw(...)` with `layers`";
            ("a volume has layers, and here are none".to_owned(), help, "VOL-1")
        }
        (Cube, _) => (of_kind("six faces"), "write `kind: Cube`, or leave `kind` out", "TEX-12"),
        (_, Cube) => {
            let help = "write `Faces(positive_x: ..., negative_x: ..., ...)`, or name a DDS file of a cube map";
            ("a cube map has six faces, and here is one picture".to_owned(), help, "TEX-12")
        }
        _ => return Some(kind),
    };
    reader.refuse(finding("NB0232", given.place.clone(), message, "here", help).rule(rule))
}

/// Returns the sides of level 0 without border texels.
fn interior(reader: &mut Reader<'_>, given: &SourceTexels, border: bool) -> Option<(u32, u32)> {
    let beyond = texture_levels::beyond(border);
    let (width, height) = (given.width, given.height);
    if width <= beyond || height <= beyond {
        let message = format!("{width} x {height} texels leave nothing inside a border of 4 on each side");
        let help = "with `border: true` a source has 8 columns and rows more than the texture";
        return reader.refuse(finding("NB0231", given.place.clone(), message, "too small", help).rule("TEX-7"));
    }
    Some((width - beyond, height - beyond))
}

/// Makes a texture that shows a render target.
fn of_target<'a>(
    reader: &mut Reader<'a>,
    (text, depths): (&'a str, bool),
    kind: Option<TextureKind>,
    format: Option<(TextureFormat, Span)>,
    fields: &source::Texture<'a>,
    name: &str,
) -> Option<Texture> {
    let raw = only::<String>(reader, text, "the name of one target")?;
    let index = target::find(reader, &raw)?;
    let target = &reader.targets.list[index].clone();
    let place = reader.span(&raw);
    let kind = kind.unwrap_or(TextureKind::TwoDimensional);
    let extra = [
        (kind == TextureKind::Cube).then(|| (place.clone(), "face of a cube map")),
        (kind == TextureKind::ThreeDimensional).then(|| (place.clone(), "volume")),
        fields.levels.as_ref().map(|raw| (reader.span(raw), "level of several")),
        fields.mips.as_ref().map(|raw| (reader.span(raw), "level of several")),
        fields.first_level.as_ref().map(|raw| (reader.span(raw), "level of several")),
        fields.border.as_ref().map(|raw| (reader.span(raw), "texture with border texels")),
    ];
    if let Some((place, what)) = extra.into_iter().flatten().next() {
        let message = format!("a render target cannot be a {what}");
        let help = "a target is sampled as one picture: `TwoDimensional` or `Rectangle`, one level, no border";
        return reader.refuse(finding("NB0232", place, message, "does not go with `Target`", help));
    }
    if depths {
        return of_depths(reader, (target, index), kind, format, place, name);
    }
    let own = target.format.texture_format();
    let (format, format_place) = match format {
        Some((TextureFormat::P8, place)) => {
            let message = "a render target does not hold indices of a palette";
            let help = format!("leave `format` out, which means {own:?} here");
            return reader.refuse(finding("NB0232", place, message, "does not go with `Target`", help));
        }
        Some((format, place)) if format.is_paired() => {
            let message = format!("a render target is not read as {}", format.name());
            let help = format!("leave `format` out, which means {own:?} here");
            return reader.refuse(finding("NB0232", place, message, "does not go with `Target`", help));
        }
        Some((format, place)) if format.depth().is_some() => {
            let message = "the colours of a render target are no depths";
            let help =
                format!("write `Depth(...)` for its depth buffer, or leave `format` out, which means {own:?} here");
            return reader.refuse(finding("NB0232", place, message, "does not go with `Target`", help));
        }
        Some((format, place)) => (format, place),
        None => (own, place.clone()),
    };
    let (texel, pixel) = (format.bytes(), target.format.bytes());
    let columns = surface::texel_columns(target.width, pixel, texel);
    let problem = match columns {
        _ if texel == pixel => None,
        _ if format.is_compressed() => {
            Some((format!("a block of {texel} bytes cannot show a pixel of {pixel}"), String::new()))
        }
        _ if kind != TextureKind::Rectangle => {
            let message =
                format!("a texel of {texel} bytes cannot show a pixel of {pixel} in a {} texture", kind.name());
            Some((message, ", or write `kind: Rectangle`, whose rows are read in texels of another size".to_owned()))
        }
        None => {
            let bytes = u64::from(target.width) * u64::from(pixel);
            Some((format!("a row of {bytes} bytes is no whole number of texels of {texel}"), String::new()))
        }
        Some(_) => None,
    };
    if let Some((message, or)) = problem {
        let size = if pixel == 1 { "1 byte".to_owned() } else { format!("{pixel} bytes") };
        let help = format!("leave `format` out, which means {own:?} here, or take another with texels of {size}{or}");
        return reader.refuse(finding("NB0218", format_place, message, "another size", help));
    }
    let checks = reader.texture_checks();
    reader.accept(checks.format(format, Some(format_place)))?;
    reader.accept(checks.sides(kind, format, [columns.unwrap_or(target.width), target.height], Some(place)))?;
    Some(Texture { name: name.to_owned(), kind, format, image: TextureImage::Target { target: index } })
}

/// Makes a texture that shows the depth buffer of a target.
fn of_depths(
    reader: &mut Reader<'_>,
    (target, index): (&Target, usize),
    kind: TextureKind,
    format: Option<(TextureFormat, Span)>,
    place: Span,
    name: &str,
) -> Option<Texture> {
    let Some(depth) = target.depth else {
        let message = format!("target \"{}\" has no depth buffer", shorten(&target.name));
        let help = "give the target `depth: Z24S8`";
        return reader.refuse(finding("NB0216", place, message, "shows its depths", help).rule("SHD-1"));
    };
    let own = TextureFormat::ALL.iter().copied().find(|format| format.depth() == Some(depth.format))?;
    let (format, format_place) = format.unwrap_or((own, place.clone()));
    if format.depth().is_none_or(|format| format.bits() != depth.format.bits()) {
        let message = format!("depths of {} cannot be read as {}", own.name(), format.name());
        let help = format!("leave `format` out, which means {} here", own.name());
        return reader.refuse(finding("NB0218", format_place, message, "another size, or no depths", help));
    }
    let checks = reader.texture_checks();
    reader.accept(checks.format(format, Some(format_place)))?;
    reader.accept(checks.sides(kind, format, [target.width, target.height], Some(place)))?;
    Some(Texture { name: name.to_owned(), kind, format, image: TextureImage::Depth { target: index } })
}
