//! Reads the sources of texels: files, raw memory, lists of words, generated pictures.

use super::texture_levels::{self, LevelCount};
use super::*;
use ninebit::legality::texture::no_texels;
use ninebit_files::texels;

mod made;
mod stored;

pub(super) use stored::read_file;

/// Texels that a source gives.
pub(super) struct SourceTexels {
    pub(super) format: TextureFormat,
    /// Columns of level 0, border texels included.
    pub(super) width: u32,
    /// Rows of level 0, border texels included.
    pub(super) height: u32,
    /// Words of each level of each face (one or six) or layer.
    pub(super) faces: Vec<Vec<Vec<u32>>>,
    /// Whether `faces` are the layers of a volume.
    pub(super) volume: bool,
    /// Entries of the palette, if the file has one.
    pub(super) palette: Option<Vec<u32>>,
    /// The place that messages about the texture point to.
    pub(super) place: Span,
}

impl SourceTexels {
    /// Returns the number of levels of each face.
    pub(super) fn levels(&self) -> u32 {
        self.faces.first().map_or(1, |levels| levels.len() as u32)
    }
}

/// What a texture asks of its source.
#[derive(Clone, Copy)]
pub(super) struct Request {
    /// Format that the scene gives, if any.
    pub(super) format: Option<TextureFormat>,
    /// Number of faces in a raw file.
    pub(super) faces: u32,
    /// Whether a raw file holds the layers of a volume.
    pub(super) volume: bool,
    /// Number of levels in a raw file.
    pub(super) levels: LevelCount,
    /// Whether sources have border texels.
    pub(super) border: bool,
}

ninebit::state::named! {
    /// A kind of source.
    pub(super) enum Variant {
        /// A PNG, TGA or DDS file.
        File,
        /// A file of texels as they lie in memory, without a header.
        Raw,
        /// A source for each face of a cube map.
        Faces,
        /// A source for each layer of a volume.
        Layers,
        /// Words of texels in hexadecimal.
        Texels,
        /// One colour for all texels.
        Solid,
        /// A checkerboard of two colours.
        Checker,
        /// A gradient from one colour to another.
        Ramp,
        /// A render target.
        Target,
        /// The depth buffer of a render target.
        Depth,
    }
}

impl Variant {
    pub(super) const ALL_NAMES: &'static [&'static str] = Variant::NAMES;
    /// Sources of a face or layer, which exclude whole cube maps and targets.
    const OF_FACE: [Variant; 6] =
        [Variant::File, Variant::Raw, Variant::Texels, Variant::Solid, Variant::Checker, Variant::Ramp];
    /// Sources of a level.
    pub(super) const OF_LEVEL: [Variant; 7] =
        [Variant::File, Variant::Raw, Variant::Faces, Variant::Texels, Variant::Solid, Variant::Checker, Variant::Ramp];
}

/// Reads a source; `text` is what follows the name of its variant. Returns `None` after recording what is wrong.
pub(super) fn read<'a>(
    reader: &mut Reader<'a>,
    variant: Variant,
    raw: &Raw<'a, source::ImageSource>,
    text: &'a str,
    request: &Request,
) -> Option<SourceTexels> {
    let place = reader.span(raw);
    match variant {
        Variant::File => stored::file(reader, text, request, place),
        Variant::Raw => stored::memory(reader, text, request),
        Variant::Faces => faces(reader, text, request, place),
        Variant::Layers => layers(reader, text, request, place),
        Variant::Texels => words(reader, text, request),
        Variant::Solid | Variant::Checker | Variant::Ramp => {
            let format = packable(reader, request, place)?;
            let picture = made::picture(reader, variant, text, request)?;
            Some(one(format, picture.width, picture.height, texels::pack(&picture.pixels, format), picture.place))
        }
        // These are lowered by the caller.
        Variant::Target | Variant::Depth => None,
    }
}

/// Reads a source within another one, which has to be one of `variants`.
pub(super) fn nested<'a>(
    reader: &mut Reader<'a>,
    raw: &Raw<'a, source::ImageSource>,
    what: &str,
    variants: &[Variant],
    request: &Request,
) -> Option<SourceTexels> {
    let names: Vec<&'static str> = variants.iter().map(|variant| variant.name()).collect();
    let (variant, rest) = reader.variant(raw, what, &names)?;
    read(reader, variants[variant], raw, rest, request)
}

