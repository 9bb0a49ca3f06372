//! Reads a log line by line.

use super::event::{Entry, Event, Write};
use super::line::{Line, line};
use super::words::Words;
use crate::class::{KELVIN, METHOD_BYTES};

/// Longest line that is read, in bytes. A longer one is unknown.
pub const LONGEST_LINE: usize = 16 << 10;

/// Reads a log part by part, in memory that does not grow with it.
#[derive(Debug)]
pub struct Reader {
    /// The class of lines that name none.
    class: u32,
    line: u64,
    partial: Vec<u8>,
    cut: bool,
    /// The last write, whose repetition as an unhandled method is no second write.
    last: Option<Write>,
    form: Option<Form>,
    /// Lines that no form has: their number, and the first with its text.
    pub unknown: u64,
    /// The first such line.
    pub first_unknown: Option<(u64, String)>,
}

/// The form of lines that have words alone.
#[derive(Debug)]
enum Form {
    /// A method and its word.
    Pairs,
    /// Words of a push buffer.
    Stream(Words),
}

impl Default for Reader {
    fn default() -> Reader {
        Reader::of_class(KELVIN)
    }
}

impl Reader {
    /// Makes a reader at the beginning of a log, whose lines are of Kelvin unless they say otherwise.
    pub fn new() -> Reader {
        Reader::default()
    }

    /// Makes a reader of a log whose lines are of a class unless they say otherwise.
    pub fn of_class(class: u32) -> Reader {
        Reader {
            class,
            line: 0,
            partial: Vec::new(),
            cut: false,
            last: None,
            form: None,
            unknown: 0,
            first_unknown: None,
        }
    }

    /// Reads more bytes, and passes each event that they complete.
    pub fn feed(&mut self, bytes: &[u8], each: &mut dyn FnMut(Entry)) {
        for part in bytes.split_inclusive(|byte| *byte == b'\n') {
            let (text, complete) = part.strip_suffix(b"\n").map_or((part, false), |text| (text, true));
            let room = LONGEST_LINE.saturating_sub(self.partial.len());
            self.cut |= text.len() > room;
            self.partial.extend_from_slice(&text[..text.len().min(room)]);
            if complete {
                self.complete(each);
            }
        }
    }

    /// Reads the last line, which may lack its end.
    pub fn finish(&mut self, each: &mut dyn FnMut(Entry)) {
        if !self.partial.is_empty() {
            self.complete(each);
        }
        if let Some(Form::Stream(words)) = &mut self.form
            && let Some(fault) = words.finish()
        {
            each(Entry { line: self.line, event: Event::Fault(fault) });
        }
    }

    /// Returns whether a line had a method as a tool prints it, rather than words alone.
    pub fn is_log(&self) -> bool {
        self.last.is_some()
    }

    fn complete(&mut self, each: &mut dyn FnMut(Entry)) {
        self.line += 1;
        let partial = std::mem::take(&mut self.partial);
        let text = String::from_utf8_lossy(&partial);
        let found = if std::mem::take(&mut self.cut) { Line::Unknown } else { line(text.trim(), self.class) };
        self.pass(found, &text, each);
        self.partial = partial;
        self.partial.clear();
    }

    fn pass(&mut self, found: Line, text: &str, each: &mut dyn FnMut(Entry)) {
        let (line, class) = (self.line, self.class);
        let mut put = |event| each(Entry { line, event });
        match found {
            Line::Nothing => {}
            Line::Write(write) => {
                self.last = Some(write);
                put(Event::Write(write));
            }
            Line::Unhandled(write) => {
                // xemu prints a method that it does not handle twice: as a method, and as one that is not handled.
                if self.last != Some(write) {
                    put(Event::Write(write));
                }
                self.last = Some(Write { class: 0, ..write });
            }
            Line::Writes(writes) => writes.into_iter().for_each(|write| put(Event::Write(write))),
            Line::Event(event) => put(event),
            Line::Words(words) => {
                let form = self.form.get_or_insert_with(|| {
                    let pairs = words.len() == 2 && words[0] < METHOD_BYTES && words[0] % 4 == 0;
                    if pairs { Form::Pairs } else { Form::Stream(Words::of_class(class)) }
                });
                match form {
                    Form::Pairs => match words[..] {
                        [method, word] if method < METHOD_BYTES => {
                            put(Event::Write(Write { class, method, word }));
                        }
                        _ => self.note(text),
                    },
                    Form::Stream(stream) => words.into_iter().for_each(|word| stream.take(word, &mut put)),
                }
            }
            Line::Unknown => self.note(text),
        }
    }

    fn note(&mut self, text: &str) {
        self.unknown += 1;
        let line = self.line;
        self.first_unknown.get_or_insert_with(|| (line, text.chars().take(80).collect()));
    }
}

#[cfg(test)]
mod tests;
