//! Diagnosis of arrays.

use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use stribeck_diagnosis::{Analysis, Machine};
use stribeck_formats::Channel;
use stribeck_scene::catalogue;

fn refused(why: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(why.to_string())
}

/// Findings of a record, as JSON in the form of `findings.json`.
#[pyfunction]
#[pyo3(signature = (signal, rate_hz, bearing, speed_rpm, unit, name))]
pub(crate) fn analyse(
    py: Python<'_>,
    signal: PyReadonlyArray1<'_, f64>,
    rate_hz: f64,
    bearing: Option<String>,
    speed_rpm: Option<f64>,
    unit: Option<String>,
    name: String,
) -> PyResult<String> {
    let samples = signal.as_slice()?.to_vec();
    py.detach(|| {
        let bearing = bearing.map(|text| catalogue::parse(&text)).transpose().map_err(refused)?;
        let channel = Channel::held(name, samples).in_unit(unit);
        let machine = Machine { speed_rpm, bearing, ..Machine::default() };
        let analysis = Analysis::of(&channel, rate_hz, &machine).map_err(refused)?;
        serde_json::to_string(&analysis.findings).map_err(refused)
    })
}

/// Frequencies of a bearing's defects over that of the shaft: outer and inner raceway, element, cage.
#[pyfunction]
pub(crate) fn defect_orders(bearing: &str) -> PyResult<(f64, f64, f64, f64)> {
    let orders = catalogue::parse(bearing).and_then(|b| b.orders()).map_err(refused)?;
    Ok((orders.bpfo, orders.bpfi, orders.bsf, orders.ftf))
}
