//! The register file of the combiners.

use crate::number::Lane;
use crate::state::Register;

/// Number of registers, ZERO included.
pub const REGISTERS: usize = 12;

/// The registers of one pixel; index by [`Register`], then by channel R, G, B, A.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Registers<L> {
    /// The values, by [register](Register) and channel.
    pub values: [[L; 4]; REGISTERS],
}

/// The bit of a channel in a set of channels of registers.
pub fn bit(register: Register, channel: usize) -> u64 {
    1 << (4 * register as usize + channel)
}

/// All four channels of a register.
pub fn bits(register: Register) -> u64 {
    15 << (4 * register as usize)
}

impl<L: Lane> Registers<L> {
    /// CMB-13: zeros; the caller loads what the pixel brings, SPARE0's alpha included.
    #[inline]
    pub fn new() -> Self {
        Registers::from_value(L::ZERO)
    }
}

impl<V: Copy> Registers<V> {
    /// A set that holds the value in every channel of every register.
    #[inline]
    pub fn from_value(value: V) -> Self {
        Registers { values: [[value; 4]; REGISTERS] }
    }

    /// Loads a register before the first stage.
    #[inline]
    pub fn load(&mut self, register: Register, value: [V; 4]) {
        self.values[register as usize] = value;
    }

    /// Sets one channel.
    #[inline(always)]
    pub fn write(&mut self, register: Register, channel: usize, value: V) {
        self.values[register as usize][channel] = value;
    }

    /// Reads one channel.
    #[inline(always)]
    pub fn read(&self, register: Register, channel: usize) -> V {
        self.values[register as usize][channel]
    }
}

impl<L: Lane> Default for Registers<L> {
    fn default() -> Self {
        Self::new()
    }
}

/// What no document defines before a stage writes it: SPARE0's colour and SPARE1 (CMB-13), taken as 0.
pub fn initially_undefined() -> u64 {
    (bits(Register::Spare0) & !bit(Register::Spare0, 3)) | bits(Register::Spare1)
}

/// The register's name in traces, after the vendor extension.
pub fn name(register: Register) -> &'static str {
    match register {
        Register::Zero => "zero",
        Register::ConstantColor0 => "constant0",
        Register::ConstantColor1 => "constant1",
        Register::Fog => "fog",
        Register::PrimaryColor => "primary",
        Register::SecondaryColor => "secondary",
        Register::Texture0 => "texture0",
        Register::Texture1 => "texture1",
        Register::Texture2 => "texture2",
        Register::Texture3 => "texture3",
        Register::Spare0 => "spare0",
        Register::Spare1 => "spare1",
    }
}

/// The channel's letter.
pub fn channel_name(channel: usize) -> &'static str {
    ["r", "g", "b", "a"][channel]
}
