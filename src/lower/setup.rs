//! Makes the constants of a triangle from its vertices, as set-up computes them once.

use std::collections::{BTreeSet, HashMap};

use ninebit::engine::context::TriangleContext;
use ninebit::number::Integer;
use ninebit::plan::{Plan, PlannedDraw};
use ninebit::raster::binary::Binary;
use ninebit::raster::fog;
use ninebit::raster::setup::{EdgeFunctions, edge_function, is_inside};
use ninebit::raster::stroke::Figure;
use ninebit::raster::weights::{Linear, ratios};
use ninebit::state::{CompareFunction, Profile};
use ninebit::texture::coordinates::wrapped;

use crate::binary::{Interpolant, call};
use crate::code::{Code, Line, Operand, Operation, Test, run, value_of};
use crate::helper::Helper;
use crate::input::Input;
use crate::number::Number;
use crate::pixel::Function;
use crate::triangle::{Attribute, Field, Part};
use crate::truth::Truth;

/// The code that makes the constants which a function reads.
#[derive(Debug)]
pub struct Setup {
    /// The operations in order.
    pub lines: Vec<Line>,
    /// The constants and the lines that hold them.
    pub outputs: Vec<(Field, Operand)>,
}

impl Setup {
    /// Makes the code for the function of a draw's whole pixel.
    pub fn new(plan: &Plan, draw: &PlannedDraw, function: &Function) -> Setup {
        let fields = function.inputs().into_iter().filter_map(|input| match input {
            // The offset of DEP-5 is its caller's, and so are points.
            Input::Triangle(Field::Offset | Field::OffsetExponent | Field::Sprite(_) | Field::SpriteSize) => None,
            Input::Triangle(field) => Some(field),
            _ => None,
        });
        let fields: BTreeSet<Field> = fields.chain(fields_of_coverage()).collect();
        Setup::of_fields(plan, draw, &Vec::from_iter(fields))
    }

    /// Makes the code of all constants of a draw, for a text of every draw.
    pub fn of_all(plan: &Plan, draw: &PlannedDraw) -> Setup {
        Setup::of_fields(plan, draw, &Field::all())
    }

    fn of_fields(plan: &Plan, draw: &PlannedDraw, fields: &[Field]) -> Setup {
        let holds_w = draw.depth_test.as_ref().is_some_and(|test| test.w_buffer);
        let fixed_fog = draw.fog.function.map_or(-1, |function| fog::not_finite(function.mode).into());
        Setup::of_any(plan.profile, fields, |_| SetupState {
            holds_w: Truth::Known(holds_w),
            perspective: Truth::Known(draw.perspective),
            is_far: draw.assembly.is_far,
            fixed_fog: Number::Constant(fixed_fog),
        })
    }

    /// Makes the code of fields whatever the state, which `state` reads.
    pub(crate) fn of_any(
        profile: Profile,
        fields: &[Field],
        state: impl for<'a> FnOnce(&'a Code) -> SetupState<'a>,
    ) -> Setup {
        let code = Code::default();
        let reader = Reader { code: &code, profile, state: state(&code) };
        let outputs: Vec<_> = fields.iter().map(|field| (*field, reader.field(*field))).collect();
        let (lines, renamed) = code.reachable(&outputs.iter().map(|output| output.1).collect::<Vec<_>>());
        Setup { lines, outputs: outputs.into_iter().map(|(field, operand)| (field, renamed(operand))).collect() }
    }

    /// Computes the constants of a triangle, of which binary numbers are [packed](crate::code::packed).
    pub fn constants(&self, context: &TriangleContext<'_>) -> HashMap<Field, i64> {
        let values = run(&self.lines, |input| match input {
            Input::Vertex(k, attribute) => attribute.value_of(context, k),
            _ => 0,
        });
        let mut constants: HashMap<Field, i64> =
            self.outputs.iter().map(|(field, operand)| (*field, value_of(&values, *operand))).collect();
        let offset = context.depth.offset;
        constants.insert(Field::Offset, offset.mantissa);
        constants.insert(Field::OffsetExponent, if offset.mantissa == 0 { 0 } else { offset.exponent });
        let [x, y] = context.positions()[1].map(i64::from);
        let is_point = context.triangle.figure == Figure::Point;
        let size = if is_point { context.draw.assembly.size_of(context.number).into() } else { -1 };
        constants.extend([(Field::Sprite(0), x), (Field::Sprite(1), y), (Field::SpriteSize, size)]);
        if context.triangle.figure != Figure::Triangle {
            // Lines and points are set up otherwise.
            for (k, [a, b, c]) in context.triangle.edge_functions().into_iter().enumerate() {
                for (field, value) in [(Field::EdgeX(k), a), (Field::EdgeY(k), b), (Field::Edge(k), c)] {
                    constants.insert(field, value);
                }
            }
        }
        constants
    }
}

