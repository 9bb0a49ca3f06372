//! Selection of a table's rows: regressions, boundaries and seeded random rows.

use std::collections::HashSet;

use super::{Column, Domain, Unit};
use ninebit::random::{Random, mix};
use ninebit::state::{Profile, named};

named! {
    /// Size class of a table.
    pub enum Level =>
    /// Returns the maximum number of rows of a table.
    rows: usize {
        /// Small: committed to the repository, and checked in a second.
        L0 => 1_000,
        /// Medium: combinations of boundaries, and random rows.
        L1 => 60_000,
        /// Large: more rows of the same kinds.
        L2 => 5_000_000,
    }
}

named! {
    /// Reason why a table has a row.
    pub enum Origin =>
    /// Returns the tag in the table.
    word: &'static str {
        /// An example of the handbook, or a case that was once wrong.
        Regression => "regression",
        /// The table has every possible row.
        Exhaustive => "exhaustive",
        /// Every input is at a boundary of its column.
        Boundary => "boundary",
        /// Drawn by the seeded generator.
        Random => "random",
    }
}

/// Returns the number of possible rows of these columns, saturated.
pub fn size(columns: &[Column]) -> u128 {
    columns.iter().fold(1, |size, column| size.saturating_mul(column.size()))
}

/// Writes the row of index `place` in the enumeration of all rows, in which the last column varies fastest.
pub fn nth(columns: &[Column], mut place: u128, row: &mut [i64]) {
    for (column, value) in columns.iter().zip(row).rev() {
        let size = column.size();
        *value = column.nth(place % size);
        place /= size;
    }
}

/// Calls `each` with the inputs of every row of a table, in the table's order. Rows and order depend on nothing but the arguments.
pub fn visit(unit: &dyn Unit, profile: Profile, level: Level, seed: u64, each: impl FnMut(&[i64], Origin)) {
    let columns = unit.inputs();
    let rows = level.rows();
    let mut filter = RowFilter { unit, profile, seen: HashSet::new(), rows, each };
    for row in unit.regressions() {
        filter.offer(&row, Origin::Regression);
    }
    let mut row = vec![0; columns.len()];
    if size(&columns) <= rows as u128 {
        for place in 0..size(&columns) {
            nth(&columns, place, &mut row);
            filter.offer(&row, Origin::Exhaustive);
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
            filter.offer(&row, Origin::Boundary);
        }
    } else {
        filter.draw(rows / 2, &mut row, Origin::Boundary, |row| {
            for (values, value) in boundaries.iter().zip(row) {
                *value = random.pick(values).unwrap_or_default();
            }
        });
    }
    filter.draw(rows, &mut row, Origin::Random, |row| {
        // A column at its boundary among arbitrary ones tells more than none, so each is at a boundary one time in four.
        for ((column, values), value) in columns.iter().zip(&boundaries).zip(row) {
            *value =
                if random.once_in(4) { random.pick(values).unwrap_or_default() } else { draw(column, &mut random) };
        }
    });
}

/// Draws a number of a column.
fn draw(column: &Column, random: &mut Random) -> i64 {
    match column.domain {
        // Half of the floats are spread evenly over 0..1, the others over the exponents.
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

/// Filter that passes each row once, if the unit accepts it, up to a number of rows.
struct RowFilter<'u, F> {
    unit: &'u dyn Unit,
    profile: Profile,
    seen: HashSet<u64>,
    rows: usize,
    each: F,
}

impl<F: FnMut(&[i64], Origin)> RowFilter<'_, F> {
    fn offer(&mut self, row: &[i64], origin: Origin) {
        if self.seen.len() >= self.rows || !self.unit.accepts(row, self.profile) {
            return;
        }
        if self.seen.insert(row.iter().fold(0, |sum, value| mix(sum ^ *value as u64))) {
            (self.each)(row, origin);
        }
    }

    /// Draws rows until `rows` have passed, or 20 times as many draws have been made.
    fn draw(&mut self, rows: usize, row: &mut [i64], origin: Origin, mut draw: impl FnMut(&mut [i64])) {
        for _ in 0..rows.saturating_mul(20) {
            if self.seen.len() >= rows {
                return;
            }
            draw(row);
            self.unit.fit(row);
            self.offer(row, origin);
        }
    }
}
