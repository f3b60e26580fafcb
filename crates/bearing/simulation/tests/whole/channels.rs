//! Channels of a trace: each value of a sample stands under its name, in the unit that the name says.

use stribeck_scene::scene::Scene;
use stribeck_simulation::run::channels::{CageSample, Channels, RollerSample, Sample, SensorSample, names};

/// A sample in which every number differs.
fn sample(scene: &stribeck_scene::resolved::ResolvedScene) -> Sample {
    let mut next = 0.0;
    let mut number = || {
        next += 1.0;
        next
    };
    let mut two = || [number(), number()];
    let mut sample = Sample::of(scene);
    for sensor in &mut sample.sensors {
        *sensor = SensorSample { mean: two(), instant: two() };
    }
    for roller in &mut sample.rollers {
        *roller = RollerSample {
            centre: two(),
            spin: two()[0],
            outer: two(),
            inner: two(),
            cage: roller.cage.map(|_| two()),
            films: roller.films.map(|_| two()),
        };
    }
    sample.cage = sample.cage.map(|_| CageSample { centre: two(), angle: two()[0] });
    sample.seat = sample.seat.map(|_| two());
    sample.time = two()[0];
    sample
}

/// SI units throughout, as the ends of the names say: nothing is scaled on the way into a row.
#[test]
fn behaves_a_row_holds_each_value_under_its_name() {
    let scene = Scene::default().resolve();
    let sample = sample(&scene);
    let names = names(&scene);
    let mut row = Vec::new();
    Channels::of(&scene).write(&sample, &mut row);
    assert_eq!(names.len(), row.len());
    let of = |name: &str| row[names.iter().position(|other| other == name).expect(name)];
    assert_eq!(of("time_s"), sample.time);
    for (sensor, written) in sample.sensors.iter().zip(&scene.written.output.sensors) {
        let at = |end: &str| of(&format!("sensor.{}.{end}_m_s2", written.name));
        assert_eq!([at("ax"), at("ay")], sensor.mean);
        assert_eq!([at("ax_instant"), at("ay_instant")], sensor.instant);
    }
    for (n, roller) in (1..).zip(&sample.rollers) {
        let at = |end: &str| of(&format!("roller.{n}.{end}"));
        assert_eq!([at("x_m"), at("y_m")], roller.centre);
        assert_eq!(at("spin_rad"), roller.spin);
        assert_eq!([at("outer_fx_n"), at("outer_fy_n")], roller.outer);
        assert_eq!([at("inner_fx_n"), at("inner_fy_n")], roller.inner);
        assert_eq!(Some([at("cage_fx_n"), at("cage_fy_n")]), roller.cage);
        assert_eq!(Some([at("outer_film_m"), at("inner_film_m")]), roller.films);
    }
    let cage = sample.cage.expect("a cage");
    assert_eq!(([of("cage.x_m"), of("cage.y_m")], of("cage.angle_rad")), (cage.centre, cage.angle));
    assert_eq!(Some([of("seat.fx_n"), of("seat.fy_n")]), sample.seat);
}
