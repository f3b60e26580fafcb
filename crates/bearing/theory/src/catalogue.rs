//! Bearings by name, with the dimensions that their defect frequencies follow from.
//!
//! Makers do not print the number of rolling elements of every bearing; where no source is known for it, the
//! entry has none and the user must give it. Any bearing can be given by its numbers:
//! `elements=9, diameter_mm=7.94, pitch_mm=39.04, angle_deg=0`.

mod names;
mod tables;

use std::borrow::Cow;
use std::f64::consts::PI;
use std::fmt;

/// Shapes of rolling elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Element {
    /// Balls.
    Ball,
    /// Cylindrical or tapered rollers.
    Roller,
}

/// Dimensions of one row of a bearing.
#[derive(Debug, Clone, PartialEq)]
pub struct CatalogueBearing {
    /// Designation.
    pub name: String,
    /// Shape of the rolling elements.
    pub element: Element,
    /// Rolling elements in the row; `None` where no source is known.
    pub elements: Option<u32>,
    /// Diameter of a rolling element [mm].
    pub diameter_mm: f64,
    /// Pitch diameter [mm].
    pub pitch_mm: f64,
    /// Contact angle [°].
    pub angle_deg: f64,
    /// Boundary dimensions; `None` where no source is known.
    pub boundary: Option<Boundary>,
    /// Where the numbers are from.
    pub source: String,
}

/// Boundary dimensions of a bearing [mm].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Boundary {
    /// Diameter of the bore.
    pub bore_mm: f64,
    /// Outside diameter.
    pub outside_mm: f64,
    /// Width of the outer ring.
    pub width_mm: f64,
}

/// Frequencies of a defect over that of the shaft; inner ring turning, outer ring fixed, no slip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DefectOrders {
    /// Ball pass frequency of the outer raceway.
    pub bpfo: f64,
    /// Ball pass frequency of the inner raceway.
    pub bpfi: f64,
    /// Spin frequency of a rolling element; a defect on it strikes twice a turn.
    pub bsf: f64,
    /// Fundamental train frequency, that of the cage.
    pub ftf: f64,
}

pub use names::{beyond_a_plane, plain};
pub use tables::{PAPER, all};

/// Those among `known` whose names begin as `text` does: `NU`, `62`.
pub fn beginning_with(text: &str, known: &[CatalogueBearing]) -> Vec<CatalogueBearing> {
    names::beginning_with(text, known)
}

/// What to do about a name that is not known.
pub const ADVICE: &str =
    "give its numbers, `--bearing \"elements=9, diameter_mm=7.94, pitch_mm=39.04, angle_deg=0\"`";

/// Circumference of the pitch circle over the rolling elements side by side, where their number is not known:
/// cages of E design leave about a quarter.
const SPACING: f64 = 1.25;

/// Part of the pitch circle [°] over which balls lie side by side when a deep groove bearing is filled.
const FILLING_DEG: f64 = 186.0;

/// Number of balls that can be filled into a deep groove bearing while its rings lie against each other:
/// right for all of the catalogue whose number is known.
pub fn filled(pitch_mm: f64, diameter_mm: f64) -> usize {
    let one = 2.0 * libm::asin((diameter_mm / pitch_mm).min(1.0));
    (1.0 + FILLING_DEG.to_radians() / one).round() as usize
}

/// As many rolling elements as cages usually hold.
pub fn usual_elements(pitch_mm: f64, diameter_mm: f64) -> usize {
    (PI * pitch_mm / (SPACING * diameter_mm)).round() as usize
}

