//! The programs that solve the same problem, and how closely each must agree.

/// A program, as one of the scripts in `fixtures/peers` runs it.
#[derive(Debug)]
pub(super) struct Peer {
    /// Name for `--peers`; several variants may share it.
    pub(super) name: &'static str,
    /// The task of the script.
    pub(super) variant: &'static str,
    pub(super) script: &'static str,
    /// What pip installs for it; versions stand in `requirements.txt`.
    pub(super) packages: &'static [&'static str],
    /// Whether a thousand steps take seconds rather than minutes.
    pub(super) fast: bool,
    /// Largest difference from our displacements, relative to their norm.
    pub(super) tolerance: f64,
    /// Why not less.
    pub(super) reason: &'static str,
    /// Label of a program with the same element, and the largest difference from it.
    pub(super) twin: Option<(&'static str, f64)>,
}

/// Shapes are known to 3·10⁻¹⁴ from positions of 0.1 m; a body that is longer by as much everywhere is off by
/// 10⁻⁹ of displacements of some µm, and a thousand steps add about the same.
pub(super) const ROUNDING: f64 = 1e-8;
const SAME: &str = "same element: rounding";

/// Strains are about 2·10⁻⁴, and so are the terms that a small-strain element leaves out.
const LINEAR: f64 = 1e-3;

/// Two elements of the same order: the dispersion of waves differs by some (kh)²/24 = 4·10⁻⁵ a radian, over
/// ten radians and more in the short waves.
const DISPERSION: f64 = 2e-3;
const OTHER: &str = "another element: dispersion";

const NUMBA: Peer = Peer {
    name: "numba",
    variant: "grid",
    script: "numba_kernels.py",
    packages: &["numba", "numpy"],
    fast: true,
    tolerance: ROUNDING,
    reason: SAME,
    twin: None,
};

const FULL: Peer = Peer { name: "numba2x2", variant: "full", tolerance: DISPERSION, reason: OTHER, ..NUMBA };

const KRATOS: Peer = Peer {
    name: "kratos",
    variant: "small",
    script: "kratos_block.py",
    packages: &["kratosmultiphysics", "kratosstructuralmechanicsapplication", "numpy"],
    fast: false,
    tolerance: DISPERSION,
    reason: OTHER,
    twin: Some(("numba2x2 full", LINEAR)),
};

/// Programs on the block, fastest first.
pub(super) const ON_BLOCKS: [Peer; 10] = [
    Peer { variant: "strips", ..NUMBA },
    NUMBA,
    Peer { variant: "general", ..NUMBA },
    Peer { variant: "random", ..NUMBA },
    Peer {
        name: "scipy",
        variant: "matrix",
        script: "scipy_csr.py",
        packages: &["numpy", "scipy"],
        tolerance: LINEAR,
        reason: "same element, small strain",
        ..NUMBA
    },
    FULL,
    Peer { name: "akantu", script: "akantu_block.py", packages: &["akantu", "numpy"], ..KRATOS },
    KRATOS,
    Peer { variant: "total", twin: Some(("numba2x2 full", ROUNDING)), ..KRATOS },
    Peer { name: "openseespy", script: "opensees_block.py", packages: &["numpy", "openseespy"], ..KRATOS },
];

/// Programs on the disc between two blocks. Contact that opens and closes enlarges what rounding leaves.
pub(super) const ON_DISC: [Peer; 1] = [Peer {
    variant: "squeeze",
    script: "numba_squeeze.py",
    tolerance: 1e-7,
    reason: "same elements and contact: rounding",
    ..NUMBA
}];

impl Peer {
    /// Name and variant.
    pub(super) fn label(&self) -> String {
        format!("{} {}", self.name, self.variant)
    }
}
