//! Results of a card or a driver, as `vectors/harness/gl` writes them.
//!
//! ```text
//! device.json     the device: vendor, renderer, version, extensions, surface; the root digest of the pack that was asked
//! UNIT.tsv        rows: id, observed columns, status
//! ```
//!
//! A table has no observed columns and no rows if the chip cannot show the unit's results (on nv10 those of a whole stage, for example). A table
//! begins with `# ninebit-results 1` and ends with `# end ROWS CRC`, the CRC-32 of everything before that line: a truncated, reordered or edited
//! table is refused. [`compare`](compare::compare) compares results with a pack; [`adopt`](adopt::adopt) records those of a real card.

pub mod adopt;
pub mod compare;
mod read;
pub mod waiver;

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

pub use read::parse;

use super::pack::Manifest;
use super::{Unit, VectorError, read_text};
use ninebit::limits;
use ninebit_files::leftover::is_leftover;
use ninebit_files::read::Kind;

/// Value of `format` in a device file.
const DEVICE_FORMAT: &str = "ninebit-device-1";

/// File name of the device file.
const DEVICE: &str = "device.json";

/// Advice for results of another pack.
const OTHER_PACK: &str = "name the pack that was drawn, or draw this one";

/// Advice for incomplete results.
const AGAIN: &str = "draw the pack again";

/// Description of the card and driver, as the harness wrote it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Device {
    /// Version of the format: `ninebit-device-1`.
    pub format: String,
    /// Root digest of the pack that was drawn.
    pub pack: String,
    /// OpenGL's vendor string.
    pub vendor: String,
    /// OpenGL's renderer string.
    pub renderer: String,
    /// OpenGL's version string.
    pub version: String,
    /// Kind of the surface that was drawn into.
    pub surface: String,
    /// Bits of red, green, blue and alpha that the surface really has.
    pub surface_format: String,
    /// OpenGL's extensions, separated by spaces.
    pub extensions: String,
}

impl Device {
    /// Returns whether the device is a software renderer.
    fn is_software(&self) -> bool {
        let programs = "llvmpipe,softpipe,swrast,software,swiftshader,gdi generic,basic render,recorder,virgl,lavapipe";
        let renderer = format!("{} {}", self.vendor, self.renderer).to_lowercase();
        programs.split(',').any(|program| renderer.contains(program))
    }

    /// Returns whether the card is younger than the chips of the model: their drivers end at OpenGL 1.5, those of later cards draw combiners by shaders.
    fn is_younger(&self) -> bool {
        let major = self.version.split(['.', ' ']).find_map(|word| word.parse::<u32>().ok());
        major.is_some_and(|major| major >= 2)
    }
}

/// An observed column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ObservedColumn {
    /// The column's name in the results, such as `out.u>>8`.
    pub name: String,
    /// Index among the unit's result columns.
    pub column: usize,
    /// Number of lowest bits that were not observed.
    pub shift: u32,
}

/// The results of a unit.
#[derive(Debug)]
pub struct UnitResults {
    /// The file of results.
    pub path: PathBuf,
    /// The unit whose results these are.
    pub unit: &'static dyn Unit,
    /// Chip, level, seed and behaviour of the table that was drawn, as text.
    pub asked: [String; 4],
    /// The observed columns.
    pub columns: Vec<ObservedColumn>,
    /// The rows, in the order of the file.
    pub rows: Vec<ResultRow>,
    /// Number of rows in batches that the device could not draw.
    pub unsupported: u64,
}

/// A row of results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ResultRow {
    /// Line number in the file, from 1.
    pub line: usize,
    /// Id of the pack's row.
    pub id: String,
    /// A number for each observed column, in the column's unit; `None` if the draw failed.
    pub values: Option<Vec<i64>>,
}

/// All results of a device.
#[derive(Debug)]
pub struct Results {
    /// The card and driver.
    pub device: Device,
    /// Results of each unit, in the order of the units' names.
    pub units: Vec<UnitResults>,
}

/// Reads a folder of results of a pack.
///
/// # Errors
/// Returns an error if a file is missing, truncated, changed, of another version, or of another pack.
pub fn open(folder: &Path, manifest: &Manifest) -> Result<Results, VectorError> {
    let device = device(folder, &manifest.root)?;
    let entries = std::fs::read_dir(folder).map_err(|error| VectorError::unreadable(folder, error))?;
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| !path.file_name().is_some_and(is_leftover));
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "tsv" || extension == "part"));
    paths.sort();
    if let Some(part) = paths.iter().find(|path| path.extension().is_some_and(|extension| extension == "part")) {
        return Err(VectorError::file("NB1030", part, "a run was broken off here", AGAIN));
    }
    if paths.is_empty() {
        return Err(VectorError::missing(folder.join("UNIT.tsv"), "there are no results: draw the pack again"));
    }
    let mut units = Vec::new();
    for path in paths {
        let results = parse(&read_text(&path, Kind::Regular, limits::VECTOR_TABLE, AGAIN)?, &path)?;
        let name = results.unit.name();
        if path.file_stem().is_none_or(|stem| stem != name) {
            let message = format!("these are results of `{name}`");
            return Err(VectorError::line("NB1032", &path, 2, message, "do not rename results"));
        }
        let of_pack =
            [&manifest.profile, &manifest.level, &manifest.seed.to_string(), &manifest.behaviour_rev.to_string()];
        if results.asked.iter().zip(of_pack).any(|(asked, own)| asked != own) {
            let message = "its chip, level, seed or behaviour is not the pack's";
            return Err(VectorError::file("NB1031", &path, message, OTHER_PACK));
        }
        units.push(results);
    }
    Ok(Results { device, units })
}

/// Reads the device file of a folder of results.
///
/// # Errors
/// Returns an error if it is missing, of another version, or of a pack with another root digest.
pub fn device(folder: &Path, root: &str) -> Result<Device, VectorError> {
    let path = folder.join(DEVICE);
    let missing = "name the folder of results that the program for the chip wrote";
    let text = read_text(&path, Kind::Regular, limits::DEVICE, missing)?;
    let broken = |error: serde_json::Error| {
        VectorError::line("NB1033", &path, error.line(), format!("not a device file: {error}"), AGAIN)
    };
    let device: Device = serde_json::from_str(&text).map_err(broken)?;
    if device.format != DEVICE_FORMAT {
        let message = format!("the format is `{:.60}`, not `{DEVICE_FORMAT}`", device.format);
        let help = "use the program that wrote it, or draw the pack again";
        return Err(VectorError::file("NB1003", &path, message, help));
    }
    if device.pack != root {
        let message = format!("these are results of the pack {:.12}, not of {root:.12}", device.pack);
        return Err(VectorError::file("NB1031", &path, message, OTHER_PACK));
    }
    Ok(device)
}
