//! Planes: values that traces name, of all pixels of a rectangle.
//!
//! The walk is that of the scalar engine, the lane and the pixel are those of a trace. Bands of rows are drawn by several threads.

use std::collections::BTreeMap;

use super::reals::FragmentRecorder;
use super::tracing::{Pixel, TraceError};
use super::{BAND, TextureWords, cleared, cleared_colors, draw_defined, walk};
use crate::number::Pair;
use crate::plan::Plan;
use crate::state::Rectangle;
use crate::threads::on_threads;
use crate::trace::{Silent, Step, Unit};
#[cfg(feature = "threads")]
use rayon::prelude::*;

/// Which fragments are observed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlaneOptions {
    /// Number of the target.
    pub target: usize,
    /// The pixels; `None` for the whole target.
    pub rectangle: Option<Rectangle>,
    /// Only fragments of this draw.
    pub draw: Option<usize>,
    /// Whether fragments that a test drops count. Otherwise a pixel shows its last stored fragment.
    pub dropped: bool,
    /// Whether the ideals are computed, too.
    pub ideal: bool,
    /// Number of threads; 0 for one per core. The result does not depend on it.
    pub threads: usize,
}

/// One named value of each pixel of a rectangle, row by row from the top.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plane {
    /// The integers; 0 where the pixel has none.
    pub values: Vec<i64>,
    /// The float64 ideals, in the unit of the real number; NaN where there is none. Empty unless they were asked for.
    pub ideals: Vec<f64>,
    /// The units that occur.
    pub units: Vec<Unit>,
    /// For each pixel the index of its unit in `units`; [`Plane::ABSENT`] where the pixel has no value.
    pub unit_of: Vec<u16>,
}

impl Plane {
    /// Index of the unit of a pixel without a value.
    pub const ABSENT: u16 = u16::MAX;

    fn blank(pixels: usize, ideal: bool) -> Plane {
        Plane {
            values: vec![0; pixels],
            ideals: vec![f64::NAN; if ideal { pixels } else { 0 }],
            units: Vec::new(),
            unit_of: vec![Plane::ABSENT; pixels],
        }
    }

    /// Returns the unit of a pixel; `None` if it has no value.
    pub fn unit(&self, pixel: usize) -> Option<Unit> {
        self.units.get(usize::from(self.unit_of[pixel])).copied()
    }

    /// Returns the number of a unit. There are as many exponents as a binary32 number has, and few integers for 1.0.
    fn number(&mut self, unit: Unit) -> u16 {
        let at = self.units.iter().position(|known| *known == unit).unwrap_or_else(|| {
            self.units.push(unit);
            self.units.len() - 1
        });
        at as u16
    }

    fn put(&mut self, pixel: usize, value: Value) {
        self.values[pixel] = value.value;
        if let Some(ideal) = self.ideals.get_mut(pixel) {
            *ideal = value.ideal;
        }
        self.unit_of[pixel] = self.number(value.unit);
    }

    /// Appends the rows below.
    fn append(&mut self, other: &Plane) {
        let numbers: Vec<u16> = other.units.iter().map(|unit| self.number(*unit)).collect();
        self.values.extend_from_slice(&other.values);
        self.ideals.extend_from_slice(&other.ideals);
        self.unit_of
            .extend(other.unit_of.iter().map(|n| numbers.get(usize::from(*n)).copied().unwrap_or(Plane::ABSENT)));
    }
}

/// Planes that no rule yields: they say of which fragment the others are.
pub const FRAGMENT_NAMES: [&str; 3] = ["fragment.draw", "fragment.triangle", "fragment.stored"];

/// Returns the named values of all pixels, one plane for each name, in their order. A pixel's value is that of its last fragment that has one; within
/// a fragment the last step of the name counts. Draws that change nothing have no fragments.
///
/// # Errors
/// The target or the draw does not exist, or the rectangle is not inside the target.
pub fn planes(plan: &Plan, names: &[String], options: &PlaneOptions) -> Result<Vec<Plane>, TraceError> {
    let record = |pixels| Values { names, planes: vec![Plane::blank(pixels, options.ideal); names.len()] };
    let bands = observe(plan, options, Some(names), |_| true, record)?;
    let mut planes = vec![Plane::default(); names.len()];
    for band in &bands {
        planes.iter_mut().zip(&band.planes).for_each(|(plane, part)| plane.append(part));
    }
    Ok(planes)
}

/// Returns the names of steps at some 256 pixels spread over the rectangle, each with its block.
///
/// # Errors
/// Those of [`planes`].
pub fn plane_names(plan: &Plan, options: &PlaneOptions) -> Result<BTreeMap<String, String>, TraceError> {
    let Rectangle { width, height, .. } = rectangle(plan, options)?;
    let pixels = u64::from(width) * u64::from(height);
    let step = (pixels / 256).isqrt().max(1) as i64;
    let are_few = |(x, y)| x % step == 0 && y % step == 0;
    let every = PlaneOptions { dropped: true, draw: None, ..*options };
    let bands = observe(plan, &every, None, are_few, |_| Names::default())?;
    let mut names = BTreeMap::new();
    for band in bands {
        names.extend(band.names);
    }
    if !names.is_empty() {
        names.extend(FRAGMENT_NAMES.map(|name| (name.to_owned(), "fragment".to_owned())));
    }
    Ok(names)
}

/// What is kept of all fragments of some rows.
trait Record: Send {
    /// Keeps the steps of a fragment of the pixel with this index among those of the rows.
    fn keep(&mut self, pixel: usize, fragment: [i64; 3], steps: Vec<Step>);
}

/// A value of a pixel.
#[derive(Clone, Copy)]
struct Value {
    value: i64,
    ideal: f64,
    unit: Unit,
}

