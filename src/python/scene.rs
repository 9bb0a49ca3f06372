//! Scenes: read, changed, drawn, traced, measured.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

use ninebit::engine::{self, Engine, Isa, PlaneOptions, RenderOptions};
use ninebit::frame::Surface;
use ninebit::limits::{FileLimit, Limits};
use ninebit::plan::Plan;
use ninebit::state::{Named, POLICIES, Policies, Rectangle};
use ninebit_files::read::ReadError;
use ninebit_lab::accuracy::{accuracy_value, measure};
use ninebit_report::compare::{ALL_CHANNELS, CompareOptions, Mode, compare, comparison_json};
use ninebit_report::planes::{PlanesError, plane_arrays};
use ninebit_report::{trace_json, trace_text};
use ninebit_scene::assets::{Assets, Bundle, Folder};
use ninebit_scene::change::Change;
use ninebit_scene::data::{Data, scene_text as text_of_scene, value_text as text_of_value};
use ninebit_scene::path::PathError;
use ninebit_scene::{LoadedScene, load_changed, parse_changed};
use numpy::PyArray1;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};

use crate::fail::{Failure, described, detached};
use crate::units::parsed;

/// Files in memory, and beside them those of a folder.
#[derive(Debug)]
struct Files(Bundle);

impl Assets for Files {
    fn resolve(&self, folder: &Path, name: &str) -> Result<PathBuf, PathError> {
        self.0.resolve(folder, name).or_else(|_| Folder.resolve(folder, name))
    }

    fn bytes(&self, file: &Path, limit: FileLimit) -> Result<Vec<u8>, ReadError> {
        match self.0.bytes(file, limit) {
            Err(ReadError::Missing) => Folder.bytes(file, limit),
            found => found,
        }
    }
}

/// A scene that has been read and checked.
#[pyclass(frozen)]
pub(crate) struct Scene {
    loaded: LoadedScene,
}

/// Arguments that choose what is drawn, and how.
#[derive(Clone, Copy, Debug)]
struct Drawing {
    policies: Policies,
    work: u64,
}

impl Scene {
    fn plan(&self, drawing: Drawing) -> Result<Cow<'_, Plan>, Failure> {
        self.loaded.affordable(drawing.work)?;
        let plan = &self.loaded.plan;
        let same = plan.policies == drawing.policies;
        Ok(if same { Cow::Borrowed(plan) } else { Cow::Owned(plan.clone().under(drawing.policies)) })
    }

    fn target(&self, name: Option<&str>) -> Result<usize, Failure> {
        let Some(name) = name else { return Ok(0) };
        let targets = &self.loaded.scene.targets;
        targets.iter().position(|target| target.name == name).ok_or_else(|| {
            let names: Vec<&str> = targets.iter().map(|target| target.name.as_str()).collect();
            Failure::argument(format!("the scene has no target `{name}`"), format!("its targets: {}", names.join(", ")))
        })
    }

    fn drawing(policies: &[String], work: Option<u64>) -> Result<Drawing, Failure> {
        Ok(Drawing { policies: parsed(policies)?, work: work.unwrap_or(Limits::default().shaded_pixels) })
    }
}

/// A document, height and width, and the bytes and numbers of pixels.
type MeasuredPicture<'py> = (String, (u32, u32), Bound<'py, PyArray1<u8>>, Bound<'py, PyArray1<f64>>);

/// Name, format, width, height, words, bytes of the picture, depths, stencils.
type FrameArrays<'py> = (
    String,
    &'static str,
    u32,
    u32,
    Bound<'py, PyArray1<u32>>,
    Bound<'py, PyArray1<u8>>,
    Option<Bound<'py, PyArray1<u32>>>,
    Option<Bound<'py, PyArray1<u8>>>,
);

