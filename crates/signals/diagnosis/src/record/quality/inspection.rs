//! The inspection of samples as they are read: each finding that needs no spectrum, and its words.

use super::flat::{self, Flat, Run};
use super::histogram::Histogram;
use super::rails::{Rail, Rails};
use super::similarity::{self, Pattern, Repeats};
use super::{Kind, Quality, jumps, median, percent};

/// Stretches over which mean and level are followed, at most, and the shortest [s].
const STRETCHES: usize = 200;
const SHORTEST_S: f64 = 0.1;

/// Sums over a stretch of the record.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Stretch {
    count: f64,
    sum: f64,
    /// Of the samples, of their steps, and of the steps of these.
    squares: [f64; 3],
}

impl Stretch {
    pub(super) fn mean(&self) -> f64 {
        self.sum / self.count
    }

    fn deviation(&self) -> f64 {
        self.spreads()[0]
    }

    /// Root mean squares about the mean of the samples, of their steps, and of the steps of these.
    pub(super) fn spreads(&self) -> [f64; 3] {
        let [samples, steps, bends] = self.squares.map(|of| of / self.count);
        [samples - self.mean().powi(2), steps, bends].map(|square| square.max(0.0).sqrt())
    }
}

/// Stretches that stand still.
#[derive(Debug, Default)]
struct Stays {
    /// At the least or the largest value.
    at_rail: Vec<Run>,
    /// From the beginning, or to the end.
    ends: Vec<Run>,
    /// All others.
    gaps: Vec<Run>,
}

/// Part of the record from which on a channel that stands still at its end is dead.
const LEAST_END: f64 = 0.01;

/// An inspection in the making.
#[derive(Debug)]
pub(crate) struct Inspection {
    rate_hz: f64,
    values: Rails,
    steps: Rails,
    flat: Flat,
    /// Steps: straight lines have equal ones.
    lines: Flat,
    stretches: Vec<Stretch>,
    /// Samples of a stretch.
    length: usize,
    /// First value, from which stretches count, the last one, and the step to it.
    origin: Option<f64>,
    last: Option<f64>,
    step: f64,
    count: u64,
}

impl Inspection {
    /// Of a record of `len` samples.
    pub(crate) fn new(rate_hz: f64, len: usize) -> Self {
        let longest = (len as f64 / rate_hz / SHORTEST_S) as usize;
        let length = len.div_ceil(longest.clamp(8, STRETCHES)).max(1);
        Self {
            rate_hz,
            values: Rails::with_levels(),
            steps: Rails::default(),
            flat: Flat::default(),
            lines: Flat::default(),
            stretches: vec![Stretch::default(); len.div_ceil(length).max(1)],
            length,
            origin: None,
            last: None,
            step: 0.0,
            count: 0,
        }
    }

    /// Samples as they follow.
    pub(crate) fn add(&mut self, block: &[f64]) {
        for &x in block {
            let at = self.count;
            self.count += 1;
            if !x.is_finite() {
                self.flat.interrupt();
                self.lines.interrupt();
                self.last = None;
                continue;
            }
            let is_new = self.last != Some(x);
            self.values.add(x, is_new);
            self.flat.add(x, at, is_new, self.values.is_extreme(x));
            let place = (at as usize / self.length).min(self.stretches.len() - 1);
            let stretch = &mut self.stretches[place];
            if let Some(last) = self.last
                && (x - last).is_finite()
            {
                self.steps.add(x - last, true);
                let reach = flat::ROUNDING * (last.abs() + (x - last).abs()) + f64::MIN_POSITIVE;
                let goes_on = self.lines.goes_on(x - last, reach);
                self.lines.add(x - last, at, !goes_on, false);
                stretch.squares[1] += (x - last).powi(2);
                stretch.squares[2] += (x - last - self.step).powi(2);
                self.step = x - last;
            }
            self.last = Some(x);
            let d = x - *self.origin.get_or_insert(x);
            stretch.count += 1.0;
            stretch.sum += d;
            stretch.squares[0] += d * d;
        }
    }

