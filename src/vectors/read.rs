//! Reads tables, and compares them with the model.

use std::collections::HashMap;
use std::path::Path;

use super::table::{FORMAT, LAST};
use super::{BEHAVIOUR, Column, Conditions, Contents, Level, Origin, Row, VectorError, Writer, lanes, units};
use ninebit::state::{Named, Policies, Profile};

const AGAIN: &str = "export the pack again";

/// A table that was read.
#[derive(Debug)]
pub struct Table {
    /// The behaviour of the model that wrote it.
    pub behaviour: u32,
    /// Writer of the same table; it has the columns.
    pub writer: Writer,
    /// The rows, in the file's order.
    pub rows: Vec<TableRow>,
}

/// A row of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableRow {
    /// Line number in the file, from 1.
    pub line: usize,
    /// The row's id.
    pub id: String,
    /// Values of the input columns.
    pub inputs: Vec<i64>,
    /// Values of the result columns, as the file has them.
    pub results: Vec<i64>,
    /// Reason why the table has it.
    pub origin: Origin,
    /// The line without its end.
    pub text: String,
}

/// The first difference between a row and the model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Line number in the file, from 1.
    pub line: usize,
    /// Id of the row that differs.
    pub id: String,
    /// The first column that differs.
    pub column: String,
    /// Value in the table.
    pub table: String,
    /// Value of the model.
    pub model: String,
    /// Whether only the model's block lanes differ; then the fault is the program's.
    pub in_lanes: bool,
    /// The row as the model computes it.
    pub row: Row,
}

/// Iterates over lines and their numbers.
struct Lines<'t> {
    path: &'t Path,
    lines: std::iter::Enumerate<std::str::Split<'t, char>>,
}

impl<'t> Lines<'t> {
    fn next(&mut self, wanted: &str) -> Result<(usize, &'t str), VectorError> {
        let found = self.lines.next();
        let message = || format!("the file ends where {wanted} should be");
        found.map(|(n, line)| (n + 1, line)).ok_or_else(|| VectorError::file("NB1004", self.path, message(), AGAIN))
    }

    /// Reads the next line as a header line. Returns its line number and value.
    fn field(&mut self, name: &str) -> Result<(usize, &'t str), VectorError> {
        let (line, text) = self.next(&format!("`# {name}`"))?;
        let expected = || format!("`# {name} ...` is expected here");
        let error = || VectorError::line("NB1004", self.path, line, expected(), AGAIN);
        Ok((line, header(text, name).ok_or_else(error)?))
    }
}

/// Returns the value of a header line, or `None` if the line does not have that name.
pub(super) fn header<'t>(line: &'t str, name: &str) -> Option<&'t str> {
    line.strip_prefix("# ")?.strip_prefix(name)?.strip_prefix(' ')
}

