//! Any text is a table of results or an error, sealed or not; what is read has a number a column.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ninebit_vectors::results::parse;
use std::path::Path;

fuzz_target!(|text: &str| {
    let path = Path::new("results.tsv");
    let _ = parse(text, path);
    // With the last line that its own lines call for, so that what comes after the checksum is reached.
    let body = format!("# ninebit-results 1\n# unit product\n{text}\n");
    let rows = body.lines().filter(|line| !line.starts_with('#')).count().saturating_sub(1);
    let sealed = format!("{body}# end {rows} {:08x}\n", crc32fast::hash(body.as_bytes()));
    if let Ok(results) = parse(&sealed, path) {
        for row in &results.rows {
            assert!(row.values.as_ref().is_none_or(|values| values.len() == results.columns.len()));
        }
    }
});