    /// The findings that need no spectrum; `kept` are the first samples.
    pub(crate) fn finish(mut self, kept: &[f64]) -> Vec<Quality> {
        self.flat.interrupt();
        self.lines.interrupt();
        let few = self.values.few_levels();
        let Stays { at_rail, ends, gaps } = self.stays(few.is_some());
        let rails = self.rails(few.is_some(), &[&ends[..], &gaps].concat());
        // Where the channel stands still at an end of the record it says nothing of the rest.
        let from = ends.iter().filter(|run| run.from_start).map(|run| run.count as usize).max().unwrap_or(0);
        let to =
            ends.iter().filter(|run| run.to_end).map(|run| run.from as usize).min().unwrap_or(kept.len());
        let live = kept.get(from..to.min(kept.len())).unwrap_or(&[]);
        let mut found = self.no_signal(live, from, &rails, few.is_some());
        // Values at both ends of numbers without their sign stand at no rail, nor do marks.
        if found.iter().all(|of| !matches!(of.kind, Kind::SignLost | Kind::Marked)) {
            found.extend(self.clipped(&rails, &at_rail));
        }
        found.extend(ends.iter().map(|run| self.dead(run)));
        if few.is_none() && found.iter().all(|of| of.kind != Kind::Marked) {
            found.extend(self.held(&gaps));
        }
        found.extend(self.straight());
        let silent = if ends.is_empty() { self.silent() } else { None };
        if ends.is_empty() && gaps.is_empty() && silent.is_none() {
            found.extend(self.jump());
        }
        found.extend(silent);
        match few {
            Some(levels) => found.push(self.coarse(levels)),
            // A gap makes steps of its own.
            None if found.is_empty() => found.extend(self.slewing()),
            None => {}
        }
        // What was filled in moves the mean, too.
        if found.iter().all(|of| !matches!(of.kind, Kind::Held | Kind::Dead | Kind::Jump)) {
            found.extend(self.drift());
        }
        found
    }

    /// By which the samples, `from` the given one on, are no record of a signal.
    fn no_signal(&self, kept: &[f64], from: usize, rails: &[Rail], few_levels: bool) -> Vec<Quality> {
        let Some(histogram) = Histogram::of(kept) else { return Vec::new() };
        let whole = |kind, words: String| self.quality(kind, 1.0, 0, words);
        if let Some((period, rise)) = similarity::counter(kept) {
            return vec![whole(
                Kind::Pattern,
                format!(
                    "a counter: in every {period} samples the values rise evenly by {} and fall back at once, as a count \
                     of samples or of bytes does; it stands in place of a signal, or lies over it. Take the channel \
                     of the sensor, or read the file with the layout of its recorder",
                    spelt(rise)
                ),
            )];
        }
        if histogram.is_of_another_format() {
            return vec![whole(Kind::Swapped, "values over more decades than a sensor has: the bytes of the numbers stand in the other \
                order, or they are numbers of another format. Read them with the order of bytes of their recorder".to_owned())];
        }
        let repeats = similarity::repeats(kept);
        // A gap, or a glitch, says nothing of places.
        let (low, high) = histogram.usual();
        let usual: Vec<f64> = kept.iter().map(|x| x.clamp(low, high)).collect();
        let values: Vec<f64> = rails.iter().map(|rail| rail.value).collect();
        let marks = if few_levels { None } else { self.marks(kept, &histogram, &values) };
        // Of few levels some places have more by chance, and so they do of marks.
        let is_waveform = repeats.is_some_and(|repeats| repeats.is_waveform);
        let pattern = self.pattern(&usual, !few_levels && !is_waveform && marks.is_none());
        let mut found: Vec<Quality> = pattern.into_iter().collect();
        found
            .extend(repeats.filter(|_| !is_waveform).map(|repeats| self.repeated(kept.len(), from, repeats)));
        if found.is_empty() {
            found.extend(marks);
        }
        let quantum = histogram.quantum();
        let is_apart = rails.is_empty() && !few_levels;
        let piled = is_apart.then(|| similarity::piled(kept, quantum.unwrap_or(0.0))).flatten();
        let across = jumps::crossings(kept, histogram.range());
        if let Some(share) = piled {
            found.push(self.quality(Kind::DriftingRails, share, 0, format!(
                "clipped at rails that drift: {} of the samples pile up at the highest or the lowest value of their \
                 neighbourhood; levels, crest and kurtosis are not those of the machine. Measure again with a larger \
                 range",
                percent(share)
            )));
        } else if found.is_empty() && (rails.is_empty() || histogram.is_hollow()) {
            found.extend(self.wrapped(kept, &histogram, quantum, across));
        }
        if found.is_empty() && rails.is_empty() && histogram.is_one_sided() {
            found.push(whole(
                Kind::SignLost,
                "sign lost: all values lie on one side of zero, and most of them near it, as those of a \
                rectified signal do. Record the signal itself, with its sign"
                    .to_owned(),
            ));
        }
        found
    }

