//! A committed expectation, which allows a captured frame to be compared without the frame itself.

use serde::Deserialize;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

/// Rows from the first to the last number have the same runs, each with its first and last column.
type Rows = (u32, u32, Vec<(u32, u32)>);

/// The contents of `vectors/silicon/frames/NAME.ron`. Values have 24 bits: R, G, B, or a depth.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expectation {
    /// Version of the format, 1.
    pub version: u32,
    /// Name of the case.
    pub case: String,
    /// Path of the picture among the golden results.
    pub capture: String,
    /// Number of pixels that are compared.
    pub pixels: usize,
    /// The pixels that are compared.
    pub mask: Vec<Rows>,
    /// SHA-256 over the pixels that are compared except for those of `differing`, row by row: x and y with two bytes each and the value
    /// with three, all high byte first.
    pub sha256: String,
    /// Pixels at which the model is known to differ: x, y, captured value, value of the model.
    pub differing: Vec<(u32, u32, u32, u32)>,
}

/// The pixels that are compared, row by row, each with its value.
pub type Values = Vec<((u32, u32), u32)>;

impl Expectation {
    /// Returns the path of an expectation.
    pub fn path(name: &str) -> PathBuf {
        crate::repository::at("vectors/silicon/frames").join(format!("{name}.ron"))
    }

    /// Reads the text of an expectation.
    pub fn parse(text: &str) -> Expectation {
        let expectation: Expectation = ron::from_str(text).unwrap();
        assert_eq!(expectation.version, 1);
        expectation
    }

    /// Returns the pixels of the mask.
    pub fn positions(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        self.mask.iter().flat_map(|(first, last, runs)| {
            (*first..=*last)
                .flat_map(move |y| runs.iter().flat_map(move |(from, to)| (*from..=*to).map(move |x| (x, y))))
        })
    }

    /// Returns the text of an expectation. Pixels at which `captured` and `ours` agree are hashed, others are listed.
    pub fn text(case: &str, capture: &str, captured: &Values, ours: &Values) -> String {
        let mut out = format!(
            "(\n    version: 1,\n    case: \"{case}\",\n    capture: \"{capture}\",\n    pixels: {},\n    mask: [\n",
            captured.len()
        );
        for (first, last, runs) in mask(captured) {
            let runs: Vec<String> = runs.iter().map(|(from, to)| format!("({from},{to})")).collect();
            writeln!(out, "        ({first}, {last}, [{}]),", runs.join(",")).unwrap();
        }
        let differs = |n: &usize| captured[*n].1 != ours[*n].1;
        let equal: Values = (0..captured.len()).filter(|n| !differs(n)).map(|n| captured[n]).collect();
        writeln!(out, "    ],\n    sha256: \"{}\",\n    differing: [", digest(&equal)).unwrap();
        let different: Vec<usize> = (0..captured.len()).filter(differs).collect();
        // Four in each line, because thousands of depths may differ.
        for line in different.chunks(4) {
            let items: Vec<String> = line
                .iter()
                .map(|n| format!("({},{},{},{})", captured[*n].0.0, captured[*n].0.1, captured[*n].1, ours[*n].1))
                .collect();
            writeln!(out, "        {},", items.join(", ")).unwrap();
        }
        out + "    ],\n)\n"
    }
}

/// Returns the SHA-256 of positions and values.
pub fn digest(values: &[((u32, u32), u32)]) -> String {
    let mut hash = Sha256::new();
    for ((x, y), value) in values {
        hash.update((*x as u16).to_be_bytes());
        hash.update((*y as u16).to_be_bytes());
        hash.update(&value.to_be_bytes()[1..]);
    }
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Returns positions as runs, where adjacent rows with equal runs are combined.
fn mask(values: &Values) -> Vec<Rows> {
    let mut rows: BTreeMap<u32, Vec<(u32, u32)>> = BTreeMap::new();
    for ((x, y), _) in values {
        let runs = rows.entry(*y).or_default();
        match runs.last_mut() {
            Some((_, to)) if *to + 1 == *x => *to = *x,
            _ => runs.push((*x, *x)),
        }
    }
    let mut merged: Vec<Rows> = Vec::new();
    for (y, runs) in rows {
        match merged.last_mut() {
            Some((_, last, same)) if *last + 1 == y && *same == runs => *last = y,
            _ => merged.push((y, y, runs)),
        }
    }
    merged
}
