//! Which rows a table has: those that are always there, boundaries, and seeded random ones.

use std::collections::HashSet;

use super::{Column, Domain, Unit};
use ninebit::random::{Random, mix};
use ninebit::state::{Profile, named};

named! {
    /// The number of rows that a table has.
    pub enum Level =>
    /// The most rows of a table.
    rows: usize {
        /// Committed, checked in a second.
        L0 => 1_000,
        /// Boundaries crossed, and random rows.
        L1 => 60_000,
        /// More of these.
        L2 => 5_000_000,
    }
}

named! {
    /// Why a row is there.
    pub enum Origin =>
    /// The word in the table.
    word: &'static str {
        /// An example, or something that was once wrong.
        Regression => "regression",
        /// The table has every row that there is.
        Exhaustive => "exhaustive",
        /// Every input is at a boundary of its column.
        Boundary => "boundary",
        /// Drawn by the seeded generator.
        Random => "random",
    }
}

/// How many rows there are at all.
pub fn size(columns: &[Column]) -> u128 {
    columns.iter().fold(1, |size, column| size.saturating_mul(column.size()))
}

/// The row of that place among all; the last column counts fastest.
pub fn nth(columns: &[Column], mut place: u128, row: &mut [i64]) {
    for (column, value) in columns.iter().zip(row).rev() {
        let size = column.size();
        *value = column.nth(place % size);
        place /= size;
    }
}

/// Calls `each` with the inputs of every row of a table, in its order, which depends on nothing but the arguments.
pub fn visit(unit: &dyn Unit, profile: Profile, level: Level, seed: u64, each: impl FnMut(&[i64], Origin)) {
    let columns = unit.inputs();
    let rows = level.rows();
    let mut sieve = Sieve { unit, profile, seen: HashSet::new(), rows, each };
    for row in unit.regressions() {
        sieve.give(&row, Origin::Regression);
    }
    let mut row = vec![0; columns.len()];
    if size(&columns) <= rows as u128 {
        for place in 0..size(&columns) {
            nth(&columns, place, &mut row);
            sieve.give(&row, Origin::Exhaustive);
        }
        return;
    }
    let boundaries: Vec<Vec<i64>> = columns.iter().map(Column::boundary).collect();
    let crossed = boundaries.iter().fold(1_u128, |size, values| size.saturating_mul(values.len() as u128));
    let mut random = Random::new(seed, unit.name());
    if crossed <= rows as u128 / 2 {
        for mut place in 0..crossed {
            for (values, value) in boundaries.iter().zip(&mut row).rev() {
                *value = values[(place % values.len() as u128) as usize];
                place /= values.len() as u128;
            }
            sieve.give(&row, Origin::Boundary);
        }
    } else {
        sieve.draw(rows / 2, &mut row, Origin::Boundary, |row| {
            for (values, value) in boundaries.iter().zip(row) {
                *value = random.pick(values).unwrap_or_default();
            }
        });
    }
    sieve.draw(rows, &mut row, Origin::Random, |row| {
        // Where most columns are anything, one at a boundary tells more than none.
        for ((column, values), value) in columns.iter().zip(&boundaries).zip(row) {
            *value =
                if random.once_in(4) { random.pick(values).unwrap_or_default() } else { draw(column, &mut random) };
        }
    });
}

/// A number of a column.
fn draw(column: &Column, random: &mut Random) -> i64 {
    match column.domain {
        // Half of the floats are spread over 0..1, the others over the exponents.
        Some(Domain::Float(negative, limit)) => {
            let sign = if negative { (random.bits() as u32) & 0x8000_0000 } else { 0 };
            let exponent = match random.once_in(2) {
                true => 126 - (random.bits().trailing_zeros().min(30)),
                false => (127 + limit - 1 - random.below(24) as i32).clamp(0, 254) as u32,
            };
            i64::from(sign | exponent << 23 | random.bits() as u32 & 0x007f_ffff)
        }
        _ => column.nth(random.below(column.size())),
    }
}

/// Lets rows through that make sense and were not there yet.
struct Sieve<'u, F> {
    unit: &'u dyn Unit,
    profile: Profile,
    seen: HashSet<u64>,
    rows: usize,
    each: F,
}

impl<F: FnMut(&[i64], Origin)> Sieve<'_, F> {
    fn give(&mut self, row: &[i64], origin: Origin) {
        if self.seen.len() >= self.rows || !self.unit.accepts(row, self.profile) {
            return;
        }
        if self.seen.insert(row.iter().fold(0, |sum, value| mix(sum ^ *value as u64))) {
            (self.each)(row, origin);
        }
    }

    /// Draws rows until there are so many, or no new ones come.
    fn draw(&mut self, rows: usize, row: &mut [i64], origin: Origin, mut draw: impl FnMut(&mut [i64])) {
        for _ in 0..rows.saturating_mul(20) {
            if self.seen.len() >= rows {
                return;
            }
            draw(row);
            self.unit.fit(row);
            self.give(row, origin);
        }
    }
}
