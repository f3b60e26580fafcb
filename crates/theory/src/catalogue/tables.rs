//! The bearings themselves: dimensions, and where each is from.

use super::{Boundary, CatalogueBearing, Element};

/// Name, element, number, diameter, pitch [mm], contact angle [°], bore, outside, width [mm], source.
type Row = (&'static str, Element, Option<u32>, f64, f64, f64, Option<[f64; 3]>, &'static str);

/// Size, F, E, bore and outside diameter, width of the narrow and of the wide series [mm].
type Cylindrical = (u32, f64, f64, [f64; 2], [f64; 2]);

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

/// Raceway diameters F and E [mm] of cylindrical roller bearings of E design by size, with bore and outside
/// diameter [mm] by ISO 15, and width [mm] of the narrow and of the wide series, which have the same
/// raceways; those of [`IN_PROPORTION`] from its neighbour.
const CYLINDRICAL: [Cylindrical; 38] = [
    (202, 19.3, 30.3, [15.0, 35.0], [11.0, 14.0]),
    (203, 22.1, 35.1, [17.0, 40.0], [12.0, 16.0]),
    (204, 26.5, 41.5, [20.0, 47.0], [14.0, 18.0]),
    (205, 31.5, 46.5, [25.0, 52.0], [15.0, 18.0]),
    (206, 37.5, 55.5, [30.0, 62.0], [16.0, 20.0]),
    (207, 44.0, 64.0, [35.0, 72.0], [17.0, 23.0]),
    (208, 49.5, 71.5, [40.0, 80.0], [18.0, 23.0]),
    (209, 54.5, 76.5, [45.0, 85.0], [19.0, 23.0]),
    (210, 59.5, 81.5, [50.0, 90.0], [20.0, 23.0]),
    (211, 66.0, 90.0, [55.0, 100.0], [21.0, 25.0]),
    (212, 72.0, 100.0, [60.0, 110.0], [22.0, 28.0]),
    (213, 78.5, 108.5, [65.0, 120.0], [23.0, 31.0]),
    (214, 83.5, 113.5, [70.0, 125.0], [24.0, 31.0]),
    (215, 88.5, 118.5, [75.0, 130.0], [25.0, 31.0]),
    (216, 95.3, 127.3, [80.0, 140.0], [26.0, 33.0]),
    (217, 100.5, 136.5, [85.0, 150.0], [28.0, 36.0]),
    (218, 107.0, 145.0, [90.0, 160.0], [30.0, 40.0]),
    (219, 112.5, 154.5, [95.0, 170.0], [32.0, 43.0]),
    (220, 119.0, 163.0, [100.0, 180.0], [34.0, 46.0]),
    (IN_PROPORTION, 21.5, 35.9, [15.0, 42.0], [13.0, 17.0]),
    (303, 24.2, 40.2, [17.0, 47.0], [14.0, 19.0]),
    (304, 27.5, 45.5, [20.0, 52.0], [15.0, 21.0]),
    (305, 34.0, 54.0, [25.0, 62.0], [17.0, 24.0]),
    (306, 40.5, 62.5, [30.0, 72.0], [19.0, 27.0]),
    (307, 46.2, 70.2, [35.0, 80.0], [21.0, 31.0]),
    (308, 52.0, 80.0, [40.0, 90.0], [23.0, 33.0]),
    (309, 58.5, 88.5, [45.0, 100.0], [25.0, 36.0]),
    (310, 65.0, 97.0, [50.0, 110.0], [27.0, 40.0]),
    (311, 70.5, 106.5, [55.0, 120.0], [29.0, 43.0]),
    (312, 77.0, 115.0, [60.0, 130.0], [31.0, 46.0]),
    (313, 82.5, 124.5, [65.0, 140.0], [33.0, 48.0]),
    (314, 89.0, 133.0, [70.0, 150.0], [35.0, 51.0]),
    (315, 95.0, 143.0, [75.0, 160.0], [37.0, 55.0]),
    (316, 101.0, 151.0, [80.0, 170.0], [39.0, 58.0]),
    (317, 108.0, 160.0, [85.0, 180.0], [41.0, 60.0]),
    (318, 113.5, 169.5, [90.0, 190.0], [43.0, 64.0]),
    (319, 121.5, 177.5, [95.0, 200.0], [45.0, 67.0]),
    (320, 127.5, 191.5, [100.0, 215.0], [47.0, 73.0]),
];

