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
use std::io::{self, Write};

use super::{Case, Placement, recipes};
use crate::state::Named;
use crate::vectors::BEHAVIOUR;
use crate::vectors::table::Writer;

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

/// The batches of a unit, by their state.
fn batches(writer: &Writer, deciding: bool) -> io::Result<Vec<Batch>> {
    let contents = writer.contents();
    let recipes = recipes(contents.unit.name());
    let mut open: BTreeMap<String, Vec<Batch>> = BTreeMap::new();
    writer.each(deciding, |row| {
        let case = Case { inputs: writer.inputs(), results: writer.results(), row, profile: contents.profile };
        for placement in recipes.iter().filter_map(|recipe| recipe(&case)) {
            let batches = open.entry(key(&placement)).or_default();
            if batches.last().is_none_or(|batch| batch.rows == ROWS) {
                let sources = vec![Vec::new(); placement.sources.len()];
                let placement = placement.clone();
                batches.push(Batch { ids: Vec::new(), placement, sources, rows: 0, deciding: false });
            }
            let Some(batch) = batches.last_mut() else { continue };
            batch.ids.extend(id_bytes(&writer.id(&row.inputs)));
            for (all, (_, bytes)) in batch.sources.iter_mut().zip(placement.sources) {
                all.extend(bytes);
            }
            batch.rows += 1;
            batch.deciding |= !row.alternatives.is_empty();
        }
        Ok(())
    })?;
    let mut batches: Vec<Batch> = open.into_values().flatten().collect();
    if batches.len() > BATCHES {
        batches.sort_by_key(|batch| !batch.deciding);
        batches.truncate(BATCHES);
    }
    // The path first, so that a reader that skips one skips it at once.
    batches.sort_by_key(|batch| batch.placement.path);
    Ok(batches)
}

/// Twelve hexadecimal digits as six bytes.
fn id_bytes(id: &str) -> Vec<u8> {
    let digit = |c: u8| char::from(c).to_digit(16).unwrap_or(0) as u8;
    id.as_bytes().chunks(2).map(|pair| pair.iter().fold(0, |byte, c| byte << 4 | digit(*c))).collect()
}

/// Writes the text; returns how many rows are asked.
///
/// # Errors
/// The destination refuses.
pub fn text(writer: &Writer, deciding: bool, out: &mut dyn Write) -> io::Result<usize> {
    let contents = writer.contents();
    let batches = batches(writer, deciding)?;
    writeln!(out, "ninebit-gpu 1\nunit {}\nprofile {}", contents.unit.name(), contents.profile.name())?;
    writeln!(out, "level {}\nseed {}\nbehaviour {BEHAVIOUR}", contents.level.name(), contents.seed)?;
    let mut columns: Vec<&str> = Vec::new();
    let reads = batches.iter().flat_map(|batch| &batch.placement.draws).flat_map(|draw| &draw.reads);
    for read in reads {
        if !columns.contains(&read.column.as_str()) {
            columns.push(&read.column);
        }
    }
    writeln!(out, "columns {}", columns.join(" "))?;
    let (mut place, mut rows) = (0, 0);
    for batch in &batches {
        let Batch { placement, .. } = batch;
        writeln!(out, "batch {} {}", batch.rows, placement.path.word())?;
        for needs in &placement.needs {
            writeln!(out, "needs {needs}")?;
        }
        writeln!(out, "ids {place}")?;
        place += batch.ids.len();
        for ((name, bytes), all) in placement.sources.iter().zip(&batch.sources) {
            writeln!(out, "source {name} {} {place}", bytes.len())?;
            place += all.len();
        }
        for line in &placement.state {
            writeln!(out, "{line}")?;
        }
        for draw in &placement.draws {
            writeln!(out, "draw")?;
            for line in &draw.state {
                writeln!(out, "{line}")?;
            }
            for read in &draw.reads {
                let channel = ["R", "G", "B", "A"][read.channel];
                writeln!(out, "read {} {channel} {}", read.column, read.weight)?;
            }
        }
        writeln!(out, "end")?;
        rows += batch.rows;
    }
    Ok(rows)
}

/// Writes the bytes that the text names; returns how many rows are asked.
///
/// # Errors
/// The destination refuses.
pub fn raw(writer: &Writer, deciding: bool, out: &mut dyn Write) -> io::Result<usize> {
    let mut rows = 0;
    for batch in batches(writer, deciding)? {
        out.write_all(&batch.ids)?;
        for bytes in &batch.sources {
            out.write_all(bytes)?;
        }
        rows += batch.rows;
    }
    Ok(rows)
}
