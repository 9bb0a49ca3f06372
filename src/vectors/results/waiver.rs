//! Waivers: known and documented differences. There is no other tolerance.

use super::*;

use crate::{VectorError, read_text, units};

/// A known difference.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Waiver {
    /// Name of the unit.
    pub unit: String,
    /// Largest accepted difference of a number, in steps of its column.
    pub maximum: u64,
    /// Maximum number of accepted rows.
    pub count: usize,
    /// Why the difference is accepted.
    pub reason: String,
}

/// Reads a file of waivers: JSON, a list of objects.
///
/// # Errors
/// Returns an error if the file is missing or is not such a list, a unit does not exist or is listed twice, or a waiver accepts nothing or has no
/// reason.
pub fn read(path: &Path) -> Result<Vec<Waiver>, VectorError> {
    let help = r#"a list such as [{"unit": "blend", "maximum": 1, "count": 7, "reason": "..."}]"#;
    let invalid = |line, message: String| VectorError::line("NB1034", path, line, message, help);
    let text = read_text(path, Kind::Stream, limits::WAIVERS, "check the spelling of the file of waivers")?;
    let waivers: Vec<Waiver> = serde_json::from_str(&text)
        .map_err(|error| invalid(error.line(), format!("not a list of waivers: {error}")))?;
    for (n, waiver) in waivers.iter().enumerate() {
        let name = &waiver.unit;
        if units::by_name(name).is_none() {
            return Err(invalid(0, format!("there is no unit `{name:.60}`")));
        }
        if waivers[..n].iter().any(|other| other.unit == *name) {
            return Err(invalid(0, format!("`{name:.60}` has two waivers")));
        }
        if waiver.maximum == 0 || waiver.count == 0 || waiver.reason.trim().is_empty() {
            return Err(invalid(0, format!("the waiver of `{name:.60}` needs a maximum, a count and a reason")));
        }
    }
    Ok(waivers)
}
