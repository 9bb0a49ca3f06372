//! Makes the code of what a draw interpolates and tests.

use std::ops::Deref;

use ninebit::number::convert;
use ninebit::number::{Integer, Register as _};
use ninebit::plan::PlannedDraw;
use ninebit::raster::binary::Binary;
use ninebit::raster::fog::{self, Curve};
use ninebit::raster::setup::edge_function;
use ninebit::raster::weights::{self, Linear, Number as _};
use ninebit::raster::{depth, interpolate};
use ninebit::rop::stencil;
use ninebit::state::*;

use crate::binary::Interpolant;
use crate::code::{COORDINATE, Code};
use crate::helper::Sign;
use crate::input::Input;
use crate::number::{Number, Word};
use crate::triangle::{ANY_UNIT, Field, Part};
use crate::truth::Truth;

/// A sample of a triangle.
#[derive(Clone, Copy)]
pub(crate) struct Sample<'a> {
    /// The weights b_0 and b_2.
    pub(crate) b: [Interpolant<'a>; 2],
    /// Sum of the edge numbers.
    pub(crate) sum: Interpolant<'a>,
}

/// What reads the rules of the interpolator.
#[derive(Clone, Copy)]
pub(crate) struct Interpolator<'a> {
    pub(crate) code: &'a Code,
    /// Whether w of the vertices count.
    pub(crate) perspective: bool,
    /// Whether vertices may lie behind the eye (RAS-8).
    pub(crate) is_far: bool,
}

/// What reads the rules of one draw.
pub(crate) struct Whole<'a, 's> {
    pub(crate) interpolator: Interpolator<'a>,
    pub(crate) planned: &'s PlannedDraw,
}

impl<'a> Deref for Whole<'a, '_> {
    type Target = Interpolator<'a>;
    fn deref(&self) -> &Interpolator<'a> {
        &self.interpolator
    }
}

