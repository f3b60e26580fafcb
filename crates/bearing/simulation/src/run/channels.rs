//! **Recorded channels and their order.** The names are a contract with reports and readers; no other file
//! knows them.
//!
//! A model fills a [`Sample`]; [`Channels`] turns it into a row of `trace.npy`. Adding a channel that follows
//! from a sample is one line in `Channels::visit`; one that a model must provide is a field of [`Sample`]
//! besides.

use std::fmt::Arguments;

use stribeck_scene::resolved::ResolvedScene;
use stribeck_theory::duty::Duty;

/// The state of a bearing at the end of a sampling interval. Forces are means over the interval.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sample {
    /// Time of the positions [s].
    pub time: f64,
    /// Sensors, in the order of the scene.
    pub sensors: Vec<SensorSample>,
    /// Rolling elements, in the order of their numbers; missing ones have no entry.
    pub rollers: Vec<RollerSample>,
    /// The cage, if there is one.
    pub cage: Option<CageSample>,
    /// Force of the housing on the outer ring [N], where the ring sits in a seat.
    pub seat: Option<[f64; 2]>,
}

/// Readings of a sensor.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SensorSample {
    /// Acceleration [m/s²], mean over the interval: the change of velocity over its length.
    pub mean: [f64; 2],
    /// Acceleration [m/s²] in the last step alone.
    pub instant: [f64; 2],
}

/// A rolling element: its position, and the forces on it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RollerSample {
    /// Centre [m].
    pub centre: [f64; 2],
    /// Angle by which it has turned since the start [rad], counter-clockwise positive.
    pub spin: f64,
    /// Force of the outer raceway on it [N], by contact and oil.
    pub outer: [f64; 2],
    /// Force of the inner raceway on it [N], by contact and oil.
    pub inner: [f64; 2],
    /// Force of the cage on it [N], if there is a cage.
    pub cage: Option<[f64; 2]>,
    /// Thickness of the oil on the outer and on the inner raceway [m], if there is oil.
    pub films: Option<[f64; 2]>,
}

/// Where the cage is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CageSample {
    /// Centre of mass [m].
    pub centre: [f64; 2],
    /// Angle by which it has turned since the start [rad], counter-clockwise positive.
    pub angle: f64,
}

impl Sample {
    /// A sample of zeros with the parts that the scene has.
    pub fn of(scene: &ResolvedScene) -> Self {
        let roller = RollerSample {
            cage: scene.written.cage.as_ref().map(|_| [0.0; 2]),
            films: scene.written.film.as_ref().map(|_| [0.0; 2]),
            ..RollerSample::default()
        };
        Self {
            time: 0.0,
            sensors: vec![SensorSample::default(); scene.written.output.sensors.len()],
            rollers: vec![roller; scene.written.rollers_in_place().count()],
            cage: scene.written.cage.as_ref().map(|_| CageSample::default()),
            seat: scene.written.housing.has_seat().then_some([0.0; 2]),
        }
    }
}

/// Names of the columns of a trace, whatever model made it.
pub fn names(scene: &ResolvedScene) -> Vec<String> {
    let mut names = Vec::new();
    Channels::of(scene).visit(&Sample::of(scene), &mut |name, _| names.push(name.to_string()));
    names
}

/// The channels of a scene.
#[derive(Debug, Clone)]
pub struct Channels {
    sensors: Vec<String>,
    /// Numbers of the rolling elements, from 1.
    rollers: Vec<usize>,
    shaft: ShaftChannels,
}

/// Channels of a duty that changes: the angle of the shaft, that of an outer ring that turns, and the load.
#[derive(Debug, Clone)]
struct ShaftChannels {
    /// `None` where nothing changes.
    duty: Option<Duty>,
    outer: bool,
    load: bool,
}

impl Channels {
    /// Of a scene.
    pub fn of(scene: &ResolvedScene) -> Self {
        let o = &scene.written.operation;
        Self {
            sensors: scene.written.output.sensors.iter().map(|sensor| sensor.name.clone()).collect(),
            rollers: scene.written.rollers_in_place().collect(),
            shaft: ShaftChannels {
                duty: scene.varying_duty().cloned(),
                outer: o.varies() && o.outer_turns(),
                load: o.load_varies(),
            },
        }
    }

    /// The row of a sample. `row` keeps its memory from sample to sample.
    pub fn write(&self, sample: &Sample, row: &mut Vec<f64>) {
        row.clear();
        self.visit(sample, &mut |_, value| row.push(value));
    }

    /// Every channel in its order, with its value in a sample. Names are formatted only where they are used.
    fn visit(&self, sample: &Sample, channel: &mut impl FnMut(Arguments<'_>, f64)) {
        channel(format_args!("time_s"), sample.time);
        for (name, sensor) in self.sensors.iter().zip(&sample.sensors) {
            channel(format_args!("sensor.{name}.ax_m_s2"), sensor.mean[0]);
            channel(format_args!("sensor.{name}.ay_m_s2"), sensor.mean[1]);
            channel(format_args!("sensor.{name}.ax_instant_m_s2"), sensor.instant[0]);
            channel(format_args!("sensor.{name}.ay_instant_m_s2"), sensor.instant[1]);
        }
        for (number, roller) in self.rollers.iter().zip(&sample.rollers) {
            channel(format_args!("roller.{number}.x_m"), roller.centre[0]);
            channel(format_args!("roller.{number}.y_m"), roller.centre[1]);
            channel(format_args!("roller.{number}.spin_rad"), roller.spin);
            channel(format_args!("roller.{number}.outer_fx_n"), roller.outer[0]);
            channel(format_args!("roller.{number}.outer_fy_n"), roller.outer[1]);
            channel(format_args!("roller.{number}.inner_fx_n"), roller.inner[0]);
            channel(format_args!("roller.{number}.inner_fy_n"), roller.inner[1]);
            if let Some([x, y]) = roller.cage {
                channel(format_args!("roller.{number}.cage_fx_n"), x);
                channel(format_args!("roller.{number}.cage_fy_n"), y);
            }
            if let Some([outer, inner]) = roller.films {
                channel(format_args!("roller.{number}.outer_film_m"), outer);
                channel(format_args!("roller.{number}.inner_film_m"), inner);
            }
        }
        if let Some(CageSample { centre: [x, y], angle }) = sample.cage {
            channel(format_args!("cage.x_m"), x);
            channel(format_args!("cage.y_m"), y);
            channel(format_args!("cage.angle_rad"), angle);
        }
        if let Some([x, y]) = sample.seat {
            channel(format_args!("seat.fx_n"), x);
            channel(format_args!("seat.fy_n"), y);
        }
        self.shaft.visit(sample.time, channel);
    }
}

impl ShaftChannels {
    /// Angles by which shaft and outer ring have turned since the start [rad], counter-clockwise positive,
    /// and the load [N].
    fn visit(&self, time: f64, channel: &mut impl FnMut(Arguments<'_>, f64)) {
        let Some(duty) = &self.duty else { return };
        channel(format_args!("shaft.angle_rad"), duty.shaft_rad(time));
        if self.outer {
            channel(format_args!("outer_ring.angle_rad"), duty.outer_rad(time));
        }
        if self.load {
            channel(format_args!("adapter.load_n"), duty.load_n(time));
        }
    }
}
