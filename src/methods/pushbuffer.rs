//! Words of a push buffer that lie in memory.

use crate::log::{Entry, Event, Fault, Header, Words, header};
use crate::memory::Memory;

/// Most words that are followed: what a minute of a demanding program sends.
const MOST_WORDS: u64 = 1 << 26;

/// Most calls inside each other. The chip has one; drivers of other chips nest.
const MOST_CALLS: usize = 16;

/// The reason for which a push buffer was not followed to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// A word lies outside of the memory.
    Outside(u64),
    /// The words run in a circle.
    Circle(u64),
    /// Calls inside each other without an end.
    Calls(u64),
}

/// Passes the words for a class from address `first` on until `end`. Jumps and calls are followed. The places of entries are addresses.
///
/// # Errors
/// The words lead out of the memory, or do not end.
pub fn follow(memory: &Memory, (first, end): (u64, u64), class: u32, each: &mut dyn FnMut(Entry)) -> Result<(), Stop> {
    let (mut at, mut calls) = (first, Vec::new());
    let mut words = Words::of_class(class);
    for _ in 0..MOST_WORDS {
        if at == end {
            if let Some(fault) = words.finish() {
                each(Entry { line: at, event: Event::Fault(fault) });
            }
            return Ok(());
        }
        let word = memory.word(at).ok_or(Stop::Outside(at))?;
        let place = at;
        at += 4;
        if !words.is_between() {
            each(Entry { line: place, event: Event::Write(words.data(word)) });
            continue;
        }
        match header(word) {
            Header::Command { method, subchannel, count, increasing } => {
                words.begin(method, subchannel, count, increasing)
            }
            Header::Jump(target) => at = target.into(),
            Header::Call(target) => {
                if calls.len() >= MOST_CALLS {
                    return Err(Stop::Calls(place));
                }
                calls.push(at);
                at = target.into();
            }
            Header::Return => match calls.pop() {
                Some(back) => at = back,
                None => each(Entry { line: place, event: Event::Fault(Fault::Branch(word)) }),
            },
            Header::Unknown => each(Entry { line: place, event: Event::Fault(Fault::Header(word)) }),
        }
    }
    Err(Stop::Circle(at))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::class::KELVIN;
    use crate::log::Write;

    fn read(words: &[u32], first: u64, end: u64) -> (Vec<Event>, Result<(), Stop>) {
        let memory = Memory::new(words.iter().flat_map(|word| word.to_le_bytes()).collect());
        let mut events = Vec::new();
        let result = follow(&memory, (first, end), KELVIN, &mut |entry| events.push(entry.event));
        (events, result)
    }

    fn write(method: u32, word: u32) -> Event {
        Event::Write(Write { class: KELVIN, method, word })
    }

    #[test]
    fn jumps_and_calls_are_followed() {
        // A jump to 0x14; there a call of 0x08, which returns; then a last command.
        let words = [0x15, 0, 0x0004_0304, 7, 0x0002_0000, 0x0a, 0x0004_0300, 1];
        let (events, result) = read(&words, 0, 0x20);
        assert_eq!(result, Ok(()));
        assert_eq!(events, [write(0x304, 7), write(0x300, 1)]);
    }

    #[test]
    fn circles_and_places_outside_end() {
        assert_eq!(read(&[1], 0, 8).1, Err(Stop::Circle(0)));
        assert_eq!(read(&[0x1001], 0, 8).1, Err(Stop::Outside(0x1000)));
        assert_eq!(read(&[2], 0, 8).1, Err(Stop::Calls(0)));
        let (events, result) = read(&[0x0002_0000, 0x0008_0300, 1], 0, 12);
        assert_eq!(result, Ok(()));
        assert_eq!(events, [Event::Fault(Fault::Branch(0x0002_0000)), write(0x300, 1), Event::Fault(Fault::End(1))]);
    }
}
