//! Textures: where their texels come from.

use std::collections::HashMap;

use super::names::Names;
use super::target::Targets;
use super::*;
use crate::scene::image::{self, ImageLimits};
use crate::scene::path;
use crate::scene::reader::Entry;
use crate::state::Named;
use crate::state::{Texels, Texture, TextureFormat, TextureImage, TextureKind};

const SOURCES: &[&str] = &["File", "Texels", "Solid", "Checker", "Ramp", "Target"];

/// The textures, and where they were named. A texture with errors keeps its name but has no index.
pub(super) struct Textures {
    pub(super) list: Vec<Texture>,
    by_name: HashMap<String, Option<usize>>,
    names: Vec<(String, Range<usize>)>,
    used: Vec<bool>,
}

impl Textures {
    /// The texture of that name; `None` once the reason has been recorded.
    pub(super) fn find<'a>(&mut self, reader: &mut Reader<'a>, raw: &Raw<'a, String>) -> Option<usize> {
        let name = reader.read(raw)?;
        if let Some(index) = self.by_name.get(&name) {
            if let Some(used) = self.names.iter().position(|(known, _)| *known == name) {
                self.used[used] = true;
            }
            return *index;
        }
        let place = reader.span(raw);
        let known = self.names.iter().map(|(name, _)| name.as_str());
        unknown_name(reader, place, "texture", &name, known, "define it in `textures: { \"...\": (source: ...) }`");
        None
    }

    pub(super) fn warn_unused(&self, reader: &mut Reader<'_>) {
        for ((name, place), used) in self.names.iter().zip(&self.used) {
            if !used {
                reader.push(super::names::unused("texture", name, place.clone()));
            }
        }
    }
}

/// Reads every texture, files included.
pub(super) fn textures<'a>(
    reader: &mut Reader<'a>,
    names: &Names<'a>,
    targets: &Targets,
    raw: &Option<Raw<'a, crate::scene::raw::Entries<'a, source::Texture<'a>>>>,
    folder: &Path,
) -> Textures {
    let mut textures = Textures { list: Vec::new(), by_name: HashMap::new(), names: Vec::new(), used: Vec::new() };
    let entries = reader.table("texture", raw);
    if let Some(raw) = raw
        && entries.len() > reader.limits.textures
    {
        let message = format!("{} textures are more than {}", entries.len(), reader.limits.textures);
        let place = reader.span(raw);
        reader.push(
            Diagnostic::error("NB0605", place, message)
                .label("too many")
                .help("`ninebit limits` prints what is allowed"),
        );
        return textures;
    }
    let mut left = reader.limits.texture_bytes;
    for entry in entries {
        let image = texture(reader, names, targets, &entry, folder, &mut left);
        let index = image.map(|(format, image)| {
            let kind = TextureKind::TwoDimensional;
            textures.list.push(Texture { name: entry.name.clone(), kind, format, image });
            textures.list.len() - 1
        });
        textures.by_name.insert(entry.name.clone(), index);
        textures.names.push((entry.name, entry.place));
        textures.used.push(false);
    }
    textures
}

/// The colour at a column and row.
type PixelAt = Box<dyn Fn(u32, u32) -> [u8; 4]>;

/// Pixels before they are packed.
struct Pixels {
    width: u32,
    height: u32,
    pixels: Vec<[u8; 4]>,
}

fn texture<'a>(
    reader: &mut Reader<'a>,
    names: &Names<'a>,
    targets: &Targets,
    entry: &Entry<'a, source::Texture<'a>>,
    folder: &Path,
    left: &mut u64,
) -> Option<(TextureFormat, TextureImage)> {
    let opening = reader.range(entry.value.text.get(..1).unwrap_or(entry.value.text));
    let fields = reader.read(&entry.value)?;
    if let Some(raw) = &fields.kind {
        let (kind, _) =
            reader.variant(raw, "texture kind", &["TwoDimensional", "Cube", "Rectangle", "ThreeDimensional"])?;
        if kind > 0 {
            reader.not_built(reader.span(raw), ["", "cube maps", "rectangle textures", "volume textures"][kind]);
        }
    }
    reader.reserve(&fields.levels, "mipmap levels");
    reader.reserve(&fields.palette, "palettes");
    reader.reserve(&fields.border, "texture border texels");
    let format = match &fields.format {
        Some(raw) => {
            let format = reader.name(raw)?;
            if format.is_nv2a_only() && reader.profile == Profile::Nv10 {
                let what = format!("texture format {}", format.name());
                reader.push(target::only_nv2a("NB0320", reader.span(raw), &what, "TEX-1"));
            }
            if format == TextureFormat::P8 || format.is_compressed() {
                reader.not_built(reader.span(raw), "palettes and compressed textures");
            }
            Some((format, reader.span(raw)))
        }
        None => None,
    };
    let source = reader.required(&fields.source, "source", "texture", opening)?;
    let (kind, rest) = reader.variant(&source, "texture source", SOURCES)?;
    let words_as = format.as_ref().map_or(TextureFormat::A8R8G8B8, |(format, _)| *format);
    let (width, height, words) = match SOURCES[kind] {
        "Target" => return of_target(reader, targets, rest, format),
        "Texels" => texels(reader, rest, words_as, left)?,
        "File" => {
            let Pixels { width, height, pixels } = file(reader, rest, folder, left)?;
            check_sides(reader, reader.span(&source), width, height)?;
            (width, height, pack(&pixels, words_as))
        }
        kind => {
            let Pixels { width, height, pixels } = procedural(reader, names, rest, kind, left)?;
            (width, height, pack(&pixels, words_as))
        }
    };
    let texels = Texels { width, height, levels: 1, border: false, words: words.into() };
    Some((words_as, TextureImage::Texels(texels)))
}

