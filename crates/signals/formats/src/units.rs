//! Units of time, and the names under which files of all formats keep times and rates: one list for all.

use crate::csv;

/// Units of time with their usual spelling and their seconds.
const TIMES: [(&str, f64, &str); 7] = [
    ("s", 1.0, "s sec secs second seconds sek sekunde sekunden seconde secondes"),
    ("ms", 1e-3, "ms msec msecs msek millisec millisecond milliseconds millisekunden millis"),
    // The second is the micro sign, the third the Greek letter, the fourth the remains of one in another
    // encoding.
    (
        "us",
        1e-6,
        "us µs μs \u{fffd}s usec usecs µsec μsec microsec microsecond microseconds mikrosekunden \
      micros",
    ),
    ("ns", 1e-9, "ns nsec nsecs nanosec nanosecond nanoseconds nanosekunden nanos"),
    ("min", 60.0, "min mins minute minutes minuten"),
    ("h", 3600.0, "h hr hrs hour hours std stunde stunden"),
    ("d", 86_400.0, "d day days tag tage"),
];

/// Other units that recorders write, without brackets and in small letters.
const OTHERS: [&str; 62] = [
    "g", "gn", "mg", "v", "mv", "uv", "µv", "volt", "volts", "n", "kn", "nm", "pa", "kpa", "mpa", "bar", "m",
    "mm", "um", "µm", "μm", "mil", "mils", "in", "rad", "deg", "rev", "rpm", "hz", "khz", "-", "%", "eu",
    "ips", "a", "ma", "w", "kw", "db", "k", "c", "f", "counts", "1", "unit", "units", "strain", "none", "ug",
    "µg", "g's", "gs", "gee", "gees", "g_rms", "grms", "g rms", "g peak", "gal", "cm", "ft", "inch",
];

/// Names of sample rates, of letters and digits alone; a unit of frequency may follow.
const RATES: &str = "fs sr rate sfreq fsample samplerate samplingrate samplesrate samplefrequency \
    samplingfrequency samplefreq samplingfreq sampfreq samprate samplespersecond samplespersec \
    abtastrate abtastfrequenz acquisitionrate acquisitionfrequency scanrate datarate sps fsamp \
    fabtast framerate";

/// Names of the time between two samples; a unit of time may follow.
const STEPS: &str = "dt ts deltat deltax deltatime tstep timestep sampleinterval samplinginterval sampleperiod \
    samplingperiod sampletime samplingtime wfincrement timeincrement xincrement abtastintervall \
    tsample";

/// Names of the time at which a channel begins; a unit of time may follow.
const STARTS: &str = "t0 tstart start starttime startoffset timestart timeoffset timezero wfstarttime \
    wfstartoffset xstart x0 begin begintime timebegin starttimestamp starttimeutc recordingstart";

/// Names that are times of beginning only with a unit of time behind them.
const OFFSETS: [&str; 3] = ["offset", "delay", "lag"];

