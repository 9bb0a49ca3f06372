//! Opens the texture that the command line names: a file, or a texture of a scene.

use std::path::Path;
use std::sync::Arc;

use ninebit::engine::{self, RenderOptions};
use ninebit::plan::texture_size;
use ninebit::rop::surface;
use ninebit::shown;
use ninebit::state::{CUBE_FACES, Named, Profile, Scene, Texels, TextureFormat, TextureImage, TextureKind};
use ninebit_files::texels;
use ninebit_scene::image::{self, Contents, ImageLimits};

use super::{Arguments, Context, Failure};
use crate::commands::scene::{StateArguments, load, load_to_draw};

/// A texture and how it is read.
pub(super) struct TextureSource {
    /// Name, as given on the command line.
    pub(super) name: String,
    pub(super) kind: TextureKind,
    pub(super) format: TextureFormat,
    pub(super) texels: Texels,
    /// Palette entries of P8; empty without a palette.
    pub(super) palette: Arc<[u32]>,
    /// Whether DXT1 is dithered.
    pub(super) dithered: bool,
    /// Name of the render target, if the texture reads one.
    pub(super) target: Option<String>,
}

impl TextureSource {
    /// Returns the number of faces of a cube map, or of layers otherwise.
    pub(super) fn faces(&self) -> u32 {
        if self.kind == TextureKind::Cube { CUBE_FACES } else { self.texels.layers }
    }
}

/// Reads the texture.
pub(super) fn open(arguments: &Arguments, context: Context) -> Result<TextureSource, Failure> {
    let name = shown::lossless(Path::new(&arguments.texture));
    if let Some(end) = name.find(".ron:") {
        return of_scene(arguments, name, end + ".ron".len(), context);
    }
    let path = Path::new(&arguments.texture);
    if path.extension().is_some_and(|extension| extension == "ron") {
        let (scene, _) = load(path, &StateArguments::default(), context)?;
        return Err(Failure::usage(format!("which texture of `{name}`?"), advice(&scene, &name)));
    }
    of_file(arguments, path, name.clone())
}

/// Returns advice on how to name the textures of a scene.
fn advice(scene: &Scene, file: &str) -> String {
    let names: Vec<String> = scene.textures.iter().map(|texture| format!("`{file}:{}`", texture.name)).collect();
    if names.is_empty() { "it has none".to_owned() } else { format!("write {}", names.join(" or ")) }
}

fn of_file(arguments: &Arguments, path: &Path, name: String) -> Result<TextureSource, Failure> {
    if arguments.palette.is_some() {
        return Err(Failure::usage("`--palette` names a palette of a scene", "name a texture as SCENE.ron:NAME"));
    }
    let dithered = arguments.profile != Some(Profile::Nv10);
    let (kind, format, texels, palette) = match image::open(path, &ImageLimits::default())? {
        Contents::Picture(picture) => {
            let format = arguments.format.unwrap_or(TextureFormat::A8R8G8B8);
            if !texels::can_pack(format) {
                let message = format!("a picture cannot be packed into {}", format.name());
                return Err(Failure::usage(message, "blocks and indices come from DDS files; choose another format"));
            }
            let (width, height) = (picture.width(), picture.height());
            let words = texels::pack(picture.pixels(), format).into();
            let texels = Texels { width, height, levels: 1, layers: 1, border: false, words };
            (plain_kind(width, height), format, texels, None)
        }
        Contents::Texture(dds) => {
            let format = arguments.format.unwrap_or(dds.format);
            let Some(words) = dds.words_as(format) else {
                let message = format!("`{name}` holds {}, not {}", dds.format.name(), format.name());
                return Err(Failure::usage(message, "leave out `--format`"));
            };
            let kind = match dds.layers {
                Some(_) => TextureKind::ThreeDimensional,
                None if dds.cube => TextureKind::Cube,
                None => plain_kind(dds.width, dds.height),
            };
            let (width, height, levels, layers) = (dds.width, dds.height, dds.levels, dds.layers.unwrap_or(1));
            let texels = Texels { width, height, levels, layers, border: false, words: words.into() };
            (kind, format, texels, dds.palette.filter(|_| format == TextureFormat::P8))
        }
    };
    let palette = palette.unwrap_or_default().into();
    Ok(TextureSource { name, kind, format, texels, palette, dithered, target: None })
}

