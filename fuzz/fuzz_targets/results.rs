//! Checks that any text, with or without a valid checksum, is either a table of results or an error, and that each row of a table has one
//! number for each column.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ninebit_vectors::results::parse;
use std::path::Path;

fuzz_target!(|text: &str| {
    let path = Path::new("results.tsv");
    let _ = parse(text, path);
    // A correct last line lets the text past the checksum, so that the checks after it are reached.
    let body = format!("# ninebit-results 1\n# unit product\n{text}\n");
    let rows = body.lines().filter(|line| !line.starts_with('#')).count().saturating_sub(1);
    let sealed = format!("{body}# end {rows} {:08x}\n", crc32fast::hash(body.as_bytes()));
    if let Ok(results) = parse(&sealed, path) {
        for row in &results.rows {
            assert!(row.values.as_ref().is_none_or(|values| values.len() == results.columns.len()));
        }
    }
});
