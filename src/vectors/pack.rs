//! A pack: the tables of many units in one folder, with a manifest.
//!
//! ```text
//! MANIFEST.json           what there is: versions, seed, counts, digests
//! SHA256SUMS              the digests again, for `sha256sum --check`
//! LICENSE                 CC0 1.0
//! schema/*.schema.json    what the JSON files hold
//! units/UNIT.tsv          the rows
//! units/UNIT.hex, .jsonl, .rows.h and others  views, where asked for
//! ```

use std::collections::HashSet;
use std::io::Write;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::error::unread;
use super::gpu::write::Batches;
use super::read::parse;
use super::view::{Content, Layout, TABLE, View};
use super::{BEHAVIOUR, Contents, Level, Table, Unit, VectorError, Writer, read_text};
use ninebit::limits::{self, FileLimit};
use ninebit::state::{Named, Profile};
use ninebit::threads::on_threads;
use ninebit_files::leftover::is_leftover;
use ninebit_files::output::{OutputError, make_folder, write_file};
use ninebit_files::pending::{PendingFile, PendingFolder};
use ninebit_files::picture::hexadecimal;
use ninebit_files::read::{self, Kind, ReadError};

/// Value of `format` in a manifest.
const FORMAT: &str = "ninebit-vectors-1";

/// Folders of a pack.
const FOLDERS: [&str; 2] = ["schema", "units"];

/// File name of the manifest.
const MANIFEST: &str = "MANIFEST.json";

/// File name of the digests.
const SUMS: &str = "SHA256SUMS";

/// Manifest of a pack.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// Version of the format: `ninebit-vectors-1`.
    pub format: String,
    /// Version of the program that wrote it.
    pub version: String,
    /// The model's [`BEHAVIOUR`] when it was written.
    pub behaviour_rev: u32,
    /// Name of the chip.
    pub profile: String,
    /// L0, L1 or L2.
    pub level: String,
    /// The seed of the random rows.
    pub seed: u64,
    /// Whether the tables have only rows that a policy or a reading changes.
    pub deciding: bool,
    /// SPDX identifier of the licence.
    pub license: String,
    /// The files, sorted by path.
    pub files: Vec<File>,
    /// SHA-256 of the lines of SHA256SUMS, in hexadecimal.
    pub root: String,
}

/// A file of a pack.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct File {
    /// Path inside the pack, with `/` as separator.
    pub path: String,
    /// Name of the unit; empty for the licence and schemas.
    pub unit: String,
    /// Size of the file in bytes.
    pub bytes: u64,
    /// Number of rows.
    pub rows: usize,
    /// Number of rows that could be drawn and are left out: a unit has at most [`BATCHES`](super::gpu::write::BATCHES).
    #[serde(default, skip_serializing_if = "is_zero")]
    pub left_out: usize,
    /// SHA-256 of the file, in hexadecimal.
    pub sha256: String,
}

fn is_zero(rows: &usize) -> bool {
    *rows == 0
}

/// Options of an export.
#[derive(Clone, Debug)]
pub struct Options {
    /// The chip whose rules the tables follow.
    pub profile: Profile,
    /// The level, which limits the rows of each table.
    pub level: Level,
    /// The seed of the random rows.
    pub seed: u64,
    /// The units whose tables are written.
    pub units: Vec<&'static dyn Unit>,
    /// Whether to write only rows that a policy or a reading changes.
    pub deciding: bool,
    /// The views that are written beside the tables.
    pub views: Vec<View>,
}

/// A file of a pack that is being written; it hashes and counts its bytes.
struct Hashing {
    path: String,
    file: PendingFile,
    hash: Sha256,
    bytes: u64,
}

impl Hashing {
    fn create(folder: &Path, path: String) -> Result<Hashing, VectorError> {
        let file = PendingFile::create(&folder.join(&path))?;
        Ok(Hashing { path, file, hash: Sha256::new(), bytes: 0 })
    }

    fn add(&mut self, content: impl AsRef<[u8]>) -> Result<(), VectorError> {
        let bytes = content.as_ref();
        self.hash.update(bytes);
        self.bytes += bytes.len() as u64;
        Ok(self.file.write_all(bytes).map_err(|error| self.file.refused(error))?)
    }