/// Diametral clearance [mm] of a bearing with this bore [mm]: the middle of the normal group, ISO
/// 5753-1:2009.
pub fn normal_clearance_mm(element: Element, bore_mm: f64) -> f64 {
    // Largest bore [mm], clearance [µm].
    const BALL: [(f64, f64); 9] = [
        (10.0, 7.5),
        (18.0, 10.5),
        (30.0, 12.5),
        (40.0, 13.0),
        (50.0, 14.5),
        (65.0, 18.0),
        (80.0, 20.0),
        (100.0, 24.0),
        (120.0, 28.0),
    ];
    const ROLLER: [(f64, f64); 16] = [
        (30.0, 32.5),
        (40.0, 37.5),
        (50.0, 45.0),
        (65.0, 55.0),
        (80.0, 57.5),
        (100.0, 67.5),
        (120.0, 70.0),
        (140.0, 82.5),
        (160.0, 95.0),
        (180.0, 100.0),
        (200.0, 117.5),
        (225.0, 135.0),
        (250.0, 142.5),
        (280.0, 160.0),
        (315.0, 167.5),
        (355.0, 185.0),
    ];
    let of = |table: &[(f64, f64)]| {
        let found = table.iter().find(|(largest, _)| bore_mm <= *largest).or(table.last());
        1e-3 * found.map_or(0.0, |(_, um)| *um)
    };
    match element {
        Element::Ball => of(&BALL),
        Element::Roller => of(&ROLLER),
    }
}

impl CatalogueBearing {
    /// Diameter of a rolling element and of the pitch circle as they are read [mm]: to the micrometre, which
    /// differences of raceways miss by their last digits.
    pub fn shown_mm(&self) -> [f64; 2] {
        [self.diameter_mm, self.pitch_mm].map(|mm| (1e3 * mm).round() / 1e3)
    }

    /// As many rolling elements as cages usually hold.
    pub fn usual_elements(&self) -> usize {
        match self.element {
            Element::Ball => filled(self.pitch_mm, self.diameter_mm),
            Element::Roller => usual_elements(self.pitch_mm, self.diameter_mm),
        }
    }

    /// Numbers of rolling elements that makers may fit: that of the entry, or, where it has none, for balls without
    /// a contact angle what goes in from one side and one more or less, else what leaves a twelfth (with an angle a
    /// fiftieth) to a third of the pitch circle free (own).
    pub fn possible_elements(&self) -> Vec<u32> {
        if let Some(elements) = self.elements {
            return vec![elements];
        }
        let usual = u32::try_from(self.usual_elements()).unwrap_or(3);
        let room = PI * self.pitch_mm / self.diameter_mm;
        let among = |least: u32, most: u32| (least.max(3)..=most.min(self.most_elements())).collect();
        let least = (2.0 / 3.0 * room).ceil() as u32;
        match self.element {
            _ if self.angle_deg != 0.0 => among(least, (0.98 * room) as u32),
            Element::Ball => among(usual.saturating_sub(1), usual + 1),
            Element::Roller => among(least, (11.0 / 12.0 * room) as u32),
        }
    }

    /// The most that find room on the pitch circle.
    fn most_elements(&self) -> u32 {
        (PI / libm::asin(self.diameter_mm / self.pitch_mm) + 1e-9) as u32
    }

    fn has_sane_diameters(&self) -> bool {
        self.diameter_mm > 0.0
            && self.pitch_mm > 1.1 * self.diameter_mm
            && self.pitch_mm.is_finite()
            && (0.0..90.0).contains(&self.angle_deg)
    }

    /// Whether there is such a bearing.
    pub fn is_sane(&self) -> bool {
        self.has_sane_diameters() && self.elements.is_none_or(|n| (3..=self.most_elements()).contains(&n))
    }

    /// Whether its balls follow from the boundary dimensions by rule, for want of a source.
    pub fn has_balls_by_rule(&self) -> bool {
        [tables::BALL_RULE, tables::INSERT_RULE].contains(&self.source.as_str())
    }

    /// Whether its raceways are in proportion to those of the next larger size, for want of a source.
    pub fn has_raceways_in_proportion(&self) -> bool {
        self.source == tables::PROPORTION
    }

