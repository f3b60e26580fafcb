//! `stribeck export`: the results of a run in the formats of other programs.

mod deck;
mod radioss;
mod sound;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use stribeck_analysis::stress::{Stress, elastic};
use stribeck_dsp::Sensor;
use stribeck_formats::{Channel, Recording, csv, mat5, npz, parquet, uff58, wav};
use stribeck_mesh::decks::Deck;
use stribeck_mesh::vtu::{self, Field};
use stribeck_mesh::{Body, Mesh};
use stribeck_scene::scene::ModelScene;
use stribeck_store::frames;
use stribeck_store::mesh_file::RunMesh;
use stribeck_store::run_dir::{Run, RunDir, write_atomic};

use crate::out::{caution, say};
use crate::place::{Place, shown};
use crate::shelf::existing;

/// Channel of the times of samples.
const TIME: &str = "time_s";

/// Flags of `export`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Folder of the run, or its name below runs/ [default: the newest run; of an ensemble name a start]; the
    /// file of a record, to be converted; with `--to radioss` also a scene file
    run: Option<PathBuf>,
    /// Format
    #[arg(long)]
    to: Format,
    /// Only channels whose name contains this, for example `sensor.`; may be repeated
    #[arg(long = "channel", value_name = "PART")]
    channels: Vec<String>,
    /// Records the accelerations through a sensor instead: any of "rate_hz=25600, resonance_hz=30000,
    /// quality=30, noise_density=0.002, range=500, bits=24, seed=1", in m/s²
    #[arg(long)]
    sensor: Option<String>,
    /// Writes what the sensor of a machine records instead, in m/s²: that of the scene, or the one in FILE, which
    /// `stribeck machine` writes
    #[arg(long, value_name = "FILE", num_args = 0..=1, conflicts_with_all = ["sensor", "channels"])]
    machine: Option<Option<PathBuf>>,
    /// Samples a second of a sound [Hz]: 44100 or 48000 [default: 48000]
    #[arg(long, value_name = "HZ", value_parser = sound::rate)]
    rate_hz: Option<u32>,
    /// Plays a sound N times slower, and as much lower [default: 1]
    #[arg(long, value_name = "N", value_parser = sound::slow)]
    slow: Option<f64>,
    /// Overrides a field of the scene file of `--to radioss`, for example --set contact.surface=facet; may be
    /// repeated
    #[arg(long, value_name = "FIELD=VALUE")]
    set: Vec<String>,
    /// File to write, for pvd a folder [default: in the run's folder: trace.FORMAT, sound.wav, paraview,
    /// mesh.FORMAT or radioss_0000.rad; of a scene file NAME_0000.rad, of a record NAME.FORMAT]
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Formats that are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// Text table
    Csv,
    /// NumPy archive
    Npz,
    /// MATLAB, version 5
    Mat,
    /// Universal file, dataset 58
    Uff,
    /// Parquet, a row a sample
    Parquet,
    /// Sound to listen to: one channel, scaled to 16 bits; with `--sensor` the bits of the sensor
    Wav,
    /// The same container with 64-bit floats, every channel in its own unit
    Wav64,
    /// ParaView: a folder of VTU files with the stress about the defect, a grid a frame, and the .pvd that
    /// lists them
    #[value(alias = "vtu")]
    Pvd,
    /// The mesh, undeformed, with material, sections and contacts, for Abaqus or CalculiX
    Inp,
    /// The mesh, undeformed, for Gmsh (4.1)
    Msh,
    /// The preloaded bearing, set rolling, for Radioss: a starter deck and an engine deck
    Radioss,
}

