//! The state of the 3D class, followed through a log. The first class of the log that is one decides which family it is of.
//!
//! A word that the log never set is not known: [`State::get`] says so, and nothing else stands in its place but what the user assumes.

use std::collections::{BTreeMap, BTreeSet};
use std::mem;

use crate::celsius::{self, StateWord};
use crate::class::{self, Family, METHOD_BYTES, Treatment};
use crate::log::{Event, Write};
use crate::vertex::formats::normalized;
use crate::vertex::microcode::{CONSTANTS, SLOTS};
use crate::vertex::{ATTRIBUTES, Attributes, DEFAULT};

/// Constant that SET_VIEWPORT_SCALE sets; the one behind it is set by SET_VIEWPORT_OFFSET.
const VIEWPORT_CONSTANTS: [(u32, usize); 2] = [(class::SET_VIEWPORT_SCALE, 58), (class::SET_VIEWPORT_OFFSET, 59)];

/// Most vertices, indices or inline words of a draw.
pub const LONGEST_DRAW: usize = 1 << 20;

/// Words that may not be known.
#[derive(Clone, Debug)]
pub struct Words {
    values: Vec<u32>,
    known: Vec<bool>,
}

impl Words {
    fn new(count: usize) -> Words {
        Words { values: vec![0; count], known: vec![false; count] }
    }

    /// Returns a word if it is known.
    pub fn get(&self, index: usize) -> Option<u32> {
        self.known.get(index)?.then(|| self.values[index])
    }

    fn set(&mut self, index: usize, word: u32) {
        if let Some(value) = self.values.get_mut(index) {
            (*value, self.known[index]) = (word, true);
        }
    }
}

/// Groups of four words that are sent one after the other, from a place that is said before.
#[derive(Clone, Debug)]
struct Upload {
    words: Words,
    /// The group that the next word belongs to.
    next: Option<u32>,
}

impl Upload {
    fn new(groups: usize) -> Upload {
        Upload { words: Words::new(4 * groups), next: None }
    }

    /// Takes a word, whose method says which of the four it is; the fourth moves on to the next group. A word before the first address is lost.
    fn take(&mut self, method: u32, word: u32) {
        let Some(group) = self.next else { return };
        let part = method / 4 % 4;
        self.words.set((group as usize).saturating_mul(4).saturating_add(part as usize), word);
        if part == 3 {
            self.next = group.checked_add(1);
        }
    }
}

/// The vertices of a draw as the program sent them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Batch {
    /// The primitive, as SET_BEGIN_END names it.
    pub primitive: u32,
    /// Line of the log where it begins.
    pub line: u64,
    /// Words of inline vertices.
    pub inline: Vec<u32>,
    /// Indices into the vertex arrays.
    pub indices: Vec<u32>,
    /// The attributes of vertices that were sent one by one.
    pub immediate: Vec<Attributes>,
    /// The edge flag of each of these.
    pub edge_flags: Vec<bool>,
    /// Words that the log does not have, by method.
    pub dropped: BTreeMap<u32, u64>,
    /// Methods within the draw that are not modelled.
    pub open: BTreeSet<u32>,
    /// Whether it has more than [`LONGEST_DRAW`] of anything; the rest is left out.
    pub cut: bool,
}

/// An event that draws or ends something.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// A draw is complete.
    Draw(Box<Batch>),
    /// CLEAR_SURFACE, with its word.
    Clear(u32),
    /// The frame is complete.
    Flip,
}

/// The state of the class.
#[derive(Clone, Debug)]
pub struct State {
    /// The family of the class; `None` before the first word.
    family: Option<Family>,
    words: Words,
    program: Upload,
    constants: Upload,
    /// The current attributes, and which of them are known.
    pub attributes: Attributes,
    known_attributes: u16,
    batch: Option<Box<Batch>>,
}

impl Default for State {
    fn default() -> State {
        State {
            family: None,
            words: Words::new((METHOD_BYTES / 4) as usize),
            program: Upload::new(SLOTS),
            constants: Upload::new(CONSTANTS),
            attributes: [DEFAULT; ATTRIBUTES],
            known_attributes: 0,
            batch: None,
        }
    }
}

impl State {
    /// Returns the family of the class, which is Kelvin's before the first word.
    pub fn family(&self) -> Family {
        self.family.unwrap_or_default()
    }

    /// Returns a word of state that the log or the user set, by the class's own number.
    pub fn get(&self, method: u32) -> Option<u32> {
        self.words.get(method as usize / 4)
    }

    /// Returns what is known of a state, by Kelvin's number.
    pub(crate) fn state_word(&self, kelvin: u32) -> StateWord {
        match self.family() {
            Family::Kelvin => self.get(kelvin).map_or(StateWord::Unset(kelvin), StateWord::Word),
            Family::Celsius => celsius::state_word(kelvin, |number| self.get(number)),
        }
    }

