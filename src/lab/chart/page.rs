//! Pages in Markdown: prose of a template, with what was measured in its places.

/// A file to be written, its path relative to the output folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// With `/` between folders.
    pub path: String,
    /// What it holds.
    pub bytes: Vec<u8>,
}

impl File {
    /// A file of text.
    pub fn text(path: impl Into<String>, text: String) -> File {
        File { path: path.into(), bytes: text.into_bytes() }
    }
}

/// Puts `parts` in the places of a template: `{{name}}` becomes the text of that name. Places without a text stay.
pub fn fill(template: &str, parts: &[(String, String)]) -> String {
    let mut page = template.to_owned();
    for (name, text) in parts {
        page = page.replace(&format!("{{{{{name}}}}}"), text.trim_end());
    }
    page
}

/// A table: the heading row, then the others. The first column is set left, the others right.
pub fn table(rows: &[Vec<String>]) -> String {
    let Some((heading, rows)) = rows.split_first() else { return String::new() };
    let line = |row: &[String]| format!("| {} |\n", row.join(" | "));
    let rule = format!("|---|{}\n", "---:|".repeat(heading.len().saturating_sub(1)));
    line(heading) + &rule + &rows.iter().map(|row| line(row)).collect::<String>()
}

/// A table of words: every column is set left.
pub fn words(rows: &[Vec<String>]) -> String {
    table(rows).replacen("---:|", "---|", rows.first().map_or(0, Vec::len))
}

/// The same rows as comma-separated values; cells that need it are quoted.
pub fn comma_separated(rows: &[Vec<String>]) -> String {
    let cell = |text: &String| {
        if text.contains([',', '"', '\n']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.clone() }
    };
    rows.iter().map(|row| row.iter().map(cell).collect::<Vec<_>>().join(",") + "\n").collect()
}

/// A number with three digits that count; all of its whole ones, and no others if it is whole.
pub fn number(value: f64) -> String {
    if !value.is_finite() {
        return "-".to_owned();
    }
    let decimals = match value.abs() {
        v if v >= 99.95 || v.fract() == 0.0 => 0,
        v if v >= 9.995 => 1,
        v if v >= 0.9995 => 2,
        _ => 3,
    };
    format!("{value:.decimals$}")
}

/// A number as it was chosen: whole ones without decimals.
pub fn plain(value: f64) -> String {
    if value.fract() == 0.0 { format!("{value:.0}") } else { format!("{:.3}", value).trim_end_matches('0').to_owned() }
}

/// Replaces what stands between `<!-- NAME -->` and `<!-- /NAME -->` in a page. `None`: the page has no such place.
pub fn replace_section(page: &str, name: &str, section: &str) -> Option<String> {
    let (open, close) = (format!("<!-- {name} -->\n"), format!("<!-- /{name} -->"));
    let start = page.find(&open)? + open.len();
    let end = start + page.get(start..)?.find(&close)?;
    Some(format!("{}{}\n{}", &page[..start], section.trim_end(), &page[end..]))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    fn row(cells: &[&str]) -> Vec<String> {
        cells.iter().map(|cell| (*cell).to_owned()).collect()
    }

    #[test]
    fn places_are_filled() {
        let parts = [("a".to_owned(), "1\n".to_owned()), ("b".to_owned(), "2".to_owned())];
        assert_eq!(fill("{{a}} and {{b}}, {{c}}", &parts), "1 and 2, {{c}}");
    }

    #[test]
    fn tables_have_a_heading() {
        let rows = [row(&["way", "ns"]), row(&["a, b", "1.5"])];
        assert_eq!(table(&rows), "| way | ns |\n|---|---:|\n| a, b | 1.5 |\n");
        assert_eq!(comma_separated(&rows), "way,ns\n\"a, b\",1.5\n");
        assert_eq!(table(&[]), "");
        assert_eq!(words(&rows), "| way | ns |\n|---|---|\n| a, b | 1.5 |\n");
    }

    #[test]
    fn numbers_keep_three_digits() {
        assert_eq!([0.0, 0.01234, 1.0, 12.345, 99.96, 1234.5].map(number), ["0", "0.012", "1", "12.3", "100", "1234"]);
        assert_eq!(number(f64::NAN), "-");
        assert_eq!([2.0, 0.125, 4.1].map(plain), ["2", "0.125", "4.1"]);
    }

    #[test]
    fn a_section_is_replaced_and_nothing_else() {
        let page = "before\n<!-- x -->\nold\n<!-- /x -->\nafter\n";
        assert_eq!(replace_section(page, "x", "new\n").unwrap(), "before\n<!-- x -->\nnew\n<!-- /x -->\nafter\n");
        assert_eq!(replace_section(page, "y", "new"), None);
    }
}
