//! Adoption of a real card's results as ground truth: a folder of the repository that records the card and its results.
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
use ninebit_files::output::write_file;
use ninebit_files::pending::PendingFolder;
use ninebit_files::picture::hexadecimal;
use ninebit_files::read;

/// Value of `format` in the record.
const FORMAT: &str = "ninebit-adopted-1";

/// File name of the record.
const RECORD: &str = "ADOPTED.json";

/// Record of adopted results.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AdoptionRecord {
    /// Version of the format: `ninebit-adopted-1`.
    pub format: String,
    /// The card's name in this project, which is also the name of its folder.
    pub device: String,
    /// OpenGL's vendor string.
    pub vendor: String,
    /// OpenGL's renderer string.
    pub renderer: String,
    /// OpenGL's version string.
    pub version: String,
    /// Grade of these results: SILICON.
    pub grade: String,
    /// Name of the pack's chip.
    pub profile: String,
    /// The pack's root digest.
    pub pack: String,
    /// The behaviour revision that the model has to reach: the pack's, or one more if the card contradicts it.
    pub behaviour_rev: u32,
    /// The adopted units.
    pub units: Vec<AdoptedUnit>,
}

/// Adopted results of one unit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AdoptedUnit {
    /// Name of the unit.
    pub unit: String,
    /// Number of rows that the card confirms.
    pub confirmed: usize,
    /// Number of rows that it contradicts.
    pub contradicted: usize,
    /// SHA-256 of the file of results, in hexadecimal.
    pub sha256: String,
}

/// Converts a renderer's name to a folder name: lower case, words joined by `-`.
pub fn folder_name(renderer: &str) -> String {
    let words = renderer.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-").to_lowercase()
}

/// Records results in `folder`, under the device's name. Returns the new folder and the record. All files are written to a temporary folder that is
/// then renamed, so an error leaves nothing behind.
///
/// # Errors
/// Returns an error if a software renderer or a card younger than NV2A answered, draws failed, no row was drawn, the device has a record already, or the folder cannot be
/// written.
pub fn adopt(
    folder: &Path,
    name: &str,
    manifest: &Manifest,
    results: &Results,
    comparison: &Comparison,
) -> Result<(PathBuf, AdoptionRecord), VectorError> {
    let source = results.units.first().and_then(|unit| unit.path.parent());
    let device_path = source.unwrap_or(Path::new("")).join(DEVICE);
    let refuse = |message: String, help| VectorError::file("NB1036", &device_path, message, help);
    let device = &results.device;
    if device.is_software() {
        let message = format!("`{:.80}` is a program, not silicon", device.renderer);
        return Err(refuse(message, "only what a card answers is adopted; `compare` tells how a driver differs"));
    }
    if device.is_younger() {
        let message = format!(
            "`{:.80}` has OpenGL {:.80}: its driver draws combiners by shaders",
            device.renderer, device.version
        );
        return Err(refuse(
            message,
            "only a card with combiners of its own is adopted; `compare` tells how a driver differs",
        ));
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
    let named = |error: VectorError| error.named(part.path(), &place);
    let mut units = Vec::new();
    for (unit, compared) in results.units.iter().zip(&comparison.units).filter(|(_, compared)| compared.asked > 0) {
        let sha256 = copy(&unit.path, &part.path().join(format!("{}.tsv", unit.unit.name()))).map_err(named)?;
        let contradicted = compared.off_by_one + compared.worse - compared.waived;
        units.push(AdoptedUnit { unit: unit.unit.name().to_owned(), confirmed: compared.exact, contradicted, sha256 });
    }
    copy(&device_path, &part.path().join(DEVICE)).map_err(named)?;
    let contradicts = units.iter().any(|unit| unit.contradicted > 0);
    let adopted = AdoptionRecord {
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
    write_file(&part.path().join(RECORD), text.as_bytes()).map_err(|error| named(error.into()))?;
    part.commit()?;
    Ok((place, adopted))
}

/// Copies a file. Returns its SHA-256 in hexadecimal.
fn copy(from: &Path, to: &Path) -> Result<String, VectorError> {
    let missing = "the folder has changed meanwhile: try again";
    let bytes = read::bytes(from, Kind::Regular, limits::VECTOR_TABLE).map_err(|error| unread(error, from, missing))?;
    write_file(to, &bytes)?;
    Ok(hexadecimal(&Sha256::digest(&bytes)))
}
