//! Places constants of the language in the constant registers of a stage, whose bytes have no sign.

use super::{CONSTANTS, PixelShader};
use ninebit::number::convert::constant;
use ninebit::state::{Component, Register};

/// Constants R, G, B, A in 255ths, from -255 to 255.
pub(super) type Signed = [[i16; 4]; CONSTANTS];

/// Returns the values of all constants, clamped to -1..1. Definitions in the shader replace the given values.
pub(super) fn values(program: &PixelShader, given: &[[f32; 4]; CONSTANTS]) -> [[f32; 4]; CONSTANTS] {
    let mut values = *given;
    for definition in &program.definitions {
        if let Some(slot) = values.get_mut(usize::from(definition.index)) {
            *slot = definition.value;
        }
    }
    values.map(|value| value.map(|c| c.clamp(-1.0, 1.0)))
}

/// Converts the absolute value of a number by NUM-0, and keeps the sign.
pub(super) fn signed(c: f32) -> i16 {
    let size = i16::from(constant(c.abs()));
    if c < 0.0 { -size } else { size }
}

/// The two constant registers of a stage. Their colours and alphas are allocated separately, so that all four halves can be used.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pool {
    colors: [Option<[u8; 3]>; 2],
    alphas: [Option<u8>; 2],
}

const REGISTERS: [Register; 2] = [Register::ConstantColor0, Register::ConstantColor1];

fn place<T: PartialEq>(slots: &mut [Option<T>; 2], value: T) -> Option<Register> {
    let at = slots.iter().position(|slot| slot.as_ref() == Some(&value));
    let at = at.or_else(|| slots.iter().position(Option::is_none))?;
    slots[at] = Some(value);
    Some(REGISTERS[at])
}

impl Pool {
    /// Places a colour for an RGB portion; `None` if there is no room.
    pub(super) fn color(&mut self, color: [u8; 3]) -> Option<(Register, Component)> {
        place(&mut self.colors, color).map(|register| (register, Component::Rgb))
    }

    /// Places one number for an alpha portion; `None` if there is no room.
    pub(super) fn alpha(&mut self, alpha: u8) -> Option<(Register, Component)> {
        place(&mut self.alphas, alpha).map(|register| (register, Component::Alpha))
    }

    /// Places one number for an RGB portion, where it is already or where there is room; `None` if there is none.
    pub(super) fn scalar(&mut self, value: u8) -> Option<(Register, Component)> {
        if !self.alphas.contains(&Some(value)) && self.colors.contains(&Some([value; 3])) {
            return self.color([value; 3]);
        }
        self.alpha(value).or_else(|| self.color([value; 3]))
    }

    /// Returns the values R, G, B, A of both constant registers; 0 where nothing was placed.
    pub(super) fn registers(&self) -> [[u8; 4]; 2] {
        [0, 1].map(|n| {
            let [r, g, b] = self.colors[n].unwrap_or_default();
            [r, g, b, self.alphas[n].unwrap_or_default()]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_have_signs() {
        assert_eq!([0.5, -0.5, -1.0, 0.0, -0.001].map(signed), [128, -128, -255, 0, 0]);
    }

    #[test]
    fn both_halves_of_both_registers_are_used() {
        let mut pool = Pool::default();
        let [c0, c1] = REGISTERS;
        assert_eq!(pool.color([1, 2, 3]), Some((c0, Component::Rgb)));
        assert_eq!([pool.alpha(9), pool.alpha(8)], [Some((c0, Component::Alpha)), Some((c1, Component::Alpha))]);
        assert_eq!(pool.scalar(8), Some((c1, Component::Alpha)));
        assert_eq!(pool.scalar(7), Some((c1, Component::Rgb)));
        assert_eq!([pool.scalar(6), pool.color([1, 1, 1]), pool.alpha(1)], [None; 3]);
        assert_eq!(pool.registers(), [[1, 2, 3, 9], [7, 7, 7, 8]]);
    }
}