/// The only value in the parentheses of `Variant(value)`.
fn only<'a, T>(reader: &mut Reader<'a>, text: &'a str, what: &str) -> Option<Raw<'a, T>> {
    let raw = Raw::<crate::scene::raw::Tuple<'a, T>>::new(text);
    let parts = reader.read(&raw)?.0;
    if let [part] = parts[..] {
        return Some(part);
    }
    let place = reader.span(&raw);
    reader.push(Diagnostic::error("NB0211", place, format!("expected {what} in these parentheses")).label("here"));
    None
}

fn of_target<'a>(
    reader: &mut Reader<'a>,
    targets: &Targets,
    text: &'a str,
    format: Option<(TextureFormat, Range<usize>)>,
) -> Option<(TextureFormat, TextureImage)> {
    let raw = only::<String>(reader, text, "the name of one target")?;
    let index = targets.find(reader, &raw)?;
    let target = &targets.list[index];
    let own = target.format.texture_format();
    let format = match format {
        Some((format, place)) if format.bytes() != target.format.bytes() => {
            let (texel, pixel) = (format.bytes(), target.format.bytes());
            reader.push(
                Diagnostic::error("NB0218", place, format!("a texel of {texel} bytes cannot show a pixel of {pixel}"))
                    .label("another size")
                    .help(format!("leave `format` out, which means {own:?} here, or take one of {pixel} bytes")),
            );
            return None;
        }
        Some((format, _)) => format,
        None => own,
    };
    check_sides(reader, reader.span(&raw), target.width, target.height)?;
    Some((format, TextureImage::Target { target: index }))
}

/// Sides are powers of two, within what the chip and the limits allow.
fn check_sides(reader: &mut Reader<'_>, place: Range<usize>, width: u32, height: u32) -> Option<()> {
    let most = most_texels(reader);
    if width.max(height) > most {
        let on = if most < 4096 { "; profile Nv2a allows 4096" } else { "" };
        reader.push(
            Diagnostic::error("NB0321", place, format!("a texture of {width} x {height} is too large"))
                .label(format!("a side has at most {most} texels on {:?}", reader.profile))
                .help(format!("scale it down{on}")),
        );
        return None;
    }
    if !(width.is_power_of_two() && height.is_power_of_two()) {
        let next = |side: u32| side.max(1).checked_next_power_of_two().unwrap_or(most).min(most);
        reader.push(
            Diagnostic::error("NB0219", place, format!("a texture cannot be {width} x {height}"))
                .label("sides must be powers of two")
                .rule("TEX-7")
                .help(format!("make it {} x {}, for example", next(width), next(height))),
        );
        return None;
    }
    Some(())
}

fn most_texels(reader: &Reader<'_>) -> u32 {
    let chip = if reader.profile == Profile::Nv10 { 2048 } else { 4096 };
    reader.limits.texture_side.min(chip)
}

/// Takes the memory of a texture off what is left.
fn afford(reader: &mut Reader<'_>, place: Range<usize>, width: u32, height: u32, left: &mut u64) -> Option<()> {
    let bytes = 4 * u64::from(width) * u64::from(height);
    let Some(rest) = left.checked_sub(bytes) else {
        let message = format!("the textures take more than {} bytes together", reader.limits.texture_bytes);
        reader.push(
            Diagnostic::error("NB0607", place, message)
                .label(format!("{bytes} more bytes here"))
                .help("make the textures smaller, or fewer; `ninebit limits` prints what is allowed"),
        );
        return None;
    };
    *left = rest;
    Some(())
}

