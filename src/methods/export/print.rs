//! The forms in which methods are written.

use std::fmt::Write;

use super::Methods;
use crate::class;

/// Writes methods as xemu traces them: a line each, with the method's name.
pub fn trace(methods: &Methods) -> String {
    let mut text = String::with_capacity(72 * methods.writes.len());
    for (method, word) in &methods.writes {
        let (name, place) = class::find(*method).map_or(("?".to_owned(), 0), |place| {
            (format!("NV097_{}", place.method.name), method - place.method.number)
        });
        // Writing to a string cannot fail.
        let _ = writeln!(text, "nv2a_pgraph_method 0: 0x{:x} -> 0x{method:04x} {name}[{place}] 0x{word:x}", class::KELVIN);
    }
    text
}

/// Writes methods as words of a push buffer: a header for each run of methods.
pub fn push_buffer(methods: &Methods) -> Vec<u32> {
    const LONGEST: usize = 0x7ff;
    let mut words = Vec::with_capacity(methods.writes.len() + methods.writes.len() / 2);
    let mut rest = &methods.writes[..];
    while let [(first, _), ..] = rest {
        let run = |step: u32| {
            let follows = rest.iter().enumerate().take(LONGEST).take_while(|(n, (method, _))| *method == first + step * *n as u32);
            follows.count()
        };
        let (increasing, same) = (run(4), run(0));
        let (count, flag) = if same > increasing { (same, 0x4000_0000) } else { (increasing, 0) };
        words.push(flag | (count as u32) << 18 | first);
        words.extend(rest[..count].iter().map(|(_, word)| *word));
        rest = &rest[count..];
    }
    words
}