/// Raceway diameter F [mm] of cylindrical roller bearings of series 10, from number 5 on; bore, outside diameter and
/// width are those of the ball bearings of series 60.
const LIGHT_SERIES: [f64; 16] =
    [30.5, 36.5, 42.0, 47.0, 52.5, 57.5, 64.5, 69.5, 74.5, 80.0, 85.0, 91.5, 96.5, 103.0, 108.0, 113.0];

/// The size whose raceways are printed nowhere: 15 + 27·(24.2 − 17)/30 and 15 + 27·(40.2 − 17)/30 mm, to a
/// tenth.
const IN_PROPORTION: u32 = 302;

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

/// Deep groove ball bearings whose designations begin alike, by the number of their bore from `first` on: outside
/// diameters and widths [mm] by ISO 15. The bore of a miniature is its number in millimetres.
struct Series {
    begins: &'static str,
    first: usize,
    outside: &'static [f64],
    width: &'static [f64],
}

/// Outside diameters [mm] of the series of diameters 0, 2 and 3, numbers 0 to 22.
const OUTSIDE: [[f64; 23]; 3] = [
    [
        26.0, 28.0, 32.0, 35.0, 42.0, 47.0, 55.0, 62.0, 68.0, 75.0, 80.0, 90.0, 95.0, 100.0, 110.0, 115.0,
        125.0, 130.0, 140.0, 145.0, 150.0, 160.0, 170.0,
    ],
    [
        30.0, 32.0, 35.0, 40.0, 47.0, 52.0, 62.0, 72.0, 80.0, 85.0, 90.0, 100.0, 110.0, 120.0, 125.0, 130.0,
        140.0, 150.0, 160.0, 170.0, 180.0, 190.0, 200.0,
    ],
    [
        35.0, 37.0, 42.0, 47.0, 52.0, 62.0, 72.0, 80.0, 90.0, 100.0, 110.0, 120.0, 130.0, 140.0, 150.0,
        160.0, 170.0, 180.0, 190.0, 200.0, 215.0, 225.0, 240.0,
    ],
];

const DEEP_GROOVE: [Series; 9] = [
    Series {
        begins: "60",
        first: 0,
        outside: &OUTSIDE[0],
        width: &[
            8.0, 8.0, 9.0, 10.0, 12.0, 12.0, 13.0, 14.0, 15.0, 16.0, 16.0, 18.0, 18.0, 18.0, 20.0, 20.0,
            22.0, 22.0, 24.0, 24.0, 24.0, 26.0, 28.0,
        ],
    },
    Series {
        begins: "62",
        first: 0,
        outside: &OUTSIDE[1],
        width: &[
            9.0, 10.0, 11.0, 12.0, 14.0, 15.0, 16.0, 17.0, 18.0, 19.0, 20.0, 21.0, 22.0, 23.0, 24.0, 25.0,
            26.0, 28.0, 30.0, 32.0, 34.0, 36.0, 38.0,
        ],
    },
    Series {
        begins: "63",
        first: 0,
        outside: &OUTSIDE[2],
        width: &[
            11.0, 12.0, 13.0, 14.0, 15.0, 17.0, 19.0, 21.0, 23.0, 25.0, 27.0, 29.0, 31.0, 33.0, 35.0, 37.0,
            39.0, 41.0, 43.0, 45.0, 47.0, 49.0, 50.0,
        ],
    },
    Series {
        begins: "622",
        first: 0,
        outside: &OUTSIDE[1],
        width: &[14.0, 14.0, 14.0, 16.0, 18.0, 18.0, 20.0, 23.0, 23.0, 23.0, 23.0, 25.0, 28.0, 31.0, 31.0],
    },
    Series {
        begins: "623",
        first: 0,
        outside: &OUTSIDE[2],
        width: &[17.0, 17.0, 17.0, 19.0, 21.0, 24.0, 27.0, 31.0, 33.0, 36.0, 40.0],
    },
    Series {
        begins: "64",
        first: 3,
        outside: &[62.0, 72.0, 80.0, 90.0, 100.0, 110.0, 120.0, 130.0, 140.0, 150.0, 160.0, 180.0, 190.0],
        width: &[17.0, 19.0, 21.0, 23.0, 25.0, 27.0, 29.0, 31.0, 33.0, 35.0, 37.0, 42.0, 45.0],
    },
    Series {
        begins: "68",
        first: 0,
        outside: &[
            19.0, 21.0, 24.0, 26.0, 32.0, 37.0, 42.0, 47.0, 52.0, 58.0, 65.0, 72.0, 78.0, 85.0, 90.0, 95.0,
            100.0, 110.0, 115.0, 120.0, 125.0,
        ],
        width: &[
            5.0, 5.0, 5.0, 5.0, 7.0, 7.0, 7.0, 7.0, 7.0, 7.0, 7.0, 9.0, 10.0, 10.0, 10.0, 10.0, 10.0, 13.0,
            13.0, 13.0, 13.0,
        ],
    },
    Series {
        begins: "69",
        first: 0,
        outside: &[
            22.0, 24.0, 28.0, 30.0, 37.0, 42.0, 47.0, 55.0, 62.0, 68.0, 72.0, 80.0, 85.0, 90.0, 100.0, 105.0,
            110.0, 120.0, 125.0, 130.0, 140.0,
        ],
        width: &[
            6.0, 6.0, 7.0, 7.0, 9.0, 9.0, 9.0, 10.0, 12.0, 12.0, 12.0, 13.0, 13.0, 13.0, 16.0, 16.0, 16.0,
            18.0, 18.0, 18.0, 20.0,
        ],
    },
    Series {
        begins: "160",
        first: 2,
        outside: &[
            32.0, 35.0, 42.0, 47.0, 55.0, 62.0, 68.0, 75.0, 80.0, 90.0, 95.0, 100.0, 110.0, 115.0, 125.0,
            130.0, 140.0, 145.0, 150.0,
        ],
        width: &[
            8.0, 8.0, 8.0, 8.0, 9.0, 9.0, 9.0, 10.0, 10.0, 11.0, 11.0, 11.0, 13.0, 13.0, 14.0, 14.0, 16.0,
            16.0, 16.0,
        ],
    },
];

