//! How many runs fit into memory side by side.

use stribeck_scene::geometry::Geometry;
use stribeck_scene::scene::Scene;

/// Of a model [GB]: 100 000 elements with the factors of their preload, or the modes of as many.
const MODEL_GB: f64 = 0.3;

/// Channels as long as the record that its numbers take at once: time, cage and sensors, these filtered too, and the transforms of
/// one. Rollers are read a few at a time.
const CHANNELS: f64 = 40.0;

/// What the run of a scene takes [GB], while it runs or when its numbers are made.
pub(super) fn need_gb(scene: &Scene) -> f64 {
    let g = Geometry::of(scene);
    MODEL_GB + 8e-9 * CHANNELS * g.duration / g.interval
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
    fn example_long_records_take_more() {
        let mut scene = Scene::default();
        let short = need_gb(&scene);
        assert!((MODEL_GB..1.1 * MODEL_GB).contains(&short), "{short}");
        // A million samples.
        scene.solver.duration_ms = 1e4;
        let long = need_gb(&scene);
        assert!((0.5..0.8).contains(&long), "{long}");
        assert!(free_gb().is_none_or(|free| free > 0.0));
    }
}
