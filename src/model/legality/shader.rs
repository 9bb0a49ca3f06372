//! Checks that the stages of a texture shader are legal: their order, and the textures that they sample (TSH-10).

use crate::diagnostic::Diagnostic;
use crate::place::Span;
use crate::state::{Named, ShaderOperation, ShaderStage, TEXTURE_UNITS, TextureKind};

/// Returns the finding that an operation may not follow those before it, or that it reads a unit too late. `previous` is the place of the
/// field of that name.
pub fn order(
    stages: &[ShaderStage; TEXTURE_UNITS],
    index: usize,
    stage: Option<Span>,
    previous: Option<Span>,
) -> Option<Diagnostic> {
    if let Some(help) = ShaderStage::misplaced(stages, index) {
        let message = format!("{} cannot stand at stage {index} here", stages[index].operation.name());
        let finding = Diagnostic::error("NB0341", stage, message).label("the chip refuses it");
        return Some(finding.rule("TSH-10").help(help));
    }
    ShaderStage::reads_too_late(stages, index).then(|| {
        let message = "with DotReflectDiffuse before it, stage 3 cannot read unit 2";
        Diagnostic::error("NB0342", previous.or(stage), message)
            .label("its dot product is part of what unit 2 samples with")
            .rule("TSH-10")
            .help("write `(operation: ..., previous: 0)` or `previous: 1`")
    })
}

/// Returns the finding that a stage reads a unit that is not before it.
pub fn later_unit(index: usize, previous: usize, place: Option<Span>) -> Diagnostic {
    let help = match index {
        0 | 1 => "stage 1 always reads unit 0: leave `previous` out".to_owned(),
        _ => format!("it reads what is fetched before it: unit 0 to {}", index - 1),
    };
    Diagnostic::error("NB0342", place, format!("stage {index} cannot read unit {previous}"))
        .label("not fetched yet")
        .rule("TSH-10")
        .help(help)
}

/// Returns the finding that an operation does not sample textures of a kind, or `None` if it does.
pub fn kind(operation: &ShaderOperation, kind: TextureKind, place: Option<Span>) -> Option<Diagnostic> {
    let kinds = operation.kinds();
    (!kinds.contains(&kind)).then(|| {
        let names: Vec<&str> = kinds.iter().map(|kind| kind.name()).collect();
        let message = format!("{} does not sample a texture of kind {}", operation.name(), kind.name());
        Diagnostic::error("NB0343", place, message)
            .label(format!("needs {}", names.join(" or ")))
            .rule("TSH-10")
            .help("give the unit another texture, or take the operation for this kind")
    })
}

/// Returns the finding that the unit of a stage that samples has no texture.
pub fn unbound(index: usize, place: Option<Span>) -> Diagnostic {
    Diagnostic::error("NB0343", place, format!("stage {index} samples, but its unit has no texture"))
        .label("nothing to sample")
        .rule("TSH-10")
        .help(format!("give the draw `textures: [...]` with an entry for unit {index}"))
}