    /// Samples that stand many times, zeros between samples, channels one after the other.
    fn pattern(&self, kept: &[f64], may_differ: bool) -> Option<Quality> {
        let (places, kind) =
            similarity::pattern(kept).filter(|(_, kind)| *kind != Pattern::Unlike || may_differ)?;
        let lower = self.rate_hz / places as f64;
        let words = match kind {
            Pattern::Held => format!(
                "samples held: each stands {places} times. Keep one of {places}, and give the rate of {} Hz",
                spelt(lower)
            ),
            Pattern::Stuffed => format!(
                "one value between samples: of each {places} samples some are always the same. Keep the others, and \
                 give the rate of {} Hz",
                spelt(lower)
            ),
            Pattern::Unlike => format!(
                "every {places} samples a pattern recurs: channels that stand one after the other, or samples between \
                 which others were interpolated. Keep one of {places}, and give the rate of {} Hz",
                spelt(lower)
            ),
        };
        Some(self.quality(Kind::Pattern, 1.0 - 1.0 / places as f64, 0, words))
    }

    /// Stretches that stand twice.
    fn repeated(&self, of: usize, from: usize, repeats: Repeats) -> Quality {
        let Repeats { samples, first, lag, .. } = repeats;
        let (share, first) = (samples as f64 / of as f64, from + first);
        let words = format!(
            "repeated: {} of the samples stand a second time, to the last bit, the first of them {lag} samples behind \
             their like; a recorder wrote a buffer twice. Cut the record at {:.4} s",
            percent(share),
            first as f64 / self.rate_hz
        );
        self.quality(Kind::Repeated, share, first as u64, words)
    }

    /// Values that are too frequent to be measured.
    fn marks(&self, kept: &[f64], histogram: &Histogram, rails: &[f64]) -> Option<Quality> {
        let marks = histogram.marks(kept, rails);
        let share = marks.iter().map(|(_, samples)| self.part(*samples as u64)).sum::<f64>();
        let each: Vec<String> = marks
            .iter()
            .map(|(value, samples)| format!("{samples} samples are exactly {}", spelt(*value)))
            .collect();
        let words = format!(
            "one value too often: {}, as no other value is; a mark of missing samples, or what a dead zone leaves, \
             which looks like impacts. Leave the field empty in their place",
            each.join(" and ")
        );
        (!marks.is_empty()).then(|| self.quality(Kind::Marked, share, 0, words))
    }

