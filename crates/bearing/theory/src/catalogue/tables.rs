//! The bearings themselves: dimensions, and where each is from.

use std::sync::LazyLock;

use super::{Boundary, CatalogueBearing, Element};

/// Name, element, number, diameter, pitch [mm], contact angle [°], bore, outside, width [mm], source.
type Row = (&'static str, Element, Option<u32>, f64, f64, f64, Option<[f64; 3]>, &'static str);

/// Name of the paper's bearing.
pub const PAPER: &str = "paper";

const SINGH: &str = "S. Singh et al., Numerical noise generation in modelled bearing vibration signals, \
    Inter-Noise 2014, table 1";
const CWRU: &str = "Case Western Reserve University Bearing Data Center, bearing information";
const IMS: &str = "J. Lee et al., Bearing data set, IMS, University of Cincinnati, 2007";
const XJTU: &str = "B. Wang et al., IEEE Trans. Reliab. 69 (2020) 401–412, table II";
const MFPT: &str =
    "E. Bechhoefer, MFPT bearing fault data set, 2013: 8 rolling elements of 0.235 in, pitch 1.245 in";
const E_TYPE: &str = "raceway diameters F and E of NU and N bearings of E design, makers' catalogues: d = (E \
    − F)/2, pitch (E + F)/2";
pub(super) const PROPORTION: &str = "bore, outside and width by ISO 15; no catalogue known here prints \
    raceways: F and E lie where those of size 303 do between bore and outside, d = (E − F)/2, pitch (E + \
    F)/2";
const BOUNDARY: &str =
    "ISO 15 boundary dimensions for the pitch, (bore + outside)/2; balls as commonly fitted";
pub(super) const BALL_RULE: &str = "bore, outside and width by ISO 15; balls by rule: pitch (bore + \
    outside)/2, diameter 0.3 (outside − bore), but no more than 0.8 of the width. Of seven bearings whose balls are known the rule is off by 6 % \
    at most in diameter and by 1.5 % in pitch";
pub(super) const INSERT_RULE: &str = "bore and outside of UC inserts by ISO 9628; balls by the rule of deep \
    groove bearings of the same outside diameter (pitch (bore + outside)/2, diameter 0.3 (outside − bore)), \
    which is off by 6 % at most in the diameter of seven known ones";

const BEYOND_RULE: &str = "bore and outside by ISO 15; rolling elements by rule: pitch (bore + outside)/2, \
    diameter a usual part of (outside − bore), a usual contact angle. No bearing of this kind is known here to try \
    the rule on: give `diameter_mm`, `pitch_mm` and `angle_deg` where you have them";
const LIGHT: &str = "raceway diameter F of NU bearings of series 10, makers' catalogues; pitch by rule, (bore + \
    outside)/2, so that d = pitch − F";

/// Deep groove ball bearings: name, bore, outside diameter and width [mm] by ISO 15.
const DEEP_GROOVE: &str = include_str!("deep_groove.csv");

/// Cylindrical roller bearings of E design by size: raceway diameters F and E, bore and outside diameter by ISO 15,
/// and width of the narrow and of the wide series, which have the same raceways [mm]; those of [`IN_PROPORTION`]
/// from its neighbour.
const CYLINDRICAL: &str = include_str!("cylindrical.csv");

/// Raceway diameter F [mm] of cylindrical roller bearings of series 10, from number 5 on; bore, outside diameter and
/// width are those of the ball bearings of series 60.
const LIGHT_SERIES: [f64; 16] =
    [30.5, 36.5, 42.0, 47.0, 52.5, 57.5, 64.5, 69.5, 74.5, 80.0, 85.0, 91.5, 96.5, 103.0, 108.0, 113.0];

/// The size whose raceways are printed nowhere: 15 + 27·(24.2 − 17)/30 and 15 + 27·(40.2 − 17)/30 mm, to a
/// tenth.
const IN_PROPORTION: &str = "302";

/// Cylindrical roller bearings by where their flanges are, which a plane model does not have: rollers and
/// raceways are the same.
const FLANGES: [&str; 4] = ["NU", "NJ", "NUP", "N"];

