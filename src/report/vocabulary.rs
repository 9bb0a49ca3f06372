//! The vocabulary of traces: the fields of their documents, and the names and operations of their steps, each with its meaning.
//!
//! `docs/trace-format.md` shows it, and every trace is written in it.

/// Tables one after the other: a line `# NAME`, a line that names the columns, the rows; tabs between cells, an empty line between tables.
const TEXT: &str = include_str!("vocabulary.tsv");

/// A table of the vocabulary.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// What its rows are, for example "A step" or "Operations: Texture units".
    pub name: &'static str,
    /// What each column has.
    pub columns: Vec<&'static str>,
    /// Cells in Markdown, one for each column. Words of traces stand in backticks.
    pub rows: Vec<Vec<&'static str>>,
}

/// All tables, in the order of the page.
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
