//! Planes as arrays: values that traces name, of all pixels of a rectangle.

use std::collections::BTreeMap;

use ninebit::engine::{Plane, PlaneOptions, TraceError, plane_names, planes};
use ninebit::plan::Plan;
use ninebit::state::Rectangle;
use ninebit_program::spelling::closest;
use thiserror::Error;

/// Letters of the channels, in the order of an array's last axis.
pub const CHANNELS: [&str; 4] = ["r", "g", "b", "a"];

/// Values of one name, or of the channels that the name stands for.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneArray {
    /// The name as it was asked for.
    pub name: String,
    /// Names of the steps: one, or one for each channel.
    pub steps: Vec<String>,
    /// One plane for each step.
    pub planes: Vec<Plane>,
}

impl PlaneArray {
    /// Returns all values with the channels innermost, as `f` makes them of a plane and a pixel.
    pub fn interleaved<T>(&self, f: impl Fn(&Plane, usize) -> T) -> Vec<T> {
        let pixels = self.planes.first().map_or(0, |plane| plane.values.len());
        let mut all = Vec::with_capacity(pixels * self.planes.len());
        for pixel in 0..pixels {
            all.extend(self.planes.iter().map(|plane| f(plane, pixel)));
        }
        all
    }

    /// Returns whether all values are 32-bit signed integers.
    pub fn is_narrow(&self) -> bool {
        self.planes.iter().flat_map(|plane| &plane.values).all(|value| i32::try_from(*value).is_ok())
    }

    /// Returns whether every pixel has a value.
    pub fn is_whole(&self) -> bool {
        self.planes.iter().flat_map(|plane| &plane.unit_of).all(|unit| *unit != Plane::ABSENT)
    }

    /// Returns whether pixels have values of several powers of two.
    pub fn has_exponents(&self) -> bool {
        self.planes.iter().flat_map(|plane| &plane.units).any(|unit| unit.exponent != 0)
    }

    /// Returns the integer that stands for 1.0 in all pixels; `None` if there are several.
    pub fn per_one(&self) -> Option<i64> {
        let mut all = self.planes.iter().flat_map(|plane| &plane.units).map(|unit| unit.per_one);
        let first = all.next().unwrap_or(1);
        all.all(|other| other == first).then_some(first)
    }
}

/// Planes of a rectangle.
#[derive(Clone, Debug, PartialEq)]
pub struct Planes {
    /// The pixels.
    pub rectangle: Rectangle,
    /// The arrays, in the order that was asked for.
    pub arrays: Vec<PlaneArray>,
}

/// The planes cannot be computed.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PlanesError {
    /// The target, the draw or the pixels do not exist.
    #[error("{0}")]
    Place(TraceError),
    /// No observed pixel has a value of this name.
    #[error("no pixel has a value `{name}`")]
    Unknown {
        /// The name.
        name: String,
        /// A name that is like it, if there is one.
        meant: Option<String>,
    },
}

impl PlanesError {
    /// Code of a name that no pixel has a value of.
    pub const UNKNOWN: &str = "NB1401";

    /// Returns what to do about it.
    pub fn help(&self) -> String {
        match self {
            PlanesError::Unknown { meant: Some(meant), .. } => format!("did you mean `{meant}`?"),
            PlanesError::Unknown { .. } => {
                "`ninebit planes SCENE` lists the names; registers that cannot reach the stored word are left out"
                    .to_owned()
            }
            PlanesError::Place(_) => "name a target, a draw and pixels of the scene".to_owned(),
        }
    }
}

/// Computes planes. A name is that of a step; or stands for its channels, `texture0.rgb`, `texture0.rgba`, `stage0.rgb.AB`.
///
/// # Errors
/// The target, the draw or the rectangle does not exist; no pixel has a value of a name.
pub fn plane_arrays(plan: &Plan, names: &[String], options: &PlaneOptions) -> Result<Planes, PlanesError> {
    let known = plane_names(plan, options).map_err(PlanesError::Place)?;
    let steps: Vec<Vec<String>> = names.iter().map(|name| steps_of(name, &known)).collect();
    let wanted: Vec<String> = steps.iter().flatten().cloned().collect();
    let mut found = planes(plan, &wanted, options).map_err(PlanesError::Place)?.into_iter();
    let mut arrays = Vec::new();
    for (name, steps) in names.iter().zip(steps) {
        let planes: Vec<Plane> = found.by_ref().take(steps.len()).collect();
        if planes.iter().any(|plane| plane.units.is_empty()) && !steps.iter().all(|step| known.contains_key(step)) {
            let meant = closest(name, known.keys().map(String::as_str)).map(str::to_owned);
            return Err(PlanesError::Unknown { name: name.clone(), meant });
        }
        arrays.push(PlaneArray { name: name.clone(), steps, planes });
    }
    let target = &plan.targets()[options.target];
    let whole = Rectangle { x: 0, y: 0, width: target.width, height: target.height };
    Ok(Planes { rectangle: options.rectangle.unwrap_or(whole), arrays })
}

/// Returns the names of the steps that a name stands for. One that is not known may be that of a step of some other pixel.
fn steps_of(name: &str, known: &BTreeMap<String, String>) -> Vec<String> {
    if known.contains_key(name) {
        return vec![name.to_owned()];
    }
    let of = |stem: &str, count: usize| CHANNELS[..count].iter().map(|c| format!("{stem}.{c}")).collect::<Vec<_>>();
    let there = |steps: Vec<String>| steps.into_iter().filter(|step| known.contains_key(step)).collect::<Vec<_>>();
    let channels = there(of(name, 4));
    if !channels.is_empty() {
        return channels;
    }
    match (name.strip_suffix(".rgba"), name.strip_suffix(".rgb")) {
        (Some(stem), _) => of(stem, 4),
        (_, Some(stem)) => of(stem, 3),
        _ => vec![name.to_owned()],
    }
}