/// Keeps the values of some names.
struct Values<'a> {
    names: &'a [String],
    planes: Vec<Plane>,
}

impl Record for Values<'_> {
    fn keep(&mut self, pixel: usize, fragment: [i64; 3], steps: Vec<Step>) {
        let whole = |value: i64| Value { value, ideal: f64::NAN, unit: Unit { per_one: 1, exponent: 0 } };
        for (name, plane) in self.names.iter().zip(&mut self.planes) {
            let value = match FRAGMENT_NAMES.iter().position(|own| own == name) {
                Some(own) => Some(whole(fragment[own])),
                None => steps.iter().rfind(|step| step.name == *name).map(|step| Value {
                    value: step.value,
                    ideal: step.ideal.unwrap_or(f64::NAN),
                    unit: step.unit(),
                }),
            };
            if let Some(value) = value {
                plane.put(pixel, value);
            }
        }
    }
}

/// Keeps the names of all steps.
#[derive(Default)]
struct Names {
    names: BTreeMap<String, String>,
}

impl Record for Names {
    fn keep(&mut self, _: usize, _: [i64; 3], steps: Vec<Step>) {
        for step in steps {
            self.names.entry(step.name).or_insert(step.block);
        }
    }
}

/// Returns the pixels that are observed, all of them inside the target.
fn rectangle(plan: &Plan, options: &PlaneOptions) -> Result<Rectangle, TraceError> {
    let count = plan.targets.len();
    let target = plan.targets.get(options.target).ok_or(TraceError::Target { target: options.target, count })?;
    let (width, height) = (target.width, target.height);
    let rectangle = options.rectangle.unwrap_or(Rectangle { x: 0, y: 0, width, height });
    let (end, bottom) =
        (u64::from(rectangle.x) + u64::from(rectangle.width), u64::from(rectangle.y) + u64::from(rectangle.height));
    if end > u64::from(width) || bottom > u64::from(height) || rectangle.width == 0 || rectangle.height == 0 {
        let last = |start: u32, count: u32| start.saturating_add(count.max(1) - 1);
        let (x, y) = (last(rectangle.x, rectangle.width), last(rectangle.y, rectangle.height));
        return Err(TraceError::Pixel { x, y, target: target.name.clone(), width, height });
    }
    if let Some(draw) = options.draw.filter(|draw| *draw >= plan.draws.len()) {
        return Err(TraceError::Draw { draw, count: plan.draws.len() });
    }
    Ok(rectangle)
}

/// Some rows of the rectangle.
struct Band<R> {
    first_row: i64,
    pixels: Vec<Pixel>,
    record: R,
}

/// Draws the pixels of a rectangle. The record of a band keeps steps of some names, or all, of fragments that count, of pixels that `chosen` names.
fn observe<R: Record>(
    plan: &Plan,
    options: &PlaneOptions,
    names: Option<&[String]>,
    chosen: impl Fn((i64, i64)) -> bool + Sync,
    record: impl Fn(usize) -> R + Sync,
) -> Result<Vec<R>, TraceError> {
    let Rectangle { x, y, width, height } = rectangle(plan, options)?;
    let target = &plan.targets[options.target];
    let mut frames = cleared(plan);
    // Whole frames are needed only if a draw reads one.
    let rendered = plan.textures.iter().any(|texture| texture.image.target().is_some());
    let band = |first: u32| {
        let rows = height.min(first - y + BAND as u32) - (first - y);
        let surface = &frames.surfaces[options.target];
        let pixels =
            (first..first + rows).flat_map(|row| (x..x + width).map(move |column| (column, row))).map(|(i, j)| {
                let at = j as usize * target.width as usize + i as usize;
                let depth = surface.depth.get(at).copied().unwrap_or(0);
                Pixel::new(surface.words[at], depth, cleared_colors(target, at))
            });
        let pixels: Vec<Pixel> = pixels.collect();
        let record = record(pixels.len());
        Band { first_row: i64::from(first), pixels, record }
    };
    let mut bands: Vec<Band<R>> = (y..y + height).step_by(BAND).map(band).collect();
    let work = || {
        let mut finished = 0;
        for (index, planned) in plan.draws.iter().enumerate().filter(|(_, planned)| planned.target == options.target) {
            if rendered {
                for before in &plan.draws[finished..index] {
                    draw_defined(plan, before, &mut frames, &mut Silent);
                }
                finished = index;
            }
            let words = TextureWords::new(plan, std::slice::from_ref(planned), &frames.surfaces);
            let images = words.images::<Pair>();
            let counts = options.draw.is_none_or(|only| only == index);
            let columns = i64::from(x)..i64::from(x + width);
            let draw = |band: &mut Band<R>| {
                let rows = (band.first_row, band.first_row + (band.pixels.len() / width as usize) as i64);
                walk::covered(plan, planned, rows, |context, i, j| {
                    if !columns.contains(&i) || !chosen((i, j)) {
                        return;
                    }
                    let at = (j - band.first_row) as usize * width as usize + (i - columns.start) as usize;
                    let mut recorder = FragmentRecorder { names, ..FragmentRecorder::default() };
                    let stored = band.pixels[at].shade(planned, context, (i, j), &images, &mut recorder);
                    if counts && (stored || options.dropped) {
                        band.record.keep(at, [index as i64, context.number as i64, i64::from(stored)], recorder.steps);
                    }
                });
            };
            #[cfg(feature = "threads")]
            bands.par_iter_mut().for_each(draw);
            #[cfg(not(feature = "threads"))]
            bands.iter_mut().for_each(draw);
        }
    };
    on_threads(options.threads, work);
    Ok(bands.into_iter().map(|band| band.record).collect())
}
