//! Makes the function of a draw's whole pixel: from its place in a triangle and the memories of textures to the stored words.

use ninebit::number::{Integer, Register as _};
use ninebit::plan::{Plan, PlannedDraw};
use ninebit::raster::assemble::ScalarPart;
use ninebit::state::{CompareFunction, Scene};

use crate::code::{Code, Operand, Test};
use crate::input::Input;
use crate::number::{Number, Word};
use crate::pixel::{Builder, Function, Options, Result, UNBOUND, converted, is_idle, loaded};
use crate::place::{Place, Projection, Unit};
use crate::stage::Stages;
use crate::truth::Truth;
use crate::whole::{Interpolator, Whole};

/// The bits of columns and rows that all pixels of a quad share.
pub(crate) const QUAD: i64 = 4094;

/// What a unit that is not planned gives: nobody reads it, or the plan knows that all of it is 0.
const UNPLANNED: [Number<'static>; 4] = [Number::ZERO; 4];

/// Returns what of a draw is not printed. `is_own` says that the text is the draw's own, and that no host rasterises it: then vertices may lie behind the
/// eye.
pub fn unprinted(draw: &PlannedDraw, is_own: bool) -> Option<ScalarPart> {
    draw.assembly.scalar_part().filter(|part| !(is_own && *part == ScalarPart::FarVertices))
}

impl Function {
    /// Makes the function of a whole pixel of a draw: `number` of a scene, and of its plan.
    pub fn of_pixel(scene: &Scene, plan: &Plan, number: usize, options: &Options) -> Function {
        let (draw, planned) = (&scene.draws[number], &plan.draws()[number]);
        let code = Code::default();
        let builder = Builder { code: &code, options: *options };
        let interpolator =
            Interpolator { code: &code, perspective: planned.perspective, is_far: planned.assembly.is_far };
        let whole = Whole { interpolator, planned };
        let (x, y) = (whole.input(Input::X), whole.input(Input::Y));
        let e = whole.edges(x, y, true);
        let sample = whole.sample::<true>(e);
        let weights = whole.color_weights(&sample);
        let colors = [0, 1].map(|set| whole.color(set, weights));
        let [r, g, b] = draw.fog.color.map(|byte| Number::Constant(byte.into()));
        let fog = [r, g, b, whole.fog(sample.b)];
        let quad = [x, y].map(|at| at.masked(QUAD));
        let shader = planned.shader.as_ref().map(|shader| {
            let scale = options.policies.dependent_scale;
            let first = [0, 1, 2, 3].map(|n| if is_idle(draw, n) { UNBOUND } else { UNPLANNED });
            Stages { whole: &whole, shader, scale, quad, first }.run(&sample)
        });
        let mut dropped = shader.map_or(Truth::Known(false), |(_, dropped)| dropped);
        let mut register = |n: usize| {
            if let Some((registers, _)) = shader {
                return registers[n];
            }
            if is_idle(draw, n) {
                return UNBOUND;
            }
            let Some(unit) = planned.units.iter().find(|unit| unit.index == n) else { return UNPLANNED };
            let projection = Projection::new(&whole, unit);
            let (register, drops) = Unit::new(&whole, unit, &sample, quad, &|_| Place::Own(projection)).register();
            dropped = dropped | drops;
            register
        };
        let registers = loaded([colors[0], colors[1], fog], |n| converted(&code, draw, register(n)));
        let fragment = builder.fragment(&draw.combiners, registers);
        let alpha = builder.alpha_test(draw, fragment).map_or(Truth::Known(true), |test| Truth::new(&code, test));
        let never = planned.folded.invisible.is_some();
        let (stored, new) = whole.tests(alpha & !dropped & Truth::Known(!never), e);
        let held = Word(whole.input(Input::Held));
        let word = builder.word(draw, scene.targets[draw.target].format, fragment, held);
        let depth = new.map(|[depth, stencil]| {
            code.by("");
            (depth.word() | stencil.word() << 24).0.operand()
        });
        let test = match stored {
            Truth::Known(false) => Some(Test(CompareFunction::NotEqual, [Operand::Constant(0); 2])),
            stored => stored.test(),
        };
        let result = Result::Pixel { word: word.0.operand(), depth, test };
        Function::new(code, result, options)
    }
}
