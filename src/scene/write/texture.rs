//! Writes textures, palettes, and the files of large images.

use std::collections::HashMap;

use super::error::Unwritable;
use super::files::{Files, UniqueNames};
use super::node::{Fields, Node};
use ninebit::legality::texture::TextureChecks;
use ninebit::state::*;
use ninebit_files::texels;

/// Largest number of texels, of all faces, layers and levels, that are written as words; others are in a file.
const LISTED_TEXELS: usize = 256;

/// The textures of a scene as it is written, in which equal ones are one.
#[derive(Default)]
pub(super) struct Textures {
    /// For each texture of the state, the name of its entry.
    names: Vec<Option<String>>,
    /// The entries with what they are about.
    entries: Vec<Entry>,
}

struct Entry {
    name: String,
    texture: Texture,
    /// The palette that the first unit reads it with.
    palette: Option<usize>,
}

impl Textures {
    /// Collects those textures that some draw has bound.
    pub(super) fn collect(scene: &Scene, names: &mut UniqueNames) -> Textures {
        let mut palettes: Vec<Option<Option<usize>>> = vec![None; scene.textures.len()];
        for unit in scene.draws.iter().flat_map(|draw| draw.textures.iter().flatten()) {
            if let Some(first) = palettes.get_mut(unit.texture) {
                first.get_or_insert(unit.palette);
            }
        }
        let mut textures = Textures::default();
        let mut alike: HashMap<String, Vec<usize>> = HashMap::new();
        for (texture, palette) in scene.textures.iter().zip(palettes) {
            let Some(palette) = palette else {
                textures.names.push(None);
                continue;
            };
            let candidates = alike.entry(shape(texture)).or_default();
            let equal = candidates.iter().find(|at| same(&textures.entries[**at].texture, texture));
            let at = equal.copied().unwrap_or_else(|| {
                let name = names.unique(&texture.name);
                textures.entries.push(Entry { name, texture: texture.clone(), palette });
                candidates.push(textures.entries.len() - 1);
                textures.entries.len() - 1
            });
            textures.names.push(Some(textures.entries[at].name.clone()));
        }
        textures
    }

    /// Adds the image that a target begins as, its colours or its depths. Returns its name.
    ///
    /// # Errors
    /// The chip has no texture of that size.
    pub(super) fn add_contents(
        &mut self,
        (target, format): (&Target, TextureFormat),
        words: &[u32],
        profile: Profile,
        names: &mut UniqueNames,
    ) -> Result<String, String> {
        let sides = [target.width, target.height];
        let powers = sides.iter().all(|side| side.is_power_of_two());
        let kind = if powers { TextureKind::TwoDimensional } else { TextureKind::Rectangle };
        let checks = TextureChecks { profile, largest_side: u32::MAX };
        if let Some(finding) = checks.format(format, None).or_else(|| checks.sides(kind, format, sides, None)) {
            return Err(format!("the image that it begins as is no texture: {}", finding.message));
        }
        let name = names.unique(&format!("contents of {}", target.name));
        let texture = Texture { kind, ..Texture::from_words(format, sides, words) };
        self.entries.push(Entry { name: name.clone(), texture, palette: None });
        Ok(name)
    }

    /// Returns the name of a texture of the state.
    pub(super) fn name(&self, index: usize) -> Option<&str> {
        self.names.get(index)?.as_deref()
    }

    /// Returns the palette that the entry of a texture of the state has.
    pub(super) fn palette(&self, index: usize) -> Option<usize> {
        let name = self.name(index)?;
        self.entries.iter().find(|entry| entry.name == name)?.palette
    }

    /// Returns the table of textures.
    pub(super) fn table(
        &self,
        scene: &Scene,
        targets: &[String],
        palettes: &Palettes,
        files: &mut Files,
    ) -> Result<Fields, Unwritable> {
        let mut table = Fields::table();
        for Entry { name, texture, palette } in &self.entries {
            let reason = |reason: String| Unwritable { place: format!("texture `{name}`"), reason };
            let mut fields = match &texture.image {
                TextureImage::Texels(texels) => of_texels(name, texture, texels, files).map_err(reason)?,
                TextureImage::Target { target } | TextureImage::Depth { target } => {
                    let missing = || reason(format!("it shows target {target} of {}", targets.len()));
                    let shown = targets.get(*target).ok_or_else(missing)?;
                    of_target(texture, scene.targets.get(*target).ok_or_else(missing)?, shown)
                }
            };
            if let Some(palette) = palette.filter(|_| texture.format == TextureFormat::P8) {
                fields.put("palette", Node::text(palettes.name(palette).map_err(reason)?));
            }
            table.entry(name, fields);
        }
        Ok(table)
    }
}

/// Describes a texture except for its words.
fn shape(texture: &Texture) -> String {
    let image = match &texture.image {
        TextureImage::Texels(Texels { width, height, levels, layers, border, words }) => {
            format!("{width} {height} {levels} {layers} {border} {}", words.len())
        }
        image => format!("{image:?}"),
    };
    format!("{:?} {:?} {image}", texture.kind, texture.format)
}

/// Returns whether two textures of one shape have the same words.
fn same(one: &Texture, other: &Texture) -> bool {
    match (&one.image, &other.image) {
        (TextureImage::Texels(one), TextureImage::Texels(other)) => one.words == other.words,
        _ => true,
    }
}

