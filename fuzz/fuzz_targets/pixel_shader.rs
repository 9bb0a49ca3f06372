//! Checks that any text is either a pixel shader or refused with findings that point into the text, and that a shader which is read
//! survives printing and either becomes legal combiners or is refused.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ninebit::diagnostic::Severity;
use ninebit::legality::check;
use ninebit::state::Profile;
use ninebit_program::Places;
use ninebit_program::pixel_shader::{Bump, Context, lower, parse, print};
use ninebit_program::text::words::Words;

fuzz_target!(|text: &str| {
    match parse(text) {
        Err(findings) => {
            assert!(!findings.is_empty());
            for finding in findings {
                assert!(finding.span.is_some_and(|span| text.get(span).is_some()));
            }
        }
        Ok(parsed) => {
            let printed = print(&parsed.program);
            let again = parse(&printed).unwrap_or_else(|findings| panic!("{printed}\n{findings:?}"));
            assert_eq!(print(&again.program), printed);
            for profile in [Profile::Nv10, Profile::Nv2a] {
                let bump = Bump { matrix: Some([1.0, 0.0, 0.0, 1.0]), luminance: Some([1.0, 0.0]) };
                let constants = std::array::from_fn(|n| [1.0, -0.5, n as f32 / 8.0, -1.0]);
                let signed = [true, false, true, false];
                let context = Context { signed, fog: true, constants, bumps: [bump; 4], ..Context::new(profile) };
                match lower(&parsed.program, &context) {
                    Ok(lowered) => {
                        assert!((1..=profile.general_stages()).contains(&lowered.combiners.stages.len()));
                        let checked = check(&lowered.combiners, profile, &Places::default(), &Words);
                        let error = checked.findings.iter().find(|finding| finding.severity == Severity::Error);
                        assert!(error.is_none(), "{printed}\n{error:?}");
                    }
                    Err(findings) => assert!(!findings.is_empty()),
                }
            }
        }
    }
});
