//! Batches as files: `UNIT.gpu.txt` says what is drawn, `UNIT.gpu.raw` holds what the rows bring.
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
//! Numbers after a source are the bytes of a row and the place of the first in the raw file. An id takes six bytes there.

use std::collections::BTreeMap;

use super::{Case, Placement, recipes};
use crate::{BEHAVIOUR, Contents, Row, Writer};
use ninebit::state::Named;

/// Rows of a batch: a draw of 256 by 256 pixels.
pub const ROWS: usize = 65_536;

/// Batches of a unit. A unit with more configurations than these is asked of a part of its rows; those that a policy changes come first.
pub const BATCHES: usize = 1_000;

/// Rows that share their state.
#[derive(Debug)]
struct Batch {
    ids: Vec<u8>,
    placement: Placement,
    /// Bytes of all rows, source by source.
    sources: Vec<Vec<u8>>,
    rows: usize,
    /// Some policy changes a row of it.
    deciding: bool,
}

/// Everything that rows of a batch have to share.
fn key(placement: &Placement) -> String {
    let draws = placement.draws.iter().map(|draw| draw.state.join("\n"));
    let sources = placement.sources.iter().map(|(name, bytes)| format!("{name} {}", bytes.len()));
    let lines = placement.state.iter().cloned().chain(draws).chain(sources).collect::<Vec<_>>();
    format!("{}\n{}", placement.path.word(), lines.join("\n"))
}

/// The batches of a table, row by row.
#[derive(Debug)]
pub struct Batches<'w> {
    writer: &'w Writer,
    /// By their state.
    open: BTreeMap<String, Vec<Batch>>,
}

/// The two files of a unit.
#[derive(Debug)]
pub struct Drawn {
    /// What is drawn.
    pub text: String,
    /// What the rows bring.
    pub raw: Vec<u8>,
    /// How many rows are asked; one that two paths ask counts twice.
    pub rows: usize,
    /// How many more could be, beyond [`BATCHES`].
    pub left_out: usize,
}

impl<'w> Batches<'w> {
    /// Of a table whose rows will come.
    pub fn new(writer: &'w Writer) -> Batches<'w> {
        Batches { writer, open: BTreeMap::new() }
    }

    /// Places a row, if the unit has a recipe for it.
    pub fn take(&mut self, row: &Row) {
        let Contents { unit, profile, .. } = self.writer.contents();
        let case = Case { inputs: self.writer.inputs(), results: self.writer.results(), row, profile };
        for placement in recipes(unit.name()).iter().filter_map(|recipe| recipe(&case)) {
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

    /// The files; none for a unit that no frame buffer shows.
    pub fn finish(self) -> Option<Drawn> {
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
        // The path first, so that a reader that skips one skips it at once.
        batches.sort_by_key(|batch| batch.placement.path);
        let mut raw = Vec::new();
        for batch in &batches {
            raw.extend_from_slice(&batch.ids);
            batch.sources.iter().for_each(|bytes| raw.extend_from_slice(bytes));
        }
        let rows = count(&batches);
        Some(Drawn { text: text(self.writer, &batches), raw, rows, left_out: all - rows })
    }
}

/// Twelve hexadecimal digits as six bytes.
fn id_bytes(id: &str) -> Vec<u8> {
    let digit = |c: u8| char::from(c).to_digit(16).unwrap_or(0) as u8;
    id.as_bytes().chunks(2).map(|pair| pair.iter().fold(0, |byte, c| byte << 4 | digit(*c))).collect()
}

/// The lines of all batches.
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