impl Attribute {
    /// Returns what vertex `k` of a triangle has.
    pub fn value_of(self, context: &TriangleContext<'_>, k: usize) -> i64 {
        let bits = |value: f32| i64::from(value.to_bits());
        let vertices = context.vertices();
        match self {
            Attribute::Position(axis) => context.positions()[k][axis].into(),
            Attribute::Z => bits(context.depth.z[k]),
            Attribute::W => bits(vertices.position(3)[k]),
            Attribute::Color(set, channel) => context.colors()[set][k][channel].into(),
            Attribute::Coordinate(n, component) => {
                let unit = context.draw.units.iter().find(|unit| unit.index == n);
                let stage = context.draw.shader.as_ref().map(|shader| shader.stages[n].state);
                let set = match (unit, stage) {
                    // Only what a unit samples at its own coordinates is wrapped.
                    (_, Some(stage)) if !stage.operation.samples_own() => vertices.coordinates(stage.coordinate_set),
                    (Some(unit), _) => wrapped(unit, vertices.coordinates(unit.stage.coordinate_set)),
                    (None, _) => return 0,
                };
                bits(set[k][component])
            }
            Attribute::Fog => {
                let fog = vertices.fog()[k];
                bits(if context.draw.fog.function.is_none() { fog::limited(fog) } else { fog })
            }
        }
    }
}

/// Returns the code that tells whether a triangle covers a pixel, 1 or 0.
pub(crate) fn coverage() -> (Vec<Line>, Operand) {
    let code = Code::default();
    let given = |input: Input| Number::new(&code, code.input(input, input.range()));
    let (x, y) = (given(Input::X), given(Input::Y));
    code.by("RAS-3");
    let inside = [0, 1, 2].map(|k| {
        let field = |field: Field| given(Input::Triangle(field));
        let e = edge_function([Field::EdgeX(k), Field::EdgeY(k), Field::Edge(k)].map(field), x, y);
        is_inside(e, !field(Field::Owns(k)).is_zero())
    });
    let covers = (inside[0] & inside[1] & inside[2]).number().operand();
    let (lines, renamed) = code.reachable(&[covers]);
    (lines, renamed(covers))
}

/// Returns the constants that coverage takes.
fn fields_of_coverage() -> impl Iterator<Item = Field> {
    (0..3).flat_map(|k| [Field::EdgeX(k), Field::EdgeY(k), Field::Edge(k), Field::Owns(k)])
}

/// What set-up reads of a draw's state.
#[derive(Clone, Copy)]
pub(crate) struct SetupState<'a> {
    /// Whether the depth buffer holds w.
    pub(crate) holds_w: Truth<'a>,
    /// Whether attributes are in perspective.
    pub(crate) perspective: Truth<'a>,
    /// Whether vertices may lie behind the eye (RAS-8).
    pub(crate) is_far: bool,
    /// The fog byte of triangles with coordinates that are not finite, or -1.
    pub(crate) fixed_fog: Number<'a>,
}

/// Reads the rules of set-up.
struct Reader<'a> {
    code: &'a Code,
    profile: Profile,
    state: SetupState<'a>,
}

