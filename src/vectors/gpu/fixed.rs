//! Recipes that need no register combiners: the texture environment, texels and coordinates, colours, alpha test, blending.

use super::{Case, Contribution, Draw, Path, Placement, byte};
use ninebit::state::{AddressMode, Bias, BlendEquation, TextureFormat};

/// Returns a placement with one draw.
pub(super) fn drawn(
    path: Path,
    needs: Vec<&'static str>,
    state: Vec<String>,
    sources: Vec<(&'static str, Vec<u8>)>,
    reads: Vec<Contribution>,
) -> Placement {
    Placement { path, needs, state, draws: vec![Draw { state: Vec::new(), reads, combiners: None }], sources }
}

/// Reads the four channels of the pixel into `out.r` to `out.a`.
pub(super) fn colors() -> Vec<Contribution> {
    ["out.r", "out.g", "out.b", "out.a"]
        .into_iter()
        .enumerate()
        .map(|(n, column)| Contribution::byte(column, n))
        .collect()
}

/// Returns the bytes of a colour of the row, or `None` if a channel is not a byte.
pub(super) fn color(case: &Case, name: &str) -> Option<Vec<u8>> {
    ["r", "g", "b", "a"].iter().map(|channel| byte(case.number(&format!("in.{name}.{channel}")))).collect()
}

/// Returns the bits of a finite float as little-endian bytes, or `None` for infinities and NaN, which OpenGL leaves undefined.
fn float(bits: i64) -> Option<[u8; 4]> {
    let value = f32::from_bits(u32::try_from(bits).ok()?);
    value.is_finite().then(|| value.to_le_bytes())
}

/// Returns n / 2^shift as a little-endian binary32 number. It is exact because n is below 2^24.
fn scaled(n: i64, shift: u32) -> [u8; 4] {
    let whole = n as f32;
    let bits = if n == 0 { 0 } else { whole.to_bits().wrapping_sub(shift << 23) };
    bits.to_le_bytes()
}

/// Returns the state lines of an environment that combines the texture and the primary colour.
fn combine(operation: &str) -> Vec<String> {
    let words = [
        "TEXTURE_ENV_MODE COMBINE",
        &format!("COMBINE_RGB {operation}"),
        "SOURCE0_RGB TEXTURE",
        "OPERAND0_RGB SRC_COLOR",
        "SOURCE1_RGB PRIMARY_COLOR",
        "OPERAND1_RGB SRC_COLOR",
        "COMBINE_ALPHA REPLACE",
        "SOURCE0_ALPHA PRIMARY_COLOR",
    ];
    words.iter().map(|words| format!("env 0 {words}")).collect()
}

/// Extensions that bring the combine environment, of which any will do.
pub(super) const COMBINE: &str = "GL_ARB_texture_env_combine|GL_EXT_texture_env_combine";

/// Multiplies two bytes by MODULATE.
fn modulate(case: &Case, column: &str, state: &[String]) -> Option<Placement> {
    let [a, b] = case.numbers(["in.a", "in.b"]);
    let sources = vec![("texture0", vec![byte(a)?; 4]), ("primary", vec![byte(b)?; 4])];
    let state = [combine("MODULATE"), state.to_vec()].concat();
    Some(drawn(Path::Environment, vec![COMBINE], state, sources, vec![Contribution::byte(column, 0)]))
}

pub(super) fn product(case: &Case) -> Option<Placement> {
    modulate(case, "out.ab", &["env 0 RGB_SCALE 1".to_owned()])
}

/// Evaluates the scales that a texture environment has; it has no bias.
pub(super) fn scale_bias(case: &Case) -> Option<Placement> {
    let scale = case.scale()?;
    if case.choice::<Bias>("cfg.bias") != Bias::None {
        return None;
    }
    modulate(case, "out.value", &[format!("env 0 RGB_SCALE {scale}")])
}

/// Evaluates DOT3 of bytes, whose factors are the even ones of the expand mapping (CMB-3). Negative results cannot be read.
pub(super) fn dot_product(case: &Case) -> Option<Placement> {
    let expanded = |factor: i64| if factor % 2 == 0 { byte((factor + 256) / 2) } else { None };
    let vector = |names: [&str; 3]| {
        let [r, g, b] = case.numbers(names).map(expanded);
        Some(vec![r?, g?, b?, 255])
    };
    let sources = vec![
        ("texture0", vector(["in.a.r", "in.a.g", "in.a.b"])?),
        ("primary", vector(["in.b.r", "in.b.g", "in.b.b"])?),
    ];
    if case.number("out.dot") < 0 {
        return None;
    }
    let state = [combine("DOT3_RGB"), vec!["env 0 RGB_SCALE 1".to_owned()]].concat();
    let needs = vec![COMBINE, "GL_ARB_texture_env_dot3|GL_EXT_texture_env_dot3"];
    Some(drawn(Path::Environment, needs, state, sources, vec![Contribution::byte("out.dot", 0)]))
}

pub(super) fn vertex_color(case: &Case) -> Option<Placement> {
    let color = float(case.number("in.color"))?;
    let one = 1.0_f32.to_le_bytes();
    let sources = vec![("primary_float", [color, color, color, one].concat())];
    Some(drawn(Path::Common, vec![], vec![], sources, vec![Contribution::byte("out.byte", 0)]))
}

/// Evaluates the constant colour of the texture environment.
pub(super) fn constant_color(case: &Case) -> Option<Placement> {
    let color = float(case.number("in.color"))?;
    let one = 1.0_f32.to_le_bytes();
    // The unit needs a texture for its environment to apply.
    let state = [
        "ramp 0 1",
        "env 0 TEXTURE_ENV_MODE COMBINE",
        "env 0 COMBINE_RGB REPLACE",
        "env 0 SOURCE0_RGB CONSTANT",
        "env 0 OPERAND0_RGB SRC_COLOR",
        "env 0 RGB_SCALE 1",
    ];
    let state = state.map(str::to_owned).to_vec();
    let sources = vec![("environment_float", [color, color, color, one].concat())];
    Some(drawn(Path::Common, vec![COMBINE], state, sources, vec![Contribution::byte("out.byte", 0)]))
}

/// Returns OpenGL's name of an address mode, and the extensions that it needs.
pub(super) fn wrap(mode: AddressMode) -> (&'static str, Vec<&'static str>) {
    match mode {
        AddressMode::Wrap => ("REPEAT", vec![]),
        AddressMode::Mirror => {
            ("MIRRORED_REPEAT", vec!["GL_ARB_texture_mirrored_repeat|GL_IBM_texture_mirrored_repeat"])
        }
        AddressMode::ClampToEdge => ("CLAMP_TO_EDGE", vec![]),
        AddressMode::ClampToBorder => ("CLAMP_TO_BORDER", vec!["GL_ARB_texture_border_clamp"]),
        AddressMode::Clamp => ("CLAMP", vec![]),
    }
}

/// Reads the number of a texel that encodes its own position, and whether a texel was read at all.
pub(super) fn numbered(column: &str) -> Vec<Contribution> {
    vec![
        Contribution::byte("out.inside", 2),
        Contribution::byte(column, 0),
        Contribution { weight: 256, ..Contribution::byte(column, 1) },
    ]
}

/// Reads a texture whose texels encode their positions. Only sizes that are powers of two are asked: their coordinates are exact.
pub(super) fn nearest_address(case: &Case) -> Option<Placement> {
    let size = case.number("cfg.size");
    if case.number("cfg.border_texels") != 0 || size.count_ones() != 1 {
        return None;
    }
    let (mode, needs) = wrap(case.choice("cfg.mode"));
    let state = vec![format!("ramp 0 {size}"), format!("parameter 0 TEXTURE_WRAP_S {mode}")];
    // u is in 1/256 texel, s in texture sizes.
    let s = scaled(case.number("in.u"), 8 + size.trailing_zeros());
    let sources = vec![("coordinates0", [s, scaled(1, 1), [0; 4]].concat())];
    Some(drawn(Path::Common, needs, state, sources, numbered("out.texel")))
}

/// Filters four texels. The weights are encoded as coordinates between them.
fn filtered(texels: [i64; 4], weights: [i64; 2]) -> Option<Placement> {
    let mut quad = Vec::new();
    for texel in texels {
        quad.extend([byte(texel)?; 4]);
    }
    let sources = vec![("quads0", quad), ("weights0", vec![byte(weights[0])?, byte(weights[1])?])];
    Some(drawn(Path::Common, vec![], vec![], sources, vec![Contribution::byte("out.value", 0)]))
}

pub(super) fn bilinear(case: &Case) -> Option<Placement> {
    let texels = case.numbers(["in.t00", "in.t10", "in.t01", "in.t11"]);
    filtered(texels, case.numbers(["in.weight_u", "in.weight_v"]))
}

pub(super) fn linear_step(case: &Case) -> Option<Placement> {
    let [first, second, weight] = case.numbers(["in.first", "in.second", "in.weight"]);
    filtered([first, second, first, second], [weight, 0])
}

/// Reads a cube map whose texels encode their face and position in bytes.
pub(super) fn cube_face(case: &Case) -> Option<Placement> {
    let size = case.number("cfg.size");
    let [u, v] = case.numbers(["out.u", "out.v"]).map(|along| along >> 8);
    if size > 256 || u >= size || v >= size {
        return None;
    }
    let [x, y, z] = case.numbers(["in.x", "in.y", "in.z"]).map(float);
    let sources = vec![("coordinates0", [x?, y?, z?].concat())];
    let reads =
        vec![Contribution::byte("out.face", 2), Contribution::byte("out.u>>8", 0), Contribution::byte("out.v>>8", 1)];
    let needs = vec!["GL_ARB_texture_cube_map|GL_EXT_texture_cube_map"];
    Some(drawn(Path::Common, needs, vec![format!("cube 0 {size}")], sources, reads))
}

/// Returns OpenGL's internal format, format and type for the words of a texture format.
fn upload(format: TextureFormat) -> Option<&'static str> {
    Some(match format {
        TextureFormat::A8R8G8B8 => "RGBA8 BGRA UNSIGNED_INT_8_8_8_8_REV",
        TextureFormat::X8R8G8B8 => "RGB8 BGRA UNSIGNED_INT_8_8_8_8_REV",
        TextureFormat::R5G6B5 => "RGB5 RGB UNSIGNED_SHORT_5_6_5",
        TextureFormat::X1R5G5B5 => "RGB5 BGRA UNSIGNED_SHORT_1_5_5_5_REV",
        TextureFormat::A1R5G5B5 => "RGB5_A1 BGRA UNSIGNED_SHORT_1_5_5_5_REV",
        TextureFormat::A4R4G4B4 => "RGBA4 BGRA UNSIGNED_SHORT_4_4_4_4_REV",
        TextureFormat::L8 => "LUMINANCE8 LUMINANCE UNSIGNED_BYTE",
        TextureFormat::I8 => "INTENSITY8 LUMINANCE UNSIGNED_BYTE",
        TextureFormat::A8 => "ALPHA8 ALPHA UNSIGNED_BYTE",
        TextureFormat::A8L8 => "LUMINANCE8_ALPHA8 LUMINANCE_ALPHA UNSIGNED_BYTE",
        _ => return None,
    })
}

