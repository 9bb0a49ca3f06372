//! Writes values in the notation of scene files.

use std::fmt::Write;

use ninebit::state::{Named, Profile};
use ninebit_program::registers::{RegisterWords, Word};

/// Writes register words as a pixel program: `RegisterWords(nv10: (...))`. Words of 0 at the end of a list are left out.
pub fn register_words(words: &RegisterWords) -> String {
    let mut out = String::from("RegisterWords(");
    out.push_str(match words.chip {
        Profile::Nv10 => "nv10: (\n",
        Profile::Nv2a => "nv20: (\n",
    });
    for word in Word::ALL {
        let values: Vec<u32> = (0..word.count(words.chip)).map(|n| words.get(*word, n)).collect();
        let used = values.len() - values.iter().rev().take_while(|value| **value == 0).count();
        let list: Vec<String> = values[..used].iter().map(|value| format!("0x{value:08x}")).collect();
        // Writing to a string cannot fail.
        let _ = match (values.len(), list.len()) {
            (_, 0) => Ok(()),
            (1, _) => writeln!(out, "    {}: {},", word.name(), list[0]),
            _ => writeln!(out, "    {}: [{}],", word.name(), list.join(", ")),
        };
    }
    out.push_str("))");
    out
}