    /// A bearing of the catalogue by its name (spaces, hyphens and suffixes such as `-2RS1/C3` or `ECP` do not
    /// matter), by its numbers, or both: `NU 205, elements=13`.
    ///
    /// # Errors
    /// Parts that are not understood, with the valid names and numbers.
    pub fn parse(text: &str) -> Result<Self, String> {
        Self::parse_among(text, || Ok(all().into()), ADVICE)
    }

    /// As [`parse`](Self::parse), by a name among those of `known`, with other advice where it is unknown.
    ///
    /// # Errors
    /// As [`parse`](Self::parse), and those of `known`, which is asked for a name alone.
    pub fn parse_among(
        text: &str,
        known: impl FnOnce() -> Result<Cow<'static, [Self]>, String>,
        advice: &str,
    ) -> Result<Self, String> {
        let mut parts = text.split(',').map(str::trim).filter(|part| !part.is_empty()).peekable();
        if parts.peek().is_none() {
            return Err(format!("the name of the bearing is empty; {advice}, or a name such as `6205`"));
        }
        let named = match parts.peek() {
            Some(name) if !name.contains('=') => {
                let found = known().and_then(|known| names::find(name, &known, advice));
                parts.next();
                Some(found?)
            }
            _ => None,
        };
        let own = named.is_none();
        let mut bearing = named.unwrap_or_else(|| Self {
            name: text.trim().to_owned(),
            element: Element::Ball,
            elements: None,
            diameter_mm: f64::NAN,
            pitch_mm: f64::NAN,
            angle_deg: 0.0,
            boundary: None,
            source: "the user".to_owned(),
        });
        for part in parts {
            let known = "`elements`, `diameter_mm`, `pitch_mm` and `angle_deg`";
            let (key, value) = part
                .split_once('=')
                .ok_or_else(|| format!("`{part}` of the bearing is no `name=number`; known are {known}"))?;
            let number: f64 = value
                .trim()
                .parse()
                .map_err(|_| format!("`{}` of the bearing is no number", value.trim()))?;
            match key.trim() {
                "elements" if number.fract() == 0.0 && (3.0..=200.0).contains(&number) => {
                    bearing.elements = Some(number as u32);
                }
                "elements" => return Err(format!("a bearing has 3 to 200 rolling elements, not {number}")),
                name if name.contains(' ') => {
                    return Err(format!(
                        "`{name}` is no number of a bearing: a comma parts a name from its numbers, as in \
                         `NU 205, elements=13`"
                    ));
                }
                "diameter_mm" | "element_diameter_mm" => bearing.diameter_mm = number,
                "pitch_mm" | "pitch_diameter_mm" => bearing.pitch_mm = number,
                "angle_deg" => bearing.angle_deg = number,
                other => return Err(format!("`{other}` is no number of a bearing; known are {known}")),
            }
        }
        if !bearing.has_sane_diameters() {
            let wanted = if own {
                "give `diameter_mm`, a larger `pitch_mm`"
            } else {
                "check `diameter_mm`, `pitch_mm`"
            };
            return Err(format!("`{text}` is no bearing: {wanted} and an `angle_deg` from 0 to below 90"));
        }
        let ([diameter, pitch], most) = (bearing.shown_mm(), bearing.most_elements());
        if let Some(elements) = bearing.elements.filter(|elements| *elements > most) {
            return Err(format!(
                "`{text}` is no bearing: {elements} rolling elements of {diameter} mm do not fit on a pitch \
                 circle of {pitch} mm: {most} at most"
            ));
        }
        Ok(bearing)
    }

