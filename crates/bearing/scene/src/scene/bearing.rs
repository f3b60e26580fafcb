//! The bodies: rings, rolling elements, cage, adapter, their material, and the spall.

use serde::{Deserialize, Serialize};

use crate::{group, words};

group! {
    /// Rings and rolling elements (paper, Table 1).
    pub struct BearingScene {
        /// Designation; `bearing: "NU 205"` has all numbers from the catalogue
        /// ([`catalogue`](crate::catalogue)), and one that gives them may name the bearing here.
        pub designation: String = String::new(), before("\"\"");
        /// Diameter of the outer raceway [mm].
        pub outer_race_diameter_mm: f64 = 200.0, positive(20_000.0);
        /// Radial thickness of the outer ring [mm].
        pub outer_ring_thickness_mm: f64 = 10.0, positive(5_000.0);
        /// Diameter of the inner raceway [mm].
        pub inner_race_diameter_mm: f64 = 163.96, positive(20_000.0);
        /// Radial thickness of the inner ring [mm].
        pub inner_ring_thickness_mm: f64 = 10.0, positive(5_000.0);
        /// Change of the diametral clearance by fits, temperature or adjustment [µm], added to that of the
        /// diameters; negative reduces it, and beyond it preloads the rollers. It is applied to the inner
        /// raceway.
        pub clearance_change_um: f64 = 0.0, within(-1_000.0, 1_000.0), omitted();
        /// Rolling elements, where no name of the catalogue says what they are. In a file `balls` for `rollers` and
        /// `ball_diameter_mm` for `roller_diameter_mm` say that they are balls, too.
        pub element: ElementKind = ElementKind::Roller, omitted();
        /// Number of rolling elements.
        pub rollers: usize = 24, within(3.0, 400.0);
        /// Diameter of a rolling element [mm].
        pub roller_diameter_mm: f64 = 18.0, positive(5_000.0);
        /// Tolerance class, from which raceways have waves and rolling elements differ in diameter: what `stribeck
        /// new` writes. `None` for perfect ones.
        pub quality: Option<Quality> = None, omitted();
        /// Variation of the diameters of rolling elements within their set [µm], before that of `quality`: each is
        /// drawn from within half of it of its nominal value. Balls of grade 10 vary by 0.5 (V_DwL of ISO 3290-1),
        /// rollers of grade G2 by 2 (ISO 3096).
        pub diameter_variation_um: f64 = 0.0, within(0.0, 100.0), omitted();
        /// Seed of these draws, and of the waves of `quality`.
        pub diameter_seed: u64 = 1, within(0.0, 1e9), omitted();
        /// Profile of rollers along their length, in the reduced model.
        pub roller_profile: RollerProfile = RollerProfile::Straight, omitted();
        /// Out-of-plane thickness of the plane-strain model [mm], the length of rollers and the width of rings with
        /// balls; the paper does not state it.
        pub thickness_mm: f64 = 30.0, positive(10_000.0);
        /// Angle of the centre of roller 1 [°], counter-clockwise from the x axis; the others follow
        /// counter-clockwise.
        pub first_roller_deg: f64 = 94.0, within(-360.0, 360.0);
        /// Pitch diameter [mm], instead of the raceways: a bearing that is not of the catalogue gives this beside its
        /// rolling elements, and the next three where they are known; the fields above follow.
        pub pitch_mm: Option<f64> = None, positive(20_000.0), omitted();
        /// Bore [mm], instead of the inner ring's thickness.
        pub bore_mm: Option<f64> = None, positive(20_000.0), omitted();
        /// Outside diameter [mm], instead of the outer ring's thickness.
        pub outside_mm: Option<f64> = None, positive(20_000.0), omitted();
        /// Width of the rings [mm], instead of `thickness_mm`: rollers are usually 0.6 of it long, balls have all of it.
        pub width_mm: Option<f64> = None, positive(20_000.0), omitted();
        /// Dimensions that the user did not give and the program assumed; written by the program.
        pub assumed: Vec<Assumed> = Vec::new(), omitted();
    }
}

impl BearingScene {
    /// Diametral clearance as bought, without its change in operation [µm].
    pub fn clearance_um(&self) -> f64 {
        1e3 * (self.outer_race_diameter_mm - self.inner_race_diameter_mm - 2.0 * self.roller_diameter_mm)
    }
}

words! {
    /// A rolling element.
    pub enum ElementKind: Copy, Eq {
        /// A cylinder.
        Roller = "roller",
        /// A ball: a cylinder with its mass, which gives way as points do.
        Ball = "ball",
    }
}

words! {
    /// A tolerance class of ISO 492.
    pub enum Quality: Copy, Eq {
        /// Normal: most bearings.
        Normal = "normal",
        /// Class 6.
        P6 = "p6",
        /// Class 5, of spindles.
        P5 = "p5",
    }
}

