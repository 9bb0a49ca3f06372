//! Exhaustive vectors: digests of every row of a unit. `ninebit vectors sweep` computes them; one such run is a sweep.
//!
//! All rows of a unit, in the order of [`cases::nth`], are divided into leaves: ranges whose number depends only on the unit. A leaf is the SHA-256
//! of the rows' `out.` columns. Each number takes as many whole bytes as its bits need, low byte first. Rows that the unit does not accept are left
//! out.

use std::ops::Range;

use serde::{Deserialize, Serialize};

pub use super::digest::Digesting;
use super::digest::{BUFFER, Output};
use super::{Conditions, Part, Unit, cases};
use ninebit::state::{Policies, Profile};
use ninebit_files::picture::hexadecimal;

/// Number of rows in a leaf, unless the sweep has more than [`MAX_LEAVES`] times as many.
const LEAF_ROWS: u64 = 1 << 23;

/// Maximum number of leaves.
const MAX_LEAVES: u64 = 1024;

/// Maximum number of rows of a sweep; more would take too long.
pub const MAX_ROWS: u64 = 1 << 40;

/// The digest of a range of rows.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Leaf {
    /// Index of the leaf, from 0.
    pub index: u64,
    /// Number of rows that the unit accepts.
    pub rows: u64,
    /// Number of rows with an `out.` number that is the least of its type.
    pub low: u64,
    /// Number of rows with an `out.` number that is the greatest of its type.
    pub high: u64,
    /// SHA-256 of the rows' `out.` columns.
    pub sha256: String,
}

/// All rows of a unit, or of a part of it, on one chip.
#[derive(Debug)]
pub struct Exhaustive {
    unit: &'static dyn Unit,
    /// The chip whose rules apply.
    pub(crate) profile: Profile,
    /// The part of the unit's rows.
    part: Part,
    /// Number of rows, including those that the unit does not accept.
    size: u64,
    /// Number of leaves.
    leaves: u64,
    outputs: Vec<Output>,
    results: usize,
}

impl Exhaustive {
    /// Returns the sweep of a whole unit, or `None` if it has more than [`MAX_ROWS`] rows.
    pub fn new(unit: &'static dyn Unit, profile: Profile) -> Option<Exhaustive> {
        Exhaustive::from_part(unit, profile, Part::whole(unit))
    }

    /// Returns the sweep of a part of a unit, or `None` if the part has more than [`MAX_ROWS`] rows.
    pub fn from_part(unit: &'static dyn Unit, profile: Profile, part: Part) -> Option<Exhaustive> {
        let results = unit.results();
        let size = u64::try_from(cases::size(part.columns())).ok().filter(|size| *size <= MAX_ROWS)?;
        let leaves = size.div_ceil(LEAF_ROWS).clamp(1, MAX_LEAVES);
        Some(Exhaustive {
            unit,
            profile,
            part,
            size,
            leaves,
            outputs: Output::from_columns(&results),
            results: results.len(),
        })
    }