    /// Values that leave the range at one end and come back at the other.
    fn wrapped(
        &self,
        kept: &[f64],
        histogram: &Histogram,
        quantum: Option<f64>,
        across: usize,
    ) -> Option<Quality> {
        let (low, high) = (histogram.quantile(0.0), histogram.quantile(1.0));
        let full = quantum.and_then(|quantum| jumps::full_range(low, high, quantum));
        let share = across as f64 / kept.len() as f64;
        let hollow = histogram.is_hollow() && share > 0.01;
        // What wraps has a converter's steps; noise that was made is as dense at its ends as in the middle.
        let is_wrapped = full.is_some() || quantum.is_some() && histogram.is_domed();
        let breaks_off = histogram.breaks_off() && is_wrapped && share > 1e-3;
        if !hollow && !breaks_off && (full.is_none() || across < ACROSS) {
            return None;
        }
        let unsigned = |bits: i32| {
            let all = f64::from(bits).exp2() * quantum.unwrap_or(1.0);
            format!("subtract {} above {}", spelt(all), spelt(0.5 * all - quantum.unwrap_or(1.0)))
        };
        let (kind, words) = if hollow {
            let cure = full.filter(|(_, is_unsigned)| *is_unsigned).map_or_else(
                || format!("subtract the range of its numbers above {}", spelt(0.5 * (low + high))),
                |(bits, _)| unsigned(bits),
            );
            (
                Kind::SignLost,
                format!(
                    "sign lost: values stand at both ends of the range, {} to {}, and none between, as those of signed \
                 numbers that were read as unsigned: {cure}",
                    spelt(low),
                    spelt(high)
                ),
            )
        } else if let Some(bytes) = quantum.filter(|_| breaks_off).and_then(|q| jumps::swapped_bytes(kept, q))
        {
            (
                Kind::Swapped,
                format!(
                    "bytes swapped: all values from {} to {} are as frequent, and with the {bytes} bytes of each number in \
                 the other order they lie near each other. Read the file with the other order of bytes",
                    spelt(low),
                    spelt(high)
                ),
            )
        } else {
            (
                Kind::Wrapped,
                format!(
                    "wrapped: {across} steps lead from one end of the range, {} to {}, to the other, and no value piles up \
                 there: what lies beyond one end was written at the other. Measure with a smaller gain, or convert \
                 with more bits",
                    spelt(low),
                    spelt(high)
                ),
            )
        };
        Some(self.quality(kind, share, 0, words))
    }

    /// A gain or an offset that changed.
    fn jump(&self) -> Option<Quality> {
        let full: Vec<Stretch> =
            self.stretches.iter().filter(|s| s.count >= 0.5 * self.length as f64).copied().collect();
        let usual = median(&full.iter().map(Stretch::deviation).collect::<Vec<_>>())?;
        let (at, what) = jumps::gain(&full)
            .map(|(at, ratio)| {
                (at, format!("gain changed: all frequencies are {} times as strong", spelt(ratio)))
            })
            .or_else(|| {
                let (at, by) = jumps::offset(&full, usual)?;
                Some((at, format!("offset changed: the mean moves by {}", spelt(by))))
            })?;
        let from = at * self.length;
        let words = format!(
            "{what} from {:.2} s on, at once and for good, as an amplifier or a recorder does it. Cut the record there",
            from as f64 / self.rate_hz
        );
        Some(self.quality(Kind::Jump, self.part(self.count.saturating_sub(from as u64)), from as u64, words))
    }

    /// The stretches that stand still, by what they mean.
    fn stays(&self, few_levels: bool) -> Stays {
        let least = LEAST_END * self.count as f64;
        let mut stays = Stays::default();
        for run in self.flat.stretches(self.count) {
            let at_end = run.to_end || run.from_start;
            // What fills gaps lies apart, where zero is no value of the signal, too.
            let is_rail = self.values.is_extreme(run.value) && !self.values.is_apart(run.value);
            if at_end && run.count as f64 > least {
                stays.ends.push(run);
            } else if is_rail && !at_end && !few_levels {
                stays.at_rail.push(run);
            } else {
                stays.gaps.push(run);
            }
        }
        stays
    }

    /// The rails, but for values at which the channel stands in gaps, or to the end.
    fn rails(&self, few_levels: bool, others: &[Run]) -> Vec<Rail> {
        let (low, high) = self.values.clipped(self.flat.natural(), few_levels);
        let stands = |rail: &Rail| others.iter().any(|run| run.value == rail.value);
        [low, high].into_iter().flatten().filter(|rail| !stands(rail)).collect()
    }

