//! Which channels are times, and the sample rate that they say.
//!
//! Times rise evenly from sample to sample, to their last digit, and so do counts, and the angle of a shaft
//! that turns steadily: none of them is a signal. All samples are checked, a stretch at a time, because an
//! interruption of the record, or a joint, shows nowhere else.

mod packets;

use std::collections::BTreeMap;

pub use crate::units::says_time;
use crate::units::{self, NO_RATE, SAME_RATE, SLOWEST_S, Unit};
use crate::{Channel, Recording, Result, clock_columns};

/// Samples that are looked at together.
const STRETCH: usize = 1000;
/// Fewest samples that show how a channel rises.
const LEAST: usize = 10;
/// One in this many steps may be a gap.
const RARE: usize = 250;
/// How a channel rises.
#[derive(Debug, Default)]
struct Course {
    /// First and last sample that are numbers, with their places.
    first: (f64, f64),
    last: (f64, f64),
    /// Stretches in which it rises evenly, and others.
    even: usize,
    uneven: usize,
    gaps: Vec<Gap>,
    /// Sum of all gaps beyond their steps.
    jumped: f64,
    /// Where it first rises otherwise than before.
    change: Option<(f64, f64)>,
    /// First and last sample that differ from the one before, and how many do.
    first_new: Option<(f64, f64)>,
    last_new: (f64, f64),
    new: usize,
}

/// A step of time unlike all others.
#[derive(Debug, Clone, Copy)]
struct Gap {
    /// Place and value before it.
    after: (f64, f64),
    /// Its excess over a step.
    by: f64,
}

/// A stretch that rises evenly.
struct Stretch {
    step: f64,
    /// Largest part by which rounding may change the step.
    rounding: f64,
    gaps: Vec<Gap>,
}

/// Marks the channels that are no signals, and sets the rate of the others from the file: as a number beside
/// them, or by the times.
pub(crate) fn told(mut recording: Recording) -> Result<Recording> {
    let channels = &mut recording.channels;
    let mut courses = channels.iter().map(Course::of).collect::<Result<Vec<_>>>()?;
    for (channel, course) in channels.iter_mut().zip(&courses) {
        channel.is_time |=
            course.as_ref().is_some_and(|course| course.is_even() || says_time(own_name(channel)));
        if let (true, Unit::Time(unit, _)) = (channel.is_time, unit_of(channel)) {
            channel.unit = Some(unit.to_owned());
        }
    }
    for n in 0..channels.len() {
        let stands = courses[n].as_ref().is_some_and(Course::is_held) && is_clock(&channels[n]);
        if stands && let Some(note) = clock_columns::without_doubles(channels, n)? {
            recording.notes.push(note);
            courses = channels.iter().map(Course::of).collect::<Result<Vec<_>>>()?;
        }
    }
    let said = rates_said(channels, &mut recording.notes)?;
    for channel in channels.iter_mut().filter(|c| c.rate_hz.is_none()) {
        let beside = said.iter().filter(|(of, _)| of.is_empty() || *of == parent(&channel.name));
        // The one in the same struct before that of the file.
        channel.rate_hz = beside.max_by_key(|(of, _)| of.len()).map(|(_, hz)| *hz);
    }
    for told in packets::told(channels, &courses, &mut recording.notes)? {
        courses[told] = None;
    }
    for (of, start_s) in starts_said(channels)? {
        let own = |c: &&mut Channel| c.name == of || parent(&c.name) == of;
        channels.iter_mut().filter(|c| c.len > 1).filter(own).for_each(|c| c.start_s = Some(start_s));
    }
    let mut clocks: Vec<(u64, String)> = channels.iter().map(|c| (c.len, c.group.clone())).collect();
    clocks.sort_unstable();
    clocks.dedup();
    for (len, group) in clocks {
        let of_clock = |c: &Channel| c.len == len && c.group == group;
        let first = channels.iter().position(of_clock);
        let asked = channels.iter().any(|c| of_clock(c) && c.rate_hz.is_none());
        let rank = |n: usize| {
            let inside = channels[n].group == group;
            let rank = match unit_of(&channels[n]) {
                Unit::Time(..) => 0,
                Unit::Unsaid if says_time(own_name(&channels[n])) => 1,
                Unit::Unsaid if asked && first == Some(n) => 2,
                _ => return None,
            };
            // Its own clock before that of another group; MDF groups share none.
            (inside || !group.starts_with('#')).then_some((!inside, rank))
        };
        let of_time = |n: &usize| channels[*n].len == len && channels[*n].is_time;
        let clock = (0..channels.len()).filter(of_time).filter_map(|n| Some((rank(n)?, n))).min();
        let Some((n, course)) = clock.and_then(|(_, n)| Some((n, courses[n].as_ref()?))) else { continue };
        if channels[n].group != group && !asked {
            continue;
        }
        let rate_hz = course.rate_hz(&channels[n], asked, &mut recording.notes);
        let mut own = Vec::new();
        for k in (0..channels.len()).filter(|k| of_clock(&channels[*k]) && !channels[*k].is_time) {
            own.extend(own_clock(channels, &courses, n, k).map(|(m, course)| (k, m, course)));
        }
        for (k, m, course) in &own {
            let Some(course) = course else {
                recording.notes.push(format!(
                    "`{}` and `{}` count differently, and the file does not say which of them is the clock of `{}`: \
                     give the rate by hand",
                    channels[n].name, channels[*m].name, channels[*k].name
                ));
                continue;
            };
            let rate_hz = course.rate_hz(&channels[*m], asked, &mut recording.notes);
            channels[*k].start_s = channels[*k].start_s.or(rate_hz.and_then(|hz| course.start_s(hz)));
            channels[*k].rate_hz = channels[*k].rate_hz.or(rate_hz);
        }
        // The clock of another group says how fast, and not when.
        let start_s = rate_hz.filter(|_| channels[n].group == group).and_then(|hz| course.start_s(hz));
        for (k, channel) in channels.iter_mut().enumerate() {
            if channel.len != len || channel.group != group || own.iter().any(|(of, ..)| *of == k) {
                continue;
            }
            channel.start_s = channel.start_s.or(start_s);
            match (channel.rate_hz, rate_hz) {
                (None, _) => channel.rate_hz = rate_hz,
                (Some(said), Some(hz)) if (said / hz - 1.0).abs() > SAME_RATE && !channel.is_time => {
                    recording.notes.push(format!(
                        "`{}` has a rate of {said} Hz in the file, and its times say {hz} Hz: give the one that holds",
                        channel.name
                    ));
                    channel.rate_hz = None;
                }
                _ => {}
            }
        }
    }
    recording.notes.dedup();
    if !channels.iter().any(|c| c.len > 1 && !c.is_time && c.rate_hz.is_some()) {
        for (channel, _) in
            channels.iter().zip(&courses).filter(|(channel, course)| course.is_none() && !channel.is_time)
        {
            if is_clock(channel) && channel.len >= LEAST as u64 {
                recording.notes.extend(packets::why_uneven(channel)?);
            }
        }
    } else {
        recording.notes.retain(|note| !note.ends_with(NO_RATE));
    }
    Ok(recording)
}