    /// Takes the family of a class; returns whether the class is of the log's family.
    fn is_of(&mut self, class: u32) -> bool {
        let family = Family::from_class(class);
        family.is_some() && *self.family.get_or_insert(family.unwrap_or_default()) == family.unwrap_or_default()
    }

    /// Returns a word of the vertex program.
    pub fn program(&self, slot: usize, word: usize) -> Option<u32> {
        self.program.words.get(4 * slot + word)
    }

    /// Returns a constant of the vertex program.
    pub fn constant(&self, index: usize) -> Option<[f32; 4]> {
        let word = |n| self.constants.words.get(4 * index + n).map(f32::from_bits);
        Some([word(0)?, word(1)?, word(2)?, word(3)?])
    }

    /// Returns whether an attribute was set.
    pub fn knows_attribute(&self, attribute: usize) -> bool {
        self.known_attributes >> attribute & 1 != 0
    }

    /// Returns whether a draw has begun and not ended.
    pub fn is_drawing(&self) -> bool {
        self.batch.is_some()
    }

    /// Sets a word of a class as if the log had it, without what it would do.
    pub fn assume(&mut self, class: u32, method: u32, word: u32) {
        if !self.is_of(class) {
            return;
        }
        match self.family().find(method).map(|place| place.method.treatment) {
            Some(Treatment::Draw | Treatment::Flip) => {}
            _ => {
                let _ = self.write(0, method, word);
            }
        }
    }

    /// Sets what is not known yet: words of Kelvin's methods, and the vertex program with its constants.
    pub fn complete(&mut self, words: &BTreeMap<u32, u32>, program: &[[u32; 4]], constants: &[[u32; 4]]) {
        for (method, word) in words {
            if self.get(*method).is_none() {
                self.words.set(*method as usize / 4, *word);
            }
        }
        for (upload, dumped) in [(&mut self.program, program), (&mut self.constants, constants)] {
            for (at, word) in dumped.iter().flatten().enumerate() {
                if upload.words.get(at).is_none() {
                    upload.words.set(at, *word);
                }
            }
        }
    }

    /// Follows an event of a log. Events of other classes change nothing.
    pub fn follow(&mut self, line: u64, event: &Event) -> Option<Action> {
        match *event {
            Event::Write(Write { class, method, word }) if self.is_of(class) => self.write(line, method, word),
            Event::Dropped { class, method, count } if self.is_of(class) => {
                if let Some(batch) = &mut self.batch {
                    *batch.dropped.entry(method).or_default() += count.unwrap_or(1);
                } else if let Some(known) = self.words.known.get_mut(method as usize / 4) {
                    // The last word that went there is not in the log.
                    *known = false;
                }
                None
            }
            Event::Flip => Some(Action::Flip),
            _ => None,
        }
    }

    fn write(&mut self, line: u64, method: u32, word: u32) -> Option<Action> {
        let family = self.family();
        let place = family.find(method);
        let kelvin = place.and_then(|place| family.kelvin(&place));
        match (place.map(|place| place.method.treatment), kelvin) {
            (Some(Treatment::Draw), Some(kelvin)) => return self.draw(line, kelvin, word),
            (Some(Treatment::Flip), _) => return Some(Action::Flip),
            (Some(Treatment::Program), _) => self.program.take(method, word),
            (Some(Treatment::Constant), _) => self.constants.take(method, word),
            (Some(Treatment::Vertex), Some(kelvin)) => self.vertex(kelvin, word),
            (Some(Treatment::Open), _) => {
                if let Some(batch) = &mut self.batch {
                    batch.open.insert(method);
                }
            }
            _ => {}
        }
        self.words.set(method as usize / 4, word);
        if family != Family::Kelvin {
            return None;
        }
        match method {
            class::SET_TRANSFORM_PROGRAM_LOAD => self.program.next = Some(word),
            class::SET_TRANSFORM_CONSTANT_LOAD => self.constants.next = Some(word),
            _ => {}
        }
        for (first, constant) in VIEWPORT_CONSTANTS {
            if (first..first + 16).contains(&method) {
                self.constants.words.set(4 * constant + ((method - first) / 4) as usize, word);
            }
        }
        None
    }

