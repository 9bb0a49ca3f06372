//! Writes the texture shader of a draw as scenes do.

use ninebit::state::{DotMapping, Named, ShaderOperation, ShaderStage};

/// Returns a list with an entry for each unit. Fields that have their default are left out.
pub(crate) fn written(stages: &[ShaderStage]) -> String {
    let stages: Vec<String> = stages.iter().enumerate().map(|(unit, stage)| entry(unit, stage)).collect();
    format!("[{}]", stages.join(", "))
}

fn entry(unit: usize, stage: &ShaderStage) -> String {
    let plain = ShaderStage::conventional(unit, true);
    let operation = operation(&stage.operation);
    let mut fields = String::new();
    if stage.coordinate_set != plain.coordinate_set {
        fields += &format!(", coordinates: {}", stage.coordinate_set);
    }
    if stage.operation.reads_previous() && stage.previous != plain.previous {
        fields += &format!(", previous: {}", stage.previous);
    }
    if stage.mapping != DotMapping::ZeroToOne {
        fields += &format!(", mapping: {}", stage.mapping.name());
    }
    if fields.is_empty() { operation } else { format!("(operation: {operation}{fields})") }
}

fn operation(operation: &ShaderOperation) -> String {
    let name = operation.name();
    match operation {
        ShaderOperation::CullFragment { drops_not_negative } => {
            let tests = drops_not_negative.map(|not| if not { "NotNegative" } else { "Negative" });
            let [s, t, r, q] = tests;
            format!("{name}(s: {s}, t: {t}, r: {r}, q: {q})")
        }
        ShaderOperation::BumpEnvironment { matrix, luminance } => {
            let luminance = luminance.map_or_else(String::new, |both| format!(", luminance: {}", numbers(&both)));
            format!("{name}(matrix: {}{luminance})", numbers(matrix))
        }
        ShaderOperation::DotReflectConstantEye { eye } => format!("{name}(eye: {})", numbers(eye)),
        _ => name.to_owned(),
    }
}

/// Returns the shortest decimals that are read back as the same numbers.
fn numbers(all: &[f32]) -> String {
    let all: Vec<String> = all.iter().map(f32::to_string).collect();
    format!("({})", all.join(", "))
}
