//! What the pieces of a whole pixel read: parameters of the printed functions.

use ninebit::number::Register as _;
use ninebit::raster::binary::Binary;
use ninebit::state::{CompareFunction, ShaderStage, TextureFormat, TextureKind, TextureUnit};
use ninebit::texture::planned::PlannedUnit;

use crate::binary::Interpolant;
use crate::code::{EXPONENT, Range};
use crate::generic::pieces::Reader;
use crate::helper::Helper;
use crate::number::Number;
use crate::place::{Place, Unit};
use crate::triangle::ANY_UNIT;
use crate::truth::Truth;
use crate::whole::{Interpolator, Sample};

/// The coordinates of a unit.
pub(super) const OWN: &str = "@in @binary own[4]";

/// The range of lanes: bytes and halves, which may be signed.
pub(super) const LANE: Range = (-(1 << 15), (1 << 16) - 1);

/// The range of patterns of binary32.
const PATTERN: Range = (0, u32::MAX as i64);

/// The range of mantissas that are wider than those of binary numbers.
const WIDE: Range = (-(1 << 62), 1 << 62);

impl<'a> Reader<'a> {
    pub(super) fn interpolator(&self) -> Interpolator<'a> {
        Interpolator { code: self.code, perspective: true, is_far: false }
    }

    /// Returns a binary number.
    pub(super) fn binary(&self, name: &'static str) -> Interpolant<'a> {
        Interpolant::local(self.code, name)
    }

    pub(super) fn binaries<const N: usize>(&self, names: [&'static str; N]) -> [Interpolant<'a>; N] {
        names.map(|name| self.binary(name))
    }

    /// Returns the truth of a flag.
    pub(super) fn truth(&self, name: &'static str) -> Truth<'a> {
        let flag = self.local(name, (0, 1));
        Truth::new(self.code, flag.compared(CompareFunction::NotEqual, Number::ZERO))
    }

    pub(super) fn truths<const N: usize>(&self, names: [&'static str; N]) -> [Truth<'a>; N] {
        names.map(|name| self.truth(name))
    }

    /// Returns a pattern of binary32.
    pub(super) fn pattern(&self, name: &'static str) -> Number<'a> {
        self.local(name, PATTERN)
    }

    pub(super) fn patterns<const N: usize>(&self, names: [&'static str; N]) -> [Number<'a>; N] {
        names.map(|name| self.pattern(name))
    }

    /// Returns the number of a pattern.
    pub(super) fn number_of(&self, pattern: Number<'a>) -> Interpolant<'a> {
        Interpolant::from_line(self.code, crate::binary::call(self.code, Helper::Split, &[pattern.operand()]))
    }

    /// Returns a number whose mantissa is wide.
    pub(super) fn wide(&self, [mantissa, exponent]: [&'static str; 2]) -> Binary<Number<'a>> {
        Binary { mantissa: self.local(mantissa, WIDE), exponent: self.local(exponent, EXPONENT) }
    }

    /// Returns the sample whose weights are parameters.
    pub(super) fn sample(&self) -> Sample<'a> {
        let [first, third, sum] = self.binaries(["b[0]", "b[1]", "sum"]);
        Sample { b: [first, third], sum }
    }

    /// Returns a result that is a binary number.
    pub(super) fn result(&self, number: Interpolant<'a>) -> Number<'a> {
        Number::new(self.code, number.operand(self.code))
    }

    /// Reads what a unit does at a place.
    pub(super) fn on<T>(
        &self,
        unit: &PlannedUnit,
        (place, is_point): (Place<'a>, bool),
        of: impl FnOnce(&Unit<'a, '_, '_>) -> T,
    ) -> T {
        let (sample, elsewhere) = (self.sample(), |_: &Sample<'a>| place);
        of(&Unit {
            interpolator: self.interpolator(),
            unit,
            sample: &sample,
            place,
            is_point: Truth::Known(is_point),
            quad: [Number::ZERO; 2],
            elsewhere: &elsewhere,
        })
    }

    /// Returns both parts of a number as results.
    pub(super) fn parts(&self, number: Binary<Number<'a>>) -> Vec<Number<'a>> {
        vec![number.mantissa, number.exponent]
    }

    /// Makes a flag a result.
    pub(super) fn flag(&self, truth: Truth<'a>) -> Number<'a> {
        truth.number()
    }
}

/// Returns a unit that samples an image of a kind and a format.
pub(super) fn planned(kind: TextureKind, format: TextureFormat) -> PlannedUnit {
    PlannedUnit {
        index: ANY_UNIT,
        state: TextureUnit::new(0),
        stage: ShaderStage::conventional(0, true),
        kind,
        format,
        levels: vec![ninebit::state::Level { offset: 0, width: 1, height: 1 }],
        face_words: 1,
        layers: 1,
        border: false,
        dithered: false,
        palette: None,
        live: 15,
    }
}

/// Returns a unit that samples an image of two dimensions in bytes.
pub(super) fn plain() -> PlannedUnit {
    planned(TextureKind::TwoDimensional, TextureFormat::A8R8G8B8)
}
