//! Recipes that evaluate a whole unit of the OpenGL texture environment.

use super::fixed::{COMBINE, color, colors, drawn};
use super::{Case, Path, Placement};
use ninebit_program::texture_environment::{BaseFormat, Function, Mode};

/// Returns the sources of both recipes: texture and primary colour, and the constant if it is read.
fn sources(case: &Case, reads_constant: bool) -> Option<Vec<(&'static str, Vec<u8>)>> {
    let mut sources = vec![("texture0", color(case, "texture")?), ("primary", color(case, "primary")?)];
    if reads_constant {
        sources.push(("environment", color(case, "constant")?));
    }
    Some(sources)
}

/// Evaluates the texture environment modes of OpenGL 1.1.
pub(super) fn texture_environment(case: &Case) -> Option<Placement> {
    let format: BaseFormat = case.choice("cfg.base_format");
    let internal = case.word("cfg.base_format", "ALPHA8 LUMINANCE8 LUMINANCE8_ALPHA8 INTENSITY8 RGB8 RGBA8");
    let mode: Mode = case.choice("cfg.mode");
    let (name, needs) = match mode {
        Mode::Replace => ("REPLACE", vec![]),
        Mode::Modulate => ("MODULATE", vec![]),
        // OpenGL leaves DECAL undefined for other formats.
        Mode::Decal if matches!(format, BaseFormat::Rgb | BaseFormat::Rgba) => ("DECAL", vec![]),
        Mode::Blend => ("BLEND", vec![]),
        Mode::Add => ("ADD", vec!["GL_ARB_texture_env_add|GL_EXT_texture_env_add"]),
        Mode::Decal | Mode::Combine | Mode::Combine4 => return None,
    };
    let state = vec![format!("texels 0 {internal} RGBA UNSIGNED_BYTE"), format!("env 0 TEXTURE_ENV_MODE {name}")];
    Some(drawn(Path::Common, needs, state, sources(case, mode == Mode::Blend)?, colors()))
}

/// Returns the names of a function for RGB and for alpha, and the extension that brings it.
fn function_names(function: Function) -> (&'static str, &'static str, &'static str) {
    match function {
        Function::Replace => ("REPLACE", "REPLACE", COMBINE),
        Function::Modulate => ("MODULATE", "MODULATE", COMBINE),
        Function::Add => ("ADD", "ADD", COMBINE),
        Function::AddSigned => ("ADD_SIGNED", "ADD_SIGNED", COMBINE),
        Function::Interpolate => ("INTERPOLATE", "INTERPOLATE", COMBINE),
        Function::Subtract => ("SUBTRACT", "SUBTRACT", "GL_ARB_texture_env_combine"),
        Function::Dot3RgbArb => ("DOT3_RGB", "MODULATE", "GL_ARB_texture_env_dot3"),
        Function::Dot3RgbaArb => ("DOT3_RGBA", "MODULATE", "GL_ARB_texture_env_dot3"),
        Function::Dot3RgbExt => ("DOT3_RGB_EXT", "MODULATE", "GL_EXT_texture_env_dot3"),
        Function::Dot3RgbaExt => ("DOT3_RGBA_EXT", "MODULATE", "GL_EXT_texture_env_dot3"),
    }
}

/// Evaluates the combine functions, with the arguments of the model's unit.
pub(super) fn texture_combine(case: &Case) -> Option<Placement> {
    let (mode, function): (Mode, Function) = (case.choice("cfg.mode"), case.choice("cfg.function"));
    let (rgb, alpha, extension) = function_names(function);
    let (mode_name, mut needs) = match mode {
        Mode::Combine4 => ("COMBINE4_NV", vec!["GL_NV_texture_env_combine4"]),
        _ => ("COMBINE", vec![COMBINE]),
    };
    if extension != COMBINE {
        needs.push(extension);
    }
    let scale = case.scale()?;
    let mut words = vec![
        format!("TEXTURE_ENV_MODE {mode_name}"),
        format!("COMBINE_RGB {rgb}"),
        format!("COMBINE_ALPHA {alpha}"),
        format!("RGB_SCALE {scale}"),
        format!("ALPHA_SCALE {scale}"),
    ];
    let arguments = ["TEXTURE", "PRIMARY_COLOR", "CONSTANT", "TEXTURE"];
    let last = if mode == Mode::Combine4 { 4 } else { 3 };
    for (n, source) in arguments.iter().enumerate().take(last) {
        let vendor = if n == 3 { "_NV" } else { "" };
        let operands = "SRC_COLOR ONE_MINUS_SRC_COLOR SRC_ALPHA ONE_MINUS_SRC_ALPHA";
        let of_rgb = case.word(&format!("cfg.operand{n}"), operands);
        let of_alpha = of_rgb.replace("COLOR", "ALPHA");
        words.push(format!("SOURCE{n}_RGB{vendor} {source}"));
        words.push(format!("SOURCE{n}_ALPHA{vendor} {source}"));
        words.push(format!("OPERAND{n}_RGB{vendor} {of_rgb}"));
        words.push(format!("OPERAND{n}_ALPHA{vendor} {of_alpha}"));
    }
    let state = words.iter().map(|words| format!("env 0 {words}")).collect();
    let sources = sources(case, function.reads(mode)[2])?;
    Some(drawn(Path::Common, needs, state, sources, colors()))
}
