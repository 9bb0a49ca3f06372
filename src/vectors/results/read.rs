//! Reads tables of results.

use super::*;
use std::collections::HashMap;

use crate::read::header;
use crate::{Column, Kind, VectorError, units};

/// First line of a table of results.
const FORMAT: &str = "# ninebit-results 1";

/// Reads a table of results. `path` is used for messages only.
///
/// # Errors
/// Returns an error if the text is not results, is of another version, truncated or edited, names an unknown unit or column, has a number that its
/// column does not take, or has a row twice.
pub fn parse(text: &str, path: &Path) -> Result<UnitResults, VectorError> {
    let invalid = |code, line, message: String| VectorError::line(code, path, line, message, AGAIN);
    let first = text.lines().next().unwrap_or_default();
    if first != FORMAT {
        let (code, message) = match first.starts_with("# ninebit-results") {
            true => ("NB1003", format!("`{first:.60}` is another version; this is `{FORMAT}`")),
            false => ("NB1030", format!("not results: the first line is not `{FORMAT}`")),
        };
        return Err(invalid(code, 1, message));
    }
    let body = checked(text, path)?;
    let mut lines = body.lines().enumerate().map(|(n, line)| (n + 1, line)).skip(1);
    let mut field = |name: &str| -> Result<(usize, &str), VectorError> {
        let (line, text) = lines.next().unwrap_or((0, ""));
        let expected = || invalid("NB1032", line, format!("`# {name} ...` is expected here"));
        Ok((line, header(text, name).ok_or_else(expected)?))
    };
    let (line, name) = field("unit")?;
    let unit = units::by_name(name).ok_or_else(|| invalid("NB1005", line, format!("there is no unit `{name:.60}`")))?;
    let asked = [field("profile")?.1, field("level")?.1, field("seed")?.1, field("behaviour")?.1].map(str::to_owned);
    let results = unit.results();
    let (line, names) = lines.next().unwrap_or((0, ""));
    let columns = observed(names, &results)
        .ok_or_else(|| invalid("NB1032", line, format!("the columns are not those of results of `{}`", unit.name())))?;
    let mut seen: HashMap<&str, usize> = HashMap::new();
    let mut rows = Vec::new();
    let mut unsupported = None;
    for (line, text) in lines {
        if let Some(count) = text.strip_prefix("# unsupported ") {
            unsupported = Some(count.parse().map_err(|_| invalid("NB1032", line, "not a number of rows".to_owned()))?);
            continue;
        }
        let row = row(text, line, &columns, &results).map_err(|message| invalid("NB1032", line, message))?;
        let id = text.get(..12).unwrap_or_default();
        if let Some(first) = seen.insert(id, line) {
            return Err(invalid("NB1009", line, format!("row {id} stands in line {first} already")));
        }
        rows.push(row);
    }
    let unsupported = unsupported.ok_or_else(|| invalid("NB1032", 0, "`# unsupported ...` is missing".to_owned()))?;
    Ok(UnitResults { path: path.to_path_buf(), unit, asked, columns, rows, unsupported })
}

/// Checks the last line against the text before it. Returns that text.
fn checked<'t>(text: &'t str, path: &Path) -> Result<&'t str, VectorError> {
    let invalid = |message: &str| VectorError::file("NB1030", path, message, AGAIN);
    let last = text.strip_suffix('\n').and_then(|text| text.rfind('\n')).map(|at| at + 1);
    let end = last.map(|at| text.split_at(at)).filter(|(_, end)| end.starts_with("# end "));
    let Some((body, end)) = end else { return Err(invalid("its last line is not `# end ...`: it is cut off")) };
    let mut words = end.trim_end().split(' ').skip(2);
    let (rows, crc) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
    if format!("{:08x}", crc32fast::hash(body.as_bytes())) != crc {
        return Err(invalid("its checksum is not that of its lines: it was changed or cut off"));
    }
    let found = body.lines().filter(|line| !line.starts_with('#')).count().saturating_sub(1);
    if rows != found.to_string() {
        return Err(invalid("it has not as many rows as its last line says"));
    }
    Ok(body)
}

/// Reads the columns between `id` and `status`. There are none if the chip cannot show the unit's results.
fn observed(names: &str, results: &[Column]) -> Option<Vec<ObservedColumn>> {
    let mut names = names.split('\t');
    if names.next() != Some("id") || names.next_back() != Some("status") {
        return None;
    }
    let column = |name: &str| {
        let (of, shift) = name.split_once(">>").unwrap_or((name, "0"));
        let column = results.iter().position(|column| column.name == of && of.starts_with("out."))?;
        let shift = shift.parse().ok().filter(|shift| *shift < 32)?;
        Some(ObservedColumn { name: name.to_owned(), column, shift })
    };
    names.map(column).collect()
}

fn row(text: &str, line: usize, columns: &[ObservedColumn], results: &[Column]) -> Result<ResultRow, String> {
    let fields: Vec<&str> = text.split('\t').collect();
    let wanted = columns.len() + 2;
    if columns.is_empty() {
        return Err("a row where no column was observed".to_owned());
    }
    if fields.len() != wanted {
        return Err(format!("{} fields where the columns are {wanted}", fields.len()));
    }
    let id = fields[0];
    if id.len() != 12 || !id.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f')) {
        return Err(format!("`{id:.60}` is no id"));
    }
    let observed = &fields[1..=columns.len()];
    let values = match fields[columns.len() + 1] {
        "ok" => {
            let read = |(field, column): (&&str, &ObservedColumn)| {
                let value = number(field, &results[column.column].kind);
                value.ok_or_else(|| format!("`{field:.60}` is not a value of {}", column.name))
            };
            Some(observed.iter().zip(columns).map(read).collect::<Result<Vec<i64>, String>>()?)
        }
        "error" if observed.iter().all(|field| *field == "-") => None,
        _ => return Err("the status is neither `ok` nor `error` without numbers".to_owned()),
    };
    Ok(ResultRow { line, id: id.to_owned(), values })
}

/// Reads a decimal number: the index of a name, or twice a number of halves. A card may answer with numbers that the model's column cannot hold.
fn number(field: &str, kind: &Kind) -> Option<i64> {
    let value: i32 = field.parse().ok()?;
    let value = i64::from(value);
    (value.to_string() == field).then_some(if matches!(kind, Kind::Halves(_)) { 2 * value } else { value })
}