impl Format {
    /// Endings of its files, the usual one first; a folder has none.
    fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Csv => &["csv", "txt"],
            Self::Npz => &["npz"],
            Self::Mat => &["mat"],
            Self::Uff => &["uff", "unv"],
            Self::Parquet => &["parquet"],
            Self::Wav | Self::Wav64 => &["wav"],
            Self::Inp => &["inp"],
            Self::Msh => &["msh"],
            Self::Radioss => &["rad"],
            Self::Pvd => &[],
        }
    }

    /// Whether signals are written, in their own unit.
    fn holds_signals(self) -> bool {
        matches!(self, Self::Csv | Self::Npz | Self::Mat | Self::Uff | Self::Parquet | Self::Wav64)
    }
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    if options.to == Format::Radioss
        && let Some(file) = options.run.as_ref().filter(|run| run.extension().is_some_and(|end| end == "ron"))
    {
        let scene = place.scene(Some(file), &options.set)?;
        let out = options.out.clone().unwrap_or_else(|| format!("{}_0000.rad", scene.name).into());
        may_be_written(&out, options.to)?;
        let title = format!("{}: Stribeck {}", scene.name, env!("CARGO_PKG_VERSION"));
        say!("{}", shown(&radioss::write(&scene.resolve(), &title, out)?));
        return Ok(ExitCode::SUCCESS);
    }
    ensure!(
        options.set.is_empty(),
        "`--set` changes a scene before it is written: use it with a scene file and `--to radioss`"
    );
    if let Some(file) = options.run.as_ref().map(|run| place.locate_run(run)).filter(|run| run.is_file()) {
        place.refuse_scene(&file)?;
        return convert(&file, options);
    }
    let folder = match &options.run {
        Some(run) => existing(run, place)?,
        None => place.newest_single_run()?,
    };
    let dir = RunDir::open(&folder)?;
    let run = Run::read(dir.path())?;
    for missing in run.damage() {
        caution!("{missing}");
    }
    for (flag, given) in [("--rate-hz", options.rate_hz.is_some()), ("--slow", options.slow.is_some())] {
        if given && (options.to != Format::Wav || options.sensor.is_some()) {
            bail!(
                "`{flag}` is for a sound to listen to: use it with `--to wav` and without `--sensor`, whose \
                 own `rate_hz` is the rate of a recorder"
            );
        }
    }
    if options.machine.is_some() && !options.to.holds_signals() {
        bail!("`--machine` makes a signal: use it with `--to` csv, npz, mat, uff, parquet or wav64");
    }
    if let Some(out) = &options.out {
        may_be_written(out, options.to)?;
    }
    let out = |name: &str| options.out.clone().unwrap_or_else(|| folder.join(name));
    let written = match options.to {
        Format::Pvd => series(&dir, &run, out("paraview"))?,
        Format::Inp => deck::write(&dir, &run, Deck::Abaqus, out("mesh.inp"))?,
        Format::Radioss => radioss::write(&run.scene, &provenance(&run).join("; "), out("radioss_0000.rad"))?,
        Format::Msh => deck::write(&dir, &run, Deck::Gmsh, out("mesh.msh"))?,
        Format::Wav if options.sensor.is_none() => sound::write(&dir, &run, options, &out("sound.wav"))?,
        _ => signals(&dir, &run, options, place)?,
    };
    say!("{}", shown(&written));
    Ok(ExitCode::SUCCESS)
}

/// Writes the channels of a record in another format.
fn convert(file: &Path, options: &Options) -> Result<ExitCode> {
    let of_runs = options.sensor.is_some() || options.machine.is_some();
    ensure!(
        options.to.holds_signals() && !of_runs,
        "`{}` is a record: it is converted to csv, npz, mat, uff, parquet or wav64, without `--sensor` or \
         `--machine`",
        shown(file)
    );
    let recording = Recording::open(file)?;
    let mut channels = chosen(&recording, options)?;
    // A table has rows; numbers that stand alone have a place in the others.
    if !matches!(options.to, Format::Npz | Format::Mat) {
        let longest = channels.iter().map(|c| c.len).max().unwrap_or_default();
        let (whole, others): (Vec<_>, Vec<_>) = channels.into_iter().partition(|c| c.len == longest);
        others.iter().for_each(|c| caution!("`{}` has {} samples of {longest}: left out", c.name, c.len));
        channels = whole;
    }
    let ending = options.to.endings().first().unwrap_or(&"");
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let default = || PathBuf::from(format!("{stem}.{ending}"));
    let out = options.out.clone().unwrap_or_else(default);
    may_be_written(&out, options.to)?;
    ensure!(out.canonicalize().ok() != file.canonicalize().ok(), "`{}` is the record itself", shown(&out));
    let mut notes = vec![format!("from {}, {}", shown(file), recording.format)];
    notes.extend(recording.notes);
    write_channels(&out, &channels, notes, options)?;
    say!("{}", shown(&out));
    Ok(ExitCode::SUCCESS)
}