/// Endings of names of channels that rise evenly and are not times.
const TURNS: [&str; 5] = ["rad", "deg", "rpm", "hz", "rev"];

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Unit {
    /// Time: its usual spelling, and how many seconds it has.
    Time(&'static str, f64),
    /// Another or an unknown unit, which is not one of time.
    Other,
    /// There is none.
    Unsaid,
}

/// Whether a word is one of a list.
fn is_among(list: &str, word: &str) -> bool {
    list.split(' ').any(|of| of == word)
}

/// A unit without brackets, in small letters.
fn bare(unit: &str) -> String {
    unit.trim_matches(|c: char| c.is_whitespace() || "[](){}<>\"'.,;:".contains(c)).to_lowercase()
}

/// The seconds of a unit of time, and its usual spelling.
pub(crate) fn seconds(unit: &str) -> Option<(&'static str, f64)> {
    let unit = bare(unit);
    // netCDF counts from a date: `seconds since 2024-05-01`.
    let unit = unit.split_once(" since ").map_or(unit.as_str(), |(unit, _)| unit.trim_end());
    let of = TIMES.iter().find(|(_, _, names)| is_among(names, unit));
    of.map(|(name, seconds, _)| (*name, *seconds))
}

/// The unit at the end of a name, `acc [g]`, where it is a known one.
pub(crate) fn in_brackets(name: &str) -> Option<String> {
    let within = name.trim_end().strip_suffix([']', ')'])?;
    let unit = within.rsplit_once(['[', '('])?.1.trim();
    // A number in brackets counts channels.
    let is_symbol = unit.contains(|c: char| c.is_alphabetic() || "°%".contains(c));
    (is_symbol && is_unit(unit)).then(|| unit.to_owned())
}

/// Whether a field of a table is a unit: one of the lists, one in brackets, a fraction or a power of some.
pub(crate) fn is_unit(field: &str) -> bool {
    let bracketed = field.len() > 2 && field.starts_with(['[', '(']) && field.ends_with([']', ')']);
    let unit = bare(field);
    let one = |part: &str| {
        let part = part.trim().trim_end_matches(['²', '³', '2', '3', '^', '*', '-']);
        part.is_empty() || OTHERS.contains(&part) || seconds(part).is_some()
    };
    let degrees = unit.starts_with('°') || unit.starts_with("\u{fffd}");
    let known = !unit.is_empty() && unit.split(['/', '*', '·']).all(one);
    // `ms-2`, `m s-2`, `m·s⁻²` are powers without a fraction.
    let plain: String = unit.chars().filter(|c| !" ·*^".contains(*c)).collect();
    let power = ["s-2", "s⁻²", "s-1", "s⁻¹"].into_iter().find_map(|end| plain.strip_suffix(end));
    let power = power.is_some_and(|length| OTHERS.contains(&length));
    bracketed || degrees || power || known && unit != "-" || field.trim() == "-"
}

impl Unit {
    /// Meaning of the unit of a channel, or of its name where there is none: `t [ms]`, `t (ms)`, `t/ms`,
    /// `time_ms`, `Time, ms`.
    pub(crate) fn of(name: &str, unit: Option<&str>) -> Self {
        let time = |unit: &str| seconds(unit).map(|(name, s)| Self::Time(name, s));
        if let Some(unit) = unit.filter(|unit| !bare(unit).is_empty()) {
            return time(unit).unwrap_or(Self::Other);
        }
        let end = name.trim_end_matches([' ', ']', ')']);
        let Some((_, last)) = end.rsplit_once(['[', '(', '_', '/', ' ', ',', ';', '.']) else {
            return Self::Unsaid;
        };
        // `n[0]` counts columns.
        if name.ends_with(']') && last.parse::<u32>().is_ok() {
            return Self::Unsaid;
        }
        let other = name.contains(['[', '(', ',', '/']) || TURNS.contains(&last.to_lowercase().as_str());
        time(last).unwrap_or(if other { Self::Other } else { Self::Unsaid })
    }
}

/// Units of frequency, in small letters [Hz].
const FREQUENCIES: [(&str, f64); 12] = [
    ("khz", 1e3),
    ("mhz", 1e6),
    ("ksps", 1e3),
    ("hz", 1.0),
    ("s/s", 1.0),
    ("sa/s", 1.0),
    ("samples/s", 1.0),
    ("samples/sec", 1.0),
    ("scans/s", 1.0),
    ("scans/sec", 1.0),
    ("ks/s", 1e3),
    ("ksa/s", 1e3),
];

pub(crate) fn hertz(word: &str) -> Option<f64> {
    let word = bare(word);
    FREQUENCIES.iter().find(|(unit, _)| *unit == word).map(|(_, hz)| *hz)
}

/// The sample rate [Hz] of a number under a name, where the name is that of a rate or of a time step; its
/// unit may stand in the name or beside it.
pub(crate) fn rate_hz(name: &str, unit: Option<&str>, value: f64) -> Option<f64> {
    let key: String = name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect();
    let beside = unit.map(bare).unwrap_or_default();
    let plain = |key: &str| is_among(RATES, key) && key != "rate";
    let rate = if plain(&key) {
        // In an unknown unit it is ignored.
        Some(value * if beside.is_empty() { 1.0 } else { hertz(&beside)? })
    } else {
        let of_name = FREQUENCIES.iter().find_map(|(unit, hz)| Some((key.strip_suffix(unit)?, *hz)));
        of_name.filter(|(key, _)| is_among(RATES, key)).map(|(_, hz)| value * hertz(&beside).unwrap_or(hz))
    };
    // A sampling time in seconds may be that of the whole record.
    let is_step = |key: &str, second: f64| second < 1.0 || !matches!(key, "sampletime" | "samplingtime");
    let step = || {
        if is_among(STEPS, &key) {
            let second = if beside.is_empty() { 1.0 } else { seconds(&beside)?.1 };
            // A step in another unit than seconds is not used.
            return (!beside.is_empty() && is_step(&key, second) || value * second <= SLOWEST_S)
                .then_some(value * second);
        }
        let ends = TIMES.iter().flat_map(|(_, s, names)| names.split(' ').map(move |name| (name, *s)));
        ends.filter_map(|(unit, s)| Some((key.strip_suffix(unit)?, s)))
            .find(|(key, _)| is_among(STEPS, key))
            .filter(|(key, s)| is_step(key, *s) || value * s <= SLOWEST_S)
            .map(|(_, s)| value * s)
    };
    rate.or_else(|| step().map(|s| rounded(1.0 / s))).filter(|hz| hz.is_finite() && *hz > 0.0)
}

/// Why numbers under the name of a rate or of a time step say no rate; nothing where they do, or the name is another.
pub(crate) fn odd_rate(name: &str, unit: Option<&str>, values: &[f64]) -> Option<String> {
    // Some step, and some rate, is one under such a name.
    let of_thousandth = rate_hz(name, unit, 1e-3)?;
    match values {
        [] => Some(format!("is empty{NO_RATE}")),
        [value] if rate_hz(name, unit, *value).is_some() => None,
        [value] if of_thousandth < 1.0 || !(value.is_finite() && *value > 0.0) => {
            Some(format!("is {value}{NO_RATE}"))
        }
        [value] => Some(format!(
            "is {value}: as seconds that is {} Hz, as milliseconds {} Hz, as microseconds {} Hz{NO_RATE}",
            rounded(1.0 / value),
            rounded(1e3 / value),
            rounded(1e6 / value)
        )),
        [first, ..] => {
            let all = values.iter().fold((*first, *first), |(low, high), x| (low.min(*x), high.max(*x)));
            Some(format!("has {} values, from {} to {}{NO_RATE}", values.len(), all.0, all.1))
        }
    }
}

/// By which notes on numbers that say no rate end; where a rate is known otherwise they are of no interest.
pub(crate) const NO_RATE: &str = ": no rate follows";

/// Why no rate follows from a text under the name of a rate or of a time step; nothing under another name.
pub(crate) fn odd_words(name: &str, text: &str) -> Option<String> {
    rate_hz(name, None, 1e-3)?;
    let (name, short) = (name.trim(), text.trim().chars().take(40).collect::<String>());
    let value = short.parse().ok().and_then(|value| odd_rate(name, None, &[value]));
    Some(value.map_or(format!("`{name}` is `{short}`{NO_RATE}"), |why| format!("`{name}` {why}")))
}

/// Sample rates that the properties of a file say [Hz], and why others that should say one do not.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rates {
    pub(crate) said: Vec<(String, f64)>,
    pub(crate) odd: Vec<String>,
}

