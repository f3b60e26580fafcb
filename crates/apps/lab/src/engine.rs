//! A bearing that follows its handles.

use stribeck_reduced::{
    bearing::Bearing,
    dense,
    motion::{BearingInMotion, Energies, Saved},
};

use crate::{
    content::Content,
    error::Error,
    handles::{self, HANDLES, Handles, at},
    limits::{Limits, Stop},
    parameters::{course, limits, modal},
    readings::{self, PER_SAMPLE},
};

/// A bearing in motion, its handles and what the page reads of it.
#[derive(Debug)]
pub struct Engine {
    content: Content,
    /// Handles as they are, and as they are asked for.
    now: Handles,
    asked: Handles,
    motion: BearingInMotion,
    steps_per_sample: usize,
    /// Mean displacement of the outer raceway by a unit of each mode, x and y [1/√kg].
    mean: [Vec<f64>; 2],
    energies: Energies,
    /// Energy of all kinds less work since the last change [J], and the most that rings and contacts have
    /// stored [J].
    first: Option<f64>,
    most_stored: f64,
    /// Where the run stops, with the handles as they are.
    limits: Limits,
    samples: Vec<f64>,
    picture: Vec<f64>,
    displacement: Vec<f64>,
}

impl Engine {
    /// The bearing of the scene at its start.
    pub fn new(content: Content) -> Result<Self, Error> {
        let dt = content.interval / content.steps_per_sample as f64;
        let handles = content.handles;
        let bearing = Bearing::new(modal(&content, &handles, None)?, dt)?;
        // Sensors change no motion; the first sample of one begins with its velocity at the start.
        let start = Saved::first(&bearing, content.start.state.clone());
        let mean = mean_shape(&bearing);
        Ok(Self {
            steps_per_sample: content.steps_per_sample,
            now: handles,
            asked: handles,
            motion: BearingInMotion::new(bearing, start),
            mean,
            energies: Energies::default(),
            first: None,
            most_stored: 0.0,
            limits: content.limits.clone(),
            samples: Vec::new(),
            picture: Vec::new(),
            displacement: Vec::new(),
            content,
        })
    }

    /// Asks for a value of a handle; [`apply`](Self::apply) turns all that were asked for.
    pub fn ask(&mut self, handle: usize, value: f64) -> Result<(), Error> {
        handles::check(handle, value)?;
        self.asked[handle] = value;
        Ok(())
    }

    /// Applies the requested handles: the bearing runs on, or restarts where one of them needs it. Returns
    /// whether it restarts.
    pub fn apply(&mut self) -> Result<bool, Error> {
        let anew = (0..HANDLES.len()).any(|n| !HANDLES[n].live && self.asked[n] != self.now[n]);
        let done = if anew { self.restart() } else { self.go_on() };
        match done {
            Ok(()) => {
                self.now = self.asked;
                Ok(anew)
            }
            Err(error) => {
                self.asked = self.now;
                Err(error)
            }
        }
    }

    /// Restarts with the requested handles.
    pub fn restart(&mut self) -> Result<(), Error> {
        if self.asked == self.content.handles {
            *self = Self::new(self.content.clone())?;
            return Ok(());
        }
        let constant = course(&self.content, [self.asked[at::LOAD], self.asked[at::SPEED]], &self.asked, 0.0);
        let (bearing, steps) = self.bearing(Some(constant))?;
        let state = bearing.at_start(&dense::solve)?;
        let start = Saved::first(&bearing, state);
        self.take(bearing, steps, start);
        self.now = self.asked;
        Ok(())
    }

    /// Goes on from a state of a run of the scene.
    pub fn go_on_from(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let state = postcard::from_bytes(bytes)?;
        let saved = Saved::first(self.motion.bearing(), state);
        if !saved.fits(self.motion.bearing()) {
            return Err(Error::Content(postcard::Error::DeserializeBadEncoding));
        }
        let bearing = self.motion.bearing().clone();
        self.take(bearing, self.steps_per_sample, saved);
        Ok(())
    }

    /// Goes on with the handles that were asked for.
    fn go_on(&mut self) -> Result<(), Error> {
        let only_watched = (0..HANDLES.len()).all(|n| n == at::ROLLER || self.asked[n] == self.now[n]);
        if only_watched {
            return Ok(());
        }
        let time = self.motion.time();
        let duty = &self.motion_duty();
        let from = duty.unwrap_or([self.now[at::LOAD], self.now[at::SPEED]]);
        let duty = course(&self.content, from, &self.asked, time);
        let (bearing, steps) = self.bearing(Some(duty))?;
        let mut saved = self.motion.saved();
        saved.state.steps = (time / bearing.time_step).round() as u64;
        let start = Saved::first(&bearing, saved.state);
        if !start.fits(&bearing) {
            // Whether there are films depends on the speed: they start from their equilibrium.
            let state = bearing.at_start(&dense::solve)?;
            let start = Saved::first(&bearing, state);
            self.take(bearing, steps, start);
            return Ok(());
        }
        self.take(bearing, steps, start);
        Ok(())
    }

    /// Load and speed at present, where they follow a course.
    fn motion_duty(&self) -> Option<[f64; 2]> {
        let time = self.motion.time();
        self.motion.bearing().duty().map(|duty| [duty.load_n(time), duty.speed_rpm(time)])
    }

