//! Vocabulary of traces: the fields of their documents, and the names and operations of steps, each with its meaning.
//!
//! `docs/trace-format.md` is generated from it, and every trace uses only its words.

/// The tables. Each is a line `# NAME`, a line with the names of the columns, and the rows. Cells are separated by tabs, tables by an empty line.
const TEXT: &str = include_str!("vocabulary.tsv");

/// A table of the vocabulary.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// Name, for example "A step" or "Operations: Texture units".
    pub name: &'static str,
    /// Names of the columns.
    pub columns: Vec<&'static str>,
    /// Rows of Markdown cells, one for each column. Words of traces are in backticks.
    pub rows: Vec<Vec<&'static str>>,
}

/// Returns all tables, in the order of the page.
pub fn tables() -> Vec<Table> {
    let table = |text: &'static str| {
        let mut lines = text.lines();
        let name = lines.next()?.strip_prefix("# ")?;
        let mut rows = lines.map(|line| line.split('\t').collect());
        Some(Table { name, columns: rows.next()?, rows: rows.collect() })
    };
    TEXT.split("\n\n").filter_map(table).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_has_its_columns() {
        let tables = tables();
        assert_eq!(tables.len(), TEXT.lines().filter(|line| line.starts_with("# ")).count());
        for table in tables {
            assert!(!table.rows.is_empty(), "{}", table.name);
            for row in table.rows {
                assert_eq!(row.len(), table.columns.len(), "{}: {row:?}", table.name);
            }
        }
    }
}