impl Rates {
    /// Numbers under a name, which is `shown` in messages.
    pub(crate) fn numbers(&mut self, shown: &str, name: &str, unit: Option<&str>, values: &[f64]) {
        match (odd_rate(name, unit, values), values.first().and_then(|x| rate_hz(name, unit, *x))) {
            (Some(why), _) => self.odd.push(format!("`{shown}` {why}")),
            (None, hz) => self.said.extend(hz.map(|hz| (shown.to_owned(), hz))),
        }
    }

    /// A text under a name, such as `48 kHz`.
    pub(crate) fn words(&mut self, name: &str, text: &str) {
        // Of two numbers the second may qualify the first: `25.6 kHz, decimated by 2`.
        let is_number = |c: char| c.is_ascii_digit() || ".,+-eE".contains(c);
        let behind = text.trim_start().trim_start_matches(is_number);
        let alone = !behind.contains(|c: char| c.is_ascii_digit());
        match csv::rate_hz(name, text).filter(|_| alone) {
            Some(hz) => self.said.push((name.to_owned(), hz)),
            None => self.odd.extend(odd_words(name, text)),
        }
    }

    /// The rate on which all agree, with notes on those that are odd, and on two that contradict each other.
    pub(crate) fn agreed(self, notes: &mut Vec<String>) -> Option<f64> {
        notes.extend(self.odd);
        let (name, first) = self.said.first()?;
        let other = self.said.iter().find(|(_, hz)| (hz / first - 1.0).abs() > SAME_RATE);
        let note = |(other, hz): &(String, f64)| {
            format!("`{name}` says {first} Hz and `{other}` says {hz} Hz: no rate is taken from them")
        };
        notes.extend(other.map(note));
        other.is_none().then_some(*first)
    }
}