impl<'a> Interpolator<'a> {
    pub(crate) fn input(&self, input: Input) -> Number<'a> {
        Number::new(self.code, self.code.input(input, input.range()))
    }

    fn binary(&self, field: Field) -> Interpolant<'a> {
        let input = Input::Triangle(field);
        let sign = if matches!(field, Field::Ratio(_)) { Sign::Positive } else { Sign::Any };
        Interpolant::Of(self.code, self.code.input(input, input.range()), sign)
    }

    /// Returns a number of the vertices.
    pub(crate) fn linear(&self, of: impl Fn(Part) -> Field) -> Linear<Interpolant<'a>> {
        let part = |part: Part| self.binary(of(part));
        Linear { second: part(Part::Second), first: part(Part::First), third: part(Part::Third) }
    }

    /// Returns a component of a unit's coordinates; printed functions of any unit have them as a parameter.
    pub(crate) fn coordinate(&self, unit: usize, n: usize, sample: &Sample<'a>) -> Interpolant<'a> {
        if unit == ANY_UNIT {
            return Interpolant::local(self.code, ["own[0]", "own[1]", "own[2]", "own[3]"][n]);
        }
        self.linear(|part| Field::Coordinate(unit, n, part)).at(sample.b)
    }

    /// Returns the edge functions at a pixel. They are not negative where the pixel is covered.
    pub(crate) fn edges(&self, x: Number<'a>, y: Number<'a>, covered: bool) -> [Number<'a>; 3] {
        self.code.by("RAS-2");
        [0, 1, 2].map(|k: usize| {
            let of = [Field::EdgeX(k), Field::EdgeY(k), Field::Edge(k)].map(|field| self.input(Input::Triangle(field)));
            let e = edge_function(of, x, y);
            if covered {
                self.code.name(e.operand(), || format!("E{k}"));
                return e.within(0, 1 << 53);
            }
            e.within(-(1 << 53), 1 << 53)
        })
    }

    /// Returns the weights where these are the edge functions.
    pub(crate) fn sample<const COVERED: bool>(&self, e: [Number<'a>; 3]) -> Sample<'a> {
        self.code.by("WGT-1");
        let ratios =
            self.perspective.then(|| [self.binary(Field::Ratio(0)), Interpolant::ONE, self.binary(Field::Ratio(2))]);
        let edges = weights::edge_numbers(e.map(|e| Interpolant::whole(self.code, e)), ratios);
        let sum = Interpolant::sum_of_edges::<COVERED>(edges);
        let b = weights::outer_weights::<_, COVERED>(weights::shares(edges, sum.reciprocal::<COVERED>()));
        let b = if COVERED { [0, 1].map(|n: usize| b[n].named(|| format!("b{}", 2 * n))) } else { b };
        Sample { b, sum }
    }

    /// Returns the sample of a pixel that may lie beside the triangle.
    pub(crate) fn sample_at(&self, x: Number<'a>, y: Number<'a>) -> Sample<'a> {
        self.sample::<false>(self.edges(x, y, false))
    }

    /// INT-2: returns W0 and W2.
    pub(crate) fn color_weights(&self, sample: &Sample<'a>) -> [Number<'a>; 2] {
        [(0, "W0"), (1, "W2")].map(|(k, name): (usize, &str)| {
            let b = sample.b[k].parts(self.code, (0, 1 << 24));
            self.code.by("INT-2");
            let weight = interpolate::color_weight(b).within(0, 256);
            self.code.name(weight.operand(), || name.to_string());
            weight
        })
    }

    /// INT-2: returns the primary or the secondary colour.
    pub(crate) fn color(&self, set: usize, [w0, w2]: [Number<'a>; 2]) -> [Number<'a>; 4] {
        self.code.by("INT-2");
        [0, 1, 2, 3].map(|channel: usize| {
            let c = [0, 1, 2].map(|k: usize| self.input(Input::Triangle(Field::Color(set, channel, k))));
            let color = interpolate::color(c, w0, w2).within(0, 255);
            let name = ["primary", "secondary"][set];
            self.code.name(color.operand(), || format!("{name}_{}", ["r", "g", "b", "a"][channel]));
            color
        })
    }

    /// Returns the fog factor as a byte, by a mode, the parameters of its line and the fog coordinate, or by the vertices' own factor.
    pub(crate) fn fog_by(
        &self,
        mode: Option<FogMode>,
        line: [Binary<Number<'a>>; 2],
        value: Interpolant<'a>,
    ) -> Number<'a> {
        let parts = |value: Interpolant<'a>| value.parts(self.code, COORDINATE);
        let byte = match mode {
            None => {
                let value = parts(value);
                self.code.by("NUM-6");
                convert::factor(fog::factor(value))
            }
            Some(mode) if mode.is_linear() => {
                let coordinate = parts(value.cut());
                self.code.by("FOG-2");
                convert::factor(fog::on_line(coordinate, mode == FogMode::LinearAbs, line))
            }
            Some(mode) => {
                let value = parts(value);
                self.code.by("FOG-4");
                fog::tabled(mode, fog::steps(value))
            }
        };
        let byte = byte.within(0, 255);
        self.code.name(byte.operand(), || "fog_a".to_string());
        byte
    }

    /// FOG-5: returns the byte of a triangle with a coordinate that is not finite, or else that of the pixel.
    pub(crate) fn fog_or_fixed(&self, byte: Number<'a>) -> Number<'a> {
        self.code.by("FOG-5");
        let fixed = self.input(Input::Triangle(Field::FogByte));
        byte.or(fixed.is_negative(), fixed).within(0, 255)
    }

    /// DEP-1: returns the depth between those of the vertices.
    fn z_depth(&self, e: [Number<'a>; 3]) -> Interpolant<'a> {
        let e = if self.is_far { self.unturned(e) } else { e };
        let edges = e.map(|e| Interpolant::whole(self.code, e));
        let shares = match self.is_far {
            true => weights::shares_at::<_, false>(edges, None),
            false => weights::shares_at::<_, true>(edges, None),
        };
        self.code.by("DEP-1");
        let reference = depth::reference_vertex(e);
        let of =
            |value: &dyn Fn(usize) -> Interpolant<'a>| value(0).or(reference[0], value(1).or(reference[1], value(2)));
        let differences = [0, 1, 2].map(|k: usize| of(&|r| self.binary(Field::DepthDifference(r, k))));
        depth::sum_of_terms(shares, of(&|r| self.binary(Field::Depth(r))), differences, reference)
    }

    /// RAS-8: returns edge functions as they are where no vertex counts as behind the eye.
    fn unturned(&self, e: [Number<'a>; 3]) -> [Number<'a>; 3] {
        self.code.by("RAS-8");
        [0, 1, 2].map(|k: usize| {
            let sign = self.binary(Field::DepthRatio(k)).parts(self.code, (-1, 1)).mantissa;
            (Number::ZERO - e[k]).or(sign.is_negative(), e[k])
        })
    }

    /// DEP-6: returns w between those of the vertices.
    fn w_depth(&self, e: [Number<'a>; 3]) -> Interpolant<'a> {
        let edges = e.map(|e| Interpolant::whole(self.code, e));
        self.code.by("DEP-6");
        let ratios = [self.binary(Field::DepthRatio(0)), Interpolant::ONE, self.binary(Field::DepthRatio(2))];
        let difference = |k: usize| self.binary(Field::DepthDifference(1, k));
        let w = Linear { second: self.binary(Field::Depth(1)), first: difference(0), third: difference(2) };
        depth::w_depth(edges, ratios, w, |a, b| Interpolant::cut_rest(self.code, a, b))
    }

    /// DEP-1, DEP-6: returns the depth between those of the vertices, or w.
    pub(crate) fn depth_between(&self, w_buffer: bool, e: [Number<'a>; 3]) -> Binary<Number<'a>> {
        let value = if w_buffer { self.w_depth(e) } else { self.z_depth(e) };
        value.parts(self.code, (-(1 << 31) + 1, (1 << 31) - 1))
    }

    /// DEP-5: returns a depth with the triangle's offset.
    pub(crate) fn depth_moved(&self, value: Binary<Number<'a>>) -> Binary<Number<'a>> {
        self.code.by("DEP-5");
        let [mantissa, exponent] =
            [Field::Offset, Field::OffsetExponent].map(|field| self.input(Input::Triangle(field)));
        value.or(mantissa.is_zero(), depth::moved(value, Binary { mantissa, exponent }))
    }
}

/// What the tests of a pixel yield.
pub(crate) struct Outcome<'a> {
    pub(crate) kept: Truth<'a>,
    pub(crate) stencil_passed: Truth<'a>,
    pub(crate) depth_passed: Truth<'a>,
    /// The stencils that are stored if the stencil test fails, the depth test fails, or both pass.
    pub(crate) stencils: [Number<'a>; 3],
    pub(crate) held_stencil: Number<'a>,
    /// The depth that is stored if both tests pass.
    pub(crate) depth: Number<'a>,
    pub(crate) held_depth: Number<'a>,
}

impl<'a> Outcome<'a> {
    /// STN-1, DEP-2: returns whether the fragment is stored, and the new depth and stencil.
    pub(crate) fn settled(self) -> (Truth<'a>, [Number<'a>; 2]) {
        let (kept, stencil_passed, depth_passed) = (self.kept, self.stencil_passed, self.depth_passed);
        let stored = kept & stencil_passed & depth_passed;
        let [fail, depth_fail, pass] = self.stencils;
        let stencil = pass.or(depth_passed, depth_fail).or(stencil_passed, fail).or(kept, self.held_stencil);
        (stored, [self.depth.or(stored, self.held_depth), stencil])
    }
}

impl<'a> Whole<'a, '_> {
    /// Returns the fog factor as a byte.
    pub(crate) fn fog(&self, b: [Interpolant<'a>; 2]) -> Number<'a> {
        let fog = &self.planned.fog;
        if !fog.enabled {
            // CMB-13: without fog the factor is 1.
            return Number::ONE;
        }
        let mut line = [0.0; 2];
        if let Some(function) = &fog.function {
            match Curve::new(function) {
                Some(Curve::Line(of)) => line = [of.p0, of.p1],
                Some(Curve::Table(_)) => {}
                None => return Number::Constant(fog::not_finite(function.mode).into()),
            }
        }
        let mode = fog.function.map(|function| function.mode);
        let byte = self.fog_by(mode, line.map(weights::Number::from_f32), self.linear(Field::Fog).at(b));
        if mode.is_none() || self.is_fog_finite() { byte } else { self.fog_or_fixed(byte) }
    }

    fn is_fog_finite(&self) -> bool {
        let assembly = &self.planned.assembly;
        (0..assembly.triangles.len()).all(|n| assembly.triangle(n).fog().iter().all(|fog| fog.is_finite()))
    }

    /// DEP-1, DEP-3 to DEP-6: returns the depth word, and whether the depth is outside its range.
    fn depth(&self, test: &DepthTest, e: [Number<'a>; 3]) -> (Number<'a>, Truth<'a>) {
        let mut value = self.depth_between(test.w_buffer, e);
        if test.offset != (PolygonOffset { bias: 0.0, factor: 0.0 }) {
            value = self.depth_moved(value);
        }
        let mut outside = Truth::Known(false);
        if let Some(range) = &test.range {
            self.code.by("DEP-4");
            (value, outside) = depth::limited(range, value);
        }
        self.code.by("DEP-3");
        let format = self.planned.depth_format;
        let word = depth::stored(format, value).within(0, format.largest().into());
        self.code.name(word.operand(), || "z".to_string());
        (word, outside)
    }

    /// ROP-1, STN-1, DEP-1, DEP-2: runs the tests in their order after `kept`. Returns whether the fragment is stored, and the new depth and stencil if the draw can write them.
    pub(crate) fn tests(&self, kept: Truth<'a>, e: [Number<'a>; 3]) -> (Truth<'a>, Option<[Number<'a>; 2]>) {
        let draw = self.planned;
        if draw.depth_test.is_none() && draw.stencil_test.is_none() {
            return (kept, None);
        }
        let held = Word(self.input(Input::Depth));
        let (held_depth, held_stencil) = ((held & Word::from(0x00ff_ffff)).number(), (held >> 24).number());
        let mut kept = kept;
        let stencil_passed = draw.stencil_test.map_or(Truth::Known(true), |test| {
            self.code.by("STN-1");
            stencil::compared(&test, held_stencil)
        });
        let (mut depth_passed, mut depth) = (Truth::Known(true), held_depth);
        if let Some(test) = &draw.depth_test {
            let (word, outside) = self.depth(test, e);
            if test.drops_by_range() {
                kept = kept & !outside;
            }
            self.code.by("DEP-2");
            depth_passed = Integer::compared(word, test.function, held_depth);
            if test.write {
                depth = word;
            }
        }
        let stencils = draw.stencil_test.map_or([held_stencil; 3], |test| {
            self.code.by("STN-1");
            [test.fail, test.depth_fail, test.pass].map(|operation| stencil::replaced(&test, operation, held_stencil))
        });
        let outcome = Outcome { kept, stencil_passed, depth_passed, stencils, held_stencil, depth, held_depth };
        let (stored, new) = outcome.settled();
        let is_held = new[0].operand() == held_depth.operand() && new[1].operand() == held_stencil.operand();
        (stored, (!is_held).then_some(new))
    }
}
