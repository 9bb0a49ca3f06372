//! The operations of texture stages, D3DTEXTUREOP, and their equations.

use crate::cascade::{Argument, Equation, Source};
use ninebit::state::{Named, Scale, named};

named! {
    /// D3DTEXTUREOP, in the order of the values 1 to 26. a0, a1, a2 are the arguments; results are clamped to 0..1.
    pub enum Operation {
        /// 1: this stage and all after it do nothing.
        Disable,
        /// 2: a1.
        SelectArg1,
        /// 3: a2.
        SelectArg2,
        /// 4: a1 a2.
        Modulate,
        /// 5: 2 a1 a2.
        Modulate2X,
        /// 6: 4 a1 a2.
        Modulate4X,
        /// 7: a1 + a2.
        Add,
        /// 8: a1 + a2 - 1/2.
        AddSigned,
        /// 9: 2 (a1 + a2 - 1/2).
        AddSigned2X,
        /// 10: a1 - a2.
        Subtract,
        /// 11: a1 + a2 - a1 a2.
        AddSmooth,
        /// 12: f a1 + (1 - f) a2, where f is the alpha of the diffuse colour.
        BlendDiffuseAlpha,
        /// 13: f a1 + (1 - f) a2, where f is the alpha of the stage's texture.
        BlendTextureAlpha,
        /// 14: f a1 + (1 - f) a2, where f is the alpha of the texture factor.
        BlendFactorAlpha,
        /// 15: a1 + (1 - f) a2, where f is the alpha of the stage's texture.
        BlendTextureAlphaPM,
        /// 16: f a1 + (1 - f) a2, where f is the alpha of the current colour.
        BlendCurrentAlpha,
        /// 17: a1 times the texture of the next stage.
        PreModulate,
        /// 18: a1 + a1.a a2. Colour only.
        ModulateAlphaAddColor,
        /// 19: a1 a2 + a1.a. Colour only.
        ModulateColorAddAlpha,
        /// 20: a1 + (1 - a1.a) a2. Colour only.
        ModulateInvAlphaAddColor,
        /// 21: (1 - a1) a2 + a1.a. Colour only.
        ModulateInvColorAddAlpha,
        /// 22: the stage's texture moves the coordinates of the next stage's texture. Colour only.
        BumpEnvMap,
        /// 23: like 22, and the next stage's texture is scaled by luminance. Colour only.
        BumpEnvMapLuminance,
        /// 24: the sum over R, G, B of (2 a1 - 1)(2 a2 - 1), in all four channels. Colour only.
        DotProduct3,
        /// 25: a0 + a1 a2.
        MultiplyAdd,
        /// 26: a0 a1 + (1 - a0) a2.
        Lerp,
    }
}

impl Operation {
    /// Returns the operation of a D3DTEXTUREOP value; `None` if there is none.
    pub(crate) fn from_value(value: u32) -> Option<Operation> {
        Operation::ALL.get((value as usize).checked_sub(1)?).copied()
    }

    /// Returns whether it moves the coordinates of the next texture and leaves the current colour alone.
    pub fn is_bump(self) -> bool {
        matches!(self, Operation::BumpEnvMap | Operation::BumpEnvMapLuminance)
    }

    /// Returns whether it is an operation of colour only: values 18 to 24.
    pub fn is_color_only(self) -> bool {
        (Operation::ModulateAlphaAddColor as u8..=Operation::DotProduct3 as u8).contains(&(self as u8))
    }

    /// Returns which of the arguments 0, 1, 2 it reads.
    pub fn reads(self) -> [bool; 3] {
        match self {
            Operation::Disable | Operation::BumpEnvMap | Operation::BumpEnvMapLuminance => [false; 3],
            Operation::SelectArg1 | Operation::PreModulate => [false, true, false],
            Operation::SelectArg2 => [false, false, true],
            Operation::MultiplyAdd | Operation::Lerp => [true; 3],
            _ => [false, true, true],
        }
    }

    /// Returns its equation, which passes the current colour on if nothing is computed. `texture` is the stage's texture, or for PreModulate that of
    /// the next stage; `factor` is the texture factor.
    pub(super) fn equation(self, [a0, a1, a2]: [Argument; 3], texture: Argument, factor: Argument) -> Equation {
        const ONE: Argument = Argument::ONE;
        const CURRENT: Argument = Argument::new(Source::Current);
        const DIFFUSE: Argument = Argument::new(Source::Primary);
        match self {
            Operation::Disable | Operation::BumpEnvMap | Operation::BumpEnvMapLuminance => Equation::copy(CURRENT),
            Operation::SelectArg1 => Equation::copy(a1),
            Operation::SelectArg2 => Equation::copy(a2),
            Operation::Modulate => Equation::product(a1, a2),
            Operation::Modulate2X => Equation::product(a1, a2).scaled(Scale::Two),
            Operation::Modulate4X => Equation::product(a1, a2).scaled(Scale::Four),
            Operation::Add => Equation::sum(a1, a2),
            Operation::AddSigned => Equation::signed_sum(a1, a2, Scale::One),
            Operation::AddSigned2X => Equation::signed_sum(a1, a2, Scale::Two),
            Operation::Subtract => Equation::difference(a1, a2),
            Operation::AddSmooth => Equation::products([a1, ONE], [a1.inverted(), a2]),
            Operation::BlendDiffuseAlpha => Equation::lerp(DIFFUSE.alpha(), a1, a2),
            Operation::BlendTextureAlpha => Equation::lerp(texture.alpha(), a1, a2),
            Operation::BlendFactorAlpha => Equation::lerp(factor.alpha(), a1, a2),
            Operation::BlendCurrentAlpha => Equation::lerp(CURRENT.alpha(), a1, a2),
            Operation::BlendTextureAlphaPM => Equation::products([a1, ONE], [a2, texture.alpha().inverted()]),
            Operation::PreModulate => Equation::product(a1, texture),
            Operation::ModulateAlphaAddColor => Equation::products([a1.alpha(), a2], [a1, ONE]),
            Operation::ModulateColorAddAlpha => Equation::products([a1, a2], [a1.alpha(), ONE]),
            Operation::ModulateInvAlphaAddColor => Equation::products([a1.alpha().inverted(), a2], [a1, ONE]),
            Operation::ModulateInvColorAddAlpha => Equation::products([a1.inverted(), a2], [a1.alpha(), ONE]),
            Operation::DotProduct3 => Equation::dot(a1, a2),
            Operation::MultiplyAdd => Equation::products([a0, ONE], [a1, a2]),
            Operation::Lerp => Equation::lerp(a0, a1, a2),
        }
    }
}
