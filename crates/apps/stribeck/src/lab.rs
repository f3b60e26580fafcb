//! `stribeck lab`: bearings that run in the browser, in one file.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use anyhow::{Context, Result, bail, ensure};
use stribeck_lab::page::{self, is_module};
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::{self, RunDir};

use crate::out::say;
use crate::place::{Place, shown};

/// Flags of `lab`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Scene files, each a bearing in the page [default: the run of the paper, on round surfaces; its chords
    /// are a preset]; a full model runs in its modes
    scenes: Vec<PathBuf>,
    /// The page
    #[arg(long, value_name = "FILE", default_value = PAGE)]
    out: PathBuf,
    /// Overrides a field of every scene, for example --set model=reduced(modes_khz:20); may be repeated
    #[arg(long = "set", value_name = "FIELD=VALUE")]
    set: Vec<String>,
    /// Opens the page in the browser
    #[arg(long)]
    open: bool,
    /// Whether it opens where there is a browser.
    #[arg(skip)]
    opens: bool,
    /// The module that steps the bearing, built by `cargo xtask lab-module` [default: the one that the
    /// program was built with]
    #[arg(long, value_name = "FILE")]
    module: Option<PathBuf>,
}

/// The page, unless it is written elsewhere.
const PAGE: &str = "lab.html";

/// Names the module for programs that are not beside it.
const VARIABLE: &str = "STRIBECK_LAB_MODULE";

/// Its name beside the program, and below the folder of builds in a repository.
pub const MODULE: &str = "stribeck_lab.wasm";

/// How the paper's bearing opens.
const ROUND: &str = "contact.surface=arc";

/// More in one page is slow to open.
const MOST_SCENES: usize = 12;

/// Largest page [bytes]: more is hard to send.
const LARGEST: usize = 3 << 20;

impl Options {
    /// With the page opened where there is a browser, unless it is written to a place of the user's choice.
    pub fn opened(mut self) -> Self {
        self.opens = self.out == Path::new(PAGE);
        self
    }

    /// With a module that was just built, unless the user named one.
    pub fn with_module(mut self, module: PathBuf) -> Self {
        self.module.get_or_insert(module);
        self
    }
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    ensure!(
        options.scenes.len() <= MOST_SCENES,
        "{} scenes in one page: at most {MOST_SCENES}. Make several pages",
        options.scenes.len()
    );
    let files = options.scenes.iter().map(|file| Some(file.as_path()));
    let scenes: Vec<Scene> = if options.scenes.is_empty() {
        let set: Vec<String> = [ROUND.to_owned()].into_iter().chain(options.set.iter().cloned()).collect();
        vec![place.scene(None, &set)?]
    } else {
        files.map(|file| place.scene(file, &options.set)).collect::<Result<_>>()?
    };
    let module = module(options.module.as_deref(), place)?;
    write(&scenes, &module, &place.runs(), &again(options, place), &options.out)?;
    if options.open {
        open(&options.out)?;
    } else if options.opens
        && let Err(why) = open(&options.out)
    {
        say!("{why}");
    }
    Ok(ExitCode::SUCCESS)
}

/// Writes the page of some scenes; `runs` is where their reductions may be kept.
fn write(scenes: &[Scene], module: &[u8], runs: &Path, command: &str, out: &Path) -> Result<()> {
    let names: Vec<&str> = scenes.iter().map(|scene| scene.name.as_str()).collect();
    eprintln!("{}: meshed, brought to rest and reduced", names.join(", "));
    let page = page::page(scenes, module, Some(runs), command)?;
    if let Some(folder) = out.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).with_context(|| format!("cannot make `{}`", shown(folder)))?;
    }
    std::fs::write(out, &page.html).with_context(|| format!("cannot write `{}`", shown(out)))?;
    if page.html.len() > LARGEST {
        eprintln!(
            "warning: the page has {:.1} MB; --set mesh.size_mm=1 or a smaller `model.modes_khz` makes it \
             smaller",
            1e-6 * page.html.len() as f64
        );
    }
    say!("lab: {} ({:.2} MB: {})", shown(out), 1e-6 * page.html.len() as f64, parts(&names, &page));
    Ok(())
}

/// Writes the page of a run's scene beside its report, with the module that was named or is found.
pub(crate) fn beside_report(run: &RunDir, module_file: Option<&Path>, place: &Place) -> Result<()> {
    let scene = Scene::read(run.scene())?;
    let command = format!("{} lab {}", place.program, shown(&run.scene()));
    let runs = run.path().parent().map_or_else(|| place.runs(), Path::to_owned);
    let module = module(module_file, place)?;
    write(std::slice::from_ref(&scene), &module, &runs, &command, &run.path().join(run_dir::LAB))
}

/// How large the parts of a page are.
fn parts(names: &[&str], page: &page::Page) -> String {
    let of = |(name, bytes): (&&str, &usize)| format!("{name} {:.2}", 1e-6 * *bytes as f64);
    let scenes: Vec<String> = names.iter().zip(&page.bytes_of_scenes).map(of).collect();
    format!("{}, module {:.2}", scenes.join(", "), 1e-6 * page.bytes_of_module as f64)
}

/// The command that would make the page again.
fn again(options: &Options, place: &Place) -> String {
    let scenes = options.scenes.iter().map(|scene| format!(" {}", scene.display()));
    let set = options.set.iter().map(|set| format!(" --set {set}"));
    format!("{} lab{}{}", place.program, scenes.collect::<String>(), set.collect::<String>())
}

/// The module: the one that was named, the one that the program carries, or the one that is found.
fn module(named: Option<&Path>, place: &Place) -> Result<Vec<u8>> {
    let named = named.map(Path::to_owned).or_else(|| std::env::var_os(VARIABLE).map(PathBuf::from));
    let file = match (named, page::embedded()) {
        (Some(file), _) => file,
        (None, Some(module)) => return Ok(module.to_vec()),
        (None, None) => found(place)?,
    };
    let bytes = std::fs::read(&file).with_context(|| format!("cannot read `{}`", shown(&file)))?;
    ensure!(is_module(&bytes), "`{}` is no WebAssembly module: `cargo xtask lab` builds one", shown(&file));
    Ok(bytes)
}

/// A module beside the program, or the last one of the repository.
fn found(place: &Place) -> Result<PathBuf> {
    let beside = std::env::current_exe().ok().and_then(|program| Some(program.parent()?.join(MODULE)));
    let built = place.runs().with_file_name("target").join("lab").join(MODULE);
    match beside.into_iter().chain([built]).find(|file| file.is_file()) {
        Some(file) => Ok(file),
        None => bail!(
            "this program was built without {MODULE}, which steps the bearing in the page. In the repository \
             of Stribeck `cargo xtask lab` builds it, makes the page and opens it, and `cargo xtask lab-module \
             --embed` before `cargo install` gives it to the program. Elsewhere put the file beside the program, or name it with --module or \
             {VARIABLE}"
        ),
    }
}

/// Opens a file with the browser of the system.
fn open(page: &Path) -> Result<()> {
    let page = std::path::absolute(page).with_context(|| format!("cannot find `{}`", shown(page)))?;
    let mut command = if cfg!(target_os = "macos") {
        Command::new("open")
    } else if cfg!(target_os = "windows") {
        let mut command = Command::new("cmd");
        command.args(["/c", "start", ""]);
        command
    } else {
        Command::new("xdg-open")
    };
    let started = command.arg(&page).status();
    ensure!(
        started.as_ref().is_ok_and(std::process::ExitStatus::success),
        "no browser opens by itself here: open `{}` in one",
        shown(&page)
    );
    Ok(())
}