    /// Renames the file to its final name.
    fn finish(self, unit: &str, rows: usize) -> Result<File, VectorError> {
        self.file.commit()?;
        let sha256 = hexadecimal(&self.hash.finalize());
        Ok(File { path: self.path, unit: unit.to_owned(), bytes: self.bytes, rows, left_out: 0, sha256 })
    }
}

/// Returns path and text of the files that every pack has besides its tables.
fn always() -> impl Iterator<Item = (&'static str, &'static str)> {
    std::iter::once(("LICENSE", ninebit_data::LICENSE)).chain(ninebit_data::SCHEMAS)
}

/// Returns the digests as lines of `sha256sum`.
fn sums(files: &[File]) -> String {
    files.iter().map(|file| format!("{}  {}\n", file.sha256, file.path)).collect()
}

/// Writes a pack into `folder`, which is created.
///
/// A pack that is there is replaced as a whole when the new one is, and what it does not list stays. Where its folder
/// [cannot be renamed](PendingFolder::replacing), its manifest is removed first. The new manifest is written last, so that an interrupted export
/// leaves none.
///
/// # Errors
/// Returns an error if the folder or a file in it cannot be written.
pub fn export(folder: &Path, options: &Options) -> Result<Manifest, VectorError> {
    let manifest_path = folder.join(MANIFEST);
    let earlier = manifest_path.is_file();
    if let Some(beside) = if earlier { PendingFolder::replacing(folder)? } else { None } {
        let listed = match manifest(folder) {
            Ok(earlier) => earlier.files,
            // Nothing says what else belongs to it.
            Err(VectorError::Invalid { .. }) => Vec::new(),
            Err(error) => return Err(error),
        };
        let listed: HashSet<&str> = listed.iter().map(|file| file.path.as_str()).chain([MANIFEST, SUMS]).collect();
        let is_listed = |path: &Path| path.to_str().is_some_and(|path| listed.contains(&*path.replace('\\', "/")));
        let fill = || {
            let written = write(beside.path(), options)?;
            beside.take_over(&|path| !is_listed(path))?;
            Ok(written)
        };
        let written = fill().map_err(|error: VectorError| error.named(beside.path(), folder))?;
        beside.commit()?;
        return Ok(written);
    }
    if earlier {
        // From now on the files of an earlier export are no pack.
        std::fs::remove_file(&manifest_path)
            .map_err(|source| OutputError::Write { path: manifest_path.clone(), source })?;
    }
    write(folder, options)
}

/// Writes the files of a pack into a folder, its manifest last.
fn write(folder: &Path, options: &Options) -> Result<Manifest, VectorError> {
    make_folder(folder)?;
    for part in FOLDERS {
        make_folder(&folder.join(part))?;
    }
    let tables = || options.units.par_iter().map(|unit| export_unit(folder, *unit, options)).collect();
    let written: Result<Vec<Vec<File>>, VectorError> = on_threads(0, tables);
    let written = written?;
    let mut files: Vec<File> = written.into_iter().flatten().collect();
    for (path, text) in always() {
        let mut file = Hashing::create(folder, path.to_owned())?;
        file.add(text)?;
        files.push(file.finish("", 0)?);
    }
    files.sort_by(|a, b| a.path.cmp(&b.path));
    let manifest = Manifest {
        format: FORMAT.to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        behaviour_rev: BEHAVIOUR,
        profile: options.profile.name().to_owned(),
        level: options.level.name().to_owned(),
        seed: options.seed,
        deciding: options.deciding,
        license: "CC0-1.0".to_owned(),
        root: hexadecimal(&Sha256::digest(sums(&files))),
        files,
    };
    write_file(&folder.join(SUMS), sums(&manifest.files).as_bytes())?;
    let text = serde_json::to_string_pretty(&manifest).unwrap_or_default() + "\n";
    write_file(&folder.join(MANIFEST), text.as_bytes())?;
    Ok(manifest)
}

