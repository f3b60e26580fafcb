//! How many runs fit into memory side by side.

use stribeck_bearing::recorder;
use stribeck_scene::geometry::Geometry;
use stribeck_scene::scene::Scene;

/// Of a model [GB]: 100 000 elements with the factors of their preload, or the modes of as many.
const MODEL_GB: f64 = 0.3;

/// Memory over the bytes of a record while its numbers are made: all channels at once, and what is derived from some.
const PER_RECORD: f64 = 1.5;

/// What the run of a scene takes [GB], while it runs or when its numbers are made.
pub(super) fn need_gb(scene: &Scene) -> f64 {
    let g = Geometry::of(scene);
    let record = 8.0 * recorder::names(scene).len() as f64 * g.duration / g.interval;
    MODEL_GB + PER_RECORD * 1e-9 * record
}

/// What programs may still take [GB]; `None` where the system has no `/proc`.
pub(super) fn free_gb() -> Option<f64> {
    let about = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = about.lines().find(|line| line.starts_with("MemAvailable:"))?;
    let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(1.024e-6 * kib)
}

/// How many of the runs fit side by side, at least one.
pub(super) fn fitting<'a>(scenes: impl Iterator<Item = &'a Scene>, limit_gb: f64) -> usize {
    let largest = scenes.map(need_gb).fold(MODEL_GB, f64::max);
    ((limit_gb / largest) as usize).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn example_long_records_go_one_at_a_time() {
        let mut scene = Scene::default();
        let short = need_gb(&scene);
        assert!((MODEL_GB..1.1 * MODEL_GB).contains(&short), "{short}");
        // A million samples of some 290 channels.
        scene.solver.duration_ms = 1e4;
        let long = need_gb(&scene);
        assert!((3.0..5.0).contains(&long), "{long}");
        assert_eq!(fitting([&scene].into_iter(), 16.0), (16.0 / long) as usize);
        assert_eq!(fitting([&scene].into_iter(), 1.0), 1);
        assert!(free_gb().is_none_or(|free| free > 0.0));
    }
}