/// The channels that were asked for, and the times of samples.
fn chosen(recording: &Recording, options: &Options) -> Result<Vec<Channel>> {
    let asked = |c: &Channel| {
        options.channels.is_empty() || options.channels.iter().any(|part| c.name.contains(part))
    };
    if !recording.channels.iter().any(asked) {
        bail!("no channel contains `{}`; there are {}", options.channels.join("` or `"), recording.names());
    }
    Ok(recording.channels.iter().filter(|c| c.is_time || c.name == TIME || asked(c)).cloned().collect())
}

/// Writes channels in a format that holds signals.
fn write_channels(path: &Path, channels: &[Channel], notes: Vec<String>, options: &Options) -> Result<()> {
    // A wave has no place for the time.
    let no_time = || channels.iter().filter(|c| c.name != TIME && !c.is_time).cloned().collect::<Vec<_>>();
    match options.to {
        Format::Csv => csv::write(path, channels, &notes)?,
        Format::Npz => npz::write(path, channels, &notes)?,
        Format::Mat => mat5::write(path, channels, &notes)?,
        Format::Uff => uff58::write(path, &no_time(), &notes)?,
        Format::Parquet => parquet::write(path, channels, &notes)?,
        Format::Wav => sound::recorded(path, &no_time(), options.sensor.as_deref(), notes)?,
        Format::Wav64 => wav::write(path, &no_time(), &notes)?,
        Format::Pvd | Format::Inp | Format::Msh | Format::Radioss => {}
    }
    Ok(())
}

/// Refuses to write over a file of another kind, or into a run, and makes the folder of a new file.
fn may_be_written(out: &Path, to: Format) -> Result<()> {
    let Some(usual) = to.endings().first() else {
        let is_run = out.join("run.json").exists();
        ensure!(!is_run, "`{}` is the folder of a run: choose another `--out`", shown(out));
        return Ok(());
    };
    // What is neither file nor folder is a device or a pipe.
    let end = out.extension().map(|end| end.to_string_lossy().to_lowercase());
    let fits = !out.is_file() || end.is_some_and(|end| to.endings().contains(&end.as_str()));
    ensure!(
        fits && !out.is_dir(),
        "`{}` is there and is no `.{usual}` file: choose another `--out`, or remove it",
        shown(out)
    );
    match out.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        Some(folder) => {
            std::fs::create_dir_all(folder).with_context(|| format!("cannot make `{}`", shown(folder)))
        }
        None => Ok(()),
    }
}

/// Metadata, where the format can hold them.
fn provenance(run: &Run) -> Vec<String> {
    let info = &run.info;
    let duration_s = info.interval_s * info.samples as f64;
    vec![
        format!(
            "{}: Stribeck {} ({}), scene {}",
            run.scene.written.name, info.version, info.commit, info.scene_hash
        ),
        format!(
            "run {:?}, {} samples at {} Hz, {:.6} s resolve {:.3} Hz",
            info.status,
            info.samples,
            (10.0 / info.interval_s).round() / 10.0,
            duration_s,
            1.0 / duration_s
        ),
        format!("time step {:e} s, {} elements", info.time_step_s, info.mesh.quads + info.mesh.triangles),
    ]
}

fn signals(dir: &RunDir, run: &Run, options: &Options, place: &Place) -> Result<PathBuf> {
    let mut recording = Recording::open(dir.trace())?;
    if let Some(machine) = &options.machine {
        recording.channels = crate::machine::channels(run, machine.as_deref(), place)?;
    }
    // Whatever is chosen keeps its times: a run's first sample is not at zero.
    let in_unit = |c: Channel| {
        let unit = unit(&c.name).map(str::to_owned);
        c.in_unit(unit)
    };
    let channels: Vec<Channel> = chosen(&recording, options)?.into_iter().map(in_unit).collect();
    let channels = match &options.sensor {
        Some(text) => recorded(&channels, text)?,
        None => channels,
    };
    let path = options
        .out
        .clone()
        .unwrap_or_else(|| dir.path().join(format!("trace.{}", options.to.endings().first().unwrap_or(&""))));
    write_channels(&path, &channels, provenance(run), options)?;
    Ok(path)
}