/// Writes a unit's table and views. Each row is computed once.
fn export_unit(folder: &Path, unit: &'static dyn Unit, options: &Options) -> Result<Vec<File>, VectorError> {
    let Options { profile, level, seed, deciding, .. } = *options;
    let writer = Writer::new(Contents { unit, profile, level, seed });
    let layout = Layout::new(&writer);
    let mut files = Vec::new();
    for (extension, content) in [TABLE].into_iter().chain(options.views.iter().flat_map(|view| view.files())) {
        let mut file = Hashing::create(folder, format!("units/{}.{extension}", unit.name()))?;
        file.add(&match content {
            Content::Whole(text) => text(&layout),
            Content::Rows(head, _) => head(&writer),
        })?;
        files.push((file, content));
    }
    let mut batches = options.views.contains(&View::Gpu).then(|| Batches::new(&writer));
    let rows = writer.each(deciding, |row| {
        if let Some(batches) = &mut batches {
            batches.take(row);
        }
        for (file, content) in &mut files {
            if let Content::Rows(_, line) = content {
                file.add(&(line(&layout, row) + "\n"))?;
            }
        }
        Ok::<(), VectorError>(())
    })?;
    // A file without rows counts none.
    let own = |content| if matches!(content, Content::Rows(..)) { rows } else { 0 };
    let files = files.into_iter().map(|(file, content)| file.finish(unit.name(), own(content)));
    let mut files = files.collect::<Result<Vec<File>, _>>()?;
    if let Some(drawn) = batches.and_then(Batches::finish) {
        for (extension, bytes) in [("gpu.txt", drawn.text.as_bytes()), ("gpu.raw", &drawn.raw)] {
            let mut file = Hashing::create(folder, format!("units/{}.{extension}", unit.name()))?;
            file.add(bytes)?;
            files.push(File { left_out: drawn.left_out, ..file.finish(unit.name(), drawn.rows)? });
        }
    }
    Ok(files)
}

/// Reads the manifest of a pack.
///
/// # Errors
/// Returns an error if it does not exist or is not valid.
pub fn manifest(folder: &Path) -> Result<Manifest, VectorError> {
    let path = folder.join(MANIFEST);
    let missing = "name the folder of a pack; an export that was broken off leaves no manifest: export again";
    let text = read_text(&path, Kind::Regular, limits::MANIFEST, missing)?;
    let invalid = |message: &str, help| VectorError::file("NB1010", &path, message, help);
    let no_manifest = |error| invalid(&format!("not a manifest: {error}"), "export the pack again");
    let value: serde_json::Value = serde_json::from_str(&text).map_err(no_manifest)?;
    let format = value.get("format").and_then(|format| format.as_str()).unwrap_or_default();
    if format != FORMAT {
        let message = format!("the format is `{format:.60}`, not `{FORMAT}`");
        return Err(VectorError::file("NB1003", &path, message, "use the program that wrote it, or export again"));
    }
    let manifest: Manifest = serde_json::from_value(value).map_err(no_manifest)?;
    let inside = |file: &File| {
        let name = file.path.strip_prefix("units/").unwrap_or_default();
        let plain = name.bytes().all(|b| b.is_ascii_alphanumeric() || matches!(b, b'-' | b'.' | b'_'));
        (!name.is_empty() && plain && !name.contains("..")) || always().any(|(path, _)| path == file.path)
    };
    if let Some(file) = manifest.files.iter().find(|file| !inside(file)) {
        return Err(invalid(&format!("`{:.60}` is no file of a pack", file.path), "export the pack again"));
    }
    if !manifest.files.is_sorted_by(|a, b| a.path < b.path) {
        return Err(invalid("a file stands twice, or not in order", "export the pack again"));
    }
    if hexadecimal(&Sha256::digest(sums(&manifest.files))) != manifest.root {
        return Err(invalid("its root is not that of its files", "it was changed by hand: export again"));
    }
    Ok(manifest)
}