/// The clock of one channel among those of a table, where it is another one than `main`: it counts the same time,
/// and is called after the channel, as `time_tacho` is after `tacho` and `time2` after `acc2`, or is the last before it
/// with a signal between it and `main`. Without a course where the file does not say which it is.
fn own_clock<'a>(
    channels: &[Channel],
    courses: &'a [Option<Course>],
    main: usize,
    of: usize,
) -> Option<(usize, Option<&'a Course>)> {
    let (all, name) = (courses[main].as_ref()?, own_name(&channels[of]).to_lowercase());
    let counts_same = |n: &usize| {
        let clock = &channels[*n];
        let is_other = |c: &Course| {
            let ends = |c: &Course| (c.first.1, c.last.1);
            ends(c) != ends(all) && c.first.1 < all.last.1 && all.first.1 < c.last.1
        };
        *n != main
            && (clock.len, &clock.group) == (channels[of].len, &channels[of].group)
            && clock.is_time
            && is_clock(clock)
            && unit_of(clock) == unit_of(&channels[main])
            && courses[*n].as_ref().is_some_and(is_other)
    };
    let number = |name: &str| {
        let from = name.chars().skip_while(|c| !c.is_ascii_digit());
        from.take_while(char::is_ascii_digit).collect::<String>()
    };
    let is_called = |n: &usize| {
        let clock = own_name(&channels[*n]).to_lowercase();
        let same = number(&clock) == number(&name) && !number(&name).is_empty();
        same || clock.split(|c: char| !c.is_alphanumeric()).any(|word| word == name)
    };
    if is_called(&main) {
        return None;
    }
    let clocks = || (0..channels.len()).filter(counts_same);
    let between = |near: &usize| (main..*near).any(|n| !channels[n].is_time);
    let before = || clocks().rfind(|n| *n < of).filter(between);
    if let Some(found) = clocks().find(is_called).or_else(before) {
        return Some((found, courses[found].as_ref()));
    }
    let step = |c: &Course| (c.last.1 - c.first.1) / (c.last.0 - c.first.0);
    let differs =
        |n: &usize| courses[*n].as_ref().is_some_and(|c| (step(c) / step(all) - 1.0).abs() > SAME_RATE);
    clocks().filter(|n| *n < of).find(differs).map(|n| (n, None))
}

