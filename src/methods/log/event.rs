//! The parts of a log.

/// A word that a program sent to a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Write {
    /// Class of the object that the subchannel has.
    pub class: u32,
    /// Number of the method in bytes.
    pub method: u32,
    /// The word.
    pub word: u32,
}

/// A part of a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// A method and its word.
    Write(Write),
    /// Words of a method that the log does not have.
    Dropped {
        /// Class of the object.
        class: u32,
        /// Number of the method in bytes.
        method: u32,
        /// Number of words; `None` if the log does not say.
        count: Option<u64>,
    },
    /// The end of a frame.
    Flip,
    /// The number of a dump of the surfaces that were written after a draw.
    SurfaceDump(u64),
    /// Words of a push buffer that make no sense.
    Fault(Fault),
}

/// An event with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Number of the line, from 1.
    pub line: u64,
    /// What stands there.
    pub event: Event,
}

/// A word of a push buffer that makes no sense.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A header of no known form.
    Header(u32),
    /// A jump, a call or a return in words whose memory is not given.
    Branch(u32),
    /// The words end within a command, which lacks so many.
    End(u32),
}
