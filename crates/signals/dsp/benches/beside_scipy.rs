//! Every function that scipy has, too, beside scipy's: the same answer, and the ratio of times taken in turn.
//!
//! Processor times are medians on one thread; the ratio, of pairs, is above 1 where ours is faster. scipy keeps the
//! tables of its transforms from call to call, and so do `Envelope` and `EnvelopeSpectrum`; the others make
//! theirs in every call. The interpreter in STRIBECK_PYTHON, or python3, needs numpy and scipy.

use std::cell::RefCell;
use std::hint::black_box;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Instant;

use stribeck_dsp::{
    Averaging, Detrend, Envelope, EnvelopeSpectrum, Notch, Welch, WelchOptions, Window,
    magnitude_spectrogram, resample_poly, spectrogram, statistics,
};

const RATE_HZ: f64 = 25_600.0;
/// Pairs of timings.
const ROUNDS: usize = 9;
/// One timing takes about this long [s], so that clocks do not matter.
const LONG_S: f64 = 0.04;
/// Both sides round in a different order.
const AGREED: f64 = 1e-9;

/// The input of `fixtures/peers/scipy_signals.py`.
fn signal(count: usize) -> Vec<f64> {
    let mut state: u32 = 12345;
    (0..count)
        .map(|n| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let noise = f64::from(state) / 4_294_967_296.0 - 0.5;
            let since = (n as f64).rem_euclid(357.3);
            noise + 3.0 * (-since / 26.0).exp() * (std::f64::consts::TAU * 0.12 * since).sin()
        })
        .collect()
}

/// A function of ours.
struct Case<'a> {
    /// Its name in the script.
    name: &'static str,
    /// The same in words: ours, scipy's, and on what.
    words: [&'static str; 3],
    work: Box<dyn Fn() -> Vec<f64> + 'a>,
}