/// Whether name or unit are those of a time.
pub(crate) fn is_clock(channel: &Channel) -> bool {
    matches!(unit_of(channel), Unit::Time(..)) || says_time(own_name(channel))
}

/// Sample rates [Hz] that are numbers of their own, or columns of one number, each with its struct; those that
/// contradict each other, or are none, are noted.
fn rates_said(channels: &[Channel], notes: &mut Vec<String>) -> Result<Vec<(String, f64)>> {
    let mut said: BTreeMap<&str, units::Rates> = BTreeMap::new();
    let says = |c: &&Channel| {
        c.len < LEAST as u64 && units::rate_hz(member(&c.name), c.unit.as_deref(), 1e-3).is_some()
    };
    for channel in channels.iter().filter(says) {
        let mut values = channel.read()?;
        if values.iter().all(|x| Some(x) == values.first()) {
            values.truncate(1);
        }
        let rates = said.entry(parent(&channel.name)).or_default();
        rates.numbers(&channel.name, member(&channel.name), channel.unit.as_deref(), &values);
    }
    Ok(said.into_iter().filter_map(|(of, rates)| Some((of.to_owned(), rates.agreed(notes)?))).collect())
}

/// Times of beginning [s] that are numbers of their own, each with the struct or the channel that it is of:
/// `tacho.t0`, `tacho_start_s`.
fn starts_said(channels: &[Channel]) -> Result<Vec<(String, f64)>> {
    let mut said = Vec::new();
    for channel in channels.iter().filter(|c| c.len == 1) {
        let value = channel.read()?.first().copied().unwrap_or(f64::NAN);
        let start_s = |name| units::start_s(name, value);
        let of_struct = start_s(member(&channel.name)).map(|s| (parent(&channel.name), s));
        let of_name = || {
            let (before, key) = channel.name.match_indices('_').find_map(|(at, _)| {
                let (before, key) = (&channel.name[..at], &channel.name[at + 1..]);
                let is_there = || channels.iter().any(|c| c.len > 1 && c.name == before);
                (start_s(key).is_some() && is_there()).then_some((before, key))
            })?;
            Some((before, start_s(key)?))
        };
        // One for all shifts none of them.
        let found = of_struct.filter(|(of, _)| !of.is_empty()).or_else(of_name);
        said.extend(found.filter(|(_, s)| s.is_finite()).map(|(of, s)| (of.to_owned(), s)));
    }
    Ok(said)
}

/// The structs around a name.
fn parent(name: &str) -> &str {
    name.rsplit_once('.').map_or("", |(parent, _)| parent)
}

/// The name without them.
fn member(name: &str) -> &str {
    name.rsplit('.').next().unwrap_or(name)
}

fn unit_of(channel: &Channel) -> Unit {
    Unit::of(own_name(channel), channel.unit.as_deref())
}

/// The name without the group of TDMS before it: `rig/t/ms` of the group `/'rig'` is `t/ms`.
fn own_name(channel: &Channel) -> &str {
    let group = channel.group.trim_start_matches('/').trim_matches('\'').replace("''", "'");
    let own = channel.name.strip_prefix(&group).and_then(|rest| rest.strip_prefix('/'));
    own.filter(|_| !group.is_empty()).unwrap_or(&channel.name)
}

impl Course {
    /// How a channel rises; `None` for one that does not.
    fn of(channel: &Channel) -> Result<Option<Self>> {
        if channel.len < LEAST as u64 {
            return Ok(None);
        }
        let (mut course, mut rises, mut row) = (Self::default(), true, 0.0);
        let (mut step, mut held) = (None, Vec::with_capacity(STRETCH + LEAST + 1));
        let read = channel.for_each_block(|block| {
            for &value in block {
                if value.is_finite() {
                    held.push((row, value));
                }
                row += 1.0;
                // The last stretch is long enough to show its slope, too.
                if held.len() > STRETCH + LEAST {
                    rises = course.add(&held[..=STRETCH], &mut step);
                    // The next begins with the last of this one.
                    held.drain(..STRETCH);
                }
                if !rises {
                    break;
                }
            }
            rises
        });
        if course.even == 0 && read.is_err() {
            // Unreadable samples are reported where they are needed.
            return Ok(None);
        }
        read?;
        if rises && held.len() >= LEAST {
            rises = course.add(&held, &mut step);
        }
        Ok((rises && course.even + course.uneven > 0).then_some(course))
    }