    /// Samples at the ends of the range; a long stay there is clipping, too.
    fn clipped(&self, rails: &[Rail], at_rail: &[Run]) -> Option<Quality> {
        let held: u64 = at_rail.iter().map(|run| run.count).sum();
        let samples = held.max(rails.iter().map(|rail| rail.samples).sum());
        if samples == 0 {
            return None;
        }
        let places = rails.iter().map(|rail| (rail.first, rail.value));
        let places: Vec<(u64, f64)> = places.chain(at_rail.iter().map(|run| (run.from, run.value))).collect();
        let first = places.iter().map(|(first, _)| *first).min().unwrap_or(0);
        let mut values: Vec<String> = places.iter().map(|(_, value)| spelt(*value)).collect();
        values.dedup();
        values.truncate(2);
        let share = self.part(samples);
        let words = format!(
            "clipped: {} of the samples stand at {}, the end of the range; levels, crest and kurtosis are too \
             low, the clipping makes harmonics, and a length from two events is not to be trusted. Measure \
             again with a larger range",
            percent(share),
            values.join(" and ")
        );
        Some(self.quality(Kind::Clipped, share, first, words))
    }

    /// A channel that stands still at its beginning or to its end.
    fn dead(&self, run: &Run) -> Quality {
        let share = self.part(run.count);
        let words = format!(
            "dead channel: the {} {:.2} s ({} of the samples) stand at {}; there is no signal, and levels and \
             kurtosis are not those of the machine. Cut the record to its valid part",
            if run.to_end { "last" } else { "first" },
            run.count as f64 / self.rate_hz,
            percent(share),
            spelt(run.value)
        );
        self.quality(Kind::Dead, share, run.from, words)
    }

    /// Gaps that were filled with one value, or with the last one.
    fn held(&self, gaps: &[Run]) -> Option<Quality> {
        let first = gaps.first()?;
        let longest = gaps.iter().map(|run| run.count).max().unwrap_or(0);
        let with = if gaps.iter().any(|run| run.value != first.value) {
            "the value before, as a recorder bridges gaps".to_owned()
        } else if first.value == 0.0 {
            "zero, as a recorder fills gaps".to_owned()
        } else {
            format!("{}, as a recorder marks gaps", spelt(first.value))
        };
        self.filled(gaps, &format!("of up to {longest} samples"), &format!("stand still at {with}"))
    }

    /// Gaps that were filled with straight lines.
    fn straight(&self) -> Option<Quality> {
        let length = format!("of {} samples and more", flat::STRAIGHT);
        self.filled(
            &self.lines.of_at_least(flat::STRAIGHT),
            &length,
            "are straight lines, as a recorder bridges gaps",
        )
    }

    /// Gaps of a length that were filled in some way.
    fn filled(&self, gaps: &[Run], length: &str, how: &str) -> Option<Quality> {
        let first = gaps.first()?;
        let share = self.part(gaps.iter().map(|run| run.count).sum());
        let words = format!(
            "filled gaps: {} {length} ({} of the samples) {how}; there is no signal in them, and levels and kurtosis \
             are not those of the machine. Leave the field empty in their place, or cut the record there",
            stretches(gaps.len()),
            percent(share)
        );
        Some(self.quality(Kind::Held, share, first.from, words))
    }

    /// A converter of a few levels.
    fn coarse(&self, levels: usize) -> Quality {
        let words = format!(
            "few levels: {levels} values make up 99 % of all samples; the converter hardly resolves the \
             signal, and its steps make noise and lines of their own. Measure again with a smaller range or a \
             more sensitive sensor"
        );
        self.quality(Kind::FewLevels, 1.0, 0, words)
    }

