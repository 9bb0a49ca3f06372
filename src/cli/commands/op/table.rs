//! Tables of cases: tab-separated values, which are written again with the results.

use std::ffi::OsStr;
use std::fmt::Write;
use std::path::Path;

use ninebit::limits::OPERATION_TABLE;
use ninebit::shown;
use ninebit::state::Named;
use ninebit::trace::Silent;
use ninebit_files::output::{Destination, write_stdout};
use ninebit_files::read::{self, Kind, ReadError};
use ninebit_vectors::table::FORMAT;

use super::{Exit, Failure, Report, Setup, operation::result_text as written};

/// Largest number of refused rows that are listed.
const MAX_ERRORS: usize = 16;

/// Computes each line of a table.
pub(super) fn run(setup: &Setup<'_>, path: &Path, output: Option<&OsStr>) -> Result<(), Failure> {
    let destination = output.map(Destination::from);
    let text = read(path)?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    check_pack(setup, path, text)?;
    let results = evaluate(setup, path, text)?;
    match destination {
        Some(destination) => Ok(destination.write(results.as_bytes())?),
        None => Ok(write_stdout(results.as_bytes())?),
    }
}

fn read(path: &Path) -> Result<String, Failure> {
    let unreadable = |reason: &str| {
        let message = format!("table `{}` cannot be read: {reason}", shown::path(path));
        Failure::invalid("NB0531", message, "name a text file of tab-separated values, in UTF-8")
    };
    let bytes = match path == Path::new("-") {
        true => read::all(std::io::stdin(), OPERATION_TABLE),
        false => read::bytes(path, Kind::Stream, OPERATION_TABLE),
    };
    let bytes = bytes.map_err(|error| match error {
        ReadError::Missing => {
            let message = format!("table `{}` does not exist", shown::path(path));
            let help = "check the spelling and the folder; upper and lower case count";
            Failure { exit: Exit::Missing, ..Failure::invalid("NB0530", message, help) }
        }
        ReadError::TooLarge(limit) => {
            let message = format!("table `{}` is larger than {limit}", shown::path(path));
            Failure { exit: Exit::Limit, ..Failure::invalid("NB0534", message, "split the table") }
        }
        error => unreadable(&error.to_string()),
    })?;
    String::from_utf8(bytes).map_err(|_| unreadable("it is not UTF-8 text"))
}

/// Refuses a pack's table of another unit, or of another chip.
fn check_pack(setup: &Setup<'_>, path: &Path, text: &str) -> Result<(), Failure> {
    if setup.passed_over.is_empty() || text.lines().next() != Some(FORMAT) {
        return Ok(());
    }
    let head = |name: &str| {
        text.lines()
            .take_while(|line| line.starts_with('#'))
            .find_map(|line| line.strip_prefix("# ")?.strip_prefix(name))
    };
    let own = [
        ("unit ", setup.unit.name(), "name that unit"),
        ("profile ", setup.conditions.profile.name(), "`--profile` chooses the chip"),
    ];
    for (name, own, help) in own {
        if let Some(other) = head(name).filter(|other| *other != own) {
            let other = shown::name(&other.chars().take(40).collect::<String>()).into_owned();
            let message = format!("table `{}` is of {name}{other}, not {own}", shown::path(path));
            return Err(Failure::invalid("NB0532", message, help));
        }
    }
    Ok(())
}

/// Returns the table with its results.
fn evaluate(setup: &Setup<'_>, path: &Path, text: &str) -> Result<String, Failure> {
    // Empty lines and those that begin with # are not cases.
    let mut lines = (1_usize..)
        .zip(text.lines())
        .map(|(number, line)| (number, line.trim_end_matches('\r')))
        .filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
    let Some((number, header)) = lines.next() else {
        let message = format!("table `{}` has no header", shown::path(path));
        return Err(Failure::invalid("NB0532", message, columns_help(&setup.known)));
    };
    let names: Vec<&str> = header.split('\t').map(str::trim).collect();
    let columns = header_columns(setup, path, number, &names)?;
    let given: Vec<i64> = setup.columns.iter().map(|column| column.value.unwrap_or(0)).collect();
    let mut out = String::new();
    let mut errors = Errors { shown: Vec::new(), rows: 0 };
    for (number, line) in lines {
        let fields: Vec<&str> = line.split('\t').map(str::trim).collect();
        let mut values = given.clone();
        match row(setup, &columns, &names, &fields, &mut values) {
            Ok(()) if errors.rows > 0 => {}
            Ok(()) => {
                let results = setup.results(&values, &mut Silent);
                if out.is_empty() {
                    let results = results.iter().map(|(name, _)| format!("result.{name}"));
                    let all: Vec<String> = names.iter().map(|name| (*name).to_owned()).chain(results).collect();
                    out = all.join("\t") + "\n";
                }
                out.push_str(&fields.join("\t"));
                for (_, value) in &results {
                    let _ = write!(out, "\t{}", written(value));
                }
                out.push('\n');
            }
            Err(reason) => errors.push(number, &reason),
        }
    }
    if errors.rows > 0 {
        return Err(errors.failure(path));
    }
    if out.is_empty() {
        let message = format!("table `{}` has a header and no cases", shown::path(path));
        return Err(Failure::invalid("NB0533", message, "write one case a line, its values apart by tabs"));
    }
    Ok(out)
}

