//! The Python module `stribeck._stribeck`: thin functions that `python/stribeck/__init__.py` gives names, defaults and help.

mod runs;
mod signals;

use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use stribeck_scene::Error;
use stribeck_scene::scene_file::SceneError;

/// What went wrong, as the exception that a Python user would expect.
fn raise(error: &anyhow::Error) -> PyErr {
    let text = format!("{error:#}");
    let of_scene = error.chain().any(|cause| cause.is::<SceneError>());
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
    module.add_function(wrap_pyfunction!(signals::welch, module)?)?;
    module.add_function(wrap_pyfunction!(signals::notch, module)?)?;
    module.add_function(wrap_pyfunction!(signals::envelope_spectrum, module)?)?;
    module.add_function(wrap_pyfunction!(signals::fast_kurtogram, module)?)?;
    module.add_function(wrap_pyfunction!(signals::cepstral_prewhitening, module)?)?;
    Ok(())
}