/// Returns the fields of a texture that shows a target called `shown`, or its depths.
fn of_target(texture: &Texture, target: &Target, shown: &str) -> Fields {
    let mut fields = Fields::new("");
    fields.word("kind", texture.kind, TextureKind::TwoDimensional);
    let depths = matches!(texture.image, TextureImage::Depth { .. });
    let own = if depths {
        let format = target.depth.map(|depth| depth.format);
        TextureFormat::ALL.iter().copied().find(|own| format.is_some() && own.depth() == format)
    } else {
        Some(target.format.texture_format())
    };
    if own != Some(texture.format) {
        fields.put("format", Node::word(texture.format.name()));
    }
    fields.put("source", Node::call(if depths { "Depth" } else { "Target" }, [Node::text(shown)]));
    fields
}

fn of_texels(name: &str, texture: &Texture, image: &Texels, files: &mut Files) -> Result<Fields, String> {
    let Texels { width, height, levels, layers, border, ref words } = *image;
    let Texture { kind, format, .. } = *texture;
    let volume = kind == TextureKind::ThreeDimensional;
    let pictures = if kind == TextureKind::Cube { CUBE_FACES as usize } else { layers as usize };
    let (chain, picture) = Level::chain(format, width, height, levels.clamp(1, 32), border);
    if picture.checked_mul(pictures) != Some(words.len()) || !(1..=32).contains(&levels) {
        return Err(format!("it has {} words in {levels} levels of {width} x {height}", words.len()));
    }
    let beyond = if border { 2 * BORDER_TEXELS } else { 0 };
    let mut fields = Fields::new("");
    if !matches!(kind, TextureKind::TwoDimensional) {
        fields.put("kind", Node::word(kind.name()));
    }
    fields.word("format", format, TextureFormat::A8R8G8B8);
    if words.len() > LISTED_TEXELS || format.is_compressed() {
        let file = files.add("textures", name, texels::to_bytes(words, format));
        let mut source = Fields::new("Raw");
        source.put("file", Node::text(&file));
        source.put("width", Node::whole(width + beyond));
        source.put("height", Node::whole(height + beyond));
        if volume {
            source.put("layers", Node::whole(layers));
        }
        fields.put("source", source);
        fields.whole("levels", levels, 1);
    } else {
        let mut sources = chain.iter().map(|level| {
            let picture = |n: usize| rows(&words[n * picture + level.offset..], format, level, beyond);
            match kind {
                TextureKind::Cube => faces(picture),
                _ if volume => Node::call("Layers", [Node::list((0..pictures).map(picture))]),
                _ => picture(0),
            }
        });
        fields.put("source", sources.next().unwrap_or_else(|| Node::word("None")));
        let smaller: Vec<Node> = sources.collect();
        if !smaller.is_empty() {
            fields.put("mips", Node::list(smaller));
        }
    }
    fields.flag("border", border, false);
    Ok(fields)
}

fn faces(picture: impl Fn(usize) -> Node) -> Node {
    let names = ["positive_x", "negative_x", "positive_y", "negative_y", "positive_z", "negative_z"];
    let mut fields = Fields::new("Faces");
    for (n, name) in names.into_iter().enumerate() {
        fields.put(name, picture(n));
    }
    fields.into()
}

/// Returns the rows of a level, whose words come first, as hexadecimal words.
fn rows(words: &[u32], format: TextureFormat, level: &Level, beyond: u32) -> Node {
    let [width, height] = [level.width + beyond, level.height + beyond];
    let digits = format.word_bits() as usize / 4;
    let row = |row: &[u32]| {
        let words: Vec<String> =
            row.iter().map(|word| format!("{:0digits$x}", texels::in_memory(*word, format))).collect();
        Node::text(&words.join(" "))
    };
    let mut fields = Fields::new("Texels");
    fields.put("width", Node::whole(width));
    fields.put("height", Node::whole(height));
    fields.put("rows", Node::list(words.chunks(width as usize).take(height as usize).map(row)));
    fields.into()
}

/// The palettes that units read.
pub(super) struct Palettes {
    /// For each palette of the state, its name, if some unit reads it.
    names: Vec<Option<String>>,
}

impl Palettes {
    pub(super) fn collect(scene: &Scene, names: &mut UniqueNames) -> Palettes {
        let mut read = vec![false; scene.palettes.len()];
        for unit in scene.draws.iter().flat_map(|draw| draw.textures.iter().flatten()) {
            if let Some(flag) = unit.palette.and_then(|palette| read.get_mut(palette)) {
                *flag = true;
            }
        }
        let named = scene.palettes.iter().zip(read);
        Palettes { names: named.map(|(palette, read)| read.then(|| names.unique(&palette.name))).collect() }
    }

    pub(super) fn name(&self, index: usize) -> Result<&str, String> {
        let name = self.names.get(index).and_then(Option::as_deref);
        name.ok_or_else(|| format!("it reads palette {index} of {}", self.names.len()))
    }

    /// Returns the table of palettes: eight words in each text.
    pub(super) fn table(&self, scene: &Scene) -> Fields {
        let mut table = Fields::table();
        for (palette, name) in scene.palettes.iter().zip(&self.names) {
            let Some(name) = name else { continue };
            let row = |words: &[u32]| {
                let words: Vec<String> = words.iter().map(|word| format!("{word:08x}")).collect();
                Node::text(&words.join(" "))
            };
            // Nv10 has one length; of others, which mask an index, it reads the entries again and again.
            let count = if scene.profile == Profile::Nv10 { 256 } else { palette.entries.len() };
            let entries: Vec<u32> = palette.entries.iter().copied().cycle().take(count).collect();
            table.entry(name, Node::list(entries.chunks(8).map(row)));
        }
        table
    }
}