    /// Returns the unit.
    pub fn unit(&self) -> &'static dyn Unit {
        self.unit
    }

    /// Returns the part of the unit's rows.
    pub fn part(&self) -> &Part {
        &self.part
    }

    /// Returns the number of rows, including those that the unit does not accept.
    pub fn size(&self) -> u64 {
        self.size
    }

    /// Returns the number of leaves.
    pub fn leaves(&self) -> u64 {
        self.leaves
    }

    /// Returns the range of row indices in a leaf.
    pub fn range(&self, leaf: u64) -> Range<u64> {
        let at = |leaf: u64| (u128::from(self.size) * u128::from(leaf) / u128::from(self.leaves)) as u64;
        at(leaf)..at(leaf + 1)
    }

    /// Computes the digest of a leaf.
    pub fn leaf(&self, index: u64) -> Leaf {
        let digest = self.rows(self.range(index), true);
        let [low, high] = digest.ends;
        Leaf { index, rows: digest.rows, low, high, sha256: hexadecimal(&digest.finish()) }
    }

    /// Returns the SHA-256 of a range of rows.
    pub fn digest(&self, range: Range<u64>) -> [u8; 32] {
        self.rows(range, true).finish()
    }

    /// Digests a range in runs in which only one input varies: the last that has more than one value. `blocks` allows block lanes where the unit has
    /// them.
    fn rows(&self, range: Range<u64>, blocks: bool) -> Digesting<'_> {
        let (mut digest, columns) = (Digesting::new(&self.outputs), self.part.columns());
        let Some(varying) = columns.iter().rposition(|column| column.size() > 1).or(columns.len().checked_sub(1))
        else {
            return digest;
        };
        let column = &columns[varying];
        let conditions = Conditions { profile: self.profile, policies: Policies::DEFAULT };
        // If other columns are tied to this one, they have to be set row by row.
        let most = if self.part.is_followed(varying) { 1 } else { (BUFFER / digest.width) as u64 };
        let length = column.size() as u64;
        let mut inputs = vec![0; columns.len()];
        let mut results = vec![0; self.results];
        let mut place = range.start;
        while place < range.end {
            let start = place % length;
            let run = (length - start).min(range.end - place).min(most);
            cases::nth(columns, u128::from(place), &mut inputs);
            self.part.tie(&mut inputs);
            if !blocks || !self.block(&mut inputs, varying, run, &conditions, &mut digest) {
                self.unit.run(&mut inputs, varying, column, start..start + run, &conditions, &mut results, &mut digest);
            }
            place += run;
        }
        digest
    }

    /// Digests a run in block lanes. Returns `false` if the unit has none for it, or if it does not accept all its rows.
    fn block(
        &self,
        inputs: &mut [i64],
        varying: usize,
        run: u64,
        conditions: &Conditions,
        digest: &mut Digesting,
    ) -> bool {
        if !self.part.columns()[varying].counts() {
            return false;
        }
        let first = inputs[varying];
        inputs[varying] = first + run as i64 - 1;
        let goes = self.unit.accepts(inputs, conditions.profile);
        inputs[varying] = first;
        goes && self.unit.accepts(inputs, conditions.profile)
            && digest.take_block(run, |out| self.unit.block(inputs, varying, conditions, out))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units;
    use ninebit::random::Random;

    #[test]
    fn leaves_cover_all_rows_once() {
        for unit in units::all() {
            let Some(sweep) = Exhaustive::new(unit, Profile::Nv2a) else { continue };
            assert!((1..=MAX_LEAVES).contains(&sweep.leaves));
            let ends: Vec<Range<u64>> = (0..sweep.leaves).map(|leaf| sweep.range(leaf)).collect();
            assert_eq!((ends[0].start, ends[ends.len() - 1].end), (0, sweep.size), "{}", unit.name());
            assert!(ends.windows(2).all(|pair| pair[0].end == pair[1].start && pair[0].start < pair[0].end));
        }
    }

    /// Checks that block lanes yield what the definition yields, row by row, over ranges at arbitrary positions.
    fn compare(sweep: &Exhaustive, starts: usize) {
        let mut random = Random::new(3, sweep.unit.name());
        let rows = sweep.size.min(700);
        let drawn = (0..starts).map(|_| random.below(u128::from(sweep.size - rows + 1)) as u64);
        for start in [0, sweep.size - rows].into_iter().chain(drawn) {
            let range = start..start + rows;
            let plain = sweep.rows(range.clone(), false);
            let blocks = sweep.rows(range, true);
            let name = format!("{} {:?} from {start}", sweep.unit.name(), sweep.part.texts());
            assert_eq!((blocks.rows, blocks.ends), (plain.rows, plain.ends), "{name}");
            assert_eq!(blocks.finish(), plain.finish(), "{name}");
        }
    }

    #[test]
    fn blocks_are_the_definition() {
        for (unit, only) in [("product", &[][..]), ("sum", &[]), ("sum", &["in.d=7"]), ("sum", &["in.b=7", "in.d=256"])]
        {
            let unit = units::by_name(unit).expect("a unit");
            let part = Part::new(unit, only).expect("a part");
            compare(&Exhaustive::from_part(unit, Profile::Nv2a, part).expect("not too large"), 20);
        }
    }

    /// Checks every committed tree of a part in the way that sweeps compute it: in lanes where there are some.
    #[test]
    fn committed_parts_in_blocks_are_the_definition() {
        let digests = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../vectors/digests");
        let list =
            |folder: &std::path::Path| std::fs::read_dir(folder).expect("trees").flatten().map(|entry| entry.path());
        let parts: Vec<_> = list(&digests).filter(|path| path.is_dir()).flat_map(|folder| list(&folder)).collect();
        assert!(parts.len() > 50);
        for path in parts {
            compare(&crate::tree::Tree::read(&path).expect("a tree").1, 3);
        }
    }
}
