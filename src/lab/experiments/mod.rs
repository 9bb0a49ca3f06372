//! Limits of methods: the parameter at which each begins to fail.
//!
//! An [`Experiment`] builds a small scene for every value of its parameter, draws it with the engine, and measures the deviation from a formula in
//! float64. [`threshold`] bisects an interval between a value at which a method works and one at which it fails. The code holds no outcome:
//! thresholds, curves and their page are computed by the model.
#![allow(clippy::float_arithmetic, reason = "measures pictures against formulas; nothing of this is stored")]

mod cube_resolution;
mod destination_alpha;
mod emboss;
mod filtered_normals;
mod half_vectors;
mod light;
mod long_vectors;
mod minified_normals;
mod mirrored_bases;
mod order;
pub mod page;
mod portable;
mod power_table;
mod squaring;
mod strip;
mod subtraction;

use ninebit_scene::SceneError;
use ninebit_scene::generate::normal_map::encode;
use portable::*;
use strip::*;

/// A row of pixels that a method drew, and its error.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// The error, in the unit of the experiment.
    pub error: f64,
    /// The channel that was drawn.
    drawn: Vec<u8>,
    /// What a formula in float64 gives for it.
    exact: Vec<u8>,
}

/// Function from a value of the parameter to what a method draws.
pub type Measure = Box<dyn Fn(f64) -> Result<Outcome, Box<SceneError>> + Send + Sync>;

/// A method that an experiment measures.
pub struct Method {
    /// Name in legend and table.
    pub name: String,
    /// Function from the parameter to the error.
    pub measure: Measure,
    /// Value of the parameter at which the method should work.
    pub works: f64,
    /// Value of the parameter at which it should fail.
    pub fails: f64,
}

impl Method {
    fn new(
        name: impl Into<String>,
        [works, fails]: [f64; 2],
        measure: impl Fn(f64) -> Result<Outcome, Box<SceneError>> + Send + Sync + 'static,
    ) -> Method {
        Method { name: name.into(), measure: Box::new(measure), works, fails }
    }
}

impl std::fmt::Debug for Method {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Method").field("name", &self.name).finish_non_exhaustive()
    }
}

/// Kind of values that a parameter takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// Real numbers; thresholds are found to this precision.
    Real(f64),
    /// All whole numbers of the range.
    Whole,
    /// Powers of two.
    Doubling,
}

/// An experiment: a parameter that is varied until methods fail.
#[derive(Debug)]
pub struct Experiment {
    /// Name of its files, and of its section in the page.
    pub name: &'static str,
    /// Title above its chart.
    pub title: &'static str,
    /// Name of the parameter, with its unit.
    pub parameter: &'static str,
    /// Name of the error, with its unit.
    pub error: &'static str,
    /// Largest error at which a method counts as working.
    pub limit: f64,
    /// Kind of the parameter's values.
    pub scale: Scale,
    /// Values of the parameter that the chart shows.
    pub shown: Vec<f64>,
    /// The methods that are compared.
    pub methods: Vec<Method>,
}

impl Experiment {
    fn new(name: &'static str, title: &'static str) -> Experiment {
        let (parameter, error, limit, scale) = ("", "", 0.0, Scale::Whole);
        Experiment { name, title, parameter, error, limit, scale, shown: Vec::new(), methods: Vec::new() }
    }

    /// Sets the parameter, the kind of its values, and those that the chart shows.
    fn moving(self, parameter: &'static str, scale: Scale, shown: Vec<f64>) -> Experiment {
        Experiment { parameter, scale, shown, ..self }
    }

    /// Sets the error that is measured, and its limit.
    fn measuring(self, error: &'static str, limit: f64) -> Experiment {
        Experiment { error, limit, ..self }
    }

    fn by(self, methods: impl Into<Vec<Method>>) -> Experiment {
        Experiment { methods: methods.into(), ..self }
    }
}

