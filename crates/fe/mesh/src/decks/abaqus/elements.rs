//! Which types of elements are plane, which are passed over, and which are refused.

/// Families of plane elements; digits behind them are the number of nodes: CPE4R, CPS3, S4R, M3D4.
const PLANE: [&str; 16] = [
    "CPEG", "CPE", "CPS", "CAX", "CGAX", "M3D", "SFM3D", "AC2D", "DC2D", "DCAX", "ACAX", "R2D", "R3D",
    "STRI", "DS", "S",
];

/// Families of elements along lines. Those of trusses, beams and rigid links have their two ends, or three
/// nodes in a row.
const LINES: [&str; 16] = [
    "T2D", "T3D", "B2", "B3", "PIPE2", "PIPE3", "R2D2", "RB2D2", "RB3D2", "RAX2", "SAX", "MAX1", "DC1D",
    "AC1D", "FRAME", "ELBOW",
];

/// Families of springs, masses, links and the like.
const POINTS: [&str; 12] = [
    "MASS", "ROTARYI", "HEATCAP", "SPRING", "DASHPOT", "CONN", "GAP", "JOINTC", "ITS", "DCOUP", "DGAP",
    "JOINT2D",
];

/// What becomes of a type of elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Read, with as many corners.
    Plane(usize),
    /// Passed over. The nodes that they connect bound surfaces.
    Line(usize),
    /// Passed over.
    Point,
    /// Plane, and of another order.
    Curved(usize),
    /// Anything else.
    Other,
}

/// By the name of the type, in capitals.
pub(super) fn kind(name: &str) -> Kind {
    let behind =
        |families: &[&str]| families.iter().find_map(|family| name.strip_prefix(family).map(str::to_owned));
    if behind(&POINTS).is_some() {
        return Kind::Point;
    }
    if let Some(rest) = behind(&LINES) {
        let three = rest.starts_with('3') || (name.starts_with('B') && rest.starts_with('2'));
        return Kind::Line(if three { 3 } else { 2 });
    }
    let nodes = PLANE.iter().find_map(|family| {
        let digits: String = name.strip_prefix(family)?.chars().take_while(char::is_ascii_digit).collect();
        digits.parse().ok()
    });
    match nodes {
        Some(corners @ (3 | 4)) => Kind::Plane(corners),
        // Rigid and axisymmetric ones of two nodes are lines.
        Some(2) => Kind::Line(2),
        Some(nodes @ (6..=9)) => Kind::Curved(nodes),
        _ => Kind::Other,
    }
}

/// Families of the elements that are read, for messages.
pub(super) const READ: &str = "plane ones of 3 or 4 nodes are (CPE4R, CPE3, CPS4 …)";