fn file<'a>(reader: &mut Reader<'a>, text: &'a str, folder: &Path, left: &mut u64) -> Option<Pixels> {
    let raw = only::<String>(reader, text, "the name of one file")?;
    let name = reader.read(&raw)?;
    let place = reader.span(&raw);
    let path = match path::resolve(folder, &name) {
        Ok(path) => path,
        Err(error) => {
            reader
                .push(Diagnostic::error(error.code(), place, error.to_string()).label("this file").help(error.help()));
            return None;
        }
    };
    let limits = ImageLimits {
        maximum_side: reader.limits.texture_side,
        maximum_decoded_bytes: (*left).min(64 << 20),
        maximum_file_bytes: reader.limits.image_file_bytes,
    };
    match image::load(&path, &limits) {
        Ok(image) => {
            afford(reader, place, image.width, image.height, left)?;
            Some(Pixels { width: image.width, height: image.height, pixels: image.pixels })
        }
        Err(error) => {
            // The name as the scene has it: where the folder lies does not matter here.
            let message = error.to_string().replace(&path.display().to_string(), &name);
            reader.push(Diagnostic::error(error.code(), place, message).label("this file").help(error.help()));
            None
        }
    }
}

fn sides<'a>(
    reader: &mut Reader<'a>,
    text: &'a str,
    width: &Option<Raw<'a, u32>>,
    height: &Option<Raw<'a, u32>>,
    left: &mut u64,
) -> Option<(u32, u32)> {
    let opening = reader.range(text.get(..1).unwrap_or(text));
    let width = reader.required(width, "width", "texture", opening.clone());
    let height = reader.required(height, "height", "texture", opening);
    let (width, height) = (width?, height?);
    let place = reader.span(&width).start..reader.span(&height).end.max(reader.span(&width).end);
    let (width, height) = (reader.read(&width)?, reader.read(&height)?);
    check_sides(reader, place.clone(), width, height)?;
    afford(reader, place, width, height, left)?;
    Some((width, height))
}

/// Raw words in hexadecimal, a text for each row.
fn texels<'a>(
    reader: &mut Reader<'a>,
    text: &'a str,
    format: TextureFormat,
    left: &mut u64,
) -> Option<(u32, u32, Vec<u32>)> {
    let raw = Raw::<source::TexelRows<'a>>::new(text);
    let fields = reader.read(&raw)?;
    let (width, height) = sides(reader, text, &fields.width, &fields.height, left)?;
    let opening = reader.range(text.get(..1).unwrap_or(text));
    let list = reader.required(&fields.rows, "rows", "texture", opening)?;
    let rows = reader.read(&list)?;
    let digits = 2 * format.bytes() as usize;
    let help = format!("write {width} words of {digits} hexadecimal digits in each of {height} rows, for {format:?}");
    if rows.len() != height as usize {
        let message = format!("{} rows of texels for a height of {height}", rows.len());
        let place = reader.span(&list);
        reader.push(Diagnostic::error("NB0220", place, message).label("another number of rows").help(help));
        return None;
    }
    let mut words = Vec::with_capacity(width as usize * height as usize);
    for raw in &rows {
        let row = reader.read(raw)?;
        let mut count = 0;
        for word in row.split_ascii_whitespace() {
            let valid = word.len() == digits && word.bytes().all(|digit| digit.is_ascii_hexdigit());
            let Some(value) = u32::from_str_radix(word, 16).ok().filter(|_| valid) else {
                let place = reader.span(raw);
                let message = format!("`{}` is not a texel", shorten(word));
                reader.push(Diagnostic::error("NB0220", place, message).label("in this row").help(help));
                return None;
            };
            // Bits that the format ignores are zero in the state.
            words.push(match format {
                TextureFormat::X8R8G8B8 => value & 0x00ff_ffff,
                TextureFormat::X1R5G5B5 => value & 0x7fff,
                _ => value,
            });
            count += 1;
        }
        if count != width as usize {
            let place = reader.span(raw);
            let message = format!("{count} texels in a row of {width}");
            reader.push(Diagnostic::error("NB0220", place, message).label("in this row").help(help));
            return None;
        }
    }
    Some((width, height, words))
}