/// Rates that differ by less than this part are one: clocks drift.
pub(crate) const SAME_RATE: f64 = 1e-3;

/// Whether a name is that of a time.
pub fn says_time(name: &str) -> bool {
    let word: String =
        name.rsplit('.').next().unwrap_or(name).chars().take_while(|c| c.is_alphabetic()).collect();
    let word = word.to_lowercase();
    const WORDS: &str = "t ts epoch unix utc stamp clock uhrzeit zeit temps tiempo tempo datum zeitstempel";
    word.starts_with("time") || matches!(word.as_str(), "date" | "datetime") || is_among(WORDS, &word)
}

/// Seconds from 1970 to 1990, and to 2060.
const DATES_S: std::ops::Range<f64> = 6.3e8..2.84e9;

/// The unit [s] in which a number is a date of our time from 1970 on; it is so in one unit only.
pub(crate) fn epoch_unit_s(value: f64) -> Option<f64> {
    [1.0, 1e-3, 1e-6, 1e-9].into_iter().find(|second| DATES_S.contains(&(value * second)))
}

/// A number [s] under a name, where that is the one of the time at which a channel begins.
pub(crate) fn start_s(name: &str, value: f64) -> Option<f64> {
    let key: String = name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect();
    let ends = TIMES.iter().flat_map(|(_, s, names)| names.split(' ').map(move |name| (name, *s)));
    if is_among(STARTS, &key) {
        return Some(value * epoch_unit_s(value).unwrap_or(1.0));
    }
    let (_, second) = ends
        .filter_map(|(unit, s)| Some((key.strip_suffix(unit)?, s)))
        .find(|(key, _)| is_among(STARTS, key) || OFFSETS.contains(key))?;
    Some(value * second)
}

/// A step from which on numbers without a unit are no seconds: vibration is sampled faster than a thousand
/// times a second, and times in milliseconds look the same.
pub(crate) const SLOWEST_S: f64 = 1e-3;

/// A rate is a round number more often than the digits of a step are exact.
pub(crate) fn rounded(hz: f64) -> f64 {
    let round = (hz * 10.0).round() / 10.0;
    if (hz / round - 1.0).abs() < 1e-6 { round } else { hz }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_names_and_units_of_rates() {
        for (name, unit, value) in [
            ("fs", None, 12_800.0),
            ("Fs", Some("Hz"), 12_800.0),
            ("SampleFrequency", None, 12_800.0),
            ("sampling_rate_kHz", None, 12.8),
            ("sr", Some("kHz"), 12.8),
            ("rate_hz", None, 12_800.0),
            ("dt", None, 1.0 / 12_800.0),
            ("dt_ms", None, 1e3 / 12_800.0),
            ("Sample interval", Some("us"), 1e6 / 12_800.0),
            ("wf_increment", None, 1.0 / 12_800.0),
        ] {
            let hz = rate_hz(name, unit, value).unwrap_or_else(|| panic!("{name}"));
            assert!((hz / 12_800.0 - 1.0).abs() < 1e-9, "{name}: {hz}");
        }
        // The shaft's rate, a step that is none in seconds, a unit that is not known.
        for (name, unit, value) in
            [("rate", None, 20.0), ("dt", None, 0.078), ("fs", Some("ticks"), 3.0), ("load", None, 270.0)]
        {
            assert_eq!(rate_hz(name, unit, value), None, "{name}");
        }
        for (name, text, says) in [
            ("sampling rate", "12.8 kHz", Some(12_800.0)),
            ("fs", " 12.8k", Some(12_800.0)),
            ("fs", "nan", None),
            ("load", "12800", None),
        ] {
            let (mut rates, mut notes) = (Rates::default(), Vec::new());
            rates.words(name, text);
            assert_eq!(rates.agreed(&mut notes), says, "{text}");
            assert_eq!(notes.iter().any(|note| note == "`fs` is NaN: no rate follows"), text == "nan");
        }
    }

    #[test]
    fn behaves_units_of_a_row() {
        for unit in [
            "m/s²", "mm/s2", "mm/s^2", "EU", "Volts", "mV/g", "ips", "µm/s", "gn", "mg", "%", "°C", "[x]",
            "1/min", "m/s**2",
        ] {
            assert!(is_unit(unit), "{unit}");
        }
        for name in ["acc", "Time", "x", "Kanal", "t/ms"] {
            assert!(!is_unit(name), "{name}");
        }
    }
}
