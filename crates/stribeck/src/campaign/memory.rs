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

/// What programs may still take, and this one where it has a limit of its own [GB]; `None` where the system does not tell.
pub(super) fn free_gb() -> Option<f64> {
    let about = std::fs::read_to_string("/proc/meminfo").ok();
    let available = about.and_then(|about| {
        let line = about.lines().find(|line| line.starts_with("MemAvailable:"))?;
        let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
        Some(1.024e-6 * kib)
    });
    // A container's group of processes.
    let bytes = |name: &str| -> Option<f64> {
        std::fs::read_to_string(format!("/sys/fs/cgroup/memory.{name}")).ok()?.trim().parse().ok()
    };
    let of_group = bytes("max").zip(bytes("current")).map(|(most, now)| 1e-9 * (most - now));
    available.into_iter().chain(of_group).reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn example_long_records_take_gigabytes() {
        let mut scene = Scene::default();
        let short = need_gb(&scene);
        assert!((MODEL_GB..1.1 * MODEL_GB).contains(&short), "{short}");
        // A million samples of some 290 channels.
        scene.solver.duration_ms = 1e4;
        let long = need_gb(&scene);
        assert!((3.0..5.0).contains(&long), "{long}");
        assert!(free_gb().is_none_or(|free| free > 0.0));
    }
}
