//! Errors as exceptions of the package.

use ninebit_files::catch_panic::{Panic, catch_panic};
use ninebit_scene::{Diagnostic, SceneError, Severity, Source};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// An error that is to become an exception.
pub(crate) enum Failure {
    /// A scene or a program is refused.
    Scene(Box<SceneError>),
    /// Something else, with its code and what to do.
    Plain(Option<&'static str>, String, String),
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Failure {
        Failure::Scene(Box::new(error))
    }
}

impl Failure {
    /// Returns the failure of an argument, which has no code.
    pub(crate) fn argument(message: impl Into<String>, help: impl Into<String>) -> Failure {
        Failure::Plain(None, message.into(), help.into())
    }
}

/// Runs `work` without the interpreter's lock. A panic becomes a failure.
pub(crate) fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> Result<T, Failure> + Send) -> PyResult<T> {
    let caught = |panic: Panic| Err(Failure::Plain(Some(Panic::CODE), panic.to_string(), Panic::HELP.to_owned()));
    py.detach(|| catch_panic(work).unwrap_or_else(caught)).map_err(|failure| exception(py, failure))
}

/// Returns the exception of the package that says an error.
pub(crate) fn exception(py: Python<'_>, failure: Failure) -> PyErr {
    let made = match failure {
        Failure::Scene(error) => scene_error(py, &error),
        Failure::Plain(code, message, help) => plain(py, code, &message, &help),
    };
    made.unwrap_or_else(|error| error)
}

fn plain(py: Python<'_>, code: Option<&str>, message: &str, help: &str) -> PyResult<PyErr> {
    let class = py.import("ninebit.errors")?.getattr("NinebitError")?;
    Ok(PyErr::from_value(class.call1((message, code, help))?))
}

fn scene_error(py: Python<'_>, error: &SceneError) -> PyResult<PyErr> {
    let findings: Vec<Bound<'_, PyDict>> =
        error.diagnostics.iter().map(|finding| described(py, finding, &error.source)).collect::<PyResult<_>>()?;
    let class = py.import("ninebit.errors")?.getattr("SceneError")?;
    Ok(PyErr::from_value(class.call1((error.render(false), findings, error.exit_code()))?))
}

/// Returns the fields of a finding.
pub(crate) fn described<'py>(py: Python<'py>, finding: &Diagnostic, scene: &Source) -> PyResult<Bound<'py, PyDict>> {
    let source = finding.file.as_ref().map_or(scene, |file| &file.source);
    let place = finding.span.as_ref().map(|span| source.position(span.start));
    let dict = PyDict::new(py);
    dict.set_item("code", finding.code)?;
    dict.set_item("severity", if finding.severity == Severity::Error { "error" } else { "warning" })?;
    dict.set_item("message", &finding.message)?;
    dict.set_item("file", &source.name)?;
    dict.set_item("line", place.map(|(line, _)| line))?;
    dict.set_item("column", place.map(|(_, column)| column))?;
    dict.set_item("label", &finding.label)?;
    dict.set_item("rule", finding.rule)?;
    dict.set_item("notes", &finding.notes)?;
    dict.set_item("help", &finding.help)?;
    Ok(dict)
}