const MINIATURE: [Series; 5] = [
    Series {
        begins: "60",
        first: 4,
        outside: &[12.0, 14.0, 17.0, 19.0, 22.0, 24.0],
        width: &[4.0, 5.0, 6.0, 6.0, 7.0, 7.0],
    },
    Series {
        begins: "62",
        first: 3,
        outside: &[10.0, 13.0, 16.0, 19.0, 22.0, 24.0, 26.0],
        width: &[4.0, 5.0, 5.0, 6.0, 7.0, 8.0, 8.0],
    },
    Series {
        begins: "63",
        first: 3,
        outside: &[13.0, 16.0, 19.0, 22.0, 26.0, 28.0, 30.0],
        width: &[5.0, 5.0, 6.0, 7.0, 9.0, 9.0, 10.0],
    },
    Series {
        begins: "68",
        first: 3,
        outside: &[7.0, 9.0, 11.0, 13.0, 14.0, 16.0, 17.0],
        width: &[2.0, 2.5, 3.0, 3.5, 3.5, 4.0, 4.0],
    },
    Series {
        begins: "69",
        first: 3,
        outside: &[8.0, 11.0, 13.0, 15.0, 17.0, 19.0, 20.0],
        width: &[3.0, 4.0, 4.0, 5.0, 5.0, 6.0, 6.0],
    },
];

/// Bearings that a plane model does not have, by what their designations begin with: series of outside diameters,
/// first number, element, its diameter over (outside − bore), contact angle [°]. Makers print neither: the last two
/// are usual ones (own).
const BEYOND_A_PLANE: [(&str, usize, usize, Element, f64, f64); 20] = [
    ("12", 1, 0, Element::Ball, 0.25, 10.0),
    ("13", 2, 0, Element::Ball, 0.25, 10.0),
    ("22", 1, 0, Element::Ball, 0.25, 13.0),
    ("23", 2, 0, Element::Ball, 0.25, 15.0),
    ("70", 0, 0, Element::Ball, 0.3, 15.0),
    ("72", 1, 0, Element::Ball, 0.3, 40.0),
    ("73", 2, 0, Element::Ball, 0.3, 40.0),
    ("32", 1, 0, Element::Ball, 0.3, 30.0),
    ("33", 2, 0, Element::Ball, 0.3, 30.0),
    ("213", 2, 4, Element::Roller, 0.27, 9.0),
    ("222", 1, 5, Element::Roller, 0.28, 10.0),
    ("223", 2, 8, Element::Roller, 0.28, 13.0),
    ("302", 1, 2, Element::Roller, 0.26, 14.0),
    ("303", 2, 2, Element::Roller, 0.26, 12.0),
    ("313", 2, 5, Element::Roller, 0.26, 28.0),
    ("320", 0, 4, Element::Roller, 0.26, 15.0),
    ("322", 1, 4, Element::Roller, 0.26, 14.0),
    ("323", 2, 3, Element::Roller, 0.26, 12.0),
    ("330", 0, 5, Element::Roller, 0.26, 13.0),
    ("332", 1, 5, Element::Roller, 0.26, 13.0),
];

