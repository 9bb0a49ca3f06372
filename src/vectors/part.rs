//! A part of a unit's rows: those in which some input columns are restricted.
//!
//! `cfg.format=R5G6B5` restricts a column to one number, and `in.word=00000000..00ffffff` to a range with both ends included; numbers are written as
//! in tables. `in.word0=00000000/f800f800` restricts it to words that differ from the first in no bits but those of the second.
//! `in.texture.g=in.texture.r` ties it to the number of another column.

use super::{Column, Domain, Unit};

/// A subset of a unit's rows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    columns: Vec<Column>,
    texts: Vec<String>,
    /// Ties: index of the tied column, and index of the column whose number it has.
    ties: Vec<[usize; 2]>,
}

impl Part {
    /// Returns the part with all rows.
    pub fn whole(unit: &dyn Unit) -> Part {
        Part { columns: unit.inputs(), texts: Vec::new(), ties: Vec::new() }
    }

    /// Returns the part that satisfies all restrictions in `texts`.
    ///
    /// # Errors
    /// Returns a sentence that says what is wrong with a restriction: it cannot be parsed, names no input column, names a column twice, or has
    /// numbers that the column does not take.
    pub fn new<T: AsRef<str>>(unit: &dyn Unit, texts: &[T]) -> Result<Part, String> {
        let mut columns = unit.inputs();
        let mut found: Vec<Option<String>> = vec![None; columns.len()];
        let mut named = vec![false; columns.len()];
        let mut ties = Vec::new();
        for text in texts.iter().map(AsRef::as_ref) {
            let Some((name, numbers)) = text.split_once('=') else {
                return Err(format!(
                    "`{text}` is not COLUMN=NUMBER, COLUMN=FIRST..LAST, COLUMN=WORD/MASK or COLUMN=COLUMN"
                ));
            };
            let Some(index) = columns.iter().position(|column| column.name == name) else {
                let known: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
                return Err(format!("`{}` has no input column `{name}`; it has {}", unit.name(), known.join(", ")));
            };
            if std::mem::replace(&mut named[index], true) {
                return Err(format!("column `{name}` is there twice"));
            }
            let column = &columns[index];
            if let Some(other) = columns.iter().position(|column| column.name == numbers) {
                // A tied column has only one value of its own.
                let own = column.narrowed(column.nth(0), column.nth(0));
                let Some(own) = own.filter(|_| other != index && columns[other].kind == column.kind) else {
                    return Err(format!("`{name}` cannot have the number of `{numbers}`: it takes others"));
                };
                ties.push([index, other]);
                found[index] = Some(text.to_owned());
                columns[index] = own;
                continue;
            }
            let read = |[a, b]: [&str; 2]| column.kind.read(a).zip(column.kind.read(b));
            let narrowed = match numbers.split_once('/') {
                Some((word, mask)) => read([word, mask]).and_then(|(word, mask)| column.masked(word, mask)),
                None => {
                    let (first, last) = numbers.split_once("..").unwrap_or((numbers, numbers));
                    read([first, last]).and_then(|(first, last)| column.narrowed(first, last))
                }
            };
            let Some(narrowed) = narrowed else {
                return Err(format!("`{name}` does not take `{numbers}`: {}", takes(column)));
            };
            // A range that covers the whole column is no restriction.
            if narrowed.size() < column.size() {
                found[index] = Some(written(&narrowed));
                columns[index] = narrowed;
            }
        }
        let whole = unit.inputs();
        let chained = |[tied, other]: &&[usize; 2]| {
            whole[*tied].domain != whole[*other].domain || ties.iter().any(|[index, _]| index == other)
        };
        if let Some([tied, other]) = ties.iter().find(chained) {
            let [tied, other] = [tied, other].map(|index| &columns[*index].name);
            return Err(format!(
                "`{tied}` cannot have the number of `{other}`: that has none of its own, or takes others"
            ));
        }
        ties.sort_unstable();
        let texts = found.into_iter().flatten().collect();
        Ok(Part { columns, texts, ties })
    }

    /// Returns the input columns, with their domains restricted.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Sets the tied columns of a row.
    pub(crate) fn tie(&self, inputs: &mut [i64]) {
        for [tied, other] in &self.ties {
            inputs[*tied] = inputs[*other];
        }
    }

    /// Returns whether another column is tied to this one.
    pub fn is_followed(&self, index: usize) -> bool {
        self.ties.iter().any(|[_, other]| *other == index)
    }

    /// Returns the restrictions in canonical form, in the order of the columns; empty for all rows.
    pub fn texts(&self) -> &[String] {
        &self.texts
    }
}

/// Writes a restriction in canonical form: `NAME=FIRST..LAST`, `NAME=NUMBER` for a single number, or `NAME=WORD/MASK`.
fn written(column: &Column) -> String {
    if let Some(Domain::Bits(word, mask)) = column.domain {
        let [word, mask] = [word, mask].map(|word| column.kind.write(word.into()));
        return format!("{}={word}/{mask}", column.name);
    }
    let size = column.size();
    let [first, last] = [0, size.saturating_sub(1)].map(|place| column.kind.write(column.nth(place)));
    if size == 1 { format!("{}={first}", column.name) } else { format!("{}={first}..{last}", column.name) }
}

/// Describes the numbers that a column takes, for a message.
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
    let masks = match column.domain {
        Some(Domain::Word(_)) => ", or WORD/MASK: those that differ from WORD, which has none of them, in bits of MASK",
        _ => "",
    };
    format!("it takes {first} to {last}{form}, or FIRST..LAST of them{masks}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{cases, units};

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
            ("surface-load", vec!["cfg.format=B8", "in.word=80000000/0f0000f0"], 256, None),
            ("product", vec!["in.b=in.a"], 513, None),
            ("product", vec!["in.a=1..2", "in.b=in.a"], 2, None),
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
        for texts in [&["in.a=in.a"][..], &["in.b=in.a", "in.a=in.b"], &["in.b=in.a", "in.c=in.b"], &["in.b=cfg.scale"]]
        {
            assert!(part("sum", texts).is_err(), "{texts:?}");
        }
        let mut row = [7, 0];
        part("product", &["in.b=in.a"]).expect("a part").tie(&mut row);
        assert_eq!(row, [7, 7]);
        assert!(part("scale-bias", &["in.b=cfg.scale"]).is_err_and(|error| error.contains("cannot have")));
        // Masks that are a range, cover bits that the word has, or are too wide; and columns of numbers, which take no masks.
        for text in ["00000000/000000ff", "00000000/00000000", "00000010/000000f0", "00000000/ff", "00000000/1ffffffff"]
        {
            assert!(
                part("surface-load", &[&format!("in.word={text}")]).is_err_and(|error| error.contains("WORD/MASK"))
            );
        }
        assert!(part("mux", &["in.spare0.a=0/6"]).is_err());
        let masked = part("surface-load", &["in.word=80000000/0f0000f0"]).expect("a part");
        let words: Vec<i64> = [0, 1, 0x10, 0xff].map(|place| masked.columns()[1].nth(place)).to_vec();
        assert_eq!(words, [0x8000_0000, 0x8000_0010, 0x8100_0000, 0x8f00_00f0]);
        assert!(part("mux", &["cfg.select=Msb", "cfg.select=Msb"]).is_err_and(|error| error.contains("twice")));
        let error = part("surface-load", &["in.word=ffff"]).expect_err("too few digits");
        assert!(error.contains("8 hexadecimal digits"), "{error}");
    }
}