/// Subtracts the memory of `words` words from what textures may still take.
pub(super) fn afford<'a>(reader: &mut Reader<'a>, place: Span, words: u64) -> Option<()> {
    let bytes = words.saturating_mul(4);
    let Some(rest) = reader.textures.left.checked_sub(bytes) else {
        let message = format!("the textures take more than {} bytes together", reader.limits.texture_bytes);
        let help = "make the textures smaller, or fewer; `ninebit limits` prints what is allowed";
        return reader.refuse(finding("NB0607", place, message, format!("{bytes} more bytes here"), help));
    };
    reader.textures.left = rest;
    Some(())
}

/// Reads six sources, one for each face.
fn faces<'a>(reader: &mut Reader<'a>, text: &'a str, request: &Request, place: Span) -> Option<SourceTexels> {
    let fields = reader.read(&Raw::<source::Faces<'a>>::new(text))?;
    let request = Request { faces: 1, ..*request };
    let mut six: Vec<SourceTexels> = Vec::new();
    let face = [
        source::Faces::positive_x,
        source::Faces::negative_x,
        source::Faces::positive_y,
        source::Faces::negative_y,
        source::Faces::positive_z,
        source::Faces::negative_z,
    ];
    for face in face {
        let Some(raw) = face(&fields, reader) else { continue };
        if let Some(face) = nested(reader, &raw, "source of a face", &Variant::OF_FACE, &request)
            && six.first().is_none_or(|first| alike(reader, first, &face, reader.span(&raw), "face"))
        {
            six.push(face);
        }
    }
    if six.len() < CUBE_FACES as usize {
        return None;
    }
    let mut six = six.into_iter();
    let mut first = six.next()?;
    first.faces.extend(six.flat_map(|face| face.faces));
    first.place = place;
    Some(first)
}

/// Reads a list of sources, one for each layer.
fn layers<'a>(reader: &mut Reader<'a>, text: &'a str, request: &Request, place: Span) -> Option<SourceTexels> {
    let raw = only::<source::List<'a, source::ImageSource>>(reader, text, "a list of sources")?;
    let list = reader.read(&raw)?;
    let request = Request { volume: false, ..*request };
    let mut all: Vec<SourceTexels> = Vec::new();
    for raw in &list {
        let layer = nested(reader, raw, "source of a layer", &Variant::OF_FACE, &request)?;
        if !all.first().is_none_or(|first| alike(reader, first, &layer, reader.span(raw), "layer")) {
            return None;
        }
        all.push(layer);
    }
    let mut all = all.into_iter();
    let Some(mut first) = all.next() else {
        let help = "list a source for each layer";
        return reader.refuse(finding("NB0334", place, "a volume has no layer", "empty", help).rule("VOL-1"));
    };
    first.faces.extend(all.flat_map(|layer| layer.faces));
    (first.place, first.volume) = (place, true);
    Some(first)
}

/// Reads words in hexadecimal, one text for each row.
fn words<'a>(reader: &mut Reader<'a>, text: &'a str, request: &Request) -> Option<SourceTexels> {
    let raw = Raw::<source::TexelRows<'a>>::new(text);
    let fields = reader.read(&raw)?;
    let format = request.format.unwrap_or(TextureFormat::A8R8G8B8);
    if format.is_compressed() {
        return reader.refuse(cannot_pack(format, reader.span(&raw)));
    }
    let sides = (fields.width(reader), fields.height(reader));
    let (width, height, place) = self::sides(reader, sides, request)?;
    afford(reader, place.clone(), u64::from(width) * u64::from(height))?;
    let list = fields.rows(reader)?;
    let rows = reader.read(&list)?;
    let digits = format.word_bits() as usize / 4;
    let help = format!("write {width} words of {digits} hexadecimal digits in each of {height} rows, for {format:?}");
    if rows.len() != height as usize {
        let message = format!("{} rows of texels for a height of {height}", rows.len());
        return reader.refuse(finding("NB0220", reader.span(&list), message, "another number of rows", help));
    }
    let mut words = Vec::with_capacity(width as usize * height as usize);
    for raw in &rows {
        let row = reader.read(raw)?;
        let mut count = 0;
        for word in row.split_ascii_whitespace() {
            let Some(value) = hexadecimal(word, digits) else {
                let place = reader.span(raw);
                let message = format!("`{}` is not a texel", shorten(word));
                return reader.refuse(finding("NB0220", place, message, "in this row", help));
            };
            // Bits that the format ignores are zero in the state.
            words.push(texels::stored(value & texels::used_bits(format), format));
            count += 1;
        }
        if count != width as usize {
            let place = reader.span(raw);
            let message = format!("{count} texels in a row of {width}");
            return reader.refuse(finding("NB0220", place, message, "in this row", help));
        }
    }
    Some(one(format, width, height, words, place))
}

