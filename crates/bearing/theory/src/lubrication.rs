//! Oil films of loaded contacts in steady rolling, from the textbook: for a plan, and for the least thickness
//! that a film keeps (THEORY §4.6). No pressure is computed.

use crate::bearing::Bearing;
use crate::kinematics::Kinematics;

/// Oil between rollers and raceways.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oil {
    /// Dynamic viscosity η [Pa s].
    pub viscosity: f64,
    /// Pressure–viscosity coefficient α [1/Pa].
    pub pressure_viscosity: f64,
    /// Composite roughness [m].
    pub roughness: f64,
}

/// The film of the most loaded roller on one raceway.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadedFilm {
    /// Relative radius R [m].
    pub radius: f64,
    /// Entrainment speed u [m/s]: half the sum of the speeds of both surfaces against the contact, positive.
    pub speed: f64,
    /// Least film thickness between smooth surfaces [m], elastohydrodynamic.
    pub thickness: f64,
    /// Thickness over the composite roughness, λ [-].
    pub lambda: f64,
    /// Thickness below which no film of the raceway falls [m]: that of the loaded contact, or where it is
    /// thinner the composite roughness, whose tips then hold the surfaces apart.
    pub least: f64,
}

/// Films on the outer and on the inner raceway of a roller under the force `roller_n` [N], while the rings turn
/// as `kinematics` says; thicknesses are those at `slowest` times these speeds.
pub fn loaded_films(
    bearing: impl Into<Bearing>,
    oil: &Oil,
    kinematics: &Kinematics,
    slowest: f64,
    roller_n: f64,
) -> [LoadedFilm; 2] {
    let (bearing, k) = (bearing.into(), kinematics);
    let load = roller_n / bearing.thickness;
    // The contact moves over each raceway: with the cage over the outer one, relative to the shaft over the
    // inner one.
    let speeds = [
        (k.cage_rad_s - k.outer_rad_s).abs() * bearing.outer_race_radius,
        (k.shaft_rad_s - k.cage_rad_s).abs() * bearing.inner_race_radius,
    ];
    let modulus = 2.0 * bearing.material.contact_modulus();
    let of = |radius: f64, speed: f64| {
        let slow = slowest * speed;
        let thickness = least_thickness(oil.viscosity, oil.pressure_viscosity, modulus, radius, slow, load);
        LoadedFilm {
            radius,
            speed,
            thickness,
            lambda: thickness / oil.roughness,
            least: thickness.max(oil.roughness),
        }
    };
    [of(bearing.outer_contact_radius(), speeds[0]), of(bearing.inner_contact_radius(), speeds[1])]
}

/// Least film thickness of a loaded line contact [m]:
///
/// ```text
/// h = 2.65 R G^0.54 U^0.7 W^−0.13     G = αE′,  U = ηu/(E′R),  W = w/(E′R)
/// ```
///
/// with the viscosity η [Pa s], its pressure coefficient α [1/Pa], E′ = E/(1 − ν²) of like bodies [Pa], the
/// relative radius R [m], the entrainment speed u [m/s] and the load a length w [N/m]. Source: D. Dowson,
/// Proc. Instn Mech. Engrs 182 (3A) (1967–68) 151–167, after D. Dowson, G. R. Higginson, Elasto-hydrodynamic
/// Lubrication, Pergamon 1966.
fn least_thickness(
    viscosity: f64,
    pressure_viscosity: f64,
    modulus: f64,
    radius: f64,
    speed: f64,
    load: f64,
) -> f64 {
    let stiff = modulus * radius;
    let (g, u, w) = (pressure_viscosity * modulus, viscosity * speed / stiff, load / stiff);
    2.65 * radius * libm::pow(g, 0.54) * libm::pow(u, 0.7) * libm::pow(w, -0.13)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::{
        bearing::singh2014::{BEARING, DIMENSIONS},
        line_contact::LineContacts,
    };

    /// The film at the paper's outer raceway under 12 kN, and the damper that its wedge is, as THEORY §4.6 prints
    /// them for both thicknesses: the loss 12 η q²/h³ beside the Hertz contact, by the trapezoidal rule.
    #[test]
    fn analytic_numbers_of_theory_on_the_loaded_film() {
        const ROUNDING: f64 = 0.02;
        const FORCE: f64 = 12e3;
        let oil = Oil { viscosity: 0.05, pressure_viscosity: 22e-9, roughness: 0.3e-6 };
        for (thickness, film_um, steady_nm, stiffer, damper) in
            [(0.03, 0.51, 14.3, 139.0, 141.0), (0.15, 0.63, 71.4, 27.0, 1640.0)]
        {
            let bearing = Bearing { thickness, ..BEARING };
            let film = loaded_films(bearing, &oil, &Kinematics::new(DIMENSIONS, 500.0), 1.0, FORCE)[0];
            let (h, w) = (film.thickness, FORCE / thickness);
            let steady = 4.895 * oil.viscosity * film.speed * film.radius / w;
            let k = thickness / LineContacts::of(bearing).approach_at(0, w).1;
            let modulus = bearing.material.contact_modulus();
            let b = (4.0 * w * film.radius / (PI * modulus)).sqrt();
            // Over a = arccosh ξ, by which the gap closes.
            let (step, mut flow, mut loss) = (1e-4, 0.0, 0.0);
            for n in 0..90_000 {
                let a = (f64::from(n) + 0.5) * step;
                let way = b * a.sinh() * step;
                flow += a * way;
                let gap = h + b * b / (2.0 * film.radius) * (a.cosh() * a.sinh() - a);
                loss += 12.0 * oil.viscosity * flow * flow / gap.powi(3) * way;
            }
            // ẇ is k over the thickness for each metre a second of approach.
            let found = loss * (2.0 / (PI * modulus) * k).powi(2) / thickness;
            for (ours, printed) in [
                (1e6 * h, film_um),
                (1e9 * steady, steady_nm),
                (w * thickness / (0.13 * h) / k, stiffer),
                (found, damper),
            ] {
                assert!((ours / printed - 1.0).abs() < ROUNDING, "{thickness} m: {ours}, not {printed}");
            }
        }
    }

    /// B. J. Hamrock, S. R. Schmid, B. O. Jacobson, Fundamentals of Fluid Film Lubrication, 2nd ed. 2004, use
    /// the same groups. By hand, for η = 0.04 Pa s, α = 22/GPa, E′ = 228 GPa, R = 11.43 mm, u = 2 m/s and w =
    /// 500 kN/m: G = 5016, U = 3.0698e-11, W = 1.9186e-4, so 2.65 · 99.65 · 4.378e-8 · 3.042 · 11.43 mm =
    /// 0.402 µm.
    #[test]
    fn analytic_film_of_a_loaded_line_contact() {
        let found = least_thickness(0.04, 22e-9, 228e9, 11.43e-3, 2.0, 5e5);
        assert!((found / 0.402e-6 - 1.0).abs() < 0.01, "{found}");
    }
}
