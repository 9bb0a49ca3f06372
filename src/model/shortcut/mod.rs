//! Shortcuts: readings of rules that other renderers are known to take, and pictures drawn by them.
//!
//! A shortcut is no alternative of an undecided rule, as a [policy](crate::state::Policy) is: captures or documents speak against it. It
//! serves to recognise what another renderer does. The rules stay one text. A shortcut changes the state of a [plan](crate::plan), as a
//! renderer does that ignores a flag, or it keeps the [real numbers](Reals) of some rules where the definition has integers.

mod depths;
mod draw;
mod state;
mod texels;

pub use crate::engine::Reals;
pub use depths::shown_depth;
pub use draw::{Mask, PixelSelection, drawn, render, trace};

use crate::plan::Plan;
use crate::state::{Named, Policies, named};
use crate::trace::Rule;

/// What a shortcut is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading {
    /// Ids of the rules that it reads otherwise, the main one first.
    pub rules: &'static [&'static str],
    /// What it does in place of the rules, for a sentence that begins with the renderer.
    pub does: &'static str,
    /// The rules whose results stay real numbers.
    reals: &'static [Rule],
}

const COLORS: [Rule; 2] = [Rule::Num4, Rule::Int2];
const FILTER: [Rule; 10] = [
    Rule::Tex6,
    Rule::Tex9,
    Rule::Tex17,
    Rule::Int4,
    Rule::Tex12,
    Rule::Tex15,
    Rule::Tex20,
    Rule::Tsh4,
    Rule::Tsh6,
    Rule::Tsh7,
];
const COMBINERS: [Rule; 11] = [
    Rule::Cmb2,
    Rule::Cmb3,
    Rule::Cmb4,
    Rule::Cmb5,
    Rule::Cmb6,
    Rule::Cmb7,
    Rule::Cmb8,
    Rule::Cmb9,
    Rule::Num3,
    Rule::Fin2,
    Rule::Fin4,
];
const FOG: [Rule; 3] = [Rule::Num6, Rule::Fog2, Rule::Fog4];
/// All of a shader in floats, from the vertices' colours to the output.
const SHADER: [Rule; 29] = {
    let mut all = [Rule::Num4; 29];
    let parts: [&[Rule]; 5] = [&COLORS, &FILTER, &COMBINERS, &FOG, &[Rule::Tsh8, Rule::Tsh9, Rule::Rop2]];
    let (mut part, mut at) = (0, 0);
    while part < parts.len() {
        let mut n = 0;
        while n < parts[part].len() {
            all[at] = parts[part][n];
            (n, at) = (n + 1, at + 1);
        }
        part += 1;
    }
    all
};

/// Returns a reading that changes state.
const fn state(rules: &'static [&'static str], does: &'static str) -> Reading {
    Reading { rules, does, reals: &[] }
}

/// Returns a reading that keeps real numbers.
const fn reals(rules: &'static [&'static str], does: &'static str, reals: &'static [Rule]) -> Reading {
    Reading { rules, does, reals }
}