    /// The bearing of the handles that were asked for, and the steps of a sample: no step is longer than the
    /// critical one.
    fn bearing(&self, duty: Option<stribeck_theory::duty::Duty>) -> Result<(Bearing, usize), Error> {
        let modal = modal(&self.content, &self.asked, duty)?;
        let interval = self.content.interval;
        let in_steps = |longest: f64| ((interval / longest - 1e-9).ceil() as usize).max(2);
        let mut steps = self.content.steps_per_sample;
        if self.asked[at::STEP] != self.content.handles[at::STEP] {
            steps = in_steps(1e-6 * self.asked[at::STEP]);
        }
        let bearing = Bearing::new(modal.clone(), interval / steps as f64)?;
        let critical = bearing.critical_time_step();
        if bearing.time_step <= critical || self.asked[at::STEP] != self.content.handles[at::STEP] {
            return Ok((bearing, steps));
        }
        let steps = in_steps(critical);
        Ok((Bearing::new(modal, interval / steps as f64)?, steps))
    }

    fn take(&mut self, bearing: Bearing, steps: usize, start: Saved) {
        self.mean = mean_shape(&bearing);
        self.motion = BearingInMotion::new(bearing, start);
        self.steps_per_sample = steps;
        self.limits = limits(&self.content, &self.asked);
        (self.first, self.most_stored, self.energies) = (None, 0.0, Energies::default());
    }

    /// Steps until there are `samples` samples, which are then in [`samples`](Self::samples). Where the cage
    /// has left its place between the raceways, there are fewer, the run restarts after them, and the reason
    /// is returned: a run of the program ends there.
    pub fn run(&mut self, samples: usize) -> Result<Option<String>, Error> {
        self.samples.clear();
        self.samples.reserve(samples * PER_SAMPLE);
        let watched = self.now[at::ROLLER] as usize;
        for _ in 0..samples {
            self.energies = self.motion.interval(self.steps_per_sample);
            readings::sample(&self.motion, watched, &self.mean, &mut self.samples);
            match self.stop() {
                None => {}
                Some(Stop::Diverged(why)) => return Err(Error::Diverged(why)),
                Some(Stop::CageLeft(why)) => {
                    let samples = std::mem::take(&mut self.samples);
                    self.restart()?;
                    self.samples = samples;
                    return Ok(Some(why));
                }
            }
        }
        Ok(None)
    }

    /// Energy that is stored and lost less the work that was put in, since the last change [J].
    fn imbalance(&self) -> f64 {
        balance(&self.energies) - self.first.unwrap_or(0.0)
    }

    fn stop(&mut self) -> Option<Stop> {
        let e = self.energies;
        self.first.get_or_insert(balance(&e));
        self.most_stored = self.most_stored.max(e.strain + e.contact);
        let off = [self.imbalance(), self.most_stored];
        self.limits.reason(&self.motion, &e, off)
    }

    /// Samples of the last run, in rows of [`PER_SAMPLE`].
    pub fn samples(&self) -> &[f64] {
        &self.samples
    }

    /// The bearing at present, as `readings.rs` says.
    pub fn picture(&mut self) -> &[f64] {
        let imbalance = self.imbalance();
        readings::picture(&self.motion, &self.energies, imbalance, &mut self.picture);
        &self.picture
    }

    /// Displacement of the vertices of the outer raceway, x and y of each [m].
    pub fn displacement(&mut self) -> &[f64] {
        readings::displacement(&self.motion, &mut self.displacement);
        &self.displacement
    }

    /// Vertices of the outer raceway (0), of the inner raceway (1) and of a roller (2) [m].
    pub fn outline(&self, which: usize) -> Vec<f64> {
        let outlines = modal(&self.content, &self.now, None).map(|modal| modal.parameters.outlines);
        let outlines = outlines.unwrap_or_else(|_| self.content.modal.parameters.outlines.clone());
        match which {
            0 => outlines.outer,
            1 => outlines.inner,
            _ => outlines.rims[0].clone(),
        }
        .concat()
    }

    /// Handles as they are.
    pub fn handles(&self) -> &Handles {
        &self.now
    }

    /// Angle of the vertex 0 of each roller at the start [rad].
    pub fn vertex_angles(&self) -> Vec<f64> {
        self.content.modal.parameters.rollers.iter().map(|roller| roller.vertex_angle).collect()
    }

    /// Forces of both raceways on all rollers, x and y of the outer one, then of the inner one [N]: what the
    /// check compares.
    pub fn forces(&self) -> Vec<f64> {
        self.motion.rollers().flat_map(|roller| [roller.outer, roller.inner].concat()).collect()
    }
}

fn balance(e: &Energies) -> f64 {
    e.kinetic + e.strain + e.contact + e.friction + e.damping + e.contact_damping + e.film
        - e.external
        - e.drive
}

/// Mean displacement of the outer raceway by a unit of each mode.
fn mean_shape(bearing: &Bearing) -> [Vec<f64>; 2] {
    let (r, shapes) = (bearing.reduction.padded, &bearing.reduction.shapes);
    let vertices = (shapes.len() / (2 * r)).max(1) as f64;
    let mean = |first: usize| {
        (0..r).map(|k| shapes.iter().skip(first + k).step_by(2 * r).sum::<f64>() / vertices).collect()
    };
    [mean(0), mean(r)]
}
