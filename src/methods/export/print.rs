//! The forms in which methods are written.

use std::fmt::Write;

use ninebit::state::Target;

use super::Methods;
use super::memory::pitch;
use crate::class::{self, Family};

const CONSOLE: &str = include_str!("console.c");

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

/// Writes methods as a program in C for nxdk, which draws them on a console. `name` is that of the file that it writes there, `target` the surface that
/// the file holds.
pub fn console_program(methods: &Methods, name: &str, (index, target): (usize, &Target)) -> String {
    let mut writes = String::with_capacity(24 * methods.writes.len());
    for (method, word) in methods.writes.iter().filter(|(method, _)| *method != class::FLIP_STALL) {
        // Writing to a string cannot fail.
        let _ = writeln!(writes, "    {{0x{method:x}, 0x{word:x}}},");
    }
    // A file's name on a console has 42 characters; letters, digits and `-` stand for themselves in C as well.
    let name: String = name.chars().filter(|c| c.is_ascii_alphanumeric() || *c == '-').take(38).collect();
    let bytes = target.format.bytes();
    let parts = [
        ("@NAME@", name),
        ("@WRITES@", writes),
        ("@MEMORY@", methods.memory.len().to_string()),
        ("@WIDTH@", target.width.to_string()),
        ("@HEIGHT@", target.height.to_string()),
        ("@PITCH@", pitch(target.width, bytes).to_string()),
        ("@BYTES@", bytes.to_string()),
        ("@PLACE@", methods.surfaces[index].to_string()),
    ];
    parts.iter().fold(CONSOLE.to_owned(), |text, (part, content)| text.replace(part, content))
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
