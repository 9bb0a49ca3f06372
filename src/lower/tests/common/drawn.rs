//! Scenes as printed functions of whole pixels, with all that these functions are given.

use std::borrow::Cow;
use std::collections::HashMap;

use ninebit::engine::walk::covered;
use ninebit::engine::{TextureWords, cleared, trace};
use ninebit::frame::Frames;
use ninebit::plan::Plan;
use ninebit::state::Scene;
use ninebit_lower::code::{InputSource, Test, run, value_of};
use ninebit_lower::{Draw, Field, Function, Input, Options, Result, Setup};

/// The functions of a scene's draws.
pub struct Printed<'p> {
    pub scene: &'p Scene,
    pub plan: &'p Plan,
    pub draws: Vec<(Function, Setup)>,
}

/// What a function is given at a pixel.
struct At<'g> {
    x: i64,
    y: i64,
    word: u32,
    depth: u32,
    constants: &'g HashMap<Field, i64>,
    memories: &'g [Cow<'g, [u32]>; 4],
}

impl InputSource for At<'_> {
    fn input(&mut self, input: Input) -> i64 {
        match input {
            Input::X => self.x,
            Input::Y => self.y,
            Input::Held => self.word.into(),
            Input::Depth => self.depth.into(),
            Input::Triangle(field) => self.constants[&field],
            input => panic!("{input:?} is no input of a whole pixel"),
        }
    }
    fn word(&mut self, unit: usize, at: i64) -> u32 {
        self.memories[unit][at as usize]
    }
}

impl<'p> Printed<'p> {
    /// Makes the functions.
    pub fn new(scene: &'p Scene, plan: &'p Plan) -> Printed<'p> {
        let options = Options { policies: plan.policies, ..Options::default() };
        let mut draws = Vec::new();
        for (number, draw) in plan.draws().iter().enumerate() {
            let function = Function::of_pixel(scene, plan, number, &options);
            let setup = Setup::new(plan, draw, &function);
            draws.push((function, setup));
        }
        Printed { scene, plan, draws }
    }

    /// Returns the draws with names, `draw0` and so on.
    pub fn named(&self) -> Vec<Draw<'_>> {
        (self.draws.iter().enumerate())
            .map(|(n, (function, setup))| Draw {
                name: format!("draw{n}"),
                about: format!("draw {n}"),
                function,
                setup,
            })
            .collect()
    }

    /// Draws the scene by running the lines.
    pub fn run(&self) -> Frames {
        let (plan, mut frames) = (self.plan, cleared(self.plan));
        for (number, (draw, (function, setup))) in plan.draws().iter().zip(&self.draws).enumerate() {
            let surfaces = frames.surfaces.clone();
            let words = TextureWords::new(plan, &plan.draws()[number..=number], &surfaces);
            let memories = words.memories(draw);
            let Result::Pixel { word, depth, test } = function.result else { panic!("no pixel") };
            let surface = &mut frames.surfaces[draw.target];
            let (mut triangle, mut constants) = (usize::MAX, HashMap::new());
            covered(plan, draw, (0, surface.height.into()), |context, x, y| {
                if triangle != context.number {
                    (triangle, constants) = (context.number, setup.constants(context));
                }
                let at = y as usize * surface.width as usize + x as usize;
                let held_depth = surface.depth.get(at).copied().unwrap_or(0);
                let given =
                    At { x, y, word: surface.words[at], depth: held_depth, constants: &constants, memories: &memories };
                let values = run(&function.lines, given);
                if let (Some(slot), Some(depth)) = (surface.depth.get_mut(at), depth) {
                    *slot = value_of(&values, depth) as u32;
                }
                let passes = |Test(test, [a, b])| test.passes(value_of(&values, a), value_of(&values, b));
                if test.is_none_or(passes) {
                    surface.words[at] = value_of(&values, word) as u32;
                }
            });
        }
        frames
    }
}

/// Fails with the first pixel that differs, and its trace.
pub fn difference(plan: &Plan, wanted: &Frames, found: &Frames, what: &str) {
    for (target, (wanted, found)) in wanted.surfaces.iter().zip(&found.surfaces).enumerate() {
        for (wanted, found, of) in [(&wanted.words, &found.words, "word"), (&wanted.depth, &found.depth, "depth")] {
            let Some(at) = (0..wanted.len()).find(|at| wanted[*at] != found[*at]) else { continue };
            let width = plan.targets()[target].width as usize;
            let pixel = ((at % width) as u32, (at / width) as u32);
            let count = (0..wanted.len()).filter(|at| wanted[*at] != found[*at]).count();
            let mut steps = String::new();
            for draw in trace(plan, target, pixel, None).unwrap().draws {
                steps += &format!("draw {}\n", draw.draw);
                for step in draw.steps {
                    steps += &format!("    {} = {} 2^{} ({})\n", step.name, step.value, step.exponent, step.rule);
                }
            }
            panic!(
                "{what}: {count} pixels of target {target}; {of} of {pixel:?} is {:#x}, not {:#x}\n{steps}",
                found[at], wanted[at]
            );
        }
    }
}