/// Reads width and height; also returns their place. They are checked only against the largest side that any texture may have: all other
/// conditions depend on the kind.
pub(super) fn sides<'a>(
    reader: &mut Reader<'a>,
    (width, height): (Option<Raw<'a, u32>>, Option<Raw<'a, u32>>),
    request: &Request,
) -> Option<(u32, u32, Span)> {
    let (width, height) = (width?, height?);
    let place = reader.span(&width).start..reader.span(&height).end.max(reader.span(&width).end);
    let (width, height) = (reader.read(&width)?, reader.read(&height)?);
    let checks = reader.texture_checks();
    // The largest side of any kind.
    let most = checks.largest_side.min(if reader.profile == Profile::Nv10 { 2048 } else { 4096 });
    if width.max(height) > most + texture_levels::beyond(request.border) {
        return reader.refuse(checks.too_large("a texture", [width, height], most, Some(place)));
    }
    if width == 0 || height == 0 {
        return reader.refuse(no_texels("a texture", [width, height], Some(place)));
    }
    Some((width, height, place))
}

/// Reads the only value in the parentheses of `Variant(value)`.
pub(super) fn only<'a, T>(reader: &mut Reader<'a>, text: &'a str, what: &str) -> Option<Raw<'a, T>> {
    let raw = Raw::<Tuple<'a, T>>::new(text);
    let parts = reader.read(&raw)?.0;
    if let [part] = parts[..] {
        return Some(part);
    }
    let place = reader.span(&raw);
    reader.refuse(Diagnostic::error("NB0211", place, format!("expected {what} in these parentheses")).label("here"))
}

/// Parses a word of exactly `digits` hexadecimal digits.
pub(super) fn hexadecimal(word: &str, digits: usize) -> Option<u32> {
    let valid = word.len() == digits && word.bytes().all(|digit| digit.is_ascii_hexdigit());
    u32::from_str_radix(word, 16).ok().filter(|_| valid)
}

/// Wraps the words of a texture with one face and one level.
fn one(format: TextureFormat, width: u32, height: u32, words: Vec<u32>, place: Span) -> SourceTexels {
    SourceTexels { format, width, height, faces: vec![vec![words]], volume: false, palette: None, place }
}

/// Returns whether a face or layer agrees with the first one, after recording a finding if not.
fn alike(reader: &mut Reader<'_>, first: &SourceTexels, face: &SourceTexels, place: Span, what: &str) -> bool {
    let describe = |given: &SourceTexels| {
        let levels = if given.levels() == 1 { String::new() } else { format!(" in {} levels", given.levels()) };
        format!("{} x {} texels {}{levels}", given.width, given.height, given.format.name())
    };
    let (expected, found) = (describe(first), describe(face));
    if face.faces.len() == 1 && expected == found {
        return true;
    }
    let found = if face.faces.len() == 1 { found } else { "a whole cube map or volume".to_owned() };
    let message = format!("this {what} is {found}, the first one {expected}");
    let help = format!("give every {what} the same size, format and number of levels");
    let found = finding("NB0231", place, message, "another picture than the first", help);
    let found = found.related(first.place.clone(), format!("the first {what}"));
    reader.push(found.rule(if what == "face" { "TEX-12" } else { "VOL-1" }));
    false
}

/// Returns the format that pixels are packed into, if they can be.
fn packable(reader: &mut Reader<'_>, request: &Request, place: Span) -> Option<TextureFormat> {
    let format = request.format.unwrap_or(TextureFormat::A8R8G8B8);
    if texels::can_pack(format) {
        return Some(format);
    }
    reader.refuse(cannot_pack(format, place))
}

fn cannot_pack(format: TextureFormat, place: Span) -> Diagnostic {
    let help = if format.depth().is_some() {
        "depths come from `Texels`, `Raw(...)` or `Depth(...)` of a target"
    } else if format == TextureFormat::P8 {
        "indices come from `Texels`, `Raw(...)` or a DDS file"
    } else {
        "blocks come from `Raw(...)` or a DDS file, made by a tool that compresses"
    };
    let message = format!("this source cannot make texels of format {}", format.name());
    finding("NB0232", place, message, "does not go with the format", help)
}