pub(super) fn texel_expansion(case: &Case) -> Option<Placement> {
    let format: TextureFormat = case.choice("cfg.format");
    let state = vec![format!("texels 0 {}", upload(format)?)];
    let word = u32::try_from(case.number("in.word")).ok()?.to_le_bytes();
    let sources = vec![("texture0", word[..format.bytes() as usize].to_vec())];
    Some(drawn(Path::Common, vec![], state, sources, colors()))
}

pub(super) fn compressed_block(case: &Case) -> Option<Placement> {
    let (name, words) = match case.choice("cfg.format") {
        TextureFormat::Dxt1 => ("COMPRESSED_RGBA_S3TC_DXT1_EXT", 2),
        TextureFormat::Dxt3 => ("COMPRESSED_RGBA_S3TC_DXT3_EXT", 4),
        TextureFormat::Dxt5 => ("COMPRESSED_RGBA_S3TC_DXT5_EXT", 4),
        _ => return None,
    };
    let mut block = Vec::new();
    for word in ["in.word0", "in.word1", "in.word2", "in.word3"].iter().take(words) {
        block.extend(u32::try_from(case.number(word)).ok()?.to_le_bytes());
    }
    let corner = vec![byte(case.number("in.column"))?, byte(case.number("in.row"))?];
    let needs = vec!["GL_ARB_texture_compression", "GL_EXT_texture_compression_s3tc"];
    let state = vec![format!("compressed 0 {name}")];
    let sources = vec![("blocks0", block), ("corners0", corner)];
    Some(drawn(Path::Common, needs, state, sources, colors()))
}