named! {
    /// A reading of rules that is known not to be the chip's.
    pub enum Shortcut =>
    /// Returns what the shortcut does.
    reading: Reading {
        /// NUM-4, INT-2 in floats.
        FloatColors = "float-colors" => reals(&["INT-2", "NUM-4"], "interpolates the colours of vertices in floats", &COLORS),
        /// TEX-6 with weights of more than eight bits.
        FloatFilter = "float-filter" => reals(&["TEX-6", "TEX-9"], "filters with weights of more than eight bits, and rounds once", &FILTER),
        /// TEX-1 for 5 and 6 bits.
        FloatTexels = "float-texels" => reals(&["TEX-1"], "divides channels of 5 and 6 bits by 31 and 63", &[Rule::Tex1]),
        /// TEX-2, TEX-3 in floats.
        FloatBlocks = "float-blocks" => reals(&["TEX-2", "TEX-3"], "mixes the colours of compressed blocks in floats, without dither", &[Rule::Tex2, Rule::Tex3, Rule::Tex4]),
        /// TEX-18 by the real number.
        FloatSigned = "float-signed" => reals(&["TEX-18"], "takes a signed channel as a fraction of 128, not as twice its byte", &[Rule::Tex18]),
        /// Combiners in floats.
        FloatCombiners = "float-combiners" => reals(&["CMB-9", "CMB-6", "CMB-7", "CMB-8", "CMB-3", "FIN-2"], "computes combiners in floats, without rounding between stages", &COMBINERS),
        /// Fog in floats.
        FloatFog = "float-fog" => reals(&["FOG-2", "FOG-4", "NUM-6"], "takes fog functions exactly, without tables or bytes", &FOG),
        /// TSH-8 in floats.
        FloatLuminance = "float-luminance" => reals(&["TSH-8"], "multiplies by the luminance in floats", &[Rule::Tsh8]),
        /// TSH-9 in floats.
        FloatPassThrough = "float-pass-through" => reals(&["TSH-9"], "takes coordinates as colours in floats", &[Rule::Tsh9]),
        /// Everything between vertices and output in floats.
        FloatShader = "float-shader" => reals(&["NUM-2", "INT-2", "TEX-6", "CMB-9", "FOG-2"], "computes pixels in floats from vertex to blending, and rounds once, at the store", &SHADER),
        /// ROP-2 with a source in floats.
        FloatBlend = "float-blend" => reals(&["ROP-2"], "blends a source that is not rounded before", &[Rule::Rop2]),
        /// TEX-5 by exact coordinates.
        ExactCoordinates = "exact-coordinates" => state(&["WGT-1", "INT-4", "TEX-5"], "takes texture coordinates without the chip's 24-bit weights"),
        /// RAS-1 without snapping.
        UnsnappedVertices = "unsnapped-vertices" => state(&["RAS-1", "WGT-1"], "interpolates from vertices that are not cut to sixteenths of a pixel, without the chip's 24-bit weights"),
        /// DEP-1 in floats.
        FloatDepths = "float-depths" => state(&["DEP-1", "DEP-5"], "computes depths in single precision, whose steps are whole from 2^23 on"),
        /// DEP-3 with float depths as fractions.
        ScaledDepths = "scaled-depths" => state(&["DEP-3"], "stores float depths as fractions of 511.9375, read as halves, and of 10^30, read as 24 bits"),
        /// DEP-3 with float depths as fractions, and words as halves.
        HalfDepths = "half-depths" => state(&["DEP-3"], "stores float depths as fractions, and reads a cleared buffer of 16 bits as halves, where 0xFFFF is no number and counts as 0"),
        /// DEP-3 with a 16-bit clear cut again.
        CutDepths = "cut-depths" => state(&["DEP-3", "CLR-1"], "cuts the depth of a 16-bit clear after a division in floats, and a half where it is read"),
        /// LIN-1 with one width.
        ThinLines = "thin-lines" => state(&["LIN-1"], "draws lines of every width one pixel wide"),
        /// TEX-18 ignored.
        UnsignedChannels = "unsigned-channels" => state(&["TEX-18"], "ignores that channels of textures are signed"),
        /// TEX-3 without dither.
        PlainBlocks = "plain-blocks" => state(&["TEX-3"], "mixes the colours of DXT1 at eight bits, rounded to nearest, without dither"),
        /// TEX-2 and TEX-3 cut.
        CutBlocks = "cut-blocks" => state(&["TEX-2", "TEX-3"], "widens and mixes the colours of compressed blocks by divisions that are cut"),
        /// TEX-1 by shifts.
        ShiftedTexels = "shifted-texels" => state(&["TEX-1"], "widens channels of 5 and 6 bits by zeros"),
        /// TEX-1 of Y16 as grey.
        GreyY16 = "grey-y16" => state(&["TEX-1"], "takes Y16 for sixteen bits of grey"),
        /// TEX-1 of R6G5B5 as signed.
        SignedR6G5B5 = "signed-r6g5b5" => state(&["TEX-1", "TEX-18"], "takes R6G5B5 for a red over 63 and a signed green and blue, and 255ths of these for signed bytes where they displace coordinates"),
        /// ROP-3 as the plain equations.
        PlainSignedBlend = "plain-signed-blend" => state(&["ROP-3"], "takes signed blend equations for unsigned ones, with factors"),
        /// TSH-8 ignored.
        NoLuminance = "no-luminance" => state(&["TSH-8"], "leaves the luminance of bump maps out"),
        /// TSH-8 with alpha.
        LuminanceOfAlpha = "luminance-of-alpha" => state(&["TSH-8"], "multiplies alpha by the luminance as well"),
        /// TSH-8 by a signed byte.
        LuminanceOf254 = "luminance-of-254" => reals(&["TSH-8"], "takes the luminance of bump maps as a signed byte over 127, halved and moved to 0 to 1", &[Rule::Tsh8]),
        /// TSH-7 in 127ths.
        OffsetsOf127 = "offsets-of-127" => state(&["TSH-7"], "divides the offsets of bump maps by 127"),
        /// TSH-3 as colours.
        HemisphereAsColor = "hemisphere-as-color" => state(&["TSH-3"], "takes the two halves of a hemisphere for a colour of 0 to 1"),
        /// TSH-5 without the constant eye.
        NoConstantReflection = "no-constant-reflection" => state(&["TSH-5"], "leaves reflections by a constant eye out: they are transparent black"),
        /// TSH-5 for unit normals.
        UnitNormals = "unit-normals" => state(&["TSH-5"], "takes normals for unit vectors where it reflects"),
        /// TEX-16 in white.
        WhiteUnbound = "white-unbound" => state(&["TEX-16"], "reads a unit without a texture as white"),
        /// FOG-2, FOG-4 at vertices.
        VertexFog = "vertex-fog" => state(&["FOG-2", "FOG-4"], "computes fog factors at vertices, and interpolates them"),
        /// FOG-4 with p0 outside the exponent.
        BiasOutside = "bias-outside" => state(&["FOG-4", "FOG-2"], "computes fog factors at vertices, with the bias outside of the power and the magnitude taken last, and limits them at pixels"),
        /// WGT-1 with perspective always.
        AlwaysPerspective = "always-perspective" => state(&["WGT-1"], "corrects perspective where a draw turns it off"),
        /// Targets that textures read are black.
        BlackTargets = "black-targets" => state(&["ROP-5"], "reads textures that are render targets as black"),
        /// CMB-3 to the letter.
        LiteralExpand = "literal-expand" => state(&["CMB-3"], "expands to 2x - 1, so that no byte is zero"),
        /// CMB-7, CMB-8 rounded each.
        EachProduct = "each-product" => state(&["CMB-7", "CMB-8"], "rounds each product before the sum"),
        /// CMB-9 at full width.
        LateRounding = "late-rounding" => state(&["CMB-9"], "rounds after bias and scale"),
        /// CMB-10 by a bit.
        MuxByBit = "mux-by-bit" => state(&["CMB-10"], "selects by bit 7 of a negative alpha"),
        /// ROP-1 in floats.
        FloatAlphaTest = "float-alpha-test" => reals(&["ROP-1"], "tests an alpha that is not rounded", &COMBINERS),
        /// ROP-5 to nearest.
        RoundedStores = "rounded-stores" => state(&["ROP-5"], "rounds to the nearest of the values that a 16-bit surface holds"),
        /// NUM-3 with a symmetric range.
        SymmetricRegisters = "symmetric-registers" => state(&["NUM-3"], "limits registers to -1"),
    }
}