/// The accelerations among the channels as a sensor records them, after their times.
fn recorded(channels: &[Channel], text: &str) -> Result<Vec<Channel>> {
    let mut made = Vec::new();
    for channel in channels.iter().filter(|c| c.name.ends_with("_m_s2")) {
        let rate_hz = channel.rate_hz.context("the run has no sample rate")?;
        let sensor = sensor(text, rate_hz)?;
        let samples = sensor.record(&channel.read()?, rate_hz)?;
        if let (true, Some(time)) = (made.is_empty(), channels.iter().find(|c| c.name == TIME)) {
            let first = time.read()?.first().copied().unwrap_or_default();
            let times = (0..samples.len()).map(|n| first + n as f64 / sensor.rate_hz).collect();
            made.push(Channel::held(TIME, times).at_rate(Some(sensor.rate_hz)).in_unit(time.unit.clone()));
        }
        made.push(
            Channel::held(&channel.name, samples).at_rate(Some(sensor.rate_hz)).in_unit(channel.unit.clone()),
        );
    }
    ensure!(
        !made.is_empty(),
        "`--sensor` records accelerations, and none of the channels is one: leave `--channel` out, or \
         choose some whose names end in `_m_s2`"
    );
    Ok(made)
}

/// A sensor by its flags; a missing one has no effect.
fn sensor(text: &str, rate_hz: f64) -> Result<Sensor> {
    let mut sensor = Sensor::ideal(rate_hz);
    let (mut resonance_hz, mut quality) = (None, 30.0);
    for part in text.split(',').map(str::trim).filter(|part| !part.is_empty()) {
        let (key, value) =
            part.split_once('=').with_context(|| format!("`{part}` of the sensor is no `name=number`"))?;
        let number: f64 =
            value.trim().parse().with_context(|| format!("`{}` of the sensor is no number", value.trim()))?;
        match key.trim() {
            "rate_hz" => sensor.rate_hz = number,
            "resonance_hz" => resonance_hz = Some(number),
            "quality" => quality = number,
            "noise_density" if number >= 0.0 => sensor.noise_density = number,
            "range" => sensor.range = number,
            "bits" if (2.0..=32.0).contains(&number) => sensor.bits = Some(number as u32),
            "seed" if number >= 0.0 => sensor.seed = number as u64,
            other => bail!(
                "`{other}={number}` of the sensor: known are rate_hz, resonance_hz, quality, noise_density \
                 (not negative), range, bits (2 to 32) and seed"
            ),
        }
    }
    sensor.resonance = resonance_hz.map(|hz| (hz, quality));
    Ok(sensor)
}

/// Unit of a channel of ours, by the end of its name.
pub(crate) fn unit(name: &str) -> Option<&'static str> {
    [
        ("_m_s2", "m/s^2"),
        ("_m_s", "m/s"),
        ("_rad_s", "rad/s"),
        ("_rad", "rad"),
        ("_n", "N"),
        ("_j", "J"),
        ("_um", "um"),
        ("_m", "m"),
        ("_s", "s"),
    ]
    .into_iter()
    .find(|(end, _)| name.ends_with(end))
    .map(|(_, unit)| unit)
}

struct Stressed {
    time_s: f64,
    part: Part,
    /// Von Mises stress of each element [Pa]; none in the cage, which is rigid.
    stress: Vec<f64>,
}

/// All frames of a run.
fn stressed(dir: &RunDir, run: &Run) -> Result<Vec<Stressed>> {
    let frames = frames::read_all(&dir.frames())?;
    if frames.is_empty() {
        let (model, why) = match run.scene.written.model {
            ModelScene::Full => ("", ""),
            ModelScene::Reduced(_) => (" --set model=full", "; the reduced model makes none"),
        };
        bail!(
            "`{0}` holds no frames{why}. This makes them: stribeck simulate {0}/scene.ron{model} --set \
             'output.frames=()' --name {1}-frames",
            shown(dir.path()),
            run.scene.written.name
        );
    }
    let whole = RunMesh::read(dir.mesh())?;
    let material = elastic(&run.scene.material);
    let of_frame = |frame: &frames::Frame| {
        let part = Part::of(&whole, frame);
        let rigid = |n: usize| {
            part.mesh
                .bodies
                .iter()
                .any(|b| b.name == "cage" && (b.quads.contains(&n) || part.is_triangle_of(b, n)))
        };
        let of_element = |(n, corners): (usize, &[u32])| {
            if rigid(n) {
                return 0.0;
            }
            Stress::of(&material, &part.reference(corners), &part.moved(corners)).von_mises()
        };
        let stress = part.elements().enumerate().map(of_element).collect();
        Stressed { time_s: frame.time_s, stress, part }
    };
    Ok(frames.iter().map(of_frame).collect())
}

