//! A part of a unit's rows: those of which some input columns are one number, or lie in a range.
//!
//! It is written as `cfg.format=R5G6B5`, or `in.word=00000000..00ffffff`: the numbers as tables have them, both ends included.

use super::column::Column;
use super::unit::Unit;

/// Which rows of a unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    columns: Vec<Column>,
    texts: Vec<String>,
}

impl Part {
    /// All rows.
    pub fn whole(unit: &dyn Unit) -> Part {
        Part { columns: unit.inputs(), texts: Vec::new() }
    }

    /// The rows that all of these allow.
    ///
    /// # Errors
    /// What is wrong with one of them, in a sentence: it is none, names no input column, or one that was named before, or numbers that the column
    /// does not take.
    pub fn new<T: AsRef<str>>(unit: &dyn Unit, texts: &[T]) -> Result<Part, String> {
        let mut columns = unit.inputs();
        let mut found: Vec<Option<String>> = vec![None; columns.len()];
        let mut named = vec![false; columns.len()];
        for text in texts.iter().map(AsRef::as_ref) {
            let Some((name, numbers)) = text.split_once('=') else {
                return Err(format!("`{text}` is not COLUMN=NUMBER or COLUMN=FIRST..LAST"));
            };
            let Some(index) = columns.iter().position(|column| column.name == name) else {
                let known: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
                return Err(format!("`{}` has no input column `{name}`; it has {}", unit.name(), known.join(", ")));
            };
            if std::mem::replace(&mut named[index], true) {
                return Err(format!("column `{name}` is there twice"));
            }
            let column = &columns[index];
            let (first, last) = numbers.split_once("..").unwrap_or((numbers, numbers));
            let ends = column.kind.read(first).zip(column.kind.read(last));
            let Some(narrowed) = ends.and_then(|(first, last)| column.narrowed(first, last)) else {
                return Err(format!("`{name}` does not take `{numbers}`: {}", takes(column)));
            };
            // A range that is the whole column says nothing.
            if narrowed.size() < column.size() {
                found[index] = Some(written(&narrowed));
                columns[index] = narrowed;
            }
        }
        let texts = found.into_iter().flatten().collect();
        Ok(Part { columns, texts })
    }

    /// The input columns, with the numbers that they take here.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// What holds, one a column, in the columns' order; empty for all rows.
    pub fn texts(&self) -> &[String] {
        &self.texts
    }
}

/// `NAME=FIRST..LAST`, or `NAME=NUMBER` if it takes but one.
fn written(column: &Column) -> String {
    let size = column.size();
    let [first, last] = [0, size.saturating_sub(1)].map(|place| column.kind.write(column.nth(place)));
    if size == 1 { format!("{}={first}", column.name) } else { format!("{}={first}..{last}", column.name) }
}

/// What a column takes, for a reader.
fn takes(column: &Column) -> String {
    let size = column.size();
    if size <= 32 {
        let all: Vec<String> = (0..size).map(|place| column.kind.write(column.nth(place))).collect();
        return format!("it takes {}, or a range of them in this order", all.join(", "));
    }
    let [first, last] = [0, size - 1].map(|place| column.kind.write(column.nth(place)));
    let digits = column.kind.write(0).len();
    let form = match column.kind.code().starts_with('x') {
        true => format!(" as {digits} hexadecimal digits, floats of one sign"),
        false => String::new(),
    };
    format!("it takes {first} to {last}{form}, or FIRST..LAST of them")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vectors::{cases, units};

    fn part(unit: &str, texts: &[&str]) -> Result<Part, String> {
        Part::new(units::by_name(unit).expect("a unit"), texts)
    }

    #[test]
    fn parts_are_written_in_one_way() {
        for (unit, texts, size, expected) in [
            ("texel-expansion", vec!["cfg.format=R5G6B5", "in.word=00000000..0000ffff"], 1 << 16, None),
            (
                "texel-expansion",
                vec!["in.word=00000000..ffffffff", "cfg.format=L8..A8"],
                3 << 32,
                Some(vec!["cfg.format=L8..A8"]),
            ),
            ("mux", vec!["in.spare0.a=-3..-3"], 2, Some(vec!["in.spare0.a=-3"])),
            ("mux", vec!["in.spare0.a=-256..255", "cfg.select=Msb..Lsb"], 1024, Some(vec![])),
            ("mux", vec!["in.spare0.a=1", "cfg.select=Lsb"], 1, Some(vec!["cfg.select=Lsb", "in.spare0.a=1"])),
        ] {
            let found = part(unit, &texts).expect("a part");
            assert_eq!(cases::size(found.columns()), size);
            assert_eq!(found.texts(), expected.unwrap_or(texts));
            assert_eq!(part(unit, &found.texts().iter().map(String::as_str).collect::<Vec<_>>()), Ok(found));
        }
    }

    #[test]
    fn what_is_no_part_is_refused() {
        for (text, says) in [
            ("cfg.select", "is not COLUMN=NUMBER"),
            ("select=Msb", "has no input column `select`; it has cfg.select, in.spare0.a"),
            ("out.takes_cd=1", "has no input column"),
            ("cfg.select=msb", "it takes Msb, Lsb"),
            ("cfg.select=Lsb..Msb", "does not take `Lsb..Msb`"),
            ("in.spare0.a=256", "it takes -256 to 255"),
            ("in.spare0.a=1..", "does not take `1..`"),
            ("in.spare0.a=", "does not take ``"),
            ("in.spare0.a=2..1", "does not take `2..1`"),
        ] {
            let error = part("mux", &[text]).expect_err(text);
            assert!(error.contains(says), "{error}");
        }
        assert!(part("mux", &["cfg.select=Msb", "cfg.select=Msb"]).is_err_and(|error| error.contains("twice")));
        let error = part("surface-load", &["in.word=ffff"]).expect_err("too few digits");
        assert!(error.contains("8 hexadecimal digits"), "{error}");
    }
}