impl Shortcut {
    /// The shortcuts that [`FloatShader`](Self::FloatShader) takes together.
    pub const PARTS_OF_SHADER: &'static [Shortcut] = &[
        Shortcut::FloatColors,
        Shortcut::FloatFilter,
        Shortcut::FloatCombiners,
        Shortcut::FloatFog,
        Shortcut::FloatLuminance,
        Shortcut::FloatPassThrough,
        Shortcut::FloatBlend,
    ];
}

/// A set of shortcuts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Shortcuts(u64);

impl Shortcuts {
    /// The empty set: the chip's rules.
    pub const NONE: Shortcuts = Shortcuts(0);

    /// Returns whether a shortcut is in the set.
    pub fn contains(self, shortcut: Shortcut) -> bool {
        self.0 >> shortcut as u64 & 1 != 0
    }

    /// Returns the set with a shortcut.
    #[must_use]
    pub fn with(self, shortcut: Shortcut) -> Shortcuts {
        Shortcuts(self.0 | 1 << shortcut as u64)
    }

    /// Returns whether the set is empty.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns the shortcuts of the set in the order of the enumeration.
    pub fn iter(self) -> impl Iterator<Item = Shortcut> {
        Shortcut::ALL.iter().copied().filter(move |shortcut| self.contains(*shortcut))
    }