    /// Frequencies of its defects over that of the shaft.
    ///
    /// # Errors
    /// When the number of rolling elements is not known.
    pub fn orders(&self) -> Result<DefectOrders, String> {
        let Some(elements) = self.elements else {
            return Err(format!(
                "makers fit different numbers of rolling elements into `{0}`: count them, and give \
                 `--bearing \"{0}, elements=…\"`",
                self.name
            ));
        };
        let ratio = self.diameter_mm / self.pitch_mm * libm::cos(self.angle_deg.to_radians());
        let half = 0.5 * f64::from(elements);
        Ok(DefectOrders {
            bpfo: half * (1.0 - ratio),
            bpfi: half * (1.0 + ratio),
            bsf: 0.5 * self.pitch_mm / self.diameter_mm * (1.0 - ratio * ratio),
            ftf: 0.5 * (1.0 - ratio),
        })
    }
}

impl fmt::Display for CatalogueBearing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.elements {
            Some(elements) => write!(f, "{elements} ")?,
            None => f.write_str("? ")?,
        }
        let what = match self.element {
            Element::Ball => "balls",
            Element::Roller => "rollers",
        };
        let [diameter, pitch] = self.shown_mm();
        write!(f, "{what} of {diameter} mm, pitch {pitch} mm, contact angle {}°", self.angle_deg)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peer_orders_are_those_that_the_data_center_prints() {
        // Case Western Reserve University Bearing Data Center (2000), defect frequencies, in multiples of the
        // shaft; its 4.7135 and 3.9874 are twice the spin. Dimensions have four digits there, so the third
        // decimal is shared.
        const SHARED: f64 = 2e-3;
        for (name, bpfi, bpfo, ftf, twice_bsf) in
            [("6205-2RS", 5.4152, 3.5848, 0.39828, 4.7135), ("6203 2RS", 4.9469, 3.0530, 0.3817, 3.9874)]
        {
            let orders = CatalogueBearing::parse(name).unwrap().orders().unwrap();
            for (ours, theirs) in
                [(orders.bpfi, bpfi), (orders.bpfo, bpfo), (orders.ftf, ftf), (2.0 * orders.bsf, twice_bsf)]
            {
                assert!((ours - theirs).abs() < SHARED, "{name}: {ours} {theirs}");
            }
        }
    }

    #[test]
    fn behaves_names_and_numbers() {
        let roller = CatalogueBearing::parse("NU205ECP, elements=13").unwrap();
        assert_eq!(
            (roller.name.as_str(), roller.elements, roller.diameter_mm, roller.pitch_mm),
            ("NU 205", Some(13), 7.5, 39.0)
        );
        for text in
            ["6205-2Z", "6205 2RSH", "6205.2RSR", "SKF 6205-2RS1/C3", "6205-2rs", "6205 ZZ", "6205 C3"]
        {
            assert_eq!(
                CatalogueBearing::parse(text).map(|known| known.name),
                Ok("6205".to_owned()),
                "{text}"
            );
        }
        assert_eq!(CatalogueBearing::parse("UER204-12").unwrap().name, "UER204");
        let printed = all().iter().map(CatalogueBearing::to_string).collect::<Vec<_>>();
        assert!(printed.iter().all(|words| !words.contains("999") && !words.contains("000")), "{printed:?}");
        for (text, name) in [("NJ 205", "NJ 205"), ("NUP205-ECP", "NUP 205"), ("N 205", "N 205")] {
            let other = CatalogueBearing::parse(text).unwrap();
            assert_eq!((other.name.as_str(), other.diameter_mm), (name, roller.diameter_mm));
        }
        for (text, name) in [
            ("SKF6205", "6205"),
            ("NU2210 ECP", "NU 2210"),
            ("nu 220 ecm/c3", "NU 220"),
            ("NU 2202 ECP", "NU 2202"),
            ("FAG NU2305-E-TVP2", "NU 2305"),
            ("6310-2Z", "6310"),
            ("6222/C3", "6222"),
            ("UC206", "UC206"),
            ("UC205-16", "UC205"),
            ("UC203", "UC203"),
            ("625-2Z", "625"),
            ("6232RS", "623"),
        ] {
            assert_eq!(CatalogueBearing::parse(text).map(|known| known.name), Ok(name.to_owned()), "{text}");
        }
        let needles = CatalogueBearing::parse("HK 1210").unwrap_err();
        assert!(needles.contains("no bearing `HK 1210` is known"), "{needles}");
        let own = CatalogueBearing::parse("elements=9, diameter_mm=7.94, pitch_mm=39.04").unwrap();
        assert!((own.orders().unwrap().bpfo - 3.585).abs() < 1e-3);
        assert!(CatalogueBearing::parse("NU 312").unwrap().orders().unwrap_err().contains("elements=…"));
    }

    /// Of a kind that no plane model has, for its frequencies: bores and outside diameters by ISO 15.
    #[test]
    fn behaves_kinds_beyond_a_plane_have_ratios() {
        for (text, name, angle_deg, says) in [
            ("1205 ETN9", "1205", 10.0, "self-aligning"),
            ("2205-2RS", "2205", 13.0, "self-aligning"),
            ("22210 E", "22210", 10.0, "spherical"),
            ("FAG 22320-E1-K", "22320", 13.0, "spherical"),
            ("22322 EK", "22322", 13.0, "spherical"),
            ("7205 BEP", "7205", 40.0, "contact angle"),
            ("7005 ACD/P4A", "7005", 25.0, "contact angle"),
            ("7205 C", "7205", 15.0, "contact angle"),
            ("7205 C3", "7205", 40.0, "contact angle"),
            ("32010 X", "32010", 15.0, "tapered"),
            ("31308 J2", "31308", 28.0, "tapered"),
        ] {
            let known = CatalogueBearing::parse(text).unwrap_or_else(|why| panic!("{why}"));
            assert_eq!((known.name.as_str(), known.angle_deg), (name, angle_deg), "{text}");
            assert!(beyond_a_plane(name).is_some_and(|why| why.contains(says)), "{text}");
            assert!(known.possible_elements().len() >= 3 && known.boundary.is_none(), "{known:?}");
        }
        // The balls of a thin bearing leave room for the rings' shoulders.
        let thin = CatalogueBearing::parse("16008").unwrap();
        assert!((thin.diameter_mm - 7.2).abs() < 1e-12, "{thin}");
        // N 1010 has rollers of 7.5 mm between 57.5 and 72.5 mm, makers' catalogues.
        let light = CatalogueBearing::parse("N 1010 KTN").unwrap();
        assert_eq!((light.diameter_mm, light.pitch_mm), (7.5, 65.0));
    }

    #[test]
    fn behaves_names_that_begin_alike_make_a_list() {
        let names = |text: &str| -> Vec<String> {
            beginning_with(text, all()).into_iter().map(|bearing| bearing.name).collect()
        };
        let of_kind = names("nu");
        assert_eq!(of_kind.len(), 92);
        assert!(of_kind.iter().all(|name| name.starts_with("NU ")), "{of_kind:?}");
        assert_eq!(names("N").len(), 92);
        assert_eq!(names("620").len(), 10);
        assert!(names("xyz").is_empty() && names("").is_empty());
    }

    #[test]
    fn refuses_what_is_no_bearing() {
        for (text, says) in [
            ("62055", "no bearing `62055`"),
            ("62052", "no bearing `62052`"),
            ("6205-12", "no bearing `6205-12`"),
            ("", "the name of the bearing is empty"),
            ("6205, balls=9", "`balls`"),
            ("6205, elements=2.5", "3 to 200"),
            ("diameter_mm=8, pitch_mm=8", "is no bearing"),
            ("6205, elements=x", "no number"),
            ("NU 205, elements=200", "16 at most"),
            ("NU 221", "no bearing `NU 221`"),
            ("24010", "spherical"),
            ("51105", "thrust"),
        ] {
            let why = CatalogueBearing::parse(text).unwrap_err();
            assert!(why.contains(says), "{text}: {why}");
        }
    }
}
