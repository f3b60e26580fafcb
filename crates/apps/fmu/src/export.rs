//! What an importer calls: the functions of FMI 3.0, by fmi-export.
#![allow(unsafe_code, reason = "the names of FMI are unsafe attributes; nothing else here is")]
#![allow(missing_docs, unreachable_pub, reason = "of the functions that the macro makes")]

use fmi::fmi3::{Fmi3Error, binding::fmi3ValueReference};
use fmi::schema::fmi3::{ModelStructure, ModelVariables};
use fmi_export::fmi3::{
    CSDoStepResult, Context, DefaultLoggingCategory, Model, ModelGetSet, ModelGetSetStates, UserModel,
};
use stribeck_reduced::shaft::{
    ShaftPoint,
    variables::{INPUTS, OUTPUTS, TOKEN},
};

use crate::{error::Error, session::Session};

/// An instance of the FMU.
#[derive(Debug, Default)]
pub struct BearingFmu {
    /// As [`INPUTS`] lists them.
    inputs: [f64; INPUTS.len()],
    session: Option<Session>,
}

impl BearingFmu {
    fn shaft(&self) -> ShaftPoint {
        let [x, y, vx, vy] = self.inputs;
        ShaftPoint { displacement: [x, y], velocity: [vx, vy] }
    }

    fn start(&mut self, context: &dyn Context<Self>) -> Result<(), Error> {
        let mut session = Session::open(context.resource_path())?;
        session.start(self.shaft())?;
        self.session = Some(session);
        Ok(())
    }
}

impl Model for BearingFmu {
    const MODEL_NAME: &'static str = "bearing";
    const INSTANTIATION_TOKEN: &'static str = TOKEN;
    const MAX_EVENT_INDICATORS: usize = 0;
    const SUPPORTS_MODEL_EXCHANGE: bool = false;
    const SUPPORTS_CO_SIMULATION: bool = true;
    const SUPPORTS_SCHEDULED_EXECUTION: bool = false;

    /// The description is that of the archive, which knows the scene.
    fn build_metadata(
        _: &mut ModelVariables,
        _: &mut ModelStructure,
        _: fmi3ValueReference,
        _: Option<&str>,
    ) -> u32 {
        (INPUTS.len() + OUTPUTS.len()) as u32
    }

    fn set_start_values(&mut self) {
        *self = Self::default();
    }
}

/// Value references count from 0 here: fmi-export takes the one of time away.
impl<M: Model> ModelGetSet<M> for BearingFmu
where
    M: UserModel,
{
    const FIELD_COUNT: usize = INPUTS.len() + OUTPUTS.len();

    fn get_float64(
        &self,
        reference: fmi3ValueReference,
        values: &mut [f64],
        _: &dyn Context<M>,
    ) -> Result<usize, Fmi3Error> {
        let n = reference as usize;
        let outputs = self.session.as_ref().map_or([0.0; OUTPUTS.len()], |s| s.outputs().values());
        let from = self.inputs.get(n).or_else(|| outputs.get(n.checked_sub(INPUTS.len())?));
        let (Some(from), Some(to)) = (from, values.first_mut()) else { return Err(Fmi3Error::Error) };
        *to = *from;
        Ok(1)
    }

    fn set_float64(
        &mut self,
        reference: fmi3ValueReference,
        values: &[f64],
        _: &dyn Context<M>,
    ) -> Result<usize, Fmi3Error> {
        let to = self.inputs.get_mut(reference as usize);
        let (Some(from), Some(to)) = (values.first(), to) else { return Err(Fmi3Error::Error) };
        *to = *from;
        Ok(1)
    }
}

/// It has no states that an importer integrates.
impl ModelGetSetStates for BearingFmu {
    const NUM_STATES: usize = 0;

    fn get_continuous_states(&self, _: &mut [f64]) -> Result<(), Fmi3Error> {
        Ok(())
    }

    fn set_continuous_states(&mut self, _: &[f64]) -> Result<(), Fmi3Error> {
        Ok(())
    }

    fn get_continuous_state_derivatives(&mut self, _: &mut [f64]) -> Result<(), Fmi3Error> {
        Ok(())
    }
}

impl UserModel for BearingFmu {
    type LoggingCategory = DefaultLoggingCategory;

    fn configurate(&mut self, context: &dyn Context<Self>) -> Result<(), Fmi3Error> {
        self.start(context).map_err(|error| {
            context.log(Fmi3Error::Error.into(), DefaultLoggingCategory::LogAll, format_args!("{error}"));
            Fmi3Error::Error
        })
    }

    fn do_step(
        &mut self,
        context: &mut dyn Context<Self>,
        from: f64,
        length: f64,
        _: bool,
    ) -> Result<CSDoStepResult, Fmi3Error> {
        let shaft = self.shaft();
        let done = self.session.as_mut().ok_or(Error::NotStarted).and_then(|s| s.advance(length, shaft));
        if let Err(error) = done {
            // Whoever has not asked for a log should know why it ends nevertheless.
            let on = context.logging_on(DefaultLoggingCategory::LogAll);
            context.set_logging(DefaultLoggingCategory::LogAll, true);
            context.log(Fmi3Error::Error.into(), DefaultLoggingCategory::LogAll, format_args!("{error}"));
            context.set_logging(DefaultLoggingCategory::LogAll, on);
            return Err(Fmi3Error::Error);
        }
        context.set_time(from + length);
        Ok(CSDoStepResult::completed(from + length))
    }
}

fmi_export::export_fmu!(BearingFmu);