/// Reads a table. `path` is used for messages only.
///
/// # Errors
/// Returns an error if the text is not a table, is of another version or an unknown unit, has a line that this program would not have written, has a
/// row twice, has a row whose id is not that of its inputs, or ends in the middle of a line.
pub fn parse(text: &str, path: &Path) -> Result<Table, VectorError> {
    let invalid = |code, line, message: String, help| VectorError::line(code, path, line, message, help);
    if text.contains('\r') {
        let message = "lines end in CR LF, or have a CR; those of a table end in LF";
        let help = "a program has converted the file: export the pack again";
        return Err(VectorError::file("NB1004", path, message, help));
    }
    let mut lines = Lines { path, lines: text.split('\n').enumerate() };
    let (_, first) = lines.next("the format")?;
    if first != FORMAT {
        if first.starts_with("# ninebit-vectors") {
            let message = format!("`{first}` is another version; this is `{FORMAT}`");
            return Err(invalid("NB1003", 1, message, "use the program that wrote it, or export again"));
        }
        let message = format!("not a table of vectors: the first line is not `{FORMAT}`");
        return Err(invalid("NB1004", 1, message, "name a `.tsv` file of a pack"));
    }
    let unknown =
        |line, what: &str, name: &str, help| invalid("NB1005", line, format!("there is no {what} `{name:.60}`"), help);
    let (line, name) = lines.field("unit")?;
    let unit =
        units::by_name(name).ok_or_else(|| unknown(line, "unit", name, "`ninebit vectors list` names the units"))?;
    lines.field("about")?;
    let (line, name) = lines.field("profile")?;
    let profile =
        Profile::from_name(name).ok_or_else(|| unknown(line, "profile", name, "profiles are Nv10 and Nv2a"))?;
    let (line, name) = lines.field("level")?;
    let level = Level::from_name(name).ok_or_else(|| unknown(line, "level", name, "levels are L0, L1 and L2"))?;
    let mut number = |name: &str| -> Result<u64, VectorError> {
        let (line, text) = lines.field(name)?;
        text.parse().map_err(|_| invalid("NB1004", line, format!("`{name}` is not a number"), AGAIN))
    };
    let (seed, behaviour) = (number("seed")?, number("behaviour")?);
    lines.field("rules")?;
    let writer = Writer::new(Contents { unit, profile, level, seed });
    let head = writer.head();
    let expected: Vec<&str> = head.lines().collect();
    for wanted in expected.iter().skip(8) {
        let (line, text) = lines.next("the names of the columns")?;
        if text != *wanted {
            let message = format!("the columns are not those of `{}`", unit.name());
            let help = "export the pack again, or use the program that wrote it";
            return Err(invalid("NB1006", line, message, help));
        }
    }
    let mut rows = Rows { path, writer: &writer, seen: HashMap::new(), rows: Vec::new() };
    let mut ended = false;
    for (number, line) in lines.lines {
        if ended {
            return Err(invalid("NB1007", number, "an empty line between rows".to_owned(), AGAIN));
        }
        ended = line.is_empty();
        if !ended {
            rows.take(number + 1, line)?;
        }
    }
    if !ended {
        return Err(VectorError::file("NB1007", path, "the file ends in the middle of a line: it is cut off", AGAIN));
    }
    let rows = rows.rows;
    Ok(Table { behaviour: u32::try_from(behaviour).unwrap_or(u32::MAX), writer, rows })
}

/// The rows that have been read so far.
struct Rows<'t> {
    path: &'t Path,
    writer: &'t Writer,
    seen: HashMap<String, usize>,
    rows: Vec<TableRow>,
}

impl Rows<'_> {
    fn take(&mut self, line: usize, text: &str) -> Result<(), VectorError> {
        let error = |code, message, help| Err(VectorError::line(code, self.path, line, message, help));
        let fields: Vec<&str> = text.split('\t').collect();
        let (inputs, results) = (self.writer.inputs(), self.writer.results());
        let wanted = 1 + inputs.len() + results.len() + LAST.len();
        if fields.len() != wanted {
            return error("NB1007", format!("{} fields where the columns are {wanted}", fields.len()), AGAIN);
        }
        let mut numbers = Vec::with_capacity(inputs.len() + results.len());
        for (column, field) in inputs.iter().chain(results).zip(&fields[1..]) {
            let Some(value) = column.kind.read(field) else {
                let message = format!("`{field:.60}` is not a value of {} ({})", column.name, column.kind.code());
                return error("NB1007", message, AGAIN);
            };
            numbers.push(value);
        }
        let results = numbers.split_off(inputs.len());
        let id = self.writer.id(&numbers);
        if fields[0] != id {
            let message = format!("the row's id is `{:.60}`, that of its inputs is {id}", fields[0]);
            return error("NB1008", message, "inputs were changed by hand: export the pack again");
        }
        if let Some(first) = self.seen.insert(id.clone(), line) {
            return error("NB1009", format!("row {id} stands in line {first} already"), AGAIN);
        }
        let tag = fields[fields.len() - LAST.len()].split(',').next().unwrap_or_default();
        let origins = [Origin::Regression, Origin::Exhaustive, Origin::Boundary, Origin::Random];
        let Some(origin) = origins.into_iter().find(|origin| origin.word() == tag) else {
            return error("NB1007", format!("`{tag:.60}` is no tag"), AGAIN);
        };
        self.rows.push(TableRow { line, id, inputs: numbers, results, origin, text: text.to_owned() });
        Ok(())
    }
}

impl Table {
    /// Returns whether this program has the behaviour of the one that wrote the table.
    pub fn is_current(&self) -> bool {
        self.behaviour == BEHAVIOUR
    }

