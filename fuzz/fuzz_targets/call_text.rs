//! Checks that any text is either read as OpenGL calls or refused with findings that point into the text, and that a program which is read
//! either becomes combiners or is refused.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ninebit::legality::check;
use ninebit::state::Profile;
use ninebit_program::c_source::{Style, expand};
use ninebit_program::combiner_calls::{self, Words};
use ninebit_program::texture_environment::{BaseFormat, Context, lower, parse};

fuzz_target!(|text: &str| {
    for style in [Style::Assembler, Style::Combiners, Style::Calls] {
        if let Ok(Some(expanded)) = expand(text, style, 1 << 16) {
            assert!(expanded.places.len() == expanded.text.len() + 1);
            assert!(expanded.places.iter().all(|place| *place <= text.len()));
        }
    }
    match combiner_calls::parse(text) {
        Err(findings) => {
            assert!(findings.iter().all(|finding| finding.span.clone().is_some_and(|span| text.get(span).is_some())))
        }
        Ok(pasted) => {
            let _ = check(&pasted.program.combiners, Profile::Nv10, &pasted.program.places, &Words);
        }
    }
    match parse(text) {
        Err(findings) => {
            assert!(findings.iter().all(|finding| finding.span.clone().is_some_and(|span| text.get(span).is_some())))
        }
        Ok(pasted) => {
            let textures = [Some(BaseFormat::Rgba), Some(BaseFormat::Rgb), None, None];
            let context = Context { profile: Profile::Nv10, textures, signed: [false; 4], fog: true };
            if let Err(findings) = lower(&pasted.program, &context) {
                assert!(!findings.is_empty());
            }
        }
    }
});