/// Width of the outer ring of UC inserts [mm] with bores of 20 to 70 mm. Smaller bores have the outer ring and the
/// balls of the first.
const INSERT_WIDTH: [f64; 11] = [17.0, 17.0, 19.0, 20.0, 21.0, 22.0, 24.0, 25.0, 27.0, 28.0, 30.0];
const FIRST_INSERT: usize = 4;

/// Bore [mm] of the number in a designation, ISO 15.
fn bore_mm(number: usize) -> f64 {
    match number {
        0..=3 => [10.0, 12.0, 15.0, 17.0][number],
        _ => 5.0 * number as f64,
    }
}

/// Ball and pitch diameter [mm] by the rule of [`BALL_RULE`].
pub(super) fn balls_mm([bore, outside, width]: [f64; 3]) -> [f64; 2] {
    [(0.3 * (outside - bore)).min(0.8 * width), 0.5 * (bore + outside)]
}

/// All bearings that have a name here.
pub fn all() -> Vec<CatalogueBearing> {
    let others = OTHERS.iter().copied().map(of_row);
    others.chain(deep_groove()).chain(inserts()).chain(cylindrical()).chain(beyond_a_plane()).collect()
}

fn deep_groove() -> impl Iterator<Item = CatalogueBearing> {
    let listed = |name: &str| OTHERS.iter().any(|row| row.0 == name);
    let numbered = |series: &'static Series| {
        let sizes = series.outside.iter().zip(series.width).enumerate();
        sizes.map(|(at, (&outside, &width))| (series.begins, series.first + at, outside, width))
    };
    let usual = DEEP_GROOVE.iter().flat_map(numbered).map(|(begins, number, outside, width)| {
        by_rule(format!("{begins}{number:02}"), [bore_mm(number), outside, width], BALL_RULE)
    });
    let miniature = MINIATURE.iter().flat_map(numbered).map(|(begins, number, outside, width)| {
        by_rule(format!("{begins}{number}"), [number as f64, outside, width], BALL_RULE)
    });
    usual.chain(miniature).filter(move |bearing| !listed(&bearing.name))
}

fn beyond_a_plane() -> impl Iterator<Item = CatalogueBearing> {
    BEYOND_A_PLANE.iter().flat_map(|&(begins, series, first, element, share, angle_deg)| {
        OUTSIDE[series].iter().enumerate().skip(first).map(move |(number, &outside)| {
            let bore = bore_mm(number);
            CatalogueBearing {
                name: format!("{begins}{number:02}"),
                element,
                elements: None,
                diameter_mm: share * (outside - bore),
                pitch_mm: 0.5 * (bore + outside),
                angle_deg,
                boundary: None,
                source: BEYOND_RULE.to_owned(),
            }
        })
    })
}

fn inserts() -> impl Iterator<Item = CatalogueBearing> {
    (1..FIRST_INSERT + INSERT_WIDTH.len()).map(|number| {
        let size = number.max(FIRST_INSERT);
        let boundary = [bore_mm(size), OUTSIDE[1][size], INSERT_WIDTH[size - FIRST_INSERT]];
        let of_size = by_rule(format!("UC2{number:02}"), boundary, INSERT_RULE);
        let boundary = of_size.boundary.map(|boundary| Boundary { bore_mm: bore_mm(number), ..boundary });
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
    [0, 1].into_iter().flat_map(move |wide| {
        CYLINDRICAL.iter().map(move |&(size, f, e, [bore, outside], widths)| {
            let source = if size == IN_PROPORTION { PROPORTION } else { E_TYPE };
            // 210 in its narrow series, 2210 in its wide one.
            let name = format!("{flanges} {}{size}", if wide == 1 { "2" } else { "" });
            of_raceways(name, [f, e], [bore, outside, widths[wide]], source)
        })
    })
}

fn light_series(flanges: &'static str) -> impl Iterator<Item = CatalogueBearing> {
    const FIRST: usize = 5;
    LIGHT_SERIES.iter().enumerate().map(move |(at, &f)| {
        let number = FIRST + at;
        let (bore, outside) = (bore_mm(number), OUTSIDE[0][number]);
        let boundary = [bore, outside, DEEP_GROOVE[0].width[number]];
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
        for (size, f, e, [bore, outside], [narrow, wide]) in CYLINDRICAL {
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
        let mut names: Vec<String> = all().into_iter().map(|bearing| bearing.name).collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
        assert!(count > 300, "{count}");
    }
}