    /// Takes a word of a draw, by Kelvin's number.
    fn draw(&mut self, line: u64, method: u32, word: u32) -> Option<Action> {
        let most = if self.family() == Family::Kelvin { 0xff_ffff } else { 0xffff };
        match method {
            class::CLEAR_SURFACE => return Some(Action::Clear(word)),
            class::SET_BEGIN_END => {
                let ended = self.batch.take();
                if word != 0 {
                    self.batch = Some(Box::new(Batch { primitive: word, line, ..Batch::default() }));
                }
                return ended.map(Action::Draw);
            }
            _ => {}
        }
        let batch = self.batch.as_mut()?;
        let put = |list: &mut Vec<u32>, words: &mut dyn Iterator<Item = u32>| {
            list.extend(words.take(LONGEST_DRAW - list.len()));
            list.len() >= LONGEST_DRAW
        };
        batch.cut |= match method {
            class::ARRAY_ELEMENT16 => put(&mut batch.indices, &mut [word & 0xffff, word >> 16].into_iter()),
            class::ARRAY_ELEMENT32 => put(&mut batch.indices, &mut [word].into_iter()),
            class::DRAW_ARRAYS => {
                let (first, count) = (word & most, (word >> 24) + 1);
                put(&mut batch.indices, &mut (first..first + count))
            }
            _ => put(&mut batch.inline, &mut [word].into_iter()),
        };
        None
    }

    /// Takes a word of an attribute, by Kelvin's number. The last word of the position makes a vertex.
    fn vertex(&mut self, method: u32, word: u32) {
        let Some((attribute, kind, at, last)) = attribute(method) else { return };
        let value = &mut self.attributes[attribute];
        kind.put(value, at, word);
        self.known_attributes |= 1 << attribute;
        let flag = self.state_word(class::SET_EDGE_FLAG);
        if attribute == 0
            && last
            && let Some(batch) = &mut self.batch
        {
            if batch.immediate.len() < LONGEST_DRAW / 4 {
                batch.immediate.push(self.attributes);
                batch.edge_flags.push(flag != StateWord::Word(0));
            } else {
                batch.cut = true;
            }
        }
    }

    /// Takes the draw that the end of the log cuts off.
    pub fn unfinished(&mut self) -> Option<Box<Batch>> {
        mem::take(&mut self.batch)
    }
}

/// How a word of an immediate attribute becomes numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// A number of binary32, of an attribute of so many.
    Float(usize),
    /// Two 16-bit integers, of an attribute of so many.
    Shorts(usize),
    /// Two 16-bit integers that stand for -1 to 1, of an attribute of so many.
    Signed(usize),
    /// Four bytes that stand for 0 to 1, the first the lowest.
    Bytes,
}

impl Kind {
    #[allow(clippy::float_arithmetic, reason = "attributes are binary32")]
    fn put(self, value: &mut [f32; 4], at: usize, word: u32) {
        let halves = [word as u16 as i16, (word >> 16) as i16];
        let count = match self {
            Kind::Float(count) => {
                value[at] = f32::from_bits(word);
                count
            }
            Kind::Shorts(count) => {
                value[2 * at..2 * at + 2].copy_from_slice(&halves.map(f32::from));
                count
            }
            Kind::Signed(count) => {
                value[2 * at..2 * at + 2].copy_from_slice(&halves.map(normalized));
                count
            }
            Kind::Bytes => {
                *value = word.to_le_bytes().map(|byte| f32::from(byte) / 255.0);
                4
            }
        };
        value[count..].copy_from_slice(&DEFAULT[count..]);
    }
}