    /// Returns the names, joined by `+`.
    pub fn names(self) -> String {
        self.iter().map(Named::name).collect::<Vec<_>>().join("+")
    }

    /// Returns the set that [`names`](Self::names) names, or the first name that no shortcut has.
    ///
    /// # Errors
    /// A name is not known.
    pub fn from_names(names: &str) -> Result<Shortcuts, &str> {
        names.split('+').map(str::trim).try_fold(Shortcuts::NONE, |set, name| {
            Shortcut::from_name(name).map(|shortcut| set.with(shortcut)).ok_or(name)
        })
    }

    /// Returns policies with the values of those that the shortcuts are. Other shortcuts change none.
    #[must_use]
    pub fn policies(self, policies: Policies) -> Policies {
        state::policies(policies, self)
    }

    /// Returns the numbers that stay real.
    fn reals(self) -> Reals {
        let mut reals = Reals::none();
        for shortcut in self.iter() {
            shortcut.reading().reals.iter().for_each(|rule| reals.keep(*rule));
        }
        reals.depths = self.contains(Shortcut::FloatDepths);
        reals.alpha = self.contains(Shortcut::FloatAlphaTest);
        reals.stores = self.contains(Shortcut::RoundedStores);
        if depths::scales(self) {
            reals.least_depth = depths::LEAST;
        }
        reals
    }

    /// Returns whether texels are read where real numbers find them.
    fn lead(self) -> bool {
        self.contains(Shortcut::ExactCoordinates) || self.contains(Shortcut::UnsnappedVertices)
    }

    /// Returns whether the scalar engine has to draw, because something stays a real number or is computed otherwise.
    pub fn need_scalar(self) -> bool {
        const SCALAR: [Shortcut; 3] = [Shortcut::LuminanceOfAlpha, Shortcut::UnitNormals, Shortcut::WhiteUnbound];
        self.lead() || SCALAR.iter().any(|shortcut| self.contains(*shortcut)) || self.reals() != Reals::none()
    }
}

impl FromIterator<Shortcut> for Shortcuts {
    fn from_iter<T: IntoIterator<Item = Shortcut>>(shortcuts: T) -> Shortcuts {
        shortcuts.into_iter().fold(Shortcuts::NONE, Shortcuts::with)
    }
}

impl Plan {
    /// Returns the plan as a renderer with these shortcuts would have it. Those that keep real numbers act in [`render`] alone.
    #[must_use]
    pub fn with_shortcuts(self, shortcuts: Shortcuts) -> Plan {
        state::change(self, shortcuts)
    }
}

/// Returns the shortcuts that can change a frame of a plan.
pub fn concerning(plan: &Plan) -> Shortcuts {
    Shortcut::ALL.iter().copied().filter(|shortcut| state::concerns(plan, *shortcut)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_back_and_forth() {
        let both: Shortcuts = [Shortcut::VertexFog, Shortcut::FloatFog].into_iter().collect();
        assert_eq!(both.names(), "float-fog+vertex-fog");
        assert_eq!(Shortcuts::from_names("vertex-fog + float-fog"), Ok(both));
        assert_eq!(Shortcuts::from_names("vertex-fog+mist"), Err("mist"));
        assert!(Shortcut::ALL.len() <= 64);
    }

    #[test]
    fn a_shader_keeps_what_its_parts_keep() {
        let parts: Shortcuts = Shortcut::PARTS_OF_SHADER.iter().copied().collect();
        assert_eq!(parts.reals(), Shortcuts::NONE.with(Shortcut::FloatShader).reals());
    }
}
