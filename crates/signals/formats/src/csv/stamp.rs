//! Time stamps in texts: ISO 8601 with or without a zone, `31.12.2024 08:00:00,125`, `12/31/2024 8:00:00 PM`,
//! times of a day.

use jiff::Timestamp;
use jiff::civil::{Date, DateTime, Time};
use jiff::tz::TimeZone;

use crate::units::seconds;

/// Seconds and nanoseconds since some origin that all stamps of one form share; `day_first` of dates with slashes
/// whose month may be their day.
pub(crate) fn stamp(field: &str, day_first: bool) -> Option<(i64, i32)> {
    let field = field.trim();
    if let Some(span) = span(field).or_else(|| duration(field)) {
        return Some(span);
    }
    let shaped = field.len() >= 6 && field.starts_with(|c: char| c.is_ascii_digit());
    if !shaped || !(field.contains(':') || field.matches(['-', '/', '.']).count() >= 2) {
        return None;
    }
    // A decimal comma stands behind the seconds.
    let text = match field.rsplit_once(',') {
        Some((before, fraction)) if before.contains(':') => format!("{before}.{}", fraction.trim()),
        _ => field.to_owned(),
    };
    // With a zone it is an instant; without one, a place in a calendar without zones.
    if let Ok(instant) = text.parse::<Timestamp>() {
        return Some((instant.as_second(), instant.subsec_nanosecond()));
    }
    let civil = |date: Date, time: Time| {
        let instant = DateTime::from_parts(date, time).to_zoned(TimeZone::UTC).ok()?.timestamp();
        Some((instant.as_second(), instant.subsec_nanosecond()))
    };
    let split = text.split_once(['T', ' ']);
    match split {
        Some((date, time)) if date.matches(['-', '/', '.']).count() == 2 => {
            civil(day(date, day_first)?, clock(time)?)
        }
        _ if text.contains(':') => civil(Date::constant(1970, 1, 1), clock(&text)?),
        _ => civil(day(&text, day_first)?, Time::midnight()),
    }
}

/// A number with its unit of time, as MATLAB writes the times of a timetable: `0.25 sec`, `12.5ms`.
fn span(field: &str) -> Option<(i64, i32)> {
    let at = field.rfind(|c: char| c.is_ascii_digit() || c == '.')? + 1;
    let (number, unit) = field.split_at(at);
    let second = seconds(unit.trim())?.1;
    let value: f64 = number.trim().parse().ok().filter(|x: &f64| x.abs() < 1e9)?;
    let whole = (value * second).floor();
    Some((whole as i64, (1e9 * (value * second - whole)).round() as i32))
}

/// A duration as pandas writes it, `0 days 00:00:00.000078125` or `-1 days +23:59:59`, and as ISO 8601 has it,
/// `P0DT0H0M0.5S`.
fn duration(field: &str) -> Option<(i64, i32)> {
    const DAY_S: i64 = 86_400;
    if let Some(rest) = field.strip_prefix('P').filter(|rest| !rest.is_empty()) {
        let (days, time) = rest.split_once('T').unwrap_or((rest, ""));
        let days: i64 = if days.is_empty() { 0 } else { days.strip_suffix('D')?.parse().ok()? };
        let (mut s, mut ns, mut rest) = (days.checked_mul(DAY_S)?, 0, time);
        while !rest.is_empty() {
            let (number, unit) = rest.split_at(rest.find(|c: char| c.is_ascii_uppercase())?);
            let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
            let each = match &unit[..1] {
                "H" => 3600,
                "M" => 60,
                "S" => 1,
                _ => return None,
            };
            s = s.checked_add(whole.parse::<i64>().ok()?.checked_mul(each)?)?;
            if each == 1 {
                ns = nanos(fraction)?;
            }
            rest = &unit[1..];
        }
        return Some((s, ns));
    }
    let (days, time) = field.split_once(" day")?;
    let time = time.trim_start_matches('s').trim_start_matches(',').trim().trim_start_matches('+');
    let days: i64 = days.trim().parse().ok()?;
    let [hours, minutes, seconds] = time.split(':').collect::<Vec<_>>()[..] else { return None };
    let (seconds, fraction) = seconds.split_once('.').unwrap_or((seconds, ""));
    let of = |text: &str| text.parse::<u8>().ok().map(i64::from);
    let in_day = of(hours)? * 3600 + of(minutes)? * 60 + of(seconds)?;
    Some((days.checked_mul(DAY_S)?.checked_add(in_day)?, nanos(fraction)?))
}

/// Nanoseconds of the digits behind a point.
fn nanos(fraction: &str) -> Option<i32> {
    if !fraction.bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    fraction.chars().chain("000000000".chars()).take(9).collect::<String>().parse().ok()
}