#[pymethods]
impl Scene {
    /// Reads a scene file after some changes, pairs of a path and a value.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf, changes: Vec<(String, String)>) -> PyResult<Scene> {
        detached(py, || Ok(Scene { loaded: load_changed(&path, &Limits::default(), &Folder, &changed(&changes)?)? }))
    }

    /// Reads the text of a scene, whose files are in memory or beside `origin`.
    #[staticmethod]
    fn parse(
        py: Python<'_>,
        text: &str,
        origin: PathBuf,
        files: HashMap<String, Vec<u8>>,
        changes: Vec<(String, String)>,
    ) -> PyResult<Scene> {
        let files = Files(Bundle { files: files.into_iter().collect() });
        detached(py, || {
            Ok(Scene { loaded: parse_changed(text, &origin, &Limits::default(), &files, &changed(&changes)?)? })
        })
    }

    /// The text of the scene after its changes.
    #[getter]
    fn text(&self) -> &str {
        &self.loaded.source.text
    }

    /// Name, format, width and height of each target.
    #[getter]
    fn targets(&self) -> Vec<(&str, &'static str, u32, u32)> {
        self.loaded.scene.targets.iter().map(|t| (t.name.as_str(), t.format.name(), t.width, t.height)).collect()
    }

    /// Names of the draws.
    #[getter]
    fn draws(&self) -> Vec<&str> {
        self.loaded.scene.draws.iter().map(|draw| draw.name.as_str()).collect()
    }

    /// The chip.
    #[getter]
    fn profile(&self) -> &'static str {
        self.loaded.scene.profile.name()
    }

    /// What is probably not intended, as fields of findings.
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        self.loaded.warnings.iter().map(|finding| described(py, finding, &self.loaded.source)).collect()
    }

    /// Draws the scene.
    fn render<'py>(
        &self,
        py: Python<'py>,
        engine: &str,
        isa: Option<&str>,
        threads: usize,
        policies: Vec<String>,
        work: Option<u64>,
    ) -> PyResult<Vec<FrameArrays<'py>>> {
        let frames = detached(py, || {
            let named = Engine::from_name(engine).ok_or_else(|| {
                Failure::argument(
                    format!("there is no engine `{engine}`"),
                    format!("write one of {}", Engine::NAMES.join(", ")),
                )
            })?;
            let isa = match isa {
                None => None,
                Some(name) => Some(Isa::from_name(name).filter(|isa| isa.is_available()).ok_or_else(|| {
                    Failure::argument(
                        format!("this machine does not have `{name}`"),
                        format!("the widest that it has is {}", Isa::best().name()),
                    )
                })?),
            };
            let plan = self.plan(Scene::drawing(&policies, work)?)?;
            Ok(engine::render(&plan, &RenderOptions { threads: threads_of(threads)?, engine: named, isa, band: None }))
        })?;
        let targets = &self.loaded.scene.targets;
        frames.surfaces.iter().zip(targets).map(|(surface, target)| drawn(py, surface, target)).collect()
    }

    /// Returns the names of values and their blocks, of some pixels.
    fn plane_names(&self, py: Python<'_>, target: Option<&str>) -> PyResult<Vec<(String, String)>> {
        detached(py, || {
            let plan = self.plan(Scene::drawing(&[], None)?)?;
            let options = PlaneOptions { target: self.target(target)?, ..PlaneOptions::default() };
            engine::plane_names(&plan, &options)
                .map(|names| names.into_iter().collect())
                .map_err(|error| Failure::argument(error.to_string(), "name a target of the scene"))
        })
    }

    /// Computes planes. Returns of each name: channels, values, ideals or `None`, whether a
    /// pixel has a value, integers for 1.0, powers of two. The last three are one number where it is that of all pixels.
    #[allow(clippy::too_many_arguments, reason = "the package names them")]
    fn planes<'py>(
        &self,
        py: Python<'py>,
        names: Vec<String>,
        target: Option<&str>,
        rectangle: Option<[u32; 4]>,
        draw: Option<usize>,
        dropped: bool,
        ideal: bool,
        threads: usize,
        policies: Vec<String>,
        work: Option<u64>,
    ) -> PyResult<(u32, u32, Vec<Bound<'py, PyTuple>>)> {
        let found = detached(py, || {
            let plan = self.plan(Scene::drawing(&policies, work)?)?;
            let rectangle = rectangle.map(|[x, y, width, height]| Rectangle { x, y, width, height });
            let (target, threads) = (self.target(target)?, threads_of(threads)?);
            let options = PlaneOptions { target, rectangle, draw, dropped, ideal, threads };
            plane_arrays(&plan, &names, &options).map_err(|error| {
                let code = matches!(error, PlanesError::Unknown { .. }).then_some(PlanesError::UNKNOWN);
                Failure::Plain(code, error.to_string(), error.help())
            })
        })?;
        let array = |array: &ninebit_report::planes::PlaneArray| -> PyResult<Bound<'py, PyTuple>> {
            let values: Bound<'py, PyAny> = match array.is_narrow() {
                true => PyArray1::from_vec(py, array.interleaved(|p, n| p.values[n] as i32)).into_any(),
                false => PyArray1::from_vec(py, array.interleaved(|p, n| p.values[n])).into_any(),
            };
            let ideals = match ideal {
                true => PyArray1::from_vec(py, array.interleaved(|p, n| p.ideals[n])).into_any(),
                false => py.None().into_bound(py),
            };
            let present = match array.is_whole() {
                true => PyArray1::from_slice(py, &[true]).into_any(),
                false => PyArray1::from_vec(py, array.interleaved(|p, n| p.unit(n).is_some())).into_any(),
            };
            let per_one = match array.per_one() {
                Some(per_one) => PyArray1::from_slice(py, &[per_one]).into_any(),
                None => PyArray1::from_vec(py, array.interleaved(|p, n| p.unit(n).map_or(1, |unit| unit.per_one)))
                    .into_any(),
            };
            let exponent = match array.has_exponents() {
                false => PyArray1::from_slice(py, &[0_i32]).into_any(),
                true => PyArray1::from_vec(py, array.interleaved(|p, n| p.unit(n).map_or(0, |unit| unit.exponent)))
                    .into_any(),
            };
            let channels = array.planes.len().into_pyobject(py)?.into_any();
            PyTuple::new(py, [channels, values, ideals, present, per_one, exponent])
        };
        let arrays = found.arrays.iter().map(array).collect::<PyResult<_>>()?;
        Ok((found.rectangle.width, found.rectangle.height, arrays))
    }

    /// Traces a pixel. Returns the trace as text and as JSON.
    fn trace(
        &self,
        py: Python<'_>,
        pixel: (u32, u32),
        target: Option<&str>,
        draw: Option<usize>,
        policies: Vec<String>,
        work: Option<u64>,
    ) -> PyResult<(String, String)> {
        detached(py, || {
            let plan = self.plan(Scene::drawing(&policies, work)?)?;
            let trace = engine::trace(&plan, self.target(target)?, pixel, draw).map_err(|error| {
                Failure::argument(error.to_string(), "`scene.targets` and `scene.draws` list what there is")
            })?;
            Ok((trace_text(&plan, &trace), trace_json(&plan, &trace)))
        })
    }

    /// Measures the picture against the truth. Returns a JSON document, height and width, the picture, R, G, B, A, and the truth, R, G, B from 0 to 255, NaN
    /// where a pixel is not measured.
    fn measure<'py>(
        &self,
        py: Python<'py>,
        policies: Vec<String>,
        work: Option<u64>,
    ) -> PyResult<MeasuredPicture<'py>> {
        let (value, size, shown, truth) = detached(py, || {
            let plan = self.plan(Scene::drawing(&policies, work)?)?;
            let Some(truth) = &self.loaded.truth else {
                let help = "give the scene a `truth: (lights: [...])`; docs/scene-format.md describes it";
                return Err(Failure::Plain(
                    Some("NB0396"),
                    "the scene does not say what its picture ought to show".to_owned(),
                    help.to_owned(),
                ));
            };
            let Some(accuracy) = measure(&self.loaded.scene, &plan, truth) else {
                let help = "the mesh has to be in view, and drawn into the first target";
                return Err(Failure::Plain(
                    Some("NB0395"),
                    "no pixel of the scene has a truth".to_owned(),
                    help.to_owned(),
                ));
            };
            #[allow(clippy::float_arithmetic, reason = "a change of units")]
            let color =
                |pixel: &Option<[f64; 3]>| pixel.map_or([f64::NAN; 3], |color| color.map(|channel| 255.0 * channel));
            let truth: Vec<[f64; 3]> = accuracy.pictures.truth().iter().map(color).collect();
            let shown = accuracy.pictures.pixels().as_flattened().to_vec();
            Ok((
                accuracy_value(&accuracy).to_string(),
                (accuracy.height, accuracy.width),
                shown,
                truth.into_flattened(),
            ))
        })?;
        Ok((value, size, PyArray1::from_vec(py, shown), PyArray1::from_vec(py, truth)))
    }

    /// Compares the picture with ideal arithmetic. Returns a JSON document, and R, G, B, A of each pixel's error in steps.
    fn compare<'py>(
        &self,
        py: Python<'py>,
        mode: &str,
        target: Option<&str>,
        threads: usize,
        policies: Vec<String>,
        work: Option<u64>,
    ) -> PyResult<(String, Bound<'py, PyArray1<f32>>)> {
        let (text, errors) = detached(py, || {
            let plan = self.plan(Scene::drawing(&policies, work)?)?;
            let mode = Mode::from_name(mode).ok_or_else(|| {
                Failure::argument(
                    format!("there is no mode `{mode}`"),
                    format!("write one of {}", Mode::NAMES.join(", ")),
                )
            })?;
            let options = CompareOptions {
                mode,
                target: self.target(target)?,
                threads: threads_of(threads)?,
                channels: ALL_CHANNELS,
            };
            let comparison = compare(&plan, &options);
            Ok((comparison_json(&plan, &comparison), comparison.errors.into_flattened()))
        })?;
        Ok((text, PyArray1::from_vec(py, errors)))
    }
}