fn procedural<'a>(
    reader: &mut Reader<'a>,
    names: &Names<'a>,
    text: &'a str,
    kind: &str,
    left: &mut u64,
) -> Option<Pixels> {
    let opening = reader.range(text.get(..1).unwrap_or(text));
    let color = |reader: &mut Reader<'a>, field: &Option<Raw<'a, source::Color>>, name: &str| {
        let raw = reader.required(field, name, "texture", opening.clone())?;
        color::constant(reader, names, &raw)
    };
    let (width, height, pixel): (u32, u32, PixelAt) = match kind {
        "Solid" => {
            let fields = reader.read(&Raw::<source::SolidImage<'a>>::new(text))?;
            let (width, height) = sides(reader, text, &fields.width, &fields.height, left)?;
            let color = color(reader, &fields.color, "color")?;
            (width, height, Box::new(move |_, _| color))
        }
        "Checker" => {
            let fields = reader.read(&Raw::<source::CheckerImage<'a>>::new(text))?;
            let (width, height) = sides(reader, text, &fields.width, &fields.height, left)?;
            let cell = match &fields.cell {
                Some(raw) => reader.whole(raw, "the side of a cell", 1..=4096)?,
                None => 1,
            };
            let [first, second] = match &fields.colors {
                Some(raw) => color::constants(reader, names, raw),
                None => [[255; 4], [0, 0, 0, 255]],
            };
            (width, height, Box::new(move |x, y| if (x / cell + y / cell) % 2 == 0 { first } else { second }))
        }
        _ => {
            let fields = reader.read(&Raw::<source::RampImage<'a>>::new(text))?;
            let (width, height) = sides(reader, text, &fields.width, &fields.height, left)?;
            let (from, to) = (color(reader, &fields.from, "from"), color(reader, &fields.to, "to"));
            let vertical = match &fields.axis {
                Some(raw) => reader.variant(raw, "axis", &["Horizontal", "Vertical"])?.0 == 1,
                None => false,
            };
            let (from, to, last) = (from?, to?, if vertical { height - 1 } else { width - 1 });
            let mix = move |a: u8, b: u8, at: u32| match last {
                0 => a,
                last => ((u32::from(a) * (last - at) + u32::from(b) * at + last / 2) / last) as u8,
            };
            let pixel = move |x: u32, y: u32| {
                let at = if vertical { y } else { x };
                [0, 1, 2, 3].map(|channel| mix(from[channel], to[channel], at))
            };
            (width, height, Box::new(pixel))
        }
    };
    let mut pixels = Vec::with_capacity(width as usize * height as usize);
    for y in 0..height {
        pixels.extend((0..width).map(|x| pixel(x, y)));
    }
    Some(Pixels { width, height, pixels })
}

/// Eight bits a channel into words: low bits that do not fit are cut off, channels that the format lacks are dropped.
fn pack(pixels: &[[u8; 4]], format: TextureFormat) -> Vec<u32> {
    let word = |&[r, g, b, a]: &[u8; 4]| {
        let [r, g, b, a] = [r, g, b, a].map(u32::from);
        match format {
            TextureFormat::A8R8G8B8 => a << 24 | r << 16 | g << 8 | b,
            TextureFormat::X8R8G8B8 => r << 16 | g << 8 | b,
            TextureFormat::R5G6B5 => (r >> 3) << 11 | (g >> 2) << 5 | b >> 3,
            TextureFormat::X1R5G5B5 => (r >> 3) << 10 | (g >> 3) << 5 | b >> 3,
            TextureFormat::A1R5G5B5 => (a >> 7) << 15 | (r >> 3) << 10 | (g >> 3) << 5 | b >> 3,
            TextureFormat::A8B8G8R8 => a << 24 | b << 16 | g << 8 | r,
            TextureFormat::B8G8R8A8 => b << 24 | g << 16 | r << 8 | a,
            TextureFormat::R8G8B8A8 => r << 24 | g << 16 | b << 8 | a,
            TextureFormat::R6G5B5 => (r >> 2) << 10 | (g >> 3) << 5 | b >> 3,
            TextureFormat::A4R4G4B4 => (a >> 4) << 12 | (r >> 4) << 8 | (g >> 4) << 4 | b >> 4,
            TextureFormat::L8 | TextureFormat::I8 => r,
            TextureFormat::A8 => a,
            TextureFormat::A8L8 => a << 8 | r,
            TextureFormat::G8B8 | TextureFormat::Y16 => g << 8 | b,
            TextureFormat::R8B8 => r << 8 | b,
            TextureFormat::R16B16 => a << 24 | r << 16 | g << 8 | b,
            // Refused before it comes to this.
            TextureFormat::P8 | TextureFormat::Dxt1 | TextureFormat::Dxt3 | TextureFormat::Dxt5 => 0,
        }
    };
    pixels.iter().map(word).collect()
}
