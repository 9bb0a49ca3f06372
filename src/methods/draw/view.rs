//! The state as a draw reads it: a word that is not known has a neutral value, and is noted.

use std::collections::BTreeSet;

use crate::celsius::StateWord;
use crate::class::{self, Family};
use crate::gap::Gap;
use crate::state::State;

/// Reads state, and collects what is missing.
#[derive(Debug)]
pub(crate) struct View<'a> {
    state: &'a State,
    unset: BTreeSet<u32>,
    /// The gaps other than words that were never set.
    pub(crate) gaps: Vec<Gap>,
}

/// The values that stand for words of state that are not known, where 0 would draw nothing or divide by 0: those that drivers set first.
const NEUTRAL: [(u32, u32); 21] = [
    (class::SET_SURFACE_CLIP_HORIZONTAL, 640 << 16),
    (class::SET_SURFACE_CLIP_VERTICAL, 480 << 16),
    (class::SET_SURFACE_FORMAT, 0x128),
    (class::SET_CONTROL0, 0x10_0001),
    (class::SET_ALPHA_FUNC, 0x207),
    (class::SET_BLEND_FUNC_SFACTOR, 1),
    (class::SET_BLEND_EQUATION, 0x8006),
    (class::SET_DEPTH_FUNC, 0x201),
    (class::SET_COLOR_MASK, 0x0101_0101),
    (class::SET_DEPTH_MASK, 1),
    (class::SET_STENCIL_MASK, 0xff),
    (class::SET_STENCIL_FUNC, 0x207),
    (class::SET_STENCIL_FUNC_MASK, 0xff),
    (class::SET_SHADE_MODEL, 0x1d01),
    (class::SET_LINE_WIDTH, 8),
    (class::SET_FRONT_POLYGON_MODE, 0x1b02),
    (class::SET_BACK_POLYGON_MODE, 0x1b02),
    (class::SET_CULL_FACE, 0x405),
    (class::SET_FRONT_FACE, 0x901),
    (class::SET_POINT_SIZE, 8),
    (class::SET_FOG_MODE, 0x2601),
];

impl<'a> View<'a> {
    /// Makes a view of a state.
    pub(crate) fn new(state: &'a State) -> View<'a> {
        View { state, unset: BTreeSet::new(), gaps: Vec::new() }
    }

    /// Returns the state.
    pub(crate) fn state(&self) -> &'a State {
        self.state
    }

    /// Returns the family of the class.
    pub(crate) fn family(&self) -> Family {
        self.state.family()
    }

    /// Returns a word, by Kelvin's number. One that is not known is noted.
    pub(crate) fn get(&mut self, method: u32) -> u32 {
        self.word(method).unwrap_or_else(|| {
            self.missing(method);
            neutral(method)
        })
    }

    /// Returns a word by the class's own number. One that is not known is noted.
    pub(crate) fn own(&mut self, number: u32) -> u32 {
        self.state.get(number).unwrap_or_else(|| {
            self.unset.insert(number);
            0
        })
    }

    /// Returns a word, or a value that the chip certainly has where nothing was set.
    pub(crate) fn get_or(&self, method: u32, otherwise: u32) -> u32 {
        self.word(method).unwrap_or(otherwise)
    }

    /// Returns a word if it is known.
    pub(crate) fn word(&self, method: u32) -> Option<u32> {
        match self.state.state_word(method) {
            StateWord::Word(word) => Some(word),
            _ => None,
        }
    }

    /// Returns a word as a number.
    pub(crate) fn float(&mut self, method: u32) -> f32 {
        f32::from_bits(self.get(method))
    }

    /// Returns whether a word is not 0.
    pub(crate) fn enabled(&mut self, method: u32) -> bool {
        self.get(method) != 0
    }

    /// Notes a gap once.
    pub(crate) fn note(&mut self, gap: Gap) {
        if !self.gaps.contains(&gap) {
            self.gaps.push(gap);
        }
    }

    /// Notes a word that is missing, by Kelvin's number.
    pub(crate) fn missing(&mut self, method: u32) {
        match self.state.state_word(method) {
            StateWord::Unset(number) => _ = self.unset.insert(number),
            StateWord::Word(_) => {}
            StateWord::Absent => {
                let what = format!("the class has nothing in place of Kelvin's {}", Family::Kelvin.label(method));
                self.note(Gap::NotModelled(what));
            }
        }
    }

    /// Notes a word of the class's own that is missing.
    pub(crate) fn missing_own(&mut self, number: u32) {
        self.unset.insert(number);
    }

    /// Notes that a method does not take its value.
    pub(crate) fn bad(&mut self, method: u32) {
        let family = self.family();
        let number = family.own(method).unwrap_or(method);
        let word = self.state.get(number).unwrap_or_else(|| neutral(method));
        self.note(Gap::BadValue(family, number, word));
    }

    /// Returns all gaps, words that were never set as ranges first.
    pub(crate) fn finish(self) -> Vec<Gap> {
        let (mut gaps, family): (Vec<Gap>, Family) = (Vec::new(), self.family());
        for method in self.unset {
            match gaps.last_mut() {
                Some(Gap::Unset(.., last)) if *last + 4 == method => *last = method,
                _ => gaps.push(Gap::Unset(family, method, method)),
            }
        }
        gaps.extend(self.gaps);
        gaps
    }
}

fn neutral(method: u32) -> u32 {
    NEUTRAL.iter().find(|(number, _)| *number == method).map_or(0, |(_, word)| *word)
}