fn threads_of(threads: usize) -> Result<usize, Failure> {
    if threads > ninebit::threads::MAXIMUM {
        return Err(Failure::argument(format!("{threads} threads are too many"), "0 takes all cores"));
    }
    Ok(threads)
}

fn changed(changes: &[(String, String)]) -> Result<Vec<Change>, Failure> {
    changes.iter().map(|(path, value)| Ok(Change::new(path, value)?)).collect()
}

fn drawn<'py>(py: Python<'py>, surface: &Surface, target: &ninebit::state::Target) -> PyResult<FrameArrays<'py>> {
    let depths = target.depth.map(|_| PyArray1::from_vec(py, surface.depths().collect::<Vec<u32>>()));
    let stencils = target
        .depth
        .filter(|depth| depth.format.has_stencil())
        .map(|_| PyArray1::from_vec(py, surface.depth.iter().map(|word| (word >> 24) as u8).collect::<Vec<u8>>()));
    let rgba = PyArray1::from_slice(py, surface.rgba8().as_flattened());
    let words = PyArray1::from_slice(py, &surface.words);
    Ok((target.name.clone(), target.format.name(), surface.width, surface.height, words, rgba, depths, stencils))
}

/// A rule that has alternatives: id, question, and each value with its meaning.
type Alternatives = (&'static str, &'static str, Vec<(&'static str, &'static str)>);

