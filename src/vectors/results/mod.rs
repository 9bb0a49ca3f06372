//! Results: what a card or a driver answered, as `vectors/harness/gl` writes it.
//!
//! ```text
//! device.json     who answered: vendor, renderer, version, extensions, surface; the root digest of the pack that was asked
//! UNIT.tsv        rows: id, observed columns, status
//! ```
//!
//! A unit whose results the asked chip cannot show (on nv10 those of a whole stage, for example) has a table without observed columns and rows.
//! A table begins with `# ninebit-results 1` and ends with `# end ROWS CRC`, the CRC-32 of everything before that line: one that was cut off, reordered or
//! edited is refused. [`compare`](compare::compare) holds results to a pack; [`adopt`](adopt::adopt) records those of a real card.

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
use ninebit_files::output::is_leftover;
use ninebit_files::read::Kind;

/// `format` of a device file.
pub const DEVICE_FORMAT: &str = "ninebit-device-1";

/// Name of the device file.
pub const DEVICE: &str = "device.json";

/// What to do with results that are not whole.
const AGAIN: &str = "draw the pack again";

/// The card and driver that answered, as the harness wrote them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Device {
    /// The version of the format: [`DEVICE_FORMAT`].
    pub format: String,
    /// Root digest of the pack that was asked.
    pub pack: String,
    /// The vendor, as OpenGL names it.
    pub vendor: String,
    /// The renderer, as OpenGL names it.
    pub renderer: String,
    /// The version, as OpenGL names it.
    pub version: String,
    /// What was drawn into.
    pub surface: String,
    /// The bits of red, green, blue and alpha that the surface really has.
    pub surface_format: String,
    /// OpenGL's extensions, with spaces between.
    pub extensions: String,
}

impl Device {
    /// Whether a program answered instead of a card.
    pub fn is_software(&self) -> bool {
        let programs = "llvmpipe,softpipe,swrast,software,swiftshader,gdi generic,basic render,recorder,virgl,lavapipe";
        let renderer = format!("{} {}", self.vendor, self.renderer).to_lowercase();
        programs.split(',').any(|program| renderer.contains(program))
    }
}

/// A column that was observed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Observed {
    /// The column's name in the results: `out.u>>8`.
    pub name: String,
    /// Its place among the unit's results.
    pub column: usize,
    /// Lowest bits that it lacks.
    pub shift: u32,
}

/// The results of a unit.
#[derive(Debug)]
pub struct UnitResults {
    /// The file that the answers were read from.
    pub path: PathBuf,
    /// The unit that was asked.
    pub unit: &'static dyn Unit,
    /// Chip, level, seed and behaviour of the table that was asked, as written.
    pub asked: [String; 4],
    /// What was observed.
    pub columns: Vec<Observed>,
    /// Rows in the order of the file.
    pub rows: Vec<ResultRow>,
    /// Rows of batches that the device could not draw.
    pub unsupported: u64,
}

/// A row of results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ResultRow {
    /// Its line in the file, from 1.
    pub line: usize,
    /// The row of the pack.
    pub id: String,
    /// A number for each observed column, in the column's own unit; `None` if the draw failed.
    pub values: Option<Vec<i64>>,
}

/// Everything that a device answered.
#[derive(Debug)]
pub struct Results {
    /// The card and driver that answered.
    pub device: Device,
    /// By unit, in the order of their names.
    pub units: Vec<UnitResults>,
}

/// Reads a folder of results of this pack.
///
/// # Errors
/// A file is missing, cut off, was changed, is of another version or of another pack.
pub fn open(folder: &Path, manifest: &Manifest) -> Result<Results, VectorError> {
    let device_path = folder.join(DEVICE);
    let missing = "name the folder of results that vectors/harness/gl wrote";
    let of_another_pack = "name the pack that was drawn, or draw this one";
    let device = device(&read_text(&device_path, Kind::Regular, limits::DEVICE, missing)?, &device_path)?;
    if device.pack != manifest.root {
        let message = format!("these are results of the pack {:.12}, not of {:.12}", device.pack, manifest.root);
        return Err(VectorError::file("NB1031", &device_path, message, of_another_pack));
    }
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
            return Err(VectorError::file("NB1031", &path, message, of_another_pack));
        }
        units.push(results);
    }
    Ok(Results { device, units })
}

/// Reads a device file.
fn device(text: &str, path: &Path) -> Result<Device, VectorError> {
    let broken = |error: serde_json::Error| {
        VectorError::line("NB1033", path, error.line(), format!("not a device file: {error}"), AGAIN)
    };
    let device: Device = serde_json::from_str(text).map_err(broken)?;
    if device.format != DEVICE_FORMAT {
        let message = format!("the format is `{:.60}`, not `{DEVICE_FORMAT}`", device.format);
        let help = "use the program that wrote it, or draw the pack again";
        return Err(VectorError::file("NB1003", path, message, help));
    }
    Ok(device)
}
