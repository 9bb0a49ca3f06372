//! Compares rows that have the columns of a unit of the conformance vectors. The `cfg.` and `in.` columns are what was drawn, and the
//! `out.` columns are what the pixel showed.

use crate::table::Row;
use ninebit::state::{Policies, Profile};
use ninebit_vectors::unit::Conditions;
use ninebit_vectors::units;

/// Returns a description of the first result in which the unit differs from the pixel. Results that a pixel cannot show have no column.
pub fn difference(file: &str, unit: &str, row: &Row) -> Option<String> {
    let unit = units::by_name(unit).unwrap_or_else(|| panic!("no unit {unit}"));
    let read = |column: &ninebit_vectors::column::Column, text: &str| {
        let number = column.kind.read(text);
        number.unwrap_or_else(|| panic!("{file}.tsv:{}: {}: `{text}`", row.line, column.name))
    };
    let inputs: Vec<i64> = unit.inputs().iter().map(|column| read(column, row.text(&column.name))).collect();
    let columns = unit.results();
    let mut results = vec![0; columns.len()];
    let conditions = Conditions { profile: Profile::Nv2a, policies: Policies::DEFAULT };
    unit.evaluate(&inputs, &conditions, &mut results);
    let shown = row.fields().filter(|(column, _)| column.starts_with("out."));
    let mut count = 0;
    for (column, captured) in shown {
        let n = columns.iter().position(|known| known.name == column);
        let n = n.unwrap_or_else(|| panic!("{file}.tsv: the unit has no {column}"));
        if results[n] != read(&columns[n], captured) {
            let got = columns[n].kind.write(results[n]);
            return Some(format!("{file}.tsv:{}: {}: {column} is {got}", row.line, row.describe()));
        }
        count += 1;
    }
    assert!(count > 0, "{file}.tsv shows nothing");
    None
}