    /// Steps from sample to sample that pile up at the largest, upwards and downwards.
    fn slewing(&self) -> Option<Quality> {
        let (Some(up), Some(down)) = self.steps.clipped(1, false) else { return None };
        let share = self.part(up.samples + down.samples);
        let rate = 0.5 * (up.value - down.value).abs() * self.rate_hz;
        let words = format!(
            "limited slew rate: {} of the steps from sample to sample are the largest, {} a second; the \
             amplifier cannot follow the signal, levels are too low, and lines of its own appear. Use a \
             smaller gain, or an amplifier that is faster",
            percent(share),
            spelt(rate)
        );
        let first = up.first.min(down.first);
        (share > SLEWING).then(|| self.quality(Kind::SlewLimited, share, first, words))
    }

    /// A number of samples as a part of all.
    fn part(&self, samples: u64) -> f64 {
        samples as f64 / self.count.max(1) as f64
    }

    fn quality(&self, kind: Kind, share: f64, first: u64, words: String) -> Quality {
        Quality { kind, share, first_s: first as f64 / self.rate_hz, words }
    }

    /// Level from which on a channel is silent, over that of most of the record, and how much of it must be.
    fn silent(&self) -> Option<Quality> {
        let deviations: Vec<f64> =
            self.stretches.iter().filter(|s| s.count > 1.0).map(Stretch::deviation).collect();
        let usual = median(&deviations)?;
        let quiet = |d: &&f64| **d < SILENT * usual;
        let first = deviations.iter().take_while(quiet).count();
        let last = deviations.iter().rev().take_while(quiet).count();
        let (count, from, side) =
            if last >= first { (last, deviations.len() - last, "last") } else { (first, 0, "first") };
        let share = count as f64 / deviations.len() as f64;
        (share > 0.05).then(|| {
            let seconds = (count * self.length) as f64 / self.rate_hz;
            self.quality(Kind::Dead, share, (from * self.length) as u64, format!(
                "dead channel: the {side} {seconds:.2} s ({} of the samples) have less than a hundredth of \
                 the level of the rest; the machine stood still, or the sensor came loose. Cut the record \
                 to its valid part",
                percent(share)
            ))
        })
    }

    /// A mean that moves by more than the signal swings.
    fn drift(&self) -> Option<Quality> {
        let some: Vec<&Stretch> =
            self.stretches.iter().filter(|s| s.count >= 0.5 * self.length as f64).collect();
        if some.len() < 8 || (self.length as f64) < SHORTEST_S * self.rate_hz {
            return None;
        }
        let deviations: Vec<f64> = some.iter().map(|s| s.deviation()).collect();
        let usual = median(&deviations)?;
        // Over an eighth of the record each, so that one impact or step inside moves it little.
        let eighth = some.len() / 8;
        let mean = |part: &[&Stretch]| part.iter().map(|s| s.mean()).sum::<f64>() / part.len() as f64;
        let means: Vec<f64> = some.chunks(eighth).filter(|c| c.len() == eighth).map(mean).collect();
        let (low, high) =
            means.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), m| (l.min(*m), h.max(*m)));
        (usual > 0.0 && high - low > DRIFTING * usual).then(|| {
            self.quality(
                Kind::Drift,
                1.0,
                0,
                format!(
                    "drifting mean: it moves by {} over the record, {:.1} times the root mean square of the \
                 signal about it; the sensor warms up, or its bias is not settled. Levels about the mean of \
                 the whole record are too high",
                    spelt(high - low),
                    (high - low) / usual
                ),
            )
        })
    }
}

/// Fewest steps across a range that whole numbers of a width fill: of valid ones one or two are as large by chance.
const ACROSS: usize = 8;
/// Share of steps at the largest ones from which on the slew rate is limited.
const SLEWING: f64 = 0.02;
/// Part of the usual level below which a stretch is silent.
const SILENT: f64 = 0.01;
/// How far the mean moves over the usual root mean square.
const DRIFTING: f64 = 3.0;

fn stretches(count: usize) -> String {
    if count == 1 { "1 stretch".to_owned() } else { format!("{count} stretches") }
}

/// A value with six digits, a whole number with all of its.
fn spelt(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    match value.abs() {
        1e15.. => format!("{rounded:e}"),
        _ if value.fract() == 0.0 => format!("{value}"),
        _ => format!("{rounded}"),
    }
}
