//! The register file of the combiners.

use crate::number::Lane;
use crate::state::Register;

/// Number of registers, including ZERO.
pub(crate) const REGISTERS: usize = 12;

/// The registers of one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Registers<L> {
    /// The values, indexed by [`Register`] and then by channel R, G, B, A.
    pub values: [[L; 4]; REGISTERS],
}

/// Returns the bit of a register's channel in a set of channels of registers.
pub(crate) fn bit(register: Register, channel: usize) -> u64 {
    1 << (4 * register as usize + channel)
}

/// Returns the bits of all four channels of a register.
pub(crate) fn bits(register: Register) -> u64 {
    15 << (4 * register as usize)
}

impl<L: Lane> Registers<L> {
    /// CMB-13: returns registers that are all zero. The caller loads what the pixel provides, including SPARE0's alpha.
    #[inline]
    pub fn new() -> Self {
        Registers::from_value(L::ZERO)
    }
}

impl<V: Copy> Registers<V> {
    /// Returns registers with `value` in every channel.
    #[inline]
    pub fn from_value(value: V) -> Self {
        Registers { values: [[value; 4]; REGISTERS] }
    }

    /// Loads all channels of a register.
    #[inline]
    pub fn load(&mut self, register: Register, value: [V; 4]) {
        self.values[register as usize] = value;
    }

    /// Loads the two constant colours.
    #[inline(always)]
    pub fn load_constants(&mut self, [first, second]: [[V; 4]; 2]) {
        self.load(Register::ConstantColor0, first);
        self.load(Register::ConstantColor1, second);
    }

    /// Writes one channel of a register.
    #[inline(always)]
    pub fn write(&mut self, register: Register, channel: usize, value: V) {
        self.values[register as usize][channel] = value;
    }

    /// Reads one channel of a register.
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

/// Returns the channels that no document defines before a stage writes them: SPARE0's colour and SPARE1 (CMB-13). They
/// are taken as 0.
pub(crate) fn initially_undefined() -> u64 {
    (bits(Register::Spare0) & !bit(Register::Spare0, 3)) | bits(Register::Spare1)
}

/// Returns the register's name in traces, which follows the vendor's extension.
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

/// Returns the letter of a channel.
pub fn channel_name(channel: usize) -> &'static str {
    ["r", "g", "b", "a"][channel]
}