/// OpenGL's comparison functions in the order of the model's.
pub(super) const FUNCTIONS: &str = "NEVER LESS EQUAL LEQUAL GREATER NOTEQUAL GEQUAL ALWAYS";

/// Draws fragments of the primary colour: 1 where the test passes, 0 from the cleared buffer elsewhere.
pub(super) fn alpha_test(case: &Case) -> Option<Placement> {
    let function = case.word("cfg.function", FUNCTIONS);
    let state = vec![format!("alpha_test {function} {}", case.number("cfg.reference"))];
    let sources = vec![("primary", vec![1, 1, 1, byte(case.number("in.alpha"))?])];
    Some(drawn(Path::Common, vec![], state, sources, vec![Contribution::byte("out.passes", 0)]))
}

const FACTORS: &str = "ZERO ONE SRC_COLOR ONE_MINUS_SRC_COLOR SRC_ALPHA ONE_MINUS_SRC_ALPHA DST_ALPHA \
    ONE_MINUS_DST_ALPHA DST_COLOR ONE_MINUS_DST_COLOR SRC_ALPHA_SATURATE CONSTANT_COLOR ONE_MINUS_CONSTANT_COLOR \
    CONSTANT_ALPHA ONE_MINUS_CONSTANT_ALPHA";

/// Blends the primary colour over a colour that is drawn first.
pub(super) fn blend(case: &Case) -> Option<Placement> {
    let (equation, mut needs) = match case.choice("cfg.equation") {
        BlendEquation::Add => ("FUNC_ADD", vec![]),
        BlendEquation::Subtract => ("FUNC_SUBTRACT", vec!["GL_EXT_blend_subtract"]),
        BlendEquation::ReverseSubtract => ("FUNC_REVERSE_SUBTRACT", vec!["GL_EXT_blend_subtract"]),
        BlendEquation::Min => ("MIN", vec!["GL_EXT_blend_minmax"]),
        BlendEquation::Max => ("MAX", vec!["GL_EXT_blend_minmax"]),
        // OpenGL has no such equations.
        BlendEquation::SignedAdd | BlendEquation::SignedReverseSubtract => return None,
    };
    let factors = ["cfg.source_factor", "cfg.destination_factor"].map(|name| case.word(name, FACTORS));
    if factors[1] == "SRC_ALPHA_SATURATE" {
        return None;
    }
    let mut sources = vec![("primary", color(case, "source")?), ("destination", color(case, "destination")?)];
    if factors.iter().any(|factor| factor.contains("CONSTANT")) {
        needs.push("GL_EXT_blend_color");
        sources.push(("blend_color", color(case, "constant")?));
    }
    let state = vec![format!("blend {equation} {}", factors.join(" "))];
    Some(drawn(Path::Common, needs, state, sources, colors()))
}