/// Returns the kind of a 2D texture: a rectangle unless both sides are powers of two.
fn plain_kind(width: u32, height: u32) -> TextureKind {
    let powers = width.is_power_of_two() && height.is_power_of_two();
    if powers { TextureKind::TwoDimensional } else { TextureKind::Rectangle }
}

/// Opens a texture of a scene. `end` is the position of the colon in `name`.
fn of_scene(arguments: &Arguments, name: String, end: usize, context: Context) -> Result<TextureSource, Failure> {
    let (path, texture) = (Path::new(&name[..end]), &name[end + 1..]);
    if arguments.profile.is_some() || arguments.format.is_some() {
        let help = "leave out `--profile` and `--format`";
        return Err(Failure::usage("a scene says itself what its profile and formats are", help));
    }
    let (scene, plan) = load_to_draw(path, &StateArguments::default(), arguments.work, context)?;
    let Some(index) = scene.textures.iter().position(|known| known.name == texture) else {
        let message = format!("the scene has no texture `{texture}`");
        return Err(Failure::usage(message, advice(&scene, &shown::path(path))));
    };
    let texture = &scene.textures[index];
    let (texels, target) = match &texture.image {
        TextureImage::Texels(texels) => (texels.clone(), None),
        TextureImage::Target { target } | TextureImage::Depth { target } => {
            let mut frames = engine::render(&plan, &RenderOptions { threads: 0, ..RenderOptions::default() });
            let surface = frames.surfaces.swap_remove(*target);
            let (width, height) = texture_size(&scene, index);
            let depths = matches!(texture.image, TextureImage::Depth { .. });
            let words = if depths {
                surface.depth.into()
            } else {
                surface::texels(&surface.words, surface.format.bytes(), texture.format.bytes()).into()
            };
            let name = scene.targets[*target].name.clone();
            (Texels { width, height, levels: 1, layers: 1, border: false, words }, Some(name))
        }
    };
    Ok(TextureSource {
        name,
        kind: texture.kind,
        format: texture.format,
        texels,
        palette: palette(arguments, &scene, index)?,
        dithered: scene.profile == Profile::Nv2a,
        target,
    })
}

/// Returns the named palette, or that of the first unit that samples the texture; empty if there is none.
fn palette(arguments: &Arguments, scene: &Scene, texture: usize) -> Result<Arc<[u32]>, Failure> {
    let index = match &arguments.palette {
        Some(_) if scene.textures[texture].format != TextureFormat::P8 => {
            let message = format!("a texture of format {} reads no palette", scene.textures[texture].format.name());
            return Err(Failure::usage(message, "leave out `--palette`"));
        }
        Some(name) => {
            let found = scene.palettes.iter().position(|palette| palette.name == *name);
            Some(found.ok_or_else(|| {
                let names: Vec<String> = scene.palettes.iter().map(|palette| format!("`{}`", palette.name)).collect();
                let known = format!("its palettes: {}", names.join(", "));
                let help = if names.is_empty() { "it has none" } else { &known };
                Failure::usage(format!("the scene has no palette `{name}`"), help)
            })?)
        }
        None => {
            let mut units = scene.draws.iter().flat_map(|draw| draw.textures.iter().flatten());
            units.find(|unit| unit.texture == texture).and_then(|unit| unit.palette)
        }
    };
    let palette = index.and_then(|index| scene.palettes.get(index));
    Ok(palette.map_or_else(|| Arc::from([]), |palette| palette.entries.clone()))
}
