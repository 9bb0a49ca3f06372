//! The command `ninebit vectors show`: prints a row of a pack as a trace.

use super::*;

use ninebit::state::Policies;
use ninebit_handbook::{find, mark};
use ninebit_vectors::column::Column;
use ninebit_vectors::table::LAST;
use ninebit_vectors::unit::Conditions;
use serde_json::{Map, Value, json};

use crate::commands::op;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// The folder of a pack, or one of its tables
    #[arg(value_name = "PACK")]
    pack: PathBuf,
    /// The id of the row: twelve hexadecimal digits
    #[arg(value_name = "ROW")]
    row: String,
    /// How to print the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

/// Prints a row: inputs, intermediates, outputs, rules, and how it came to be.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (path, table) = pack::find(&arguments.pack, &arguments.row.to_lowercase())?;
    let contents = table.writer.contents();
    let Some(row) = table.rows.first() else { return Err(Failure::fault("a row was found and is not there")) };
    let conditions = Conditions { profile: contents.profile, policies: Policies::DEFAULT };
    let setup = op::unit_setup(contents.unit, conditions)?;
    let told = setup.compute_row(&row.inputs);
    let model = table.writer.row(&row.inputs, row.origin).results;
    let (inputs, results) = (table.writer.inputs(), table.writer.results());
    let last: Vec<(&str, &str)> = {
        let fields: Vec<&str> = row.text.rsplitn(LAST.len() + 1, '\t').take(LAST.len()).collect();
        LAST.into_iter().zip(fields.into_iter().rev()).collect()
    };
    let text = || {
        let (unit, level) = (contents.unit, contents.level.name());
        let place = format!("line {} of `{}`", row.line, shown::path(&path));
        let mut out = format!("row {}, {place}, profile {}, level {level}\n", row.id, contents.profile.name());
        let _ = writeln!(out, "{}: {}", unit.name(), unit.about());
        let split = results.iter().position(|column| !column.name.starts_with("mid.")).unwrap_or(results.len());
        let (middle, outputs) = results.split_at(split);
        for (title, columns, values) in [
            ("inputs", inputs, &row.inputs[..]),
            ("intermediates", middle, &row.results[..split]),
            ("outputs", outputs, &row.results[split..]),
        ] {
            let pairs = columns.iter().zip(values).map(|(c, value)| format!("{} {}", c.name, c.kind.write(*value)));
            let pairs = pairs.collect::<Vec<_>>().join("  ");
            if !pairs.is_empty() {
                let _ = writeln!(out, "  {title:<14} {pairs}");
            }
        }
        let mut title = "rules";
        for rule in unit.rules() {
            let _ =
                writeln!(out, "  {title:<14} {rule:6} {:4} {}", mark(rule), find(rule).map_or("", |rule| rule.title));
            title = "";
        }
        let told_of: Vec<String> = last.iter().take(3).map(|(name, value)| format!("{name} {value}")).collect();
        let _ = writeln!(out, "  {}", told_of.join("  "));
        out.push_str(&told.steps());
        out.push_str(&told.changes());
        for (column, table, model) in differing(results, &row.results, &model) {
            let _ = writeln!(out, "the table has {} {table}, the model {model}", column.name);
        }
        out
    };
    let json = || {
        let named = |columns: &[Column], values: &[i64]| -> Value {
            let pairs = columns.iter().zip(values).map(|(c, value)| (c.name.clone(), json!(c.kind.write(*value))));
            Value::Object(pairs.collect::<Map<String, Value>>())
        };
        let mut value = told.value();
        for (name, field) in [
            ("format", json!("ninebit-row-1")),
            ("row", json!(row.id)),
            ("line", json!(row.line)),
            ("level", json!(contents.level.name())),
            ("inputs", named(inputs, &row.inputs)),
            ("results", named(results, &row.results)),
            ("model", named(results, &model)),
            ("rules", json!(contents.unit.rules())),
        ] {
            value[name] = field;
        }
        for (name, field) in last.iter().take(3) {
            value[*name] = json!(field);
        }
        format!("{value:#}\n")
    };
    arguments.format.print(text, json)?;
    if row.results == model { Ok(()) } else { Err(Failure::difference()) }
}

/// Returns the columns in which a table and the model differ, with both values.
fn differing<'c>(columns: &'c [Column], table: &[i64], model: &[i64]) -> Vec<(&'c Column, String, String)> {
    let all = columns.iter().zip(table.iter().zip(model)).filter(|(_, (table, model))| table != model);
    all.map(|(column, (table, model))| (column, column.kind.write(*table), column.kind.write(*model))).collect()
}
