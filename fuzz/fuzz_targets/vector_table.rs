//! Checks that any text is either a table of vectors or an error, that each row of a table has the id which follows from its inputs, and
//! that the model can compute every row.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ninebit_vectors::read::parse;
use std::path::Path;

fuzz_target!(|text: &str| match parse(text, Path::new("fuzzed.tsv")) {
    Err(error) => assert!(error.code().starts_with("NB10") && !error.to_string().is_empty()),
    Ok(table) => {
        for row in &table.rows {
            assert_eq!(table.writer.id(&row.inputs), row.id);
        }
        for difference in table.differences() {
            assert_ne!(difference.table, difference.model);
        }
    }
});