/// Returns the operation's column for each column of the table.
/// `None` stands for one that is passed over.
fn header_columns(setup: &Setup<'_>, path: &Path, line: usize, names: &[&str]) -> Result<Vec<Option<usize>>, Failure> {
    let wrong = |column: usize, what: String| {
        let message = format!("table `{}`, line {line}, column {}: {what}", shown::path(path), column + 1);
        Failure::invalid("NB0532", message, columns_help(&setup.known))
    };
    let mut columns = Vec::with_capacity(names.len());
    for (index, name) in names.iter().enumerate() {
        let Some(column) = (setup.find)(&setup.columns, name) else {
            if setup.passed_over.iter().any(|known| known == name) {
                columns.push(None);
                continue;
            }
            let short: String = name.chars().take(40).collect();
            return Err(wrong(index, format!("there is no input `{}`", shown::name(&short))));
        };
        if let Some(first) = columns.iter().position(|known| *known == Some(column)) {
            return Err(wrong(index, format!("`{name}` is the same input as column {}", first + 1)));
        }
        columns.push(Some(column));
    }
    let missing = (0..).zip(&setup.columns).find(|(n, column)| column.value.is_none() && !columns.contains(&Some(*n)));
    if let Some((_, column)) = missing {
        let message = format!("table `{}` has no column `{}`", shown::path(path), column.input.name);
        return Err(Failure::invalid("NB0532", message, column.how_to_give.as_str()));
    }
    Ok(columns)
}

fn columns_help(known: &str) -> String {
    format!("the first line names the inputs, apart by tabs: {known}")
}

/// Reads the values of one line.
fn row(
    setup: &Setup<'_>,
    columns: &[Option<usize>],
    names: &[&str],
    fields: &[&str],
    values: &mut [i64],
) -> Result<(), String> {
    if fields.len() != columns.len() {
        let plural = if fields.len() == 1 { "value" } else { "values" };
        return Err(format!("{} {plural}, the header has {}", fields.len(), columns.len()));
    }
    for (index, (field, place)) in fields.iter().zip(columns).enumerate() {
        let Some(place) = *place else { continue };
        let column = &setup.columns[place];
        values[place] = column.read(field).ok_or_else(|| {
            let field = shown::name(&field.chars().take(40).collect::<String>()).to_string();
            format!("column {} (`{}`): `{field}` is not {}", index + 1, names[index], column.wants())
        })?;
    }
    setup.check(values)
}

/// The first refused rows as text, and the number of all.
struct Errors {
    shown: Vec<String>,
    rows: usize,
}

impl Errors {
    fn push(&mut self, line: usize, reason: &str) {
        self.rows += 1;
        if self.shown.len() < MAX_ERRORS {
            self.shown.push(format!("  line {line}: {reason}"));
        }
    }

    fn failure(self, path: &Path) -> Failure {
        let count = if self.rows == 1 { "1 line".to_owned() } else { format!("{} lines", self.rows) };
        let mut message = format!("table `{}`: {count} cannot be used\n{}", shown::path(path), self.shown.join("\n"));
        if self.rows > self.shown.len() {
            let _ = write!(message, "\n  ... and {} more", self.rows - self.shown.len());
        }
        let help = Some("nothing was written; correct these lines, or put # before them".to_owned());
        Failure { exit: Exit::Invalid, report: Report::Message { code: Some("NB0533"), message, help } }
    }
}