/// The value of the parameter where a method stops working.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Threshold {
    /// It lies between two values.
    Between {
        /// Last value at which the method works.
        works: f64,
        /// First value at which it fails.
        fails: f64,
    },
    /// The method works even where it should fail.
    Holds,
    /// The method fails even where it should work.
    Fails,
}

impl Threshold {
    /// Returns the last value at which the method works and the first at which it fails; `None` if there is no such value.
    fn ends(self, method: &Method) -> (Option<f64>, Option<f64>) {
        match self {
            Threshold::Between { works, fails } => (Some(works), Some(fails)),
            Threshold::Holds => (Some(method.fails), None),
            Threshold::Fails => (None, Some(method.works)),
        }
    }
}

impl Scale {
    /// Returns a value between two others, or `None` if they are next to each other or close enough.
    fn between(self, a: f64, b: f64) -> Option<f64> {
        match self {
            Scale::Real(enough) => ((a - b).abs() > enough).then_some(0.5 * (a + b)),
            Scale::Whole => {
                let middle = (0.5 * (a + b)).floor();
                (middle != a && middle != b).then_some(middle)
            }
            Scale::Doubling => Scale::Whole.between(log2(a).round(), log2(b).round()).map(exp2),
        }
    }
}

/// Finds where a method's error crosses the limit, by bisection between its `works` and `fails`.
///
/// # Errors
/// Returns an error if a scene is not valid, which is a fault of the experiment.
pub fn threshold(experiment: &Experiment, method: &Method) -> Result<Threshold, Box<SceneError>> {
    let works_at = |value: f64| Ok::<bool, Box<SceneError>>((method.measure)(value)?.error <= experiment.limit);
    if !works_at(method.works)? {
        return Ok(Threshold::Fails);
    }
    if works_at(method.fails)? {
        return Ok(Threshold::Holds);
    }
    let (mut works, mut fails) = (method.works, method.fails);
    while let Some(middle) = experiment.scale.between(works, fails) {
        if works_at(middle)? {
            works = middle;
        } else {
            fails = middle;
        }
    }
    Ok(Threshold::Between { works, fails })
}

/// Returns all experiments, in the order of the page.
pub fn experiments() -> Vec<Experiment> {
    vec![
        squaring::experiment(),
        power_table::experiment(),
        subtraction::experiment(),
        order::experiment(),
        long_vectors::experiment(),
        light::grazing(),
        light::behind(),
        filtered_normals::experiment(),
        minified_normals::experiment(),
        cube_resolution::experiment(),
        half_vectors::experiment(),
        destination_alpha::experiment(),
        emboss::experiment(),
        mirrored_bases::experiment(),
    ]
}

/// Returns `count` evenly spaced values from `low` to `high`.
fn steps(low: f64, high: f64, count: usize) -> Vec<f64> {
    (0..count).map(|n| low + (high - low) * n as f64 / (count.max(2) - 1) as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn search(scale: Scale, works: f64, fails: f64, measure: fn(f64) -> f64) -> Threshold {
        let method =
            Method::new("", [works, fails], move |value| Ok(Outcome { error: measure(value), ..Outcome::default() }));
        let experiment = Experiment::new("", "").moving("", scale, Vec::new()).measuring("", 4.0).by([method]);
        threshold(&experiment, &experiment.methods[0]).unwrap()
    }

    #[test]
    fn halving_finds_the_place() {
        let between = |works, fails| Threshold::Between { works, fails };
        assert_eq!(search(Scale::Whole, 0.0, 100.0, |v| v / 3.0), between(12.0, 13.0));
        assert_eq!(search(Scale::Whole, 100.0, -7.0, |v| 20.0 - v), between(16.0, 15.0));
        assert_eq!(search(Scale::Doubling, 1.0, 1024.0, |v| v / 10.0), between(32.0, 64.0));
        assert_eq!(search(Scale::Real(0.25), 0.0, 8.0, |v| v), between(4.0, 4.25));
        assert_eq!(search(Scale::Whole, 0.0, 4.0, |v| v), Threshold::Holds);
        assert_eq!(search(Scale::Whole, 5.0, 9.0, |v| v), Threshold::Fails);
    }
}