impl<'a> Reader<'a> {
    fn input(&self, k: usize, attribute: Attribute) -> Number<'a> {
        let input = Input::Vertex(k, attribute);
        Number::new(self.code, self.code.input(input, input.range()))
    }

    fn inputs(&self, attribute: Attribute) -> [Number<'a>; 3] {
        [0, 1, 2].map(|k| self.input(k, attribute))
    }

    /// Returns a binary32 number, of which bits are given.
    fn number(&self, bits: Number<'a>) -> Interpolant<'a> {
        Interpolant::from_line(self.code, call(self.code, Helper::Split, &[bits.operand()]))
    }

    fn difference(&self, a: Number<'a>, b: Number<'a>) -> Number<'a> {
        Number::new(self.code, self.code.make(Operation::Difference(a.operand(), b.operand())))
    }

    fn linear(&self, attribute: Attribute, part: Part) -> Operand {
        self.code.by("WGT-1");
        let linear =
            Linear::from_values(self.inputs(attribute), |a, b| self.difference(a, b), |bits| self.number(bits));
        let of = match part {
            Part::Second => linear.second,
            Part::First => linear.first,
            Part::Third => linear.third,
        };
        of.operand(self.code)
    }

    fn field(&self, field: Field) -> Operand {
        match field {
            Field::EdgeX(k) => self.edges().a[k].operand(),
            Field::EdgeY(k) => self.edges().b[k].operand(),
            Field::Edge(k) => self.edges().c[k].operand(),
            Field::Owns(k) => self.edges().owns[k].number().operand(),
            Field::Ratio(k) => self.ratio(k),
            Field::Color(set, channel, k) => self.input(k, Attribute::Color(set, channel)).operand(),
            Field::Coordinate(unit, component, part) => self.linear(Attribute::Coordinate(unit, component), part),
            Field::Fog(part) => self.linear(Attribute::Fog, part),
            Field::FogByte => self.fog_byte(),
            Field::Depth(k) => self.depth(|attribute| self.input(k, attribute)),
            Field::DepthDifference(reference, k) => self.depth(|attribute| {
                self.code.by("DEP-1");
                let [z, from] = [k, reference].map(|k| self.input(k, attribute));
                self.difference(z, from)
            }),
            Field::DepthRatio(k) => self.depth_ratio(k),
            Field::SpriteSize => Operand::Constant(-1),
            Field::Offset | Field::OffsetExponent | Field::Sprite(_) => Operand::Constant(0),
        }
    }

    /// Returns the number that has the bits `of` what the depth buffer holds of vertices.
    fn depth(&self, of: impl Fn(Attribute) -> Number<'a>) -> Operand {
        let [z, w] = [Attribute::Z, Attribute::W].map(|attribute| self.number(of(attribute)));
        ninebit::raster::weights::Number::or(w, self.state.holds_w, z).operand(self.code)
    }

    fn edges(&self) -> EdgeFunctions<Number<'a>> {
        self.code.by("RAS-2");
        let edges = EdgeFunctions::new(self.inputs(Attribute::Position(0)), self.inputs(Attribute::Position(1)));
        if !self.state.is_far {
            return edges;
        }
        // With the signs of w in the edges, those of e_k r_k agree with e_1: all weights are the same, since every cut is toward zero.
        self.code.by("RAS-8");
        edges.turned(self.inputs(Attribute::W).map(|w| self.is_negative(w)))
    }

    /// Returns whether a binary32 number is negative, of which bits are given.
    fn is_negative(&self, bits: Number<'a>) -> Truth<'a> {
        let sign = Operand::Constant(1 << 31);
        Truth::new(self.code, Test(CompareFunction::GreaterOrEqual, [bits.operand(), sign]))
    }

    /// Returns the bits of some w without their signs, which [turn](EdgeFunctions::turned) the edges.
    fn magnitudes(&self, w: [Number<'a>; 3]) -> [Interpolant<'a>; 3] {
        w.map(|w| {
            let bits = match self.state.is_far {
                true => {
                    Number::new(self.code, self.code.make(Operation::And(w.operand(), Operand::Constant(0x7fff_ffff))))
                }
                false => w,
            };
            self.number(bits)
        })
    }

    /// DEP-6, RAS-8: returns a ratio of w for a w buffer, and the sign of w for a z buffer.
    fn depth_ratio(&self, k: usize) -> Operand {
        let w = self.inputs(Attribute::W);
        if self.state.is_far && matches!(self.state.holds_w, Truth::Known(false)) {
            self.code.by("RAS-8");
            let sign = |n: i64| Interpolant::Known(Binary { mantissa: n, exponent: 0 });
            return ninebit::raster::weights::Number::or(sign(-1), self.is_negative(w[k]), sign(1)).operand(self.code);
        }
        self.code.by("DEP-6");
        ratios(self.magnitudes(w))[k].operand(self.code)
    }

    /// WGT-1, INT-6: returns a ratio of w, which is 1 where all w are one.
    fn ratio(&self, k: usize) -> Operand {
        self.code.by("INT-6");
        let w = self.inputs(Attribute::W).map(|w| match self.profile {
            Profile::Nv10 => {
                Number::new(self.code, self.code.make(Operation::And(w.operand(), Operand::Constant(0xffff_ff00))))
            }
            Profile::Nv2a => w,
        });
        self.code.by("WGT-1");
        let equal = |a: Number<'a>, b: Number<'a>| {
            Truth::new(self.code, Test(CompareFunction::Equal, [a.operand(), b.operand()]))
        };
        let is_flat = equal(w[0], w[1]) & equal(w[1], w[2]);
        let ratios = ratios(self.magnitudes(w));
        let one = Interpolant::Known(Binary::ONE);
        ninebit::raster::weights::Number::or(one, is_flat | !self.state.perspective, ratios[k]).operand(self.code)
    }

    /// FOG-4, FOG-5: returns the byte of a triangle with a coordinate that is not finite, or -1.
    fn fog_byte(&self) -> Operand {
        self.code.by("FOG-5");
        let exponent = Operand::Constant(0x7f80_0000);
        let is_infinite = self.inputs(Attribute::Fog).map(|fog| {
            let bits = self.code.make(Operation::And(fog.operand(), exponent));
            Truth::new(self.code, Test(CompareFunction::Equal, [bits, exponent]))
        });
        let [a, b, c] = is_infinite;
        Integer::or(self.state.fixed_fog, a | b | c, Number::Constant(-1)).operand()
    }
}