/// Finds a row by its id, in a pack or in one of its tables. Returns the table with this row alone.
///
/// # Errors
/// Returns an error if the pack's manifest or a table cannot be read, if there is no such row, or if it cannot be read or is not as its id says.
pub fn find(place: &Path, id: &str) -> Result<(PathBuf, Table), VectorError> {
    let tables = match place.extension().is_some_and(|extension| extension == "tsv") {
        true => vec![place.to_path_buf()],
        false => {
            let files = manifest(place)?.files.into_iter().map(|file| place.join(file.path));
            files.filter(|path| path.extension().is_some_and(|extension| extension == "tsv")).collect()
        }
    };
    for path in tables {
        let text = read_text(&path, Kind::Regular, limits::VECTOR_TABLE, "the pack is not whole")?;
        let Some(at) = text.find(&format!("\n{id}\t")).map(|newline| newline + 1) else { continue };
        // The row is read behind the head of its table, and so held to it.
        let names = text.find("\nid\t").map_or(0, |newline| newline + 1);
        let head = text[..at].get(..names).unwrap_or_default();
        let columns = text[names..].lines().next().unwrap_or_default();
        let row = text[at..].lines().next().unwrap_or_default();
        let mut table = parse(&format!("{head}{columns}\n{row}\n"), &path)?;
        table.rows.iter_mut().for_each(|found| found.line = 1 + text[..at].matches('\n').count());
        return Ok((path, table));
    }
    let help = "ids are the first column of tables: twelve hexadecimal digits";
    Err(VectorError::file("NB1014", place, format!("there is no row `{:.40}`", ninebit::shown::name(id)), help))
}

/// Opens a pack: checks its files against the manifest, and reads its tables.
///
/// # Errors
/// Returns an error if a file is missing, changed or not listed, or if a table cannot be read or is of another chip, level, seed or behaviour.
pub fn open(folder: &Path) -> Result<(Manifest, Vec<Table>), VectorError> {
    let manifest = manifest(folder)?;
    let listed: Vec<PathBuf> = manifest.files.iter().map(|file| folder.join(&file.path)).collect();
    for (file, path) in manifest.files.iter().zip(&listed) {
        // No more bytes are read than the manifest lists.
        let listed = FileLimit { name: "bytes", bytes: file.bytes, counted: "bytes that the manifest lists" };
        let mut digest = Sha256::new();
        let length = match read::parts(path, Kind::Regular, listed, |part| digest.update(part)) {
            Ok(length) => length,
            Err(ReadError::TooLarge(_)) => path.metadata().map_or(u64::MAX, |metadata| metadata.len()),
            Err(error) => return Err(unread(error, path, "the manifest lists it: the pack is not whole")),
        };
        if length != file.bytes || hexadecimal(&digest.finalize()) != file.sha256 {
            let message = format!("not the file that the manifest lists ({length} bytes, {} there)", file.bytes);
            let help = "it was changed or cut off since the export: export again";
            return Err(VectorError::file("NB1011", path, message, help));
        }
    }
    let mut others = Vec::new();
    for part in FOLDERS {
        let part = folder.join(part);
        let missing = |_| VectorError::missing(&part, "the manifest lists files in it: the pack is not whole");
        let entries = std::fs::read_dir(&part).map_err(missing)?;
        let entries = entries.flatten().filter(|entry| !is_leftover(&entry.file_name()));
        others.extend(entries.map(|entry| entry.path()).filter(|path| !listed.contains(path)));
    }
    others.sort();
    if let Some(path) = others.first() {
        let message = "the manifest does not list this file";
        return Err(VectorError::file("NB1012", path, message, "take it out of the pack"));
    }
    let read = || {
        listed
            .par_iter()
            .zip(&manifest.files)
            .filter(|(path, _)| path.extension().is_some_and(|extension| extension == "tsv"))
            .map(|(path, file)| {
                let table =
                    parse(&read_text(path, Kind::Regular, limits::VECTOR_TABLE, "the pack is not whole")?, path)?;
                let Contents { profile, level, seed, .. } = table.writer.contents();
                let own = (profile.name(), level.name(), seed, table.behaviour, table.rows.len());
                let Manifest { profile, level, seed, behaviour_rev, .. } = &manifest;
                if own != (profile.as_str(), level.as_str(), *seed, *behaviour_rev, file.rows) {
                    let message = "its chip, level, seed, behaviour or number of rows is not the manifest's";
                    return Err(VectorError::file("NB1011", path, message, "it belongs to another pack: export again"));
                }
                Ok(table)
            })
            .collect()
    };
    let tables: Result<Vec<Table>, VectorError> = on_threads(0, read);
    Ok((manifest, tables?))
}