const OTHERS: [Row; 10] = [
    (PAPER, Element::Roller, Some(24), 18.0, 181.98, 0.0, None, SINGH),
    ("608", Element::Ball, Some(7), 3.969, 15.0, 0.0, Some([8.0, 22.0, 7.0]), BOUNDARY),
    ("6203", Element::Ball, Some(8), 6.746, 28.5, 0.0, Some([17.0, 40.0, 12.0]), CWRU),
    ("6205", Element::Ball, Some(9), 7.94, 39.04, 0.0, Some([25.0, 52.0, 15.0]), CWRU),
    ("6206", Element::Ball, Some(9), 9.525, 46.0, 0.0, Some([30.0, 62.0, 16.0]), BOUNDARY),
    ("6209", Element::Ball, None, 12.7, 65.0, 0.0, Some([45.0, 85.0, 19.0]), BOUNDARY),
    ("6305", Element::Ball, Some(7), 11.509, 43.5, 0.0, Some([25.0, 62.0, 17.0]), BOUNDARY),
    ("ZA-2115", Element::Roller, Some(16), 8.407, 71.501, 15.17, None, IMS),
    ("UER204", Element::Ball, Some(8), 7.92, 34.55, 0.0, Some([20.0, 47.0, 17.0]), XJTU),
    ("NICE", Element::Ball, Some(8), 5.969, 31.623, 0.0, None, MFPT),
];

/// Bearings that a plane model does not have, by what their designations begin with: series of ball bearings of
/// the same bore and outside diameter, first number, element, its diameter over (outside − bore), contact angle
/// [°]. Makers print neither: the last two are usual ones (own).
const BEYOND_A_PLANE: [(&str, &str, usize, Element, f64, f64); 20] = [
    ("12", "62", 0, Element::Ball, 0.25, 10.0),
    ("13", "63", 0, Element::Ball, 0.25, 10.0),
    ("22", "62", 0, Element::Ball, 0.25, 13.0),
    ("23", "63", 0, Element::Ball, 0.25, 15.0),
    ("70", "60", 0, Element::Ball, 0.3, 15.0),
    ("72", "62", 0, Element::Ball, 0.3, 40.0),
    ("73", "63", 0, Element::Ball, 0.3, 40.0),
    ("32", "62", 0, Element::Ball, 0.3, 30.0),
    ("33", "63", 0, Element::Ball, 0.3, 30.0),
    ("213", "63", 4, Element::Roller, 0.27, 9.0),
    ("222", "62", 5, Element::Roller, 0.28, 10.0),
    ("223", "63", 8, Element::Roller, 0.28, 13.0),
    ("302", "62", 2, Element::Roller, 0.26, 14.0),
    ("303", "63", 2, Element::Roller, 0.26, 12.0),
    ("313", "63", 5, Element::Roller, 0.26, 28.0),
    ("320", "60", 4, Element::Roller, 0.26, 15.0),
    ("322", "62", 4, Element::Roller, 0.26, 14.0),
    ("323", "63", 3, Element::Roller, 0.26, 12.0),
    ("330", "60", 5, Element::Roller, 0.26, 13.0),
    ("332", "62", 5, Element::Roller, 0.26, 13.0),
];

/// Width of the outer ring of UC inserts [mm] with bores of 20 to 70 mm. Smaller bores have the outer ring and the
/// balls of the first.
const INSERT_WIDTH: [f64; 11] = [17.0, 17.0, 19.0, 20.0, 21.0, 22.0, 24.0, 25.0, 27.0, 28.0, 30.0];
const FIRST_INSERT: usize = 4;

/// Names of a table, and what stands behind each.
fn rows(table: &'static str) -> impl Iterator<Item = (&'static str, &'static str)> {
    table.lines().skip(1).filter_map(|line| line.split_once(','))
}

/// Numbers of a row; tests hold them against their ranges.
fn numbers<const N: usize>(row: &str) -> [f64; N] {
    let mut cells = row.split(',');
    [(); N].map(|()| cells.next().and_then(|cell| cell.parse().ok()).unwrap_or(f64::NAN))
}

/// Bore, outside diameter and width [mm] of a series of ball bearings, by the last two digits of their names.
fn series(begins: &str) -> impl Iterator<Item = (usize, [f64; 3])> {
    let number = move |name: &str| name.strip_prefix(begins).filter(|end| end.len() == 2)?.parse().ok();
    rows(DEEP_GROOVE).filter_map(move |(name, row)| Some((number(name)?, numbers(row))))
}