    /// Returns the rows for which the model, or the block lanes of its sweeps, computes something else.
    pub fn differences(&self) -> Vec<Difference> {
        self.rows.iter().filter_map(|row| self.difference(row)).collect()
    }

    fn difference(&self, read: &TableRow) -> Option<Difference> {
        let row = self.writer.row(&read.inputs, read.origin);
        let line = self.writer.line(&row);
        if line == read.text {
            return self.difference_of_lanes(read, row);
        }
        let columns = self.writer.inputs().iter().chain(self.writer.results()).map(|column| column.name.as_str());
        let names = ["id"].into_iter().chain(columns).chain(LAST);
        let fields = names.zip(read.text.split('\t').zip(line.split('\t')));
        let (column, (table, model)) = fields.into_iter().find(|(_, (table, model))| table != model)?;
        let (column, table, model) = (column.to_owned(), table.to_owned(), model.to_owned());
        Some(Difference { line: read.line, id: read.id.clone(), column, table, model, in_lanes: false, row })
    }

    fn difference_of_lanes(&self, read: &TableRow, row: Row) -> Option<Difference> {
        let Contents { unit, profile, .. } = self.writer.contents();
        let conditions = Conditions { profile, policies: Policies::DEFAULT };
        let columns = [self.writer.inputs(), self.writer.results()];
        let found = lanes::outputs(unit, columns, &read.inputs, read.line, &conditions)?;
        let (index, value) = found.into_iter().find(|(index, value)| row.results[*index] != *value)?;
        let Column { name, kind, .. } = &columns[1][index];
        let (column, table, model) = (name.clone(), kind.write(row.results[index]), kind.write(value));
        Some(Difference { line: read.line, id: read.id.clone(), column, table, model, in_lanes: true, row })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::Kind;
    use crate::unit::Unit;

    /// Doubles a number. Its block lanes have a fault: 9 becomes 19.
    struct Twice;

    impl Unit for Twice {
        fn name(&self) -> &'static str {
            "twice"
        }
        fn about(&self) -> &'static str {
            "a fault in lanes"
        }
        fn rules(&self) -> &'static [&'static str] {
            &["NUM-2"]
        }
        fn inputs(&self) -> Vec<Column> {
            vec![Column::byte("in.x"), Column::flag("in.negative")]
        }
        fn results(&self) -> Vec<Column> {
            vec![Column::result("mid.x", Kind::Unsigned(8)), Column::result("out.y", Kind::Signed(10))]
        }
        fn evaluate(&self, inputs: &[i64], _: &Conditions, results: &mut [i64]) {
            let sign = if inputs[1] != 0 { -1 } else { 1 };
            (results[0], results[1]) = (inputs[0], 2 * sign * inputs[0]);
        }
        fn block(&self, inputs: &[i64], varying: usize, _: &Conditions, out: &mut [u8]) -> Option<[u64; 2]> {
            for (n, out) in (0..).zip(out.as_chunks_mut().0) {
                let mut row = inputs.to_vec();
                row[varying] += n;
                let twice = 2 * row[0] as i16 + i16::from(row[0] == 9);
                *out = (if row[1] != 0 { -twice } else { twice }).to_le_bytes();
            }
            (varying == 0).then_some([0; 2])
        }
    }

    #[test]
    fn a_difference_in_lanes_is_one() {
        let contents = Contents { unit: &Twice, profile: Profile::Nv2a, level: Level::L0, seed: 1 };
        let writer = Writer::new(contents);
        let rows = (0..512).map(|n| {
            let row = writer.row(&[n / 2, n % 2], Origin::Exhaustive);
            let (id, text) = (writer.id(&row.inputs), writer.line(&row));
            TableRow { line: n as usize, id, inputs: row.inputs, results: row.results, origin: row.origin, text }
        });
        let rows = rows.collect();
        let table = Table { behaviour: BEHAVIOUR, writer, rows };
        let found = table.differences();
        let told: Vec<_> =
            found.iter().map(|d| (d.line, d.column.as_str(), d.table.as_str(), d.model.as_str())).collect();
        assert_eq!(told, [(18, "out.y", "18", "19"), (19, "out.y", "-18", "-19")]);
        assert!(found.iter().all(|difference| difference.in_lanes));
    }
}