words! {
    /// Profile of rollers along their length.
    pub enum RollerProfile: Copy, Eq {
        /// Cylinders, whose force sets in with a corner where they enter the load.
        Straight = "straight",
        /// Relieved towards the ends by 0.00035 D ln 1/(1 − (2x/l)²), the reference profile of ISO/TS
        /// 16281: a light load presses the middle alone, and the force sets in gently. What `stribeck new`
        /// writes.
        Logarithmic = "logarithmic",
    }
}

words! {
    /// A dimension of a bearing that the user did not give.
    pub enum Assumed: Copy, Eq {
        /// The clearance: the middle of the normal group (ISO 5753-1).
        Clearance = "clearance",
        /// The pitch diameter: half-way between bore and outside diameter.
        Pitch = "pitch",
        /// The thickness of the outer ring: 0.4 of a roller.
        OuterRing = "outer_ring",
        /// The thickness of the inner ring: 0.4 of a roller.
        InnerRing = "inner_ring",
        /// The number of rollers: with a fifth of the pitch circle free between them.
        Rollers = "rollers",
        /// The length of the rollers: 0.6 of the width, or, where that is unknown, their diameter.
        Length = "length",
    }
}

group! {
    /// Rigid cage: a ring cut into as many pieces as there are pockets.
    pub struct CageScene {
        /// Outer diameter [mm].
        pub outer_diameter_mm: f64 = 196.0, positive(20_000.0);
        /// Radial thickness [mm].
        pub thickness_mm: f64 = 4.0, positive(5_000.0);
        /// Gap between a centred roller and its pocket wall [µm].
        pub pocket_clearance_um: f64 = 100.0, within(0.0, 10_000.0);
        /// Which part of a roller the walls of its pocket touch.
        pub pocket: PocketWalls = PocketWalls::Straight, before("corners");
        /// How far each roller starts from the middle of its pocket along its path, counter-clockwise, roller
        /// 1 first [µm]; empty: all in the middle.
        pub roller_offsets_um: Vec<f64> = Vec::new(), within(-10_000.0, 10_000.0), before("[]");
    }
}

words! {
    /// Which part of a roller the walls of its pocket touch.
    pub enum PocketWalls: Copy, Eq {
        /// The part between the cage's diameters. Off the pitch circle the corners touch rollers above or
        /// below their centres, and push them radially, too.
        Corners = "corners",
        /// The flanks: walls extend across the pitch circle, and push tangentially only. The mass of the cage
        /// is that between its diameters.
        Straight = "straight",
    }
}

group! {
    /// Block with a concave seat on top of the outer ring.
    pub struct AdapterScene {
        /// Width [mm].
        pub width_mm: f64 = 160.0, positive(50_000.0);
        /// Height above the crown of the seat [mm].
        pub height_mm: f64 = 40.0, positive(50_000.0);
    }
}

group! {
    /// Spall on a raceway.
    pub struct DefectScene {
        /// Ring on whose raceway it lies; on the inner one it turns with the shaft.
        pub ring: DefectRing = DefectRing::Outer, before("outer");
        /// Circumferential length [mm], measured on the raceway.
        pub length_mm: f64 = 10.0, positive(20_000.0);
        /// Depth [mm].
        pub depth_mm: f64 = 0.2, positive(5_000.0);
        /// Angle of its centre at the start [°]; 90 is the top, in the middle of the load zone.
        pub angle_deg: f64 = 90.0, within(-360.0, 360.0);
        /// Angle between its edges and the raceway [°]; 90 for radial walls, 22 or more under oil.
        pub edge_slope_deg: f64 = 90.0, within(5.0, 90.0), before("90.0");
        /// Width across the raceway [mm]; `None` for the whole contact. A narrower one stands in the plane
        /// as a shallower one.
        pub width_mm: Option<f64> = None, positive(20_000.0), omitted();
    }
}

words! {
    /// One of the two rings.
    #[serde(rename_all = "snake_case")]
    pub enum DefectRing: Copy, Eq, Default, Serialize, Deserialize {
        /// The outer ring.
        #[default]
        Outer = "outer",
        /// The inner ring, which turns with the shaft.
        Inner = "inner",
    }
}

impl DefectRing {
    /// In words: `outer` or `inner`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Outer => "outer",
            Self::Inner => "inner",
        }
    }
}

group! {
    /// Linear elastic, isotropic, plane strain.
    pub struct MaterialScene {
        /// Young's modulus [GPa].
        pub youngs_modulus_gpa: f64 = 200.0, positive(10_000.0);
        /// Poisson's ratio [-].
        pub poissons_ratio: f64 = 0.3, below(0.0, 0.5);
        /// Density [kg/m³].
        pub density_kg_m3: f64 = 7850.0, positive(1e5);
    }
}