/// Those of one bearing of a series.
fn sizes(begins: &str, number: usize) -> [f64; 3] {
    series(begins).find(|(of, _)| *of == number).map_or([f64::NAN; 3], |(_, sizes)| sizes)
}

/// Ball and pitch diameter [mm] by the rule of [`BALL_RULE`].
pub(super) fn balls_mm([bore, outside, width]: [f64; 3]) -> [f64; 2] {
    [(0.3 * (outside - bore)).min(0.8 * width), 0.5 * (bore + outside)]
}

/// All bearings that have a name here.
pub fn all() -> &'static [CatalogueBearing] {
    static ALL: LazyLock<Vec<CatalogueBearing>> = LazyLock::new(|| {
        let others = OTHERS.iter().copied().map(of_row);
        others.chain(deep_groove()).chain(inserts()).chain(cylindrical()).chain(beyond_a_plane()).collect()
    });
    &ALL
}

fn deep_groove() -> impl Iterator<Item = CatalogueBearing> {
    let listed = |name: &str| OTHERS.iter().any(|row| row.0 == name);
    let own = rows(DEEP_GROOVE).filter(move |(name, _)| !listed(name));
    own.map(|(name, row)| by_rule(name.to_owned(), numbers(row), BALL_RULE))
}

fn beyond_a_plane() -> impl Iterator<Item = CatalogueBearing> {
    BEYOND_A_PLANE.iter().flat_map(|&(begins, alike, first, element, share, angle_deg)| {
        let of_series = series(alike).filter(move |(number, _)| *number >= first);
        of_series.map(move |(number, [bore, outside, _])| CatalogueBearing {
            name: format!("{begins}{number:02}"),
            element,
            elements: None,
            diameter_mm: share * (outside - bore),
            pitch_mm: 0.5 * (bore + outside),
            angle_deg,
            boundary: None,
            source: BEYOND_RULE.to_owned(),
        })
    })
}

fn inserts() -> impl Iterator<Item = CatalogueBearing> {
    (1..FIRST_INSERT + INSERT_WIDTH.len()).map(|number| {
        let size = number.max(FIRST_INSERT);
        let [bore, outside, _] = sizes("62", size);
        let boundary = [bore, outside, INSERT_WIDTH[size - FIRST_INSERT]];
        let of_size = by_rule(format!("UC2{number:02}"), boundary, INSERT_RULE);
        let [bore_mm, ..] = sizes("62", number);
        let boundary = of_size.boundary.map(|boundary| Boundary { bore_mm, ..boundary });
        CatalogueBearing { boundary, ..of_size }
    })
}

fn by_rule(name: String, [bore_mm, outside_mm, width_mm]: [f64; 3], source: &str) -> CatalogueBearing {
    let [diameter_mm, pitch_mm] = balls_mm([bore_mm, outside_mm, width_mm]);
    CatalogueBearing {
        name,
        element: Element::Ball,
        elements: None,
        diameter_mm,
        pitch_mm,
        angle_deg: 0.0,
        boundary: Some(Boundary { bore_mm, outside_mm, width_mm }),
        source: source.to_owned(),
    }
}

fn cylindrical() -> impl Iterator<Item = CatalogueBearing> {
    FLANGES.iter().flat_map(|&flanges| e_design(flanges).chain(light_series(flanges)))
}

fn e_design(flanges: &'static str) -> impl Iterator<Item = CatalogueBearing> {
    // 210 in its narrow series, 2210 in its wide one.
    ["", "2"].into_iter().enumerate().flat_map(move |(wide, begins)| {
        rows(CYLINDRICAL).map(move |(size, row)| {
            let [f, e, bore, outside, widths @ ..]: [f64; 6] = numbers(row);
            let source = if size == IN_PROPORTION { PROPORTION } else { E_TYPE };
            of_raceways(format!("{flanges} {begins}{size}"), [f, e], [bore, outside, widths[wide]], source)
        })
    })
}

fn light_series(flanges: &'static str) -> impl Iterator<Item = CatalogueBearing> {
    series("60").skip(5).zip(LIGHT_SERIES).map(move |((number, boundary), f)| {
        let [bore, outside, _] = boundary;
        of_raceways(format!("{flanges} 10{number:02}"), [f, bore + outside - f], boundary, LIGHT)
    })
}

