//! Checks that any text is either a combiner program or refused with errors, and that a program which is read survives printing and
//! register words.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ninebit::state::Profile;
use ninebit_program::registers::{decode, encode};
use ninebit_program::text::{parse, print, read};

fuzz_target!(|text: &str| {
    match read(text) {
        Err(findings) => {
            assert!(!findings.is_empty());
            for finding in findings {
                assert!(finding.span.is_none_or(|span| text.get(span).is_some()));
            }
        }
        // What has no general stage reads back with one.
        Ok(program) if program.combiners.stages.is_empty() => {}
        Ok(program) => {
            let normal = print(&program.combiners);
            assert!(read(&normal).expect("what is printed can be read").combiners == program.combiners);
        }
    }
    for profile in [Profile::Nv10, Profile::Nv2a] {
        if let Ok(program) = parse(text, profile) {
            let words = encode(&program.combiners, profile);
            assert!(decode(&words).expect("words of a legal program are taken") == program.combiners);
        }
    }
});