fn cases(x: &[f64]) -> Vec<Case<'_>> {
    let odd = &x[..250_000];
    let notch = Notch::new(RATE_HZ, 4671.0, 15.0).expect("a notch below half the rate");
    let welch = |options: WelchOptions| {
        Box::new(move || {
            let spectrum = Welch::new(RATE_HZ, x.len(), &options).and_then(|mut plan| plan.estimate(x));
            spectrum.expect("the options fit the record").values().to_vec()
        })
    };
    let envelope = |x: &[f64]| {
        let plan = RefCell::new(Envelope::new(x.len()).expect("a record"));
        move |x: &[f64]| {
            let mut out = vec![0.0; x.len()];
            plan.borrow_mut().process(x, &mut out).expect("a finite signal");
            out
        }
    };
    let (of_all, of_odd) = (envelope(x), envelope(odd));
    let spectrum = RefCell::new(EnvelopeSpectrum::new(RATE_HZ, x.len(), None).expect("a rate above 0"));
    let thousand = WelchOptions::new(1024);
    let magnitudes = thousand.clone();
    vec![
        Case {
            name: "welch",
            words: ["`Welch`, mean", "`welch`", "segments of 8192"],
            work: welch(WelchOptions::new(8192)),
        },
        Case {
            name: "welch_median",
            words: ["`Welch`, median", "`welch`", "segments of 8192"],
            work: welch(WelchOptions { averaging: Averaging::Median, ..WelchOptions::new(8192) }),
        },
        Case {
            name: "welch_linear",
            words: ["`Welch`, straight lines removed", "`welch`", "segments of 8192"],
            work: welch(WelchOptions { detrend: Detrend::Linear, ..WelchOptions::new(8192) }),
        },
        Case {
            name: "periodogram",
            words: ["`Welch`, one segment", "`periodogram`", ""],
            work: welch(WelchOptions { window: Window::Boxcar, ..WelchOptions::new(x.len()) }),
        },
        Case {
            name: "spectrogram",
            words: ["`spectrogram`", "`spectrogram`", "segments of 1024"],
            work: Box::new(move || spectrogram(x, RATE_HZ, &thousand).expect("segments fit").values),
        },
        Case {
            name: "magnitude",
            words: ["`magnitude_spectrogram`", "`spectrogram`", "segments of 1024"],
            work: Box::new(move || {
                magnitude_spectrogram(x, RATE_HZ, &magnitudes).expect("segments fit").values
            }),
        },
        Case { name: "hilbert", words: ["`Envelope`", "`hilbert`", ""], work: Box::new(move || of_all(x)) },
        Case {
            name: "hilbert_odd",
            words: ["`Envelope`", "`hilbert`", "250 000 samples"],
            work: Box::new(move || of_odd(odd)),
        },
        Case {
            name: "envelope_spectrum",
            words: ["`EnvelopeSpectrum`", "`hilbert`, `periodogram`", ""],
            work: Box::new(move || {
                let mut plan = spectrum.borrow_mut();
                let mut out = plan.blank();
                plan.process(x, &mut out).expect("a finite signal");
                out.values().to_vec()
            }),
        },
        Case {
            name: "hann",
            words: ["`Window::samples`", "`get_window`", ""],
            work: Box::new(move || Window::Hann.samples(x.len()).expect("long enough")),
        },
        Case {
            name: "iirnotch",
            words: ["`Notch::new`", "`iirnotch`", "one notch"],
            work: Box::new(|| {
                let notch = Notch::new(RATE_HZ, 4671.0, 15.0).expect("below half the rate");
                [notch.numerator(), notch.denominator()].concat()
            }),
        },
        Case {
            name: "lfilter",
            words: ["`Notch::filter`", "`lfilter`", ""],
            work: Box::new(move || notch.filter(x).expect("a finite signal")),
        },
        Case {
            name: "lfilter_zi",
            words: ["`Notch::filter_from_first`", "`lfilter`, `lfilter_zi`", ""],
            work: Box::new(move || notch.filter_from_first(x).expect("a finite signal")),
        },
        Case {
            name: "filtfilt",
            words: ["`Notch::filtfilt`", "`filtfilt`", ""],
            work: Box::new(move || notch.filtfilt(x).expect("a finite signal")),
        },
        Case {
            name: "halved",
            words: ["`resample_poly`", "`resample_poly`", "1/2"],
            work: Box::new(move || resample_poly(x, 1, 2).expect("a finite signal")),
        },
        Case {
            name: "resampled",
            words: ["`resample_poly`", "`resample_poly`", "147/160"],
            work: Box::new(move || resample_poly(x, 147, 160).expect("a finite signal")),
        },
        Case {
            name: "rms",
            words: ["`statistics::rms`", "`numpy.mean`", ""],
            work: Box::new(move || vec![statistics::rms(x).expect("a finite signal")]),
        },
        Case {
            name: "kurtosis",
            words: ["`statistics::kurtosis`", "`stats.kurtosis`", ""],
            work: Box::new(move || vec![statistics::kurtosis(x).expect("a finite signal")]),
        },
    ]
}

/// Time of one piece of work [s], the sum of its result and that of the magnitudes.
#[derive(Debug, Clone, Copy)]
struct Done {
    seconds: f64,
    sum: f64,
    magnitude: f64,
}

/// Processor time of this process [s], where the system has it; else wall-clock time.
fn clock(began: Instant) -> f64 {
    std::thread::yield_now();
    let ticks = std::fs::read_to_string("/proc/self/schedstat").ok();
    let nanoseconds = ticks.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| began.elapsed().as_secs_f64(), |ns| 1e-9 * ns)
}

fn ours(case: &Case<'_>, count: usize) -> Done {
    let began = Instant::now();
    let from = clock(began);
    let mut result = Vec::new();
    for _ in 0..count {
        result = black_box((case.work)());
    }
    let seconds = (clock(began) - from) / count as f64;
    Done { seconds, sum: result.iter().sum(), magnitude: result.iter().map(|x| x.abs()).sum() }
}

/// scipy in a process of its own, on one thread.
struct Scipy {
    child: Child,
    ask: ChildStdin,
    answers: BufReader<ChildStdout>,
}