/// Returns the attribute that a method sets, how, the index of the word, and whether it is the last one.
fn attribute(method: u32) -> Option<(usize, Kind, usize, bool)> {
    let place = Family::Kelvin.find(method)?;
    let (at, last) = (place.word as usize, place.word + 1 == place.method.words);
    let element = place.element as usize;
    let (attribute, kind) = match place.method.number {
        0x1500 => (0, Kind::Float(3)),
        0x1518 => (0, Kind::Float(4)),
        0x1528 => (0, Kind::Shorts(4)),
        0x1530 => (2, Kind::Float(3)),
        0x1540 => (2, Kind::Signed(3)),
        0x1550 => (3, Kind::Float(4)),
        0x1560 => (3, Kind::Float(3)),
        0x156c => (3, Kind::Bytes),
        0x1570 => (4, Kind::Float(4)),
        0x1580 => (4, Kind::Float(3)),
        0x158c => (4, Kind::Bytes),
        0x1590 => (9, Kind::Float(2)),
        0x1598 => (9, Kind::Shorts(2)),
        0x15a0 => (9, Kind::Float(4)),
        0x15b0 => (9, Kind::Shorts(4)),
        0x15b8 => (10, Kind::Float(2)),
        0x15c0 => (10, Kind::Shorts(2)),
        0x15c8 => (10, Kind::Float(4)),
        0x15d8 => (10, Kind::Shorts(4)),
        0x15e0 => (11, Kind::Float(2)),
        0x15e8 => (11, Kind::Shorts(2)),
        0x15f0 => (11, Kind::Float(4)),
        0x1600 => (11, Kind::Shorts(4)),
        0x1608 => (12, Kind::Float(2)),
        0x1610 => (12, Kind::Shorts(2)),
        0x1620 => (12, Kind::Float(4)),
        0x1630 => (12, Kind::Shorts(4)),
        0x1698 => (5, Kind::Float(1)),
        0x169c => (1, Kind::Float(1)),
        0x16a0 => (1, Kind::Float(2)),
        0x16b0 => (1, Kind::Float(3)),
        0x16c0 => (1, Kind::Float(4)),
        0x1880 => (element, Kind::Float(2)),
        0x1900 => (element, Kind::Shorts(2)),
        0x1940 => (element, Kind::Bytes),
        0x1980 => (element, Kind::Shorts(4)),
        0x1a00 => (element, Kind::Float(4)),
        _ => return None,
    };
    Some((attribute, kind, at, last))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::class::KELVIN;

    fn follow(state: &mut State, writes: &[(u32, u32)]) -> Vec<Action> {
        let event = |(method, word): &(u32, u32)| Event::Write(Write { class: KELVIN, method: *method, word: *word });
        writes.iter().zip(1..).filter_map(|(write, line)| state.follow(line, &event(write))).collect()
    }

    #[test]
    fn every_attribute_has_a_method() {
        let vertex = |method: &&class::Method| method.treatment == Treatment::Vertex;
        for method in Family::Kelvin.methods().iter().filter(vertex) {
            assert!(attribute(method.number).is_some(), "{}", method.name);
        }
    }

    #[test]
    fn draws_collect_what_is_sent() {
        let mut state = State::default();
        let actions = follow(
            &mut state,
            &[
                (class::INLINE_ARRAY, 1),
                (class::SET_BEGIN_END, 5),
                (class::INLINE_ARRAY, 7),
                (class::ARRAY_ELEMENT16, 0x0002_0001),
                (class::DRAW_ARRAYS, 0x0100_0010),
                (0x1940 + 12, 0xff00_3300),
                (0x1880, 0x3f80_0000),
                (0x1884, 0x4000_0000),
                (class::SET_BEGIN_END, 0),
                (class::CLEAR_SURFACE, 0xf3),
            ],
        );
        let Action::Draw(batch) = &actions[0] else { panic!("{actions:?}") };
        assert_eq!((batch.primitive, batch.line, &batch.inline), (5, 2, &vec![7]));
        assert_eq!(batch.indices, [1, 2, 16, 17]);
        assert_eq!(batch.immediate[0][3], [0.0, 0.2, 0.0, 1.0]);
        assert_eq!(batch.immediate[0][0], [1.0, 2.0, 0.0, 1.0]);
        assert_eq!(actions[1..], [Action::Clear(0xf3)]);
        assert!(state.knows_attribute(3) && !state.knows_attribute(4));
    }

    #[test]
    fn what_was_never_set_is_not_known() {
        let mut state = State::default();
        assert_eq!(state.get(class::SET_COLOR_MASK), None);
        follow(&mut state, &[(class::SET_COLOR_MASK, 0x0101_0101)]);
        assert_eq!(state.get(class::SET_COLOR_MASK), Some(0x0101_0101));
        state.follow(2, &Event::Dropped { class: KELVIN, method: class::SET_COLOR_MASK, count: None });
        assert_eq!(state.get(class::SET_COLOR_MASK), None);
        state.follow(3, &Event::Write(Write { class: 0x44, method: class::SET_COLOR_MASK, word: 1 }));
        assert_eq!(state.get(class::SET_COLOR_MASK), None);
    }

    #[test]
    fn programs_and_constants_go_where_they_are_loaded() {
        let mut state = State::default();
        follow(&mut state, &[(class::SET_TRANSFORM_PROGRAM, 9)]);
        assert_eq!(state.program(0, 0), None);
        let word = |n: u32| (class::SET_TRANSFORM_PROGRAM + 4 * n, n);
        let mut writes = vec![(class::SET_TRANSFORM_PROGRAM_LOAD, 134)];
        writes.extend((0..8).map(word));
        // Beyond the last slot there is nothing.
        writes.extend((0..4).map(word));
        writes.extend([
            (class::SET_TRANSFORM_CONSTANT_LOAD, 0x74),
            (0xb80, 0x3f80_0000),
            (0xb84, 0),
            (0xb88, 0),
            (0xb8c, 0),
        ]);
        writes.extend([(class::SET_VIEWPORT_OFFSET, 0x3f00_0000), (class::SET_VIEWPORT_OFFSET + 4, 0)]);
        follow(&mut state, &writes);
        assert_eq!([0, 1, 2, 3].map(|n| state.program(135, n)), [4, 5, 6, 7].map(Some));
        assert_eq!((state.program(133, 0), state.program(136, 0)), (None, None));
        assert_eq!((state.constant(0x74), state.constant(0x75)), (Some([1.0, 0.0, 0.0, 0.0]), None));
        assert_eq!(state.constants.words.get(4 * 59), Some(0x3f00_0000));
    }
}
