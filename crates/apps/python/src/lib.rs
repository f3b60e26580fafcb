//! The Python module `stribeck._stribeck`: thin functions that `python/stribeck/__init__.py` gives names,
//! defaults and help.
//!
//! It is a crate because Python loads it as a library of its own.

mod runs;
mod signals;

use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use stribeck_scene::scene_file::SceneError;
use stribeck_store::Error;

/// What went wrong, as the exception that a Python user would expect.
fn raise(error: &anyhow::Error) -> PyErr {
    let text = format!("{error:#}");
    let of_scene =
        error.chain().any(|cause| cause.is::<SceneError>() || cause.is::<stribeck_theory::Error>());
    match error.chain().find_map(|cause| cause.downcast_ref::<Error>()) {
        Some(Error::Io { .. }) => PyOSError::new_err(text),
        Some(_) => PyValueError::new_err(text),
        None if of_scene => PyValueError::new_err(text),
        None => PyRuntimeError::new_err(text),
    }
}

/// The native part of `stribeck`.
#[pymodule]
fn _stribeck(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_function(wrap_pyfunction!(runs::command, module)?)?;
    module.add_function(wrap_pyfunction!(runs::simulate, module)?)?;
    module.add_function(wrap_pyfunction!(runs::resume, module)?)?;
    module.add_function(wrap_pyfunction!(runs::scene, module)?)?;
    module.add_function(wrap_pyfunction!(runs::channels, module)?)?;
    module.add_function(wrap_pyfunction!(runs::summary, module)?)?;
    module.add_function(wrap_pyfunction!(runs::report, module)?)?;
    module.add_function(wrap_pyfunction!(signals::analyse, module)?)?;
    module.add_function(wrap_pyfunction!(signals::defect_orders, module)?)?;
    Ok(())
}
