//! Units of the chip as functions on arrays.

use ninebit::state::{Named, Policies, Profile};
use ninebit_vectors::column::{Column, Kind};
use ninebit_vectors::unit::{Conditions, Unit as ChipUnit};
use ninebit_vectors::units::all;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::fail::{Failure, detached, exception};

/// Returns the names of all units.
#[pyfunction]
pub(crate) fn unit_names() -> Vec<&'static str> {
    all().iter().map(|unit| unit.name()).collect()
}

/// Returns the unit of a name.
#[pyfunction]
pub(crate) fn unit(py: Python<'_>, name: &str) -> PyResult<Unit> {
    match all().into_iter().find(|unit| unit.name() == name) {
        Some(unit) => Ok(Unit { unit }),
        None => {
            Err(exception(py, Failure::argument(format!("there is no unit `{name}`"), "`ninebit.units` lists them")))
        }
    }
}

/// A column: its name, the names of its numbers if it has some, its least and greatest number, and its default.
type Described = (String, Option<Vec<&'static str>>, i64, i64, Option<i64>);

fn described(column: &Column) -> Described {
    let names = if let Kind::Name(names) = column.kind { Some(names.to_vec()) } else { None };
    let (least, greatest) = column.kind.range();
    (column.name.clone(), names, least, greatest, column.default())
}

/// A unit of the chip.
#[pyclass(frozen)]
pub(crate) struct Unit {
    unit: &'static dyn ChipUnit,
}

#[pymethods]
impl Unit {
    /// Its name.
    #[getter]
    fn name(&self) -> &'static str {
        self.unit.name()
    }

    /// What it does.
    #[getter]
    fn about(&self) -> &'static str {
        self.unit.about()
    }

    /// Ids of its rules.
    #[getter]
    fn rules(&self) -> Vec<&'static str> {
        self.unit.rules().to_vec()
    }

    /// Its input columns.
    fn inputs(&self) -> Vec<Described> {
        self.unit.inputs().iter().map(described).collect()
    }

    /// Its result columns.
    fn results(&self) -> Vec<Described> {
        self.unit.results().iter().map(described).collect()
    }

    /// Evaluates rows: one array of int64 for each input column, all of one length. Returns one for each result column.
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        columns: Vec<PyReadonlyArray1<'py, i64>>,
        profile: &str,
        policies: Vec<String>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let conditions = conditions(profile, &policies).map_err(|failure| exception(py, failure))?;
        if !self.unit.profiles().contains(&conditions.profile) {
            let message = format!("`{}` is no unit of {}", self.unit.name(), conditions.profile.name());
            return Err(exception(py, Failure::argument(message, "choose the other chip")));
        }
        let (inputs, results) = (self.unit.inputs(), self.unit.results());
        let columns: Vec<Vec<i64>> = columns.iter().map(|column| column.as_array().to_vec()).collect();
        let rows = columns.first().map_or(0, Vec::len);
        let outputs = detached(py, || {
            let mut outputs = vec![vec![0; rows]; results.len()];
            let (mut row, mut out) = (vec![0; inputs.len()], vec![0; results.len()]);
            for n in 0..rows {
                for (k, (value, column)) in row.iter_mut().zip(&columns).enumerate() {
                    *value = column[n];
                    if !inputs[k].kind.holds(*value) {
                        let (least, greatest) = inputs[k].kind.range();
                        let message = format!("`{}` cannot be {value} in row {n}", inputs[k].name);
                        return Err(Failure::argument(message, format!("pass {least} to {greatest}")));
                    }
                }
                if !self.unit.accepts(&row, conditions.profile) {
                    let message = format!("the inputs of row {n} do not go together on this chip");
                    return Err(Failure::argument(message, "`ninebit op unit` says which values do"));
                }
                self.unit.evaluate(&row, &conditions, &mut out);
                outputs.iter_mut().zip(&out).for_each(|(column, value)| column[n] = *value);
            }
            Ok(outputs)
        })?;
        let dict = PyDict::new(py);
        for (column, values) in results.iter().zip(outputs) {
            dict.set_item(&column.name, PyArray1::from_vec(py, values))?;
        }
        Ok(dict)
    }
}

/// Returns the chip and the policies of texts.
pub(crate) fn conditions(profile: &str, policies: &[String]) -> Result<Conditions, Failure> {
    let found = Profile::ALL.iter().zip(Profile::NAMES).find(|(_, name)| name.eq_ignore_ascii_case(profile));
    let Some((profile, _)) = found else {
        return Err(Failure::argument(format!("there is no chip `{profile}`"), "write \"nv10\" or \"nv2a\""));
    };
    Ok(Conditions { profile: *profile, policies: parsed(policies)? })
}

/// Returns the policies of texts `RULE=VALUE`.
pub(crate) fn parsed(policies: &[String]) -> Result<Policies, Failure> {
    let mut all = Policies::DEFAULT;
    for policy in policies {
        all.set(policy).map_err(|error| {
            Failure::argument(error.to_string(), "`ninebit.policies()` lists the rules and their values")
        })?;
    }
    Ok(all)
}
