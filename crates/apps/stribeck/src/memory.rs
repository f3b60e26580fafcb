//! How many runs fit into memory side by side.

use stribeck_scene::scene::Scene;

/// Of a model [GB]: 100 000 elements with the factors of their preload, or the modes of as many.
const MODEL_GB: f64 = 0.3;

/// Channels as long as the record that its numbers take at once: time and cage, the transforms of one sensor,
/// and a few rollers …
const CHANNELS: f64 = 24.0;
/// … of each sensor, filtered too …
const OF_SENSOR: f64 = 4.0;
/// … and of each roller in oil, how thick films are that float.
const OF_FLOATING: f64 = 2.0;

/// Memory of a scene's run [GB], the larger of simulation and analysis.
pub(crate) fn need_gb(scene: &Scene) -> f64 {
    let g = scene.resolve();
    let floating = if scene.film.is_some() { OF_FLOATING * g.rollers as f64 } else { 0.0 };
    let channels = CHANNELS + OF_SENSOR * scene.output.sensors.len() as f64 + floating;
    MODEL_GB + 8e-9 * channels * g.duration / g.interval
}

/// Available memory [GB], capped by this process's limit; `None` where the system does not report it.
pub(crate) fn free_gb() -> Option<f64> {
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

/// Memory of the machine [bytes], capped by the limits of this process and of its group; `None` where the system
/// does not report it.
pub(crate) fn whole_bytes() -> Option<u64> {
    let about = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = about.lines().find(|line| line.starts_with("MemTotal:"))?;
    let all = line.split_whitespace().nth(1)?.parse::<u64>().ok()? * 1024;
    let of_group = std::fs::read_to_string("/sys/fs/cgroup/memory.max").ok();
    let of_group = of_group.and_then(|text| text.trim().parse().ok());
    // `ulimit -v`.
    let limits = std::fs::read_to_string("/proc/self/limits").unwrap_or_default();
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"));
    let of_process = line.and_then(|line| line.split_whitespace().next()?.parse().ok());
    [Some(all), of_group, of_process].into_iter().flatten().min()
}

#[cfg(test)]
mod tests {
    use stribeck_scene::scene::FilmScene;

    use super::*;

    #[test]
    fn behaves_long_records_take_more() {
        let mut scene = Scene { film: None, ..Scene::default() };
        let short = need_gb(&scene);
        assert!((MODEL_GB..1.1 * MODEL_GB).contains(&short), "{short}");
        // A million samples.
        scene.solver.duration_ms = 1e4;
        let long = need_gb(&scene);
        assert!((0.5..0.8).contains(&long), "{long}");
        let oiled = need_gb(&Scene { film: Some(FilmScene::default()), ..scene });
        assert!((0.9..1.2).contains(&oiled), "{oiled}");
        assert!(free_gb().is_none_or(|free| free > 0.0));
    }
}
