//! Reads `vectors/silicon/*.tsv`, whose rows are measurements of a real chip.

use ninebit::state::{Blend, BlendEquation, BlendFactor, Named};
use std::collections::HashMap;
use std::sync::Arc;

/// One probe: the fields of a row.
pub struct Row {
    columns: Arc<Vec<String>>,
    /// Number of the line in the file, from 1.
    pub line: usize,
    fields: Vec<String>,
}

/// Reads a file. Lines with `#` have the version, the number of rows, the suite and the name of each case, and the names of the columns; all
/// others are rows.
pub fn read(file: &str) -> Vec<Row> {
    let path = format!("vectors/silicon/{file}.tsv");
    let text = std::fs::read_to_string(crate::repository::at(&path)).unwrap_or_else(|error| panic!("{path}: {error}"));
    assert!(text.starts_with("# ninebit silicon probes, format 2\n"), "{path}: not a file of probes");
    let header = |key: &str| {
        let line = text.lines().find_map(|line| line.strip_prefix("# ")?.strip_prefix(key)?.strip_prefix(": "));
        line.unwrap_or_else(|| panic!("{path}: no `# {key}:`"))
    };
    let columns: Vec<String> = header("columns").split(' ').map(str::to_string).collect();
    assert_eq!(columns[0], "case", "{path}");
    let columns = Arc::new([vec!["suite".to_string()], columns].concat());
    let cases: HashMap<&str, (&str, &str)> = text
        .lines()
        .filter_map(|line| line.strip_prefix("# case ")?.split_once(": "))
        .map(|(number, names)| (number, names.split_once(' ').expect("a suite and a case")))
        .collect();
    let rows: Vec<Row> = text
        .lines()
        .enumerate()
        .filter(|(_, line)| !line.starts_with('#'))
        .map(|(n, line)| {
            let (number, others) = line.split_once('\t').expect("two fields");
            let (suite, name) = cases[number];
            let fields: Vec<String> = [suite, name].into_iter().chain(others.split('\t')).map(str::to_string).collect();
            assert_eq!(fields.len(), columns.len(), "{path}:{}", n + 1);
            Row { columns: columns.clone(), line: n + 1, fields }
        })
        .collect();
    assert_eq!(header("rows"), rows.len().to_string(), "{path}: rows");
    rows
}

impl Row {
    /// Returns the text in a column.
    pub fn text(&self, column: &str) -> &str {
        let at = self.columns.iter().position(|c| c == column).unwrap_or_else(|| panic!("no column {column}"));
        &self.fields[at]
    }

    /// Returns the columns and their texts.
    pub fn fields(&self) -> impl Iterator<Item = (&str, &str)> {
        self.columns.iter().map(String::as_str).zip(self.fields.iter().map(String::as_str))
    }

    /// Returns the number in a column.
    pub fn number<T: std::str::FromStr>(&self, column: &str) -> T {
        let text = self.text(column);
        text.parse().unwrap_or_else(|_| panic!("line {}: {column}: `{text}`", self.line))
    }

    /// Returns whether a column, which has 0 or 1, is 1.
    pub fn flag(&self, column: &str) -> bool {
        self.number::<u8>(column) == 1
    }

    /// Returns the bytes in a column, which are written as `1.2.3`.
    pub fn bytes<const N: usize>(&self, column: &str) -> [u8; N] {
        bytes(self.text(column))
    }

    /// Returns the alternatives or steps in a column, which are written as `51|68`.
    pub fn list(&self, column: &str) -> Vec<&str> {
        self.text(column).split('|').collect()
    }

    /// Returns the variant of an enumeration that a column names.
    pub fn named<T: Named>(&self, column: &str) -> T {
        let text = self.text(column);
        T::from_name(text).unwrap_or_else(|| panic!("line {}: {} `{text}`", self.line, T::TYPE))
    }

    /// Returns the blend of the columns `equation`, `source` and `destination`.
    pub fn blend(&self) -> Blend {
        Blend {
            equation: self.named::<BlendEquation>("equation"),
            source: self.named::<BlendFactor>("source"),
            destination: self.named::<BlendFactor>("destination"),
        }
    }

    /// Returns the captured R, G, B, A.
    pub fn captured(&self) -> [u8; 4] {
        ["r", "g", "b", "a"].map(|channel| self.number(channel))
    }

    /// Returns the row as text for a message.
    pub fn describe(&self) -> String {
        self.columns.iter().zip(&self.fields).map(|(c, f)| format!("{c}={f}")).collect::<Vec<_>>().join(" ")
    }
}

/// Returns bytes that are written as `1.2.3`.
pub fn bytes<const N: usize>(text: &str) -> [u8; N] {
    let list: Vec<u8> = text.split('.').map(|b| b.parse().unwrap()).collect();
    list.try_into().unwrap_or_else(|_| panic!("`{text}` has not {N} bytes"))
}
