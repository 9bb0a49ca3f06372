//! Reads texels from files.

use super::*;
use crate::image::{self, Contents, ImageError, ImageLimits};
use ninebit::limits::FileLimit;
use std::path::Path;

/// Reads a picture, or a DDS file with its levels and faces.
pub(super) fn file<'a>(
    reader: &mut Reader<'a>,
    text: &'a str,
    request: &Request,
    source: Span,
) -> Option<SourceTexels> {
    let raw = only::<String>(reader, text, "the name of one file")?;
    let limits = ImageLimits {
        maximum_side: reader.limits.texture_side + texture_levels::beyond(request.border),
        maximum_decoded_bytes: reader.textures.left,
        maximum_file_bytes: reader.limits.image_file_bytes,
    };
    let contents = read_file(reader, &raw, limits.file(), |bytes, path| image::contents(bytes, path, &limits))?;
    let place = reader.span(&raw);
    let dds = match contents {
        Contents::Picture(image) => {
            afford(reader, place.clone(), image.pixels.len() as u64)?;
            let format = packable(reader, request, place)?;
            return Some(one(format, image.width, image.height, texels::pack(&image.pixels, format), source));
        }
        Contents::Texture(dds) => dds,
    };
    afford(reader, place.clone(), dds.words.len() as u64)?;
    let format = request.format.unwrap_or(dds.format);
    let Some(words) = dds.words_as(format) else {
        let message = format!("the file holds {}, not {}", dds.format.name(), format.name());
        let help = format!("leave `format` out, which means {} here", dds.format.name());
        return reader.refuse(finding("NB0232", place, message, "of another format", help));
    };
    let faces = if dds.cube { CUBE_FACES } else { dds.layers.unwrap_or(1) };
    let faces = divide(words, format, [dds.width, dds.height], faces, dds.levels, false);
    let palette = dds.palette.filter(|_| format == TextureFormat::P8);
    let volume = dds.layers.is_some();
    Some(SourceTexels { format, width: dds.width, height: dds.height, faces, volume, palette, place: source })
}

/// Reads a file of texels as they lie in memory.
pub(super) fn memory<'a>(reader: &mut Reader<'a>, text: &'a str, request: &Request) -> Option<SourceTexels> {
    let fields = reader.read(&Raw::<source::RawFile<'a>>::new(text))?;
    let file = fields.file(reader)?;
    let sides = (fields.width(reader), fields.height(reader));
    let (width, height, place) = self::sides(reader, sides, request)?;
    let format = request.format.unwrap_or(TextureFormat::A8R8G8B8);
    let beyond = texture_levels::beyond(request.border);
    let inside = [width.saturating_sub(beyond).max(1), height.saturating_sub(beyond).max(1)];
    let levels = texture_levels::number(reader, request.levels, inside, place.clone())?;
    let (_, face) = Level::chain(format, inside[0], inside[1], levels, request.border);
    let layers = fields.layers(reader).or(request.volume.then_some(1));
    let pictures = layers.unwrap_or(request.faces);
    let words = u64::from(pictures) * face as u64;
    afford(reader, place.clone(), words)?;
    let bytes = read_file(reader, &file, reader.limits.image_file(), |bytes, _| Ok(bytes.to_vec()))?;
    let expected = words * u64::from(format.bytes().min(4));
    if bytes.len() as u64 != expected {
        let message = format!("the file has {} bytes, and the texture takes {expected}", bytes.len());
        let counted = |n: u32, what: &str| ninebit::shown::count(n.into(), what);
        let pictures = counted(pictures, if layers.is_some() { "layer" } else { "face" });
        let (levels, name) = (counted(levels, "level"), format.name());
        let note = format!("{pictures} of {levels} of {width} x {height} texels {name}, one after another");
        let help = "check `width`, `height`, `format`, `kind` and `levels`";
        return reader.refuse(finding("NB0235", reader.span(&file), message, "another length", help).note(note));
    }
    let faces = divide(texels::from_bytes(&bytes, format), format, inside, pictures, levels, request.border);
    Some(SourceTexels { format, width, height, faces, volume: layers.is_some(), palette: None, place })
}

/// Reads the file of a name and decodes it.
pub(in crate::lower) fn read_file<'a, T>(
    reader: &mut Reader<'a>,
    raw: &Raw<'a, String>,
    limit: FileLimit,
    decode: impl FnOnce(&[u8], &Path) -> Result<T, ImageError>,
) -> Option<T> {
    let name = reader.read(raw)?;
    let place = reader.span(raw);
    let assets = reader.assets;
    let path = match assets.resolve(reader.folder, &name) {
        Ok(path) => path,
        Err(error) => return reader.refuse(finding(error.code(), place, error.to_string(), "this file", error.help())),
    };
    let decoded = image::read(assets, &path, limit).and_then(|bytes| decode(&bytes, &path));
    let refused = |error: ImageError| {
        // The message shows the name as the scene has it; where the folder lies does not matter here.
        let message = error.to_string().replace(&ninebit::shown::path(&path), &name);
        reader.push(finding(error.code(), place, message, "this file", error.help()));
    };
    decoded.map_err(refused).ok()
}

/// Splits words into faces and levels.
fn divide(
    mut words: Vec<u32>,
    format: TextureFormat,
    [width, height]: [u32; 2],
    faces: u32,
    levels: u32,
    border: bool,
) -> Vec<Vec<Vec<u32>>> {
    let (chain, face) = Level::chain(format, width, height, levels, border);
    let mut divided: Vec<Vec<Vec<u32>>> = Vec::new();
    for at in (0..faces as usize).rev().map(|n| n * face) {
        let mut levels: Vec<Vec<u32>> = Vec::new();
        for level in chain.iter().rev() {
            levels.push(words.split_off((at + level.offset).min(words.len())));
        }
        levels.reverse();
        divided.push(levels);
    }
    divided.reverse();
    divided
}