fn of_raceways(
    name: String,
    [f, e]: [f64; 2],
    [bore_mm, outside_mm, width_mm]: [f64; 3],
    source: &str,
) -> CatalogueBearing {
    CatalogueBearing {
        name,
        element: Element::Roller,
        elements: None,
        diameter_mm: 0.5 * (e - f),
        pitch_mm: 0.5 * (e + f),
        angle_deg: 0.0,
        boundary: Some(Boundary { bore_mm, outside_mm, width_mm }),
        source: source.to_owned(),
    }
}

/// Content of [`all`], in words.
pub(super) fn names() -> String {
    let others: Vec<&str> = OTHERS.iter().map(|row| row.0).filter(|name| !name.starts_with('6')).collect();
    format!(
        "{}, 604 to 609, 623 to 639, 683 to 699, 6000 to 6322, 62200 to 62214, 62300 to 62310, 6403 to 6415, 6800 to 6920, 16002 to 16020, UC201 to \
         UC214, or {} with 202 to 220, 302 to 320, 2202 to 2220, 2302 to 2320, 1005 to 1020; for their frequencies \
         alone also self-aligning, angular contact, spherical and tapered ones such as 1205, 7205, 22210, 30205",
        others.join(", "),
        FLANGES.join(", ")
    )
}

fn of_row(
    (name, element, elements, diameter_mm, pitch_mm, angle_deg, boundary, source): Row,
) -> CatalogueBearing {
    let (name, source) = (name.to_owned(), source.to_owned());
    let boundary = boundary.map(|[bore_mm, outside_mm, width_mm]| Boundary { bore_mm, outside_mm, width_mm });
    CatalogueBearing { name, element, elements, diameter_mm, pitch_mm, angle_deg, boundary, source }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The accuracy stated by [`BALL_RULE`], checked with bearings whose balls are listed with their source.
    #[test]
    fn behaves_balls_by_rule_beside_known_ones() {
        // Diameter to 6 %, pitch to 1.5 %, and all of the numbers.
        let known = OTHERS.iter().filter(|row| row.1 == Element::Ball && row.5 == 0.0);
        let mut compared = 0;
        for &(name, _, elements, diameter, pitch, _, boundary, _) in known {
            let Some(boundary) = boundary else { continue };
            let [ball, circle] = balls_mm(boundary);
            assert!((ball / diameter - 1.0).abs() < 0.06, "{name}: {ball} {diameter}");
            // The insert's bore is smaller than that of a deep groove bearing with its balls.
            let allowed = if name.starts_with("UER") { 0.035 } else { 0.015 };
            assert!((circle / pitch - 1.0).abs() < allowed, "{name}: {circle} {pitch}");
            if let Some(elements) = elements {
                let by_rule = super::super::filled(circle, ball);
                assert_eq!(by_rule, elements as usize, "{name}");
            }
            compared += 1;
        }
        assert_eq!(compared, 7);
    }

    /// Rollers of E design have diameters in whole or half millimetres, and lie between bore and outside.
    #[test]
    fn invariant_raceways_lie_between_bore_and_outside_with_rollers_of_whole_sizes() {
        for (size, row) in rows(CYLINDRICAL) {
            let [f, e, bore, outside, narrow, wide] = numbers(row);
            let roller = 0.5 * (e - f);
            if size != IN_PROPORTION {
                assert!((2.0 * roller - (2.0 * roller).round()).abs() < 1e-9, "{size}: {roller} mm");
            }
            assert!(bore < f && f < e && e < outside && narrow < wide, "{size}");
            // 0.27 to 0.30 of the space between bore and outside.
            assert!((0.23..0.31).contains(&(roller / (outside - bore))), "{size}: {roller} mm");
            let middle = (e + f) / (bore + outside);
            assert!((0.98..1.05).contains(&middle), "{size}: {middle}");
        }
    }

    /// 62 × 1.5 mm wide of the light series are bearings of their own: every name is there once.
    #[test]
    fn invariant_every_name_is_there_once() {
        let mut names: Vec<&str> = all().iter().map(|bearing| bearing.name.as_str()).collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
        assert!(count > 300, "{count}");
        let mut sizes = all().iter().flat_map(|bearing| [bearing.diameter_mm, bearing.pitch_mm]);
        assert!(sizes.all(|mm| mm > 0.0 && mm < 300.0));
    }
}