    /// Takes a stretch, as places and values; false where it falls. `step` is that of the first even one.
    fn add(&mut self, values: &[(f64, f64)], step: &mut Option<f64>) -> bool {
        let [first, .., last] = values else { return true };
        let falls = values.windows(2).filter(|w| w[1].1 < w[0].1).count();
        if last.1 <= first.1 && falls == 0 || falls > (values.len() / RARE).max(1) {
            return false;
        }
        if self.even + self.uneven == 0 {
            self.first = *first;
        }
        self.last = *last;
        for pair in values.windows(2).filter(|pair| pair[1].1 != pair[0].1) {
            self.first_new.get_or_insert(pair[1]);
            self.last_new = pair[1];
            self.new += 1;
        }
        let Some(stretch) = Stretch::of(values) else {
            self.uneven += 1;
            self.change.get_or_insert(*first);
            return true;
        };
        self.even += 1;
        self.jumped += stretch.gaps.iter().map(|gap| gap.by).sum::<f64>();
        self.gaps.extend(stretch.gaps);
        let before = *step.get_or_insert(stretch.step);
        if (stretch.step / before - 1.0).abs() > SAME_RATE + stretch.rounding {
            self.change.get_or_insert(*first);
        }
        true
    }

    fn is_even(&self) -> bool {
        self.even > self.uneven
    }

    /// Between which samples the rate is counted. Where a stamp stands for several samples, these are the first
    /// that have theirs: the last stamp may stand for fewer samples than the others.
    fn ends(&self) -> [(f64, f64); 2] {
        match self.first_new {
            Some(first) if self.is_held() && self.last_new.0 > first.0 => [first, self.last_new],
            _ => [self.first, self.last],
        }
    }

    /// Whether a stamp stands for two samples or more, somewhere.
    fn is_held(&self) -> bool {
        (self.new as f64) < self.last.0 - self.first.0
    }

    /// When the first sample was taken [s], by times that rise `rate_hz` times a second.
    fn start_s(&self, rate_hz: f64) -> Option<f64> {
        let [first, last] = self.ends();
        let step = (last.1 - first.1 - self.jumped) / (last.0 - first.0);
        Some(first.1 / (step * rate_hz) - first.0 / rate_hz).filter(|s| s.is_finite())
    }

    /// The sample rate [Hz] from times, with notes on irregularities, also on their unit if it is `asked`
    /// for.
    fn rate_hz(&self, times: &Channel, asked: bool, notes: &mut Vec<String>) -> Option<f64> {
        let (name, unit) = (&times.name, unit_of(times));
        let (spelt, second) = if let Unit::Time(spelt, second) = unit { (spelt, second) } else { ("", 1.0) };
        let at = |(row, value): (f64, f64)| {
            format!("row {} ({value:.6} {spelt}", row + 1.0).trim_end().to_owned() + ")"
        };
        let [first, last] = self.ends();
        let (rows, span) = (last.0 - first.0, last.1 - first.1 - self.jumped);
        if let Some(from) = self.change {
            let each = (self.last.0 - self.first.0) / self.new as f64;
            if each > 1.5 && from.0 == self.first.0 && span > 0.0 {
                notes.push(packets::arrive(name, each, rows / (span * second)));
                return None;
            }
            let what = if from.0 == self.first.0 {
                "from the beginning on: give the rate by hand if only the times are uneven, or cut that part \
                 off"
                .to_owned()
            } else {
                format!(
                    "from about {} on: cut the file there and take the longer part, or give the rate by hand \
                     if it does not change",
                    at(from)
                )
            };
            notes.push(format!("the times of `{name}` are uneven, or their rate changes, {what}"));
            return None;
        }
        let step = span / rows;
        if let Some(gap) = self.gaps.first() {
            let (missing, more) = ((gap.by / step).round(), self.gaps.len() - 1);
            let what = if gap.by > 0.0 {
                format!("missing samples: {missing}")
            } else {
                "they fall back".to_owned()
            };
            let more = if more > 0 { format!(", and so at {more} more places") } else { String::new() };
            notes.push(format!(
                "the times of `{name}` have a gap after {}: {what}{more}. Impacts before and after it do not \
                 line up: cut the file there and take the longer part",
                at(gap.after)
            ));
        }
        let hz = units::rounded(rows / (span * second));
        // Stamps that stand for several samples say their places to a sample.
        let round = (hz / 100.0).round() * 100.0;
        let hz = if self.is_held() && (hz / round - 1.0).abs() < 1.0 / rows { round } else { hz };
        if asked && unit == Unit::Unsaid {
            // Excel counts days from 1900 on, MATLAB from the year 0.
            let date = (20_000.0..80_000.0).contains(&self.first.1) || (7e5..8e5).contains(&self.first.1);
            if date && step * 86_400.0 < SLOWEST_S {
                let hz = units::rounded(1.0 / (step * 86_400.0));
                notes.push(format!("`{name}` counts days, as Excel and MATLAB do: {hz} Hz"));
                return Some(hz);
            }
            if let Some(second) = units::epoch_unit_s(self.first.1).filter(|second| *second < 1.0) {
                let hz = units::rounded(1.0 / (step * second));
                notes.push(format!("`{name}` counts steps of {second} s from 1970 on: {hz} Hz"));
                return Some(hz);
            }
            let slow = step > SLOWEST_S * (1.0 + SAME_RATE);
            let means = if slow && step < 1.0 {
                format!(
                    "{hz} Hz if these are seconds, {} Hz if they are milliseconds: no rate follows",
                    1e3 * hz
                )
            } else if slow {
                "no rate follows".to_owned()
            } else {
                format!("{hz} Hz if these are seconds")
            };
            notes.push(format!(
                "`{name}` rises by {step:.6} from sample to sample, and does not say its unit: {means}. Call \
                 it `t [ms]` or the like if it is the time in another one"
            ));
            return (!slow).then_some(hz);
        }
        Some(hz).filter(|hz| hz.is_finite() && *hz > 0.0)
    }
}