/// The first two numbers of a date with slashes.
pub(super) fn slashed(field: &str) -> Option<(u8, u8)> {
    let mut parts = field.trim().split('/');
    let [first, second] = [parts.next()?, parts.next()?].map(|part| part.trim().parse().ok());
    parts.next().and(Some((first?, second?))).filter(|(a, b)| (1..=31).contains(a) && (1..=31).contains(b))
}

/// A day; with dots, the day comes first, with slashes the month, unless it can be none or `day_first` says so.
fn day(text: &str, day_first: bool) -> Option<Date> {
    let parts: Vec<i16> =
        text.split(['-', '/', '.']).map(|n| n.trim().parse().ok()).collect::<Option<_>>()?;
    let [a, b, c] = parts[..] else { return None };
    let of = |year: i16, month: i16, day: i16| {
        Date::new(year, i8::try_from(month).ok()?, i8::try_from(day).ok()?).ok()
    };
    let full = |year: i16| if year < 100 { 2000 + year } else { year };
    if a > 31 {
        of(a, b, c)
    } else if text.contains('/') && a <= 12 && !(day_first && b <= 12) {
        of(full(c), a, b)
    } else {
        of(full(c), b, a)
    }
}

/// A time of a day, with or without a half of the day.
fn clock(text: &str) -> Option<Time> {
    let upper = text.trim().to_uppercase();
    let (text, half) = match (upper.strip_suffix("AM"), upper.strip_suffix("PM")) {
        (Some(text), _) => (text.trim(), Some(0)),
        (_, Some(text)) => (text.trim(), Some(12)),
        _ => (upper.as_str(), None),
    };
    let mut parts = text.split(':');
    let first: i8 = parts.next()?.parse().ok()?;
    // Excel writes minutes and seconds where the seconds have a fraction: `01:23.4`.
    let is_minute = half.is_none() && text.matches(':').count() == 1 && text.contains('.');
    let (hour, minute) =
        if is_minute { (first / 60, first % 60) } else { (first, parts.next()?.parse().ok()?) };
    let seconds = parts.next().unwrap_or("0");
    let (second, fraction) = seconds.split_once('.').unwrap_or((seconds, ""));
    // Some write milliseconds behind a third colon.
    let fraction = match parts.next() {
        Some(milli) if fraction.is_empty() => format!("{milli:0>3}"),
        Some(_) => return None,
        None => fraction.to_owned(),
    };
    if parts.next().is_some() || !fraction.bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    let nanos: String = fraction.chars().chain("000000000".chars()).take(9).collect();
    let hour = half.map_or(hour, |half| hour % 12 + half);
    Time::new(hour, minute, second.parse().ok()?, nanos.parse().ok()?).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_stamps_of_many_programs() {
        let base = stamp("2024-05-01 08:00:00", false).unwrap();
        for (text, nanos) in [
            ("2024-05-01T08:00:00.000078125", 78_125),
            ("2024-05-01T10:00:00.5+02:00", 500_000_000),
            ("2024-05-01T08:00:00.25Z", 250_000_000),
            ("01.05.2024 08:00:00,125", 125_000_000),
            ("05/01/2024 8:00:00.5 AM", 500_000_000),
            ("2024/05/01 08:00:00:007", 7_000_000),
        ] {
            assert_eq!(stamp(text, false), Some((base.0, nanos)), "{text}");
        }
        assert_eq!(stamp("08:00:00,5", false), Some((28_800, 500_000_000)));
        assert_eq!(stamp("01:23.4", false), Some((83, 400_000_000)));
        assert_eq!(stamp("75:00,5", false), Some((4500, 500_000_000)));
        assert_eq!(stamp("78.125 ms", false), Some((0, 78_125_000)));
        assert_eq!(stamp("2.5 sec", false), Some((2, 500_000_000)));
        assert_eq!(stamp("0 days 00:00:00.000078125", false), Some((0, 78_125)));
        assert_eq!(stamp("-1 days +23:59:59.5", false), Some((-1, 500_000_000)));
        assert_eq!(stamp("1 day, 0:00:01", false), Some((86_401, 0)));
        assert_eq!(stamp("P0DT0H1M0.5S", false), Some((60, 500_000_000)));
        assert_eq!(stamp("PT0.000078125S", false), Some((0, 78_125)));
        for text in ["1.5", "-3", "12", "3 g", "ms", "1.5 V", "1e-3", "acc", "1.234,5", "08-15"] {
            assert_eq!(stamp(text, false), None, "{text}");
        }
    }
}
