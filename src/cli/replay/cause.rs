//! Search for the single change that draws the expected picture.

use std::fmt;

use ninebit::engine::{self, Engine, RenderOptions};
use ninebit::frame::Surface;
use ninebit::plan::Plan;
use ninebit::state::{POLICIES, Policies};

use super::outcome::Pixel;

/// A change that draws the expected picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// Another value of one policy.
    Policy {
        /// Id of the policy's rule.
        rule: &'static str,
        /// Value of the policy that draws the expected picture.
        value: &'static str,
        /// Meaning of the value.
        meaning: &'static str,
    },
    /// The scalar engine instead of the fast one.
    Engine,
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Cause::Policy { rule, value, .. } => write!(f, "{rule}={value} draws what is expected"),
            Cause::Engine => {
                write!(f, "the scalar engine draws what is expected: a fault of the fast engine, please report it")
            }
        }
    }
}

/// A cause, its plan, and the surface that it draws.
pub(super) struct ReplayCause {
    pub(super) cause: Cause,
    pub(super) plan: Plan,
    pub(super) surface: Surface,
}

/// Searches for a policy value, or the engine, with which `matches` accepts the target. `first` is a pixel whose expected value is known: values that
/// do not yield it need not be drawn.
pub(super) fn find(
    plan: &Plan,
    render: &RenderOptions,
    target: usize,
    first: Option<Pixel>,
    matches: &dyn Fn(&Surface) -> bool,
) -> Option<ReplayCause> {
    let try_out = |plan: Plan, render: &RenderOptions, cause: Cause| {
        let surface = engine::render(&plan, render).surfaces.swap_remove(target);
        matches(&surface).then_some(ReplayCause { cause, plan, surface })
    };
    if render.engine == Engine::Fast && plan.policies == Policies::DEFAULT {
        let scalar = RenderOptions { engine: Engine::Scalar, ..*render };
        if let Some(found) = try_out(plan.clone(), &scalar, Cause::Engine) {
            return Some(found);
        }
    }
    for policy in POLICIES {
        let current = plan.policies.chosen(policy.rule);
        for (index, (value, meaning)) in policy.values.iter().copied().enumerate().filter(|(n, _)| *n != current) {
            let mut other = plan.clone();
            other.policies.choose(policy.rule, index);
            let hopeless = first.is_some_and(|pixel| {
                let trace = engine::trace(&other, target, (pixel.x, pixel.y), None);
                trace.is_ok_and(|trace| trace.shown != pixel.expected)
            });
            let cause = Cause::Policy { rule: policy.rule, value, meaning };
            if !hopeless && let Some(found) = try_out(other, render, cause) {
                return Some(found);
            }
        }
    }
    None
}
