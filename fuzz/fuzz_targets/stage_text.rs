//! Checks that any text is either read as texture stages or refused with findings that point into the text, and that a program which is
//! read either becomes combiners or is refused.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ninebit::state::Profile;
use ninebit_program::PastedProgram;
use ninebit_program::texture_stages::{Context, lower, parse};

fuzz_target!(|text: &str| {
    match parse(text) {
        Err(findings) => {
            assert!(!findings.is_empty());
            for finding in findings {
                assert!(finding.span.is_some_and(|span| text.get(span).is_some()));
            }
        }
        Ok(PastedProgram { program, .. }) => {
            for profile in [Profile::Nv10, Profile::Nv2a] {
                let context = Context { profile, bound: [true, true, false, false], signed: [false; 4], fog: true };
                match lower(&program, &context) {
                    Ok(lowered) => assert!((1..=profile.general_stages()).contains(&lowered.combiners.stages.len())),
                    Err(findings) => assert!(!findings.is_empty()),
                }
            }
        }
    }
});
