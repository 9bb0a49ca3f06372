//! The reasons for which an import cannot state a draw as it was.

use std::fmt;

use crate::class::{self, Family};

/// Something that a draw needs and the log, the memory or the model does not have.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Gap {
    /// Words of state that no line set, from the first method to the last.
    Unset(Family, u32, u32),
    /// Constants or slots of the vertex program that no line set, from the first to the last.
    UnsetProgram(&'static str, u32, u32),
    /// Words of a method that the log dropped.
    Dropped(Family, u32, u64),
    /// No memory was given for something at an address.
    NoMemory(String, u64),
    /// The memory that was given ends before it.
    OutsideMemory(String, u64),
    /// The contents of a surface before the first draw that the log has.
    UnknownContents(u64),
    /// A state that the model does not have.
    NotModelled(String),
    /// A value that the method does not take.
    BadValue(Family, u32, u32),
    /// A limit of scenes.
    TooMany(String),
    /// The log ends within the draw.
    Unfinished,
}

impl Gap {
    /// Returns the kind of the gap, for summaries.
    pub fn kind(&self) -> &'static str {
        match self {
            Gap::Unset(..) | Gap::UnsetProgram(..) => "state that was never set in this log",
            Gap::Dropped(..) => "words that the log does not have",
            Gap::NoMemory(..) => "no memory was given",
            Gap::OutsideMemory(..) => "outside of the memory that was given",
            Gap::UnknownContents(..) => "contents from before the log",
            Gap::NotModelled(..) => "not modelled",
            Gap::BadValue(..) => "values that a method does not take",
            Gap::TooMany(..) => "limits of scenes",
            Gap::Unfinished => "the log ends within it",
        }
    }
}

impl fmt::Display for Gap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Gap::Unset(family, first, last) if first == last => {
                write!(f, "{} was never set in this log", family.label(*first))
            }
            Gap::Unset(family, first, last) => {
                write!(f, "{} to {} were never set in this log", family.label(*first), family.label(*last))
            }
            Gap::UnsetProgram(what, first, last) if first == last => {
                write!(f, "{what} {first} was never set in this log")
            }
            Gap::UnsetProgram(what, first, last) => write!(f, "{what}s {first} to {last} were never set in this log"),
            Gap::Dropped(family, method, count) => {
                let command = family.find(*method).and_then(|place| family.kelvin(&place));
                match command {
                    Some(class::ARRAY_ELEMENT16 | class::ARRAY_ELEMENT32) => {
                        write!(f, "{count} words of indices were not recorded")
                    }
                    _ => write!(f, "{count} words of {} were not recorded", family.label(*method)),
                }
            }
            Gap::NoMemory(what, address) => write!(f, "{what} at 0x{address:08x}: no memory was given"),
            Gap::OutsideMemory(what, address) => {
                write!(f, "{what} at 0x{address:08x}: outside of the memory that was given")
            }
            Gap::UnknownContents(address) => {
                write!(f, "the surface at 0x{address:08x} held something before this log, which black stands for")
            }
            Gap::NotModelled(what) => write!(f, "{what}: not modelled"),
            Gap::BadValue(family, method, word) => write!(f, "{} does not take 0x{word:x}", family.label(*method)),
            Gap::TooMany(what) => f.write_str(what),
            Gap::Unfinished => f.write_str("the log ends within the draw"),
        }
    }
}
