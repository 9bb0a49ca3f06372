//! Makes the function of a draw's whole pixel: from its place in a triangle and the memories of textures to the stored words.

use ninebit::number::{Integer, Register as _};
use ninebit::plan::Plan;
use ninebit::state::{CompareFunction, Scene};

use crate::binary::counted;
use crate::code::{Code, Operand, Test};
use crate::helper::Helper;
use crate::input::Input;
use crate::number::{Number, Word};
use crate::pixel::{Builder, Function, Options, Result, UNBOUND, is_idle, loaded};
use crate::place::{Place, Projection, Unit};
use crate::stage::Stages;
use crate::truth::Truth;
use crate::whole::Whole;

/// What a unit that is not planned gives: nobody reads it, or the plan knows that all of it is 0.
const UNPLANNED: [Number<'static>; 4] = [Number::ZERO; 4];

impl Function {
    /// Makes the function of a whole pixel of a draw: `number` of a scene, and of its plan.
    pub fn of_pixel(scene: &Scene, plan: &Plan, number: usize, options: &Options) -> Function {
        let (draw, planned) = (&scene.draws[number], &plan.draws()[number]);
        let code = Code::default();
        let builder = Builder { code: &code, options: *options };
        let whole = Whole { code: &code, planned, perspective: planned.perspective };
        let (x, y) = (whole.input(Input::X), whole.input(Input::Y));
        let e = whole.edges(x, y, true);
        let sample = whole.sample::<true>(e);
        let color_weight = |k: usize, name: &str| {
            let limit = [1, 8, 256].map(Operand::Constant);
            let b = sample.b[k].operand(&code);
            let weight = counted(&code, Helper::Floor, &[b, limit[0], limit[1], limit[2]]).within(0, 256);
            code.name(weight.operand(), || name.to_string());
            weight
        };
        let [w0, w2] = [color_weight(0, "W0"), color_weight(2, "W2")];
        let colors = [0, 1].map(|set| whole.color(set, [w0, w2]));
        let [r, g, b] = draw.fog.color.map(|byte| Number::Constant(byte.into()));
        let fog = [r, g, b, whole.fog(sample.b)];
        let quad = [x, y].map(|at| at.masked(4094));
        let shader = planned.shader.as_ref().map(|shader| {
            let scale = options.policies.dependent_scale;
            let first = [0, 1, 2, 3].map(|n| if is_idle(draw, n) { UNBOUND } else { UNPLANNED });
            Stages { whole: &whole, shader, scale, quad, first }.run(&sample)
        });
        let mut dropped = shader.map_or(Truth::Known(false), |(_, dropped)| dropped);
        let registers = loaded([colors[0], colors[1], fog], |n| {
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
        });
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
