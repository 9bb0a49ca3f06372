//! Batch files: `UNIT.gpu.txt` describes the draws, `UNIT.gpu.raw` holds the rows' bytes.
//!
//! ```text
//! ninebit-gpu 1
//! unit product
//! profile Nv2a
//! level L1
//! seed 1
//! behaviour 1
//! columns out.ab
//! batch 9000 combiners
//! needs GL_NV_register_combiners
//! ids 0
//! source texture0 4 54000
//! portion 0 RGB TEXTURE0_ARB UNSIGNED_IDENTITY_NV RGB ...
//! draw
//! combiners 1
//! final VARIABLE_D_NV SPARE0_NV UNSIGNED_IDENTITY_NV RGB
//! read out.ab R 1
//! draw
//! ...
//! end
//! ```
//!
//! The numbers after a source's name are the bytes per row and the offset of the first in the raw file. An id takes six bytes there.

use std::collections::BTreeMap;

use super::{Case, Placement, recipes};
use crate::{BEHAVIOUR, Contents, Row, Writer};
use ninebit::state::Named;

/// Maximum number of rows in a batch: a draw of 256 by 256 pixels.
const ROWS: usize = 65_536;

/// Maximum number of batches of a unit. Of a unit with more configurations only a part of the rows is drawn; batches that a policy or a reading
/// changes come first.
pub const BATCHES: usize = 1_000;

/// Rows that share their state.
#[derive(Debug)]
struct Batch {
    ids: Vec<u8>,
    placement: Placement,
    /// Bytes of all rows, for each source.
    sources: Vec<Vec<u8>>,
    rows: usize,
    /// Whether a policy or a reading changes one of its rows.
    deciding: bool,
}

/// Returns the key of a batch: everything that its rows have to share.
fn key(placement: &Placement) -> String {
    let draws = placement.draws.iter().map(|draw| draw.state.join("\n"));
    let sources = placement.sources.iter().map(|(name, bytes)| format!("{name} {}", bytes.len()));
    let lines = placement.state.iter().cloned().chain(draws).chain(sources).collect::<Vec<_>>();
    format!("{}\n{}", placement.path.word(), lines.join("\n"))
}

/// Collects the rows of a table into batches.
#[derive(Debug)]
pub(crate) struct Batches<'w> {
    writer: &'w Writer,
    /// Batches by their key.
    open: BTreeMap<String, Vec<Batch>>,
}

/// The two files of a unit.
#[derive(Debug)]
pub(crate) struct BatchFiles {
    /// Content of `UNIT.gpu.txt`.
    pub(crate) text: String,
    /// Content of `UNIT.gpu.raw`.
    pub(crate) raw: Vec<u8>,
    /// Number of rows that are drawn; a row that is drawn by two paths counts twice.
    pub(crate) rows: usize,
    /// Number of rows that are left out because of [`BATCHES`].
    pub(crate) left_out: usize,
}

impl<'w> Batches<'w> {
    /// Returns an empty collection for a table.
    pub(crate) fn new(writer: &'w Writer) -> Batches<'w> {
        Batches { writer, open: BTreeMap::new() }
    }

    /// Adds a row, if the unit has a recipe for it that OpenGL takes.
    pub(crate) fn take(&mut self, row: &Row) {
        let Contents { unit, profile, .. } = self.writer.contents();
        let case = Case { inputs: self.writer.inputs(), results: self.writer.results(), row, profile };
        let placements = recipes(unit.name()).iter().filter_map(|recipe| recipe(&case));
        for placement in placements.filter(|placement| !placement.is_refused()) {
            let batches = self.open.entry(key(&placement)).or_default();
            if batches.last().is_none_or(|batch| batch.rows == ROWS) {
                let sources = vec![Vec::new(); placement.sources.len()];
                let placement = placement.clone();
                batches.push(Batch { ids: Vec::new(), placement, sources, rows: 0, deciding: false });
            }
            let Some(batch) = batches.last_mut() else { continue };
            batch.ids.extend(id_bytes(&self.writer.id(&row.inputs)));
            for (all, (_, bytes)) in batch.sources.iter_mut().zip(placement.sources) {
                all.extend(bytes);
            }
            batch.rows += 1;
            batch.deciding |= !row.alternatives.is_empty();
        }
    }

    /// Returns the files, or `None` for a unit without recipes.
    pub(crate) fn finish(self) -> Option<BatchFiles> {
        if recipes(self.writer.contents().unit.name()).is_empty() {
            return None;
        }
        let mut batches: Vec<Batch> = self.open.into_values().flatten().collect();
        let count = |batches: &[Batch]| batches.iter().map(|batch| batch.rows).sum::<usize>();
        let all = count(&batches);
        if batches.len() > BATCHES {
            batches.sort_by_key(|batch| !batch.deciding);
            batches.truncate(BATCHES);
        }
        // Sorted by path, so that a reader skips an unsupported path at once.
        batches.sort_by_key(|batch| batch.placement.path);
        let mut raw = Vec::new();
        for batch in &batches {
            raw.extend_from_slice(&batch.ids);
            batch.sources.iter().for_each(|bytes| raw.extend_from_slice(bytes));
        }
        let rows = count(&batches);
        Some(BatchFiles { text: text(self.writer, &batches), raw, rows, left_out: all - rows })
    }
}

/// Converts twelve hexadecimal digits to six bytes.
fn id_bytes(id: &str) -> Vec<u8> {
    let digit = |c: u8| char::from(c).to_digit(16).unwrap_or(0) as u8;
    id.as_bytes().chunks(2).map(|pair| pair.iter().fold(0, |byte, c| byte << 4 | digit(*c))).collect()
}

/// Returns the lines of all batches.
fn text(writer: &Writer, batches: &[Batch]) -> String {
    let contents = writer.contents();
    let mut columns: Vec<&str> = Vec::new();
    let reads = batches.iter().flat_map(|batch| &batch.placement.draws).flat_map(|draw| &draw.reads);
    for read in reads {
        if !columns.contains(&read.column.as_str()) {
            columns.push(&read.column);
        }
    }
    let mut lines = vec![
        "ninebit-gpu 1".to_owned(),
        format!("unit {}", contents.unit.name()),
        format!("profile {}", contents.profile.name()),
        format!("level {}", contents.level.name()),
        format!("seed {}", contents.seed),
        format!("behaviour {BEHAVIOUR}"),
        format!("columns {}", columns.join(" ")),
    ];
    let mut place = 0;
    for batch in batches {
        let Batch { placement, .. } = batch;
        lines.push(format!("batch {} {}", batch.rows, placement.path.word()));
        lines.extend(placement.needs.iter().map(|needs| format!("needs {needs}")));
        lines.push(format!("ids {place}"));
        place += batch.ids.len();
        for ((name, bytes), all) in placement.sources.iter().zip(&batch.sources) {
            lines.push(format!("source {name} {} {place}", bytes.len()));
            place += all.len();
        }
        lines.extend_from_slice(&placement.state);
        for draw in &placement.draws {
            lines.push("draw".to_owned());
            lines.extend_from_slice(&draw.state);
            for read in &draw.reads {
                let channel = ["R", "G", "B", "A", "S"][read.channel];
                lines.push(format!("read {} {channel} {}", read.column, read.weight));
            }
        }
        lines.push("end".to_owned());
    }
    lines.join("\n") + "\n"
}
