//! The forms in which methods are written.

use std::fmt::Write;

use super::Methods;
use crate::class::Family;

/// Writes methods as emulators trace them: Kelvin's as xemu does, a line each, with the method's name; Celsius's as Bochs does, with numbers that
/// count words.
pub fn trace(methods: &Methods) -> String {
    let class = methods.family.class();
    let mut text = String::with_capacity(72 * methods.writes.len());
    for (method, word) in &methods.writes {
        // Writing to a string cannot fail.
        if methods.family == Family::Celsius {
            let number = method / 4;
            let _ =
                writeln!(text, "execute_command: obj 0x0, class 0x{class:04x}, method 0x{number:x}, param 0x{word:x}");
            continue;
        }
        let (name, place) = methods.family.find(*method).map_or(("?".to_owned(), 0), |place| {
            (format!("NV097_{}", place.method.name), method - place.method.number)
        });
        let _ = writeln!(text, "nv2a_pgraph_method 0: 0x{class:x} -> 0x{method:04x} {name}[{place}] 0x{word:x}");
    }
    text
}

/// Writes methods as words of a push buffer: a header for each run of methods.
pub fn push_buffer(methods: &Methods) -> Vec<u32> {
    const LONGEST: usize = 0x7ff;
    let mut words = Vec::with_capacity(methods.writes.len() + methods.writes.len() / 2);
    let mut rest = &methods.writes[..];
    if methods.family != Family::Kelvin {
        // Binds the class to the first subchannel.
        words.extend([1 << 18, methods.family.class()]);
    }
    while let [(first, _), ..] = rest {
        let run = |step: u32| {
            let follows = rest
                .iter()
                .enumerate()
                .take(LONGEST)
                .take_while(|(n, (method, _))| *method == first + step * *n as u32);
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
