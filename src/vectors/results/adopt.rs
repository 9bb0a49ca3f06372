//! What a real card answered becomes truth: a folder of the repository that names the card and what it said.
//!
//! ```text
//! vectors/results/DEVICE/ADOPTED.json   the card, the pack, the grade, the behaviour that the model has to have, counts and digests
//! vectors/results/DEVICE/device.json    as the harness wrote it
//! vectors/results/DEVICE/UNIT.tsv       as the harness wrote it
//! ```

use super::*;

use sha2::{Digest, Sha256};

use super::compare::Comparison;
use crate::error::{VectorError, unread};
use crate::pack::Manifest;
use ninebit_files::output::{PendingFolder, write_file};
use ninebit_files::picture::hexadecimal;
use ninebit_files::read;

/// `format` of the record.
pub const FORMAT: &str = "ninebit-adopted-1";

/// Name of the record.
pub const RECORD: &str = "ADOPTED.json";

/// What was adopted.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Adopted {
    /// The version of the format: [`FORMAT`].
    pub format: String,
    /// The card's name in this project: that of its folder.
    pub device: String,
    /// The vendor, as OpenGL names it.
    pub vendor: String,
    /// The renderer, as OpenGL names it.
    pub renderer: String,
    /// The version, as OpenGL names it.
    pub version: String,
    /// The grade of what is told here.
    pub grade: String,
    /// The chip of the pack.
    pub profile: String,
    /// The pack's root digest.
    pub pack: String,
    /// What the model has to say: the pack's behaviour, one more if the card contradicts it.
    pub behaviour_rev: u32,
    /// What was adopted, a unit each.
    pub units: Vec<AdoptedUnit>,
}

/// What was adopted of a unit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AdoptedUnit {
    /// Name of the unit.
    pub unit: String,
    /// Rows that the card confirms.
    pub confirmed: usize,
    /// Rows that it contradicts.
    pub contradicted: usize,
    /// SHA-256 of the file of results.
    pub sha256: String,
}

/// A name as a folder: lower case, words joined by `-`.
pub fn folder_name(renderer: &str) -> String {
    let words = renderer.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-").to_lowercase()
}

/// Records results in `folder`, under the device's name. Everything is written beside and renamed: nothing half-written stays.
///
/// # Errors
/// A program answered and no card; draws failed; nothing was asked; the device has a record already; the folder cannot be written.
pub fn adopt(
    folder: &Path,
    name: &str,
    manifest: &Manifest,
    results: &Results,
    comparison: &Comparison,
) -> Result<(PathBuf, Adopted), VectorError> {
    let source = results.units.first().and_then(|unit| unit.path.parent());
    let device_path = source.unwrap_or(Path::new("")).join(DEVICE);
    let refuse = |message: String, help| VectorError::file("NB1036", &device_path, message, help);
    let device = &results.device;
    if device.is_software() {
        let message = format!("`{:.80}` is a program, not silicon", device.renderer);
        return Err(refuse(message, "only what a card answers is adopted; `compare` tells how a driver differs"));
    }
    if let Some(unit) = comparison.units.iter().find(|unit| unit.errors > 0) {
        let message = format!("{} draws of `{}` failed", unit.errors, unit.unit);
        return Err(refuse(message, "draw the pack again; adopt results that are whole"));
    }
    if comparison.units.iter().all(|unit| unit.asked == 0) {
        return Err(refuse("no row was asked".to_owned(), "draw the pack on a card that has the extensions"));
    }
    let place = folder.join(name);
    if name.is_empty() || folder_name(name) != name {
        return Err(refuse(format!("`{name:.60}` is no name of a device"), "lower case, digits, words joined by `-`"));
    }
    if place.exists() {
        let help = "take the record away first, or give the device another name";
        return Err(VectorError::file("NB1036", &place, "the device has a record already", help));
    }
    let part = PendingFolder::create(&place)?;
    let mut units = Vec::new();
    for (unit, compared) in results.units.iter().zip(&comparison.units).filter(|(_, compared)| compared.asked > 0) {
        let sha256 = copy(&unit.path, &part.path().join(format!("{}.tsv", unit.unit.name())))?;
        let contradicted = compared.off_by_one + compared.worse;
        units.push(AdoptedUnit { unit: unit.unit.name().to_owned(), confirmed: compared.exact, contradicted, sha256 });
    }
    copy(&device_path, &part.path().join(DEVICE))?;
    let contradicts = units.iter().any(|unit| unit.contradicted > 0);
    let adopted = Adopted {
        format: FORMAT.to_owned(),
        device: name.to_owned(),
        vendor: device.vendor.clone(),
        renderer: device.renderer.clone(),
        version: device.version.clone(),
        grade: "SILICON".to_owned(),
        profile: manifest.profile.clone(),
        pack: manifest.root.clone(),
        behaviour_rev: manifest.behaviour_rev + u32::from(contradicts),
        units,
    };
    let text = serde_json::to_string_pretty(&adopted).unwrap_or_default() + "\n";
    write_file(&part.path().join(RECORD), text.as_bytes())?;
    part.commit()?;
    Ok((place, adopted))
}

/// Copies a file; returns its digest.
fn copy(from: &Path, to: &Path) -> Result<String, VectorError> {
    let missing = "the folder has changed meanwhile: try again";
    let bytes = read::bytes(from, Kind::Regular, limits::VECTOR_TABLE).map_err(|error| unread(error, from, missing))?;
    write_file(to, &bytes)?;
    Ok(hexadecimal(&Sha256::digest(&bytes)))
}