/// A grid a frame, with displacement and von Mises stress, and the index that gives their times.
fn series(dir: &RunDir, run: &Run, folder: PathBuf) -> Result<PathBuf> {
    let frames = stressed(dir, run)?;
    std::fs::create_dir_all(&folder).with_context(|| format!("cannot make `{}`", folder.display()))?;
    let mut index = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" \
         byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for note in provenance(run) {
        index += &format!("<!-- {} -->\n", note.replace("--", "- -"));
    }
    for (number, frame) in frames.iter().enumerate() {
        let Stressed { time_s, part, stress } = frame;
        let name = format!("frame-{number:05}.vtu");
        let mut bytes = Vec::new();
        let moved: Vec<[f64; 3]> = part.displacement.iter().map(|u| [u[0], u[1], 0.0]).collect();
        vtu::write(
            &mut bytes,
            &part.mesh,
            &[Field::vector("displacement_m", &moved)],
            &[Field::scalar("von_mises_pa", stress)],
        )?;
        write_atomic(&folder.join(&name), &bytes)?;
        index += &format!("<DataSet timestep=\"{time_s:?}\" group=\"\" part=\"0\" file=\"{name}\"/>\n");
    }
    index += "</Collection>\n</VTKFile>\n";
    let path = folder.join("frames.pvd");
    write_atomic(&path, index.as_bytes())?;
    Ok(path)
}

/// The elements whose corners are all in a frame, in place.
struct Part {
    /// With the nodes where they are now.
    mesh: Mesh,
    displacement: Vec<[f64; 2]>,
}

impl Part {
    fn of(whole: &RunMesh, frame: &frames::Frame) -> Self {
        const ABSENT: u32 = u32::MAX;
        let mut place = vec![ABSENT; whole.reference.len()];
        let mut mesh = Mesh::default();
        let mut displacement = Vec::new();
        for (&node, &u) in frame.nodes.iter().zip(&frame.displacement) {
            let (Some(at), Some(slot)) = (whole.reference.get(node as usize), place.get_mut(node as usize))
            else {
                continue;
            };
            *slot = mesh.x.len() as u32;
            mesh.x.push(at[0] + u[0]);
            mesh.y.push(at[1] + u[1]);
            displacement.push(u);
        }
        let there = |corners: &[u32]| corners.iter().all(|n| place[*n as usize] != ABSENT);
        for body in &whole.bodies {
            let (quads, triangles) = (mesh.quads.len(), mesh.triangles.len());
            let own = whole.quads[body.quads.clone()].iter().filter(|q| there(*q));
            mesh.quads.extend(own.map(|q| q.map(|n| place[n as usize])));
            let own = whole.triangles[body.triangles.clone()].iter().filter(|t| there(*t));
            mesh.triangles.extend(own.map(|t| t.map(|n| place[n as usize])));
            mesh.bodies.push(Body {
                name: body.name.clone(),
                nodes: 0..0,
                quads: quads..mesh.quads.len(),
                triangles: triangles..mesh.triangles.len(),
            });
        }
        Self { mesh, displacement }
    }

    /// Corners of the elements in the order of the file: quadrilaterals, then triangles.
    fn elements(&self) -> impl Iterator<Item = &[u32]> {
        let quads = self.mesh.quads.iter().map(|q| q.as_slice());
        quads.chain(self.mesh.triangles.iter().map(|t| t.as_slice()))
    }

    fn is_triangle_of(&self, body: &Body, element: usize) -> bool {
        element.checked_sub(self.mesh.quads.len()).is_some_and(|n| body.triangles.contains(&n))
    }

    fn moved(&self, corners: &[u32]) -> Vec<[f64; 2]> {
        corners.iter().map(|n| [self.mesh.x[*n as usize], self.mesh.y[*n as usize]]).collect()
    }

    fn reference(&self, corners: &[u32]) -> Vec<[f64; 2]> {
        let back = |n: &u32| {
            let u = self.displacement[*n as usize];
            [self.mesh.x[*n as usize] - u[0], self.mesh.y[*n as usize] - u[1]]
        };
        corners.iter().map(back).collect()
    }
}