/// Returns the rules that have alternatives.
#[pyfunction]
pub(crate) fn policies() -> Vec<Alternatives> {
    POLICIES.iter().map(|policy| (policy.rule, policy.question, policy.values.to_vec())).collect()
}

/// Returns the text of a scene that is given as data.
#[pyfunction]
pub(crate) fn scene_text(data: &Bound<'_, PyAny>) -> PyResult<String> {
    Ok(text_of_scene(&read(data, 0)?))
}

/// Returns the text of a value that is given as data.
#[pyfunction]
pub(crate) fn value_text(data: &Bound<'_, PyAny>) -> PyResult<String> {
    Ok(text_of_value(&read(data, 0)?))
}

/// Deepest nesting of data.
const NESTING: usize = 64;

/// Reads data of Python. A text of the class `ninebit.Code` is left as it is.
fn read(data: &Bound<'_, PyAny>, depth: usize) -> PyResult<Data> {
    if depth > NESTING {
        return Err(PyTypeError::new_err("lists and dictionaries are nested too deeply"));
    }
    let items =
        |items: Vec<Bound<'_, PyAny>>| items.iter().map(|item| read(item, depth + 1)).collect::<PyResult<Vec<Data>>>();
    if let Ok(value) = data.cast::<PyBool>() {
        return Ok(Data::Bool(value.is_true()));
    }
    if data.cast::<PyInt>().is_ok() {
        return Ok(Data::Whole(data.extract()?));
    }
    if data.cast::<PyFloat>().is_ok() {
        return Ok(Data::Number(data.extract()?));
    }
    if let Ok(text) = data.cast::<PyString>() {
        let text = text.to_string();
        return Ok(if data.get_type().name()? == "Code" { Data::Code(text) } else { Data::Text(text) });
    }
    if let Ok(list) = data.cast::<PyList>() {
        return Ok(Data::List(items(list.iter().collect())?));
    }
    if let Ok(tuple) = data.cast::<PyTuple>() {
        return Ok(Data::Tuple(items(tuple.iter().collect())?));
    }
    if let Ok(dict) = data.cast::<PyDict>() {
        let entry = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
            Ok((key.extract::<String>()?, read(&value, depth + 1)?))
        };
        return Ok(Data::Map(dict.iter().map(entry).collect::<PyResult<_>>()?));
    }
    Err(PyTypeError::new_err(format!("a scene has no value of the type {}", data.get_type().name()?)))
}
