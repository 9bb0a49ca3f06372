//! Checks that any text is either a vertex program or refused with findings that point into the text, and that a program which is read
//! survives printing and runs.
#![no_main]

use libfuzzer_sys::fuzz_target;
use ninebit::vertex::shader::{CONSTANTS, INPUTS, evaluate};
use ninebit_program::vertex_shader::{parse, print, read};

fuzz_target!(|text: &str| {
    if let Err(findings) = read(text) {
        assert!(!findings.is_empty());
        for finding in findings {
            assert!(finding.span.is_some_and(|span| text.get(span).is_some()));
        }
    }
    let Ok(written) = parse(text) else { return };
    let printed = print(&written.shader);
    assert!(parse(&printed).is_ok_and(|again| again.shader == written.shader), "{printed}");
    let number = |n: usize| (n as f32 - 40.0) / 8.0;
    let constants: [[f32; 4]; CONSTANTS] = std::array::from_fn(|n| [number(n), number(n + 1), -1.0, 0.0]);
    let inputs: [[f32; 4]; INPUTS] = std::array::from_fn(|n| [number(n * 7), 1.0, 0.5, number(n)]);
    let (first, second) =
        (evaluate(&written.shader, &constants, &inputs), evaluate(&written.shader, &constants, &inputs));
    assert_eq!(first.position.map(f32::is_nan), second.position.map(f32::is_nan));
});