impl Stretch {
    /// `None` for values that do not rise evenly: apart from gaps, each must lie within a step of the line,
    /// or within the last digit, where that is coarser than a step.
    fn of(values: &[(f64, f64)]) -> Option<Self> {
        let (first, last) = (values.first()?, values.last()?);
        // The rise over a quarter of the values, in the middle: few gaps do not move it.
        let lag = values.len() / 4;
        let slopes = values.iter().zip(&values[lag..]).map(|(a, b)| (b.1 - a.1) / (b.0 - a.0));
        let step = middle(slopes.collect(), 2)?;
        let over = |w: &[(f64, f64)]| w[1].1 - w[0].1 - step * (w[1].0 - w[0].0);
        // Rounding moves many steps, gaps are rare.
        let usual = middle(values.windows(2).map(|w| over(w).abs()).collect(), RARE)?;
        // A late sample is followed by a shorter step.
        let is_late =
            |n: usize| values.get(n..n + 3).is_some_and(|w| w[2].1 - w[0].1 < step * (w[2].0 - w[0].0 + 0.5));
        let is_gap = |n: &usize| {
            let w = &values[*n..n + 2];
            w[1].1 < w[0].1 || over(w) > (0.5 * step).max(1.01 * usual) && !is_late(*n)
        };
        let gap = |n: usize| Gap { after: values[n], by: over(&values[n..n + 2]) };
        let gaps: Vec<Gap> = (0..values.len() - 1).filter(is_gap).map(gap).collect();
        let jumped: f64 = gaps.iter().map(|gap| gap.by).sum();
        let rows = last.0 - first.0;
        let without = (last.1 - first.1 - jumped) / rows;
        if (without / step - 1.0).abs() > 0.5 {
            // The gaps are how it rises.
            return None;
        }
        let step = without;
        let rises = values.windows(2).map(|w| w[1].1 - w[0].1).filter(|rise| *rise > 0.0);
        let tolerance = rises.fold(f64::INFINITY, f64::min).max(step);
        let (mut at, mut jumped) = (0, 0.0);
        let even = values.iter().all(|value| {
            while gaps.get(at).is_some_and(|gap| gap.after.0 < value.0) {
                jumped += gaps[at].by;
                at += 1;
            }
            (value.1 - jumped - first.1 - step * (value.0 - first.0)).abs() < tolerance
        });
        (step > 0.0 && even).then_some(Self { step, rounding: 2.0 * tolerance / (rows * step), gaps })
    }
}

/// The number that one of `parts` of all exceed, two at least.
fn middle(mut numbers: Vec<f64>, parts: usize) -> Option<f64> {
    let at = numbers.len().checked_sub(1 + (numbers.len() / parts).max(2))?;
    Some(*numbers.select_nth_unstable_by(at, f64::total_cmp).1)
}
