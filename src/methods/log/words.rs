//! Words of a push buffer: headers and what follows them.

use super::event::{Event, Fault, Write};
use crate::class::{Family, KELVIN};

/// Decodes words one by one. Without memory it cannot follow jumps.
#[derive(Clone, Copy, Debug)]
pub struct Words {
    method: u32,
    subchannel: usize,
    left: u32,
    increasing: bool,
    /// The 3D class that the words are of.
    class: u32,
    classes: [u32; 8],
}

impl Default for Words {
    fn default() -> Words {
        Words::of_class(KELVIN)
    }
}

/// A word of a push buffer between commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Header {
    /// So many words for a method and those behind it, or all for the method itself.
    Command {
        /// The first method in bytes.
        method: u32,
        /// The subchannel.
        subchannel: usize,
        /// Number of words that follow.
        count: u32,
        /// Whether each word is for the method after that of the one before.
        increasing: bool,
    },
    /// The next word is at this address.
    Jump(u32),
    /// The next word is at this address, until a return.
    Call(u32),
    /// The next word is the one after the last call.
    Return,
    /// None of these.
    Unknown,
}

/// Decodes a word between commands.
pub(crate) fn header(word: u32) -> Header {
    let command = |increasing| Header::Command {
        method: word & 0x1ffc,
        subchannel: (word >> 13 & 7) as usize,
        count: word >> 18 & 0x7ff,
        increasing,
    };
    match word {
        0x0002_0000 => Header::Return,
        _ if word & 3 == 1 => Header::Jump(word & !3),
        _ if word & 3 == 2 => Header::Call(word & !3),
        _ if word & 0xe000_0003 == 0x2000_0000 => Header::Jump(word & 0x1fff_fffc),
        _ if word & 0xe003_0003 == 0 => command(true),
        _ if word & 0xe003_0003 == 0x4000_0000 => command(false),
        _ => Header::Unknown,
    }
}

impl Words {
    /// Makes a decoder of words for a 3D class.
    pub fn of_class(class: u32) -> Words {
        Words { method: 0, subchannel: 0, left: 0, increasing: true, class, classes: [class; 8] }
    }

    /// Returns whether the next word is a header.
    pub fn is_between(&self) -> bool {
        self.left == 0
    }

    /// Takes a header of a command.
    pub fn begin(&mut self, method: u32, subchannel: usize, count: u32, increasing: bool) {
        (self.method, self.subchannel, self.left, self.increasing) = (method, subchannel & 7, count, increasing);
    }

    /// Takes a word within a command, and returns the write that it is.
    pub fn data(&mut self, word: u32) -> Write {
        if self.method == 0 {
            // The object's class is in the low bits where a driver names objects by their class; any other handle leaves the 3D class.
            let named = if Family::from_class(word & 0xff).is_some() { word & 0xff } else { word };
            self.classes[self.subchannel] = if named > 0xff { self.class } else { named };
        }
        let write = Write { class: self.classes[self.subchannel], method: self.method, word };
        self.left -= 1;
        if self.increasing {
            self.method = (self.method + 4) & 0x1ffc;
        }
        write
    }

    /// Takes the next word, and passes what it is.
    pub fn take(&mut self, word: u32, put: &mut dyn FnMut(Event)) {
        if self.left > 0 {
            return put(Event::Write(self.data(word)));
        }
        match header(word) {
            Header::Command { method, subchannel, count, increasing } => {
                self.begin(method, subchannel, count, increasing)
            }
            Header::Jump(_) | Header::Call(_) | Header::Return => put(Event::Fault(Fault::Branch(word))),
            Header::Unknown => put(Event::Fault(Fault::Header(word))),
        }
    }

    /// Returns what is wrong with the end of the words.
    pub fn finish(&mut self) -> Option<Fault> {
        let left = std::mem::take(&mut self.left);
        (left > 0).then_some(Fault::End(left))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_are_decoded() {
        let command = |method, subchannel, count, increasing| Header::Command { method, subchannel, count, increasing };
        assert_eq!(header(0x0004_17fc), command(0x17fc, 0, 1, true));
        assert_eq!(header(0x4010_1818), command(0x1818, 0, 4, false));
        assert_eq!(header(0x0008_a200), command(0x200, 5, 2, true));
        assert_eq!(header(0x1ffc_1ffc), command(0x1ffc, 0, 0x7ff, true));
        assert_eq!(header(0x03fc_0001), Header::Jump(0x03fc_0000));
        assert_eq!(header(0x2000_1000), Header::Jump(0x1000));
        assert_eq!(header(0x0000_1002), Header::Call(0x1000));
        assert_eq!((header(0x0002_0000), header(0x8000_0000)), (Header::Return, Header::Unknown));
    }

    #[test]
    fn words_follow_their_headers() {
        let mut words = Words::default();
        let mut events = Vec::new();
        for word in [0x0008_0300, 1, 0, 0x4008_1818, 7, 8, 0, 0x9000_0000, 0x0008_0304, 5] {
            words.take(word, &mut |event| events.push(event));
        }
        let write = |method, word| Event::Write(Write { class: KELVIN, method, word });
        let expected = [
            write(0x300, 1),
            write(0x304, 0),
            write(0x1818, 7),
            write(0x1818, 8),
            Event::Fault(Fault::Header(0x9000_0000)),
            write(0x304, 5),
        ];
        assert_eq!(events, expected);
        assert_eq!((words.finish(), words.finish()), (Some(Fault::End(1)), None));
    }
}