impl Scipy {
    fn start() -> Result<(Self, String), String> {
        let python = std::env::var("STRIBECK_PYTHON").unwrap_or_else(|_| "python3".to_owned());
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/peers/scipy_signals.py");
        let mut command = Command::new(&python);
        command.arg(script).env("OMP_NUM_THREADS", "1").env("OPENBLAS_NUM_THREADS", "1");
        let child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        let mut child =
            child.map_err(|why| format!("`{python}` does not start: {why}; set STRIBECK_PYTHON"))?;
        let (ask, out) = (child.stdin.take(), child.stdout.take());
        let (Some(ask), Some(out)) = (ask, out) else { return Err("no pipes".to_owned()) };
        let mut scipy = Self { child, ask, answers: BufReader::new(out) };
        let versions =
            scipy.answer().map_err(|_| format!("`{python}` has no numpy and scipy; set STRIBECK_PYTHON"))?;
        Ok((scipy, versions))
    }

    fn answer(&mut self) -> Result<String, String> {
        let mut line = String::new();
        loop {
            line.clear();
            let read = self.answers.read_line(&mut line).map_err(|why| why.to_string())?;
            if read == 0 {
                return Err("scipy ended".to_owned());
            }
            if let Some(rest) = line.strip_prefix('@') {
                return Ok(rest.trim().to_owned());
            }
        }
    }

    fn run(&mut self, name: &str, count: usize) -> Result<Done, String> {
        writeln!(self.ask, "{name} {count}")
            .and_then(|()| self.ask.flush())
            .map_err(|why| why.to_string())?;
        let line = self.answer()?;
        let numbers: Vec<f64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let [seconds, sum, magnitude] = numbers[..] else { return Err(format!("no three numbers: {line}")) };
        Ok(Done { seconds, sum, magnitude })
    }
}

impl Drop for Scipy {
    fn drop(&mut self) {
        self.child.kill().ok();
        self.child.wait().ok();
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// A row of the table: names, times [ms] of ours and theirs, and their ratio.
fn row(case: &Case<'_>, scipy: &mut Scipy) -> Result<String, String> {
    let once = ours(case, 1);
    let count = ((LONG_S / once.seconds.max(1e-7)) as usize).clamp(1, 20_000);
    let mut pairs = Vec::new();
    for round in 0..ROUNDS {
        // Neither is always the first.
        let pair = if round % 2 == 0 {
            let first = ours(case, count);
            (first, scipy.run(case.name, count)?)
        } else {
            let first = scipy.run(case.name, count)?;
            (ours(case, count), first)
        };
        let apart = (pair.0.sum - pair.1.sum).abs().max((pair.0.magnitude - pair.1.magnitude).abs());
        if apart.is_nan() || apart > AGREED * pair.1.magnitude {
            return Err(format!("{}: other answers, {:?} and {:?}", case.name, pair.0, pair.1));
        }
        pairs.push(pair);
    }
    let of = |pick: fn(&(Done, Done)) -> f64| median(pairs.iter().map(pick).collect());
    let milliseconds = |s: f64| if s < 1e-4 { format!("{:.4}", 1e3 * s) } else { format!("{:.2}", 1e3 * s) };
    let [name, theirs, on] = case.words;
    Ok(format!(
        "| {name} | {theirs} | {on} | {} | {} | {:.2} |",
        milliseconds(of(|p| p.0.seconds)),
        milliseconds(of(|p| p.1.seconds)),
        of(|p| p.1.seconds / p.0.seconds)
    ))
}

fn table() -> Result<(), String> {
    let x = signal(1 << 18);
    let (mut scipy, versions) = Scipy::start()?;
    println!(
        "scipy and numpy {versions}, 262 144 samples unless something else is said, sums agree to {AGREED:e}\n\n\
         | ours | scipy | on | ours, ms | scipy, ms | scipy over ours |\n|---|---|---|---|---|---|"
    );
    for case in cases(&x) {
        println!("{}", row(&case, &mut scipy)?);
    }
    Ok(())
}

fn main() {
    if let Err(why) = table() {
        eprintln!("{why}");
        std::process::exit(1);
    }
}
