//! The command `ninebit texture`: a texture's levels and faces as pictures.

mod layout;
mod source;

use super::*;

use ninebit::state::{BORDER_TEXELS, CUBE_FACES, Level, TextureFormat, TextureKind};
use ninebit_scene::dds::FACES;

use source::TextureSource;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// A PNG, TGA or DDS file; or a texture of a scene, SCENE.ron:NAME
    #[arg(value_name = "FILE|SCENE.ron:NAME")]
    texture: OsString,
    /// Write what a texture unit reads of each texel, R, G, B, A, as a picture
    #[arg(long, requires = "output")]
    decode: bool,
    /// The picture, a PNG; `-` is stdout
    #[arg(short, long, value_name = "OUT.png", requires = "decode", value_parser = picture::output("png"))]
    output: Option<Destination>,
    /// This level only [default: all, level 0 on the left]
    #[arg(long, value_name = "N", requires = "decode")]
    level: Option<u32>,
    /// This face of a cube map only: +X, -X, +Y, -Y, +Z or -Z [default: all, as a cross]
    #[arg(long, value_name = "FACE", requires = "decode", allow_hyphen_values = true, value_parser = face)]
    face: Option<u32>,
    /// This layer of a volume only [default: all, in rows]
    #[arg(long, value_name = "N", requires = "decode", conflicts_with = "face")]
    layer: Option<u32>,
    /// Which chip reads a file, Nv10 or Nv2a: they differ in DXT1. A scene says so itself [default: Nv2a]
    #[arg(long, value_name = "PROFILE", value_parser = named::<Profile>)]
    profile: Option<Profile>,
    /// The texture format of a file [default: that of the DDS file, else A8R8G8B8]
    #[arg(long, value_name = "FORMAT", value_parser = named::<TextureFormat>)]
    format: Option<TextureFormat>,
    #[command(flatten)]
    work: WorkArguments,
    /// The palette of a P8 texture of a scene [default: that of the first unit that samples it]
    #[arg(long, value_name = "NAME")]
    palette: Option<String>,
}

/// Describes or decodes a texture.
pub(crate) fn run(arguments: &Arguments, context: Context) -> Result<(), Failure> {
    let opened = source::open(arguments, context)?;
    let Some(destination) = &arguments.output else {
        return Ok(write_text(&describe(&opened))?);
    };
    if opened.format == TextureFormat::P8 && opened.palette.is_empty() {
        let message = format!("`{}` is of format P8, and no draw gives it a palette", opened.name);
        return Err(Failure::invalid("NB0234", message, "name one of the scene's palettes with `--palette`"));
    }
    let texels = &opened.texels;
    let levels = match arguments.level {
        None => 0..texels.levels,
        Some(level) if level < texels.levels => level..level + 1,
        Some(level) => {
            let last = texels.levels - 1;
            let has = if last == 0 { "it has level 0 only".to_owned() } else { format!("its levels are 0 to {last}") };
            return Err(Failure::usage(format!("the texture has no level {level}"), has));
        }
    };
    let volume = opened.kind == TextureKind::ThreeDimensional;
    let faces = match (arguments.face, arguments.layer) {
        (None, None) => 0..opened.faces(),
        (_, Some(layer)) if volume && layer < texels.layers => layer..layer + 1,
        (_, Some(layer)) if volume => {
            let last = texels.layers - 1;
            let message = format!("the texture has no layer {layer}");
            return Err(Failure::usage(message, format!("its layers are 0 to {last}")));
        }
        (_, Some(_)) => {
            return Err(Failure::usage("the texture has no layers: it is no volume", "leave out `--layer`"));
        }
        (Some(face), _) if opened.kind == TextureKind::Cube => face..face + 1,
        (Some(_), _) => {
            return Err(Failure::usage("the texture has no faces: it is no cube map", "leave out `--face`"));
        }
    };
    let picture = layout::picture(&opened, faces, levels);
    Ok(destination.write(&encode_png(picture.width(), picture.height(), picture.pixels(), Compression::Small)?)?)
}

/// Describes the texture without its texels.
fn describe(opened: &TextureSource) -> String {
    let (texels, format) = (&opened.texels, opened.format);
    let (chain, words) = Level::chain(format, texels.width, texels.height, texels.levels, texels.border);
    let sides: Vec<String> = chain.iter().map(|level| format!("{} x {}", level.width, level.height)).collect();
    let unit = if format.is_compressed() { "block of 4 x 4 texels" } else { "texel" };
    let bytes = opened.faces() as usize * words * format.bytes().min(4) as usize;
    let mut text = format!("{}\n", shown::name(&opened.name));
    let mut line = |name: &str, value: String| text.push_str(&format!("  {name:<9}{value}\n"));
    line("kind", opened.kind.name().to_owned());
    line("format", format!("{}, {} a {unit}", format.name(), shown::count(format.bytes().into(), "byte")));
    if opened.kind == TextureKind::Cube {
        line("faces", format!("{CUBE_FACES}: {}", FACES.join(", ")));
    }
    if opened.kind == TextureKind::ThreeDimensional {
        line("layers", texels.layers.to_string());
    }
    line("levels", format!("{}: {}", texels.levels, sides.join(", ")));
    if texels.border {
        line("border", format!("{BORDER_TEXELS} texels beyond each edge of each level"));
    }
    if !opened.palette.is_empty() {
        line("palette", format!("{} entries", opened.palette.len()));
    }
    if let Some(target) = &opened.target {
        let what = if format.depth().is_some() { "depths of render target" } else { "render target" };
        line("contents", format!("{what} `{}` after the last draw", shown::name(target)));
    }
    line("bytes", bytes.to_string());
    text
}

/// Parses the name of a face, ignoring case.
fn face(text: &str) -> Result<u32, String> {
    one_of(&FACES, text).map(|index| index as u32)
}
