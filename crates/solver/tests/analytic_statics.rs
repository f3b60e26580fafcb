//! Static equilibrium against closed forms: cantilever, thick cylinder under pressure, spinning ring.

mod common;
use common::*;
use stribeck_mesh::Annulus;
use stribeck_solver::{Dynamics, Model, Motion, force::NodalLoad};
use stribeck_testing::{assert_close, ledger, orders};

const INNER: f64 = 0.05;
const OUTER: f64 = 0.1;

/// Unbalanced force allowed [N]: E · thickness = 1.5e9 N/m rounds a force of strained cells to some 1e-8 N of loads of
/// newtons.
const ROUNDING: f64 = 2e-7;

fn ring(facets: usize, layers: usize) -> Model {
    let ring = Annulus {
        inner_radius: INNER,
        outer_radius: OUTER,
        facets,
        layers,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    body(&ring.part().expect("a ring that can be made"))
}

/// Mean radial displacement [m] of the row of nodes that starts at `first`.
fn growth(d: &Dynamics, model: &Model, first: usize, facets: usize) -> f64 {
    let radial = |n: usize| {
        let (x, y, s) = (model.mesh.x[n], model.mesh.y[n], slot(d, n));
        d.state.x[s].hypot(d.state.y[s]) - x.hypot(y)
    };
    (first..first + facets).map(radial).sum::<f64>() / facets as f64
}

/// Radial growth of bore and rim [m] under the inner pressure `p` [Pa].
fn under_pressure(facets: usize, layers: usize, p: f64) -> [f64; 2] {
    let model = ring(facets, layers);
    let mut d = lay_out(&model);
    // Half of the force on each of the two chords that meet at a node: p · chord · thickness, along the chord's normal.
    let half_angle = std::f64::consts::PI / facets as f64;
    let push = p * THICKNESS * 2.0 * INNER * half_angle.sin() * half_angle.cos();
    let at = |n: usize| (model.mesh.x[n] / INNER, model.mesh.y[n] / INNER);
    let loads = (0..facets).map(|n| (slot(&d, n) as u32, push * at(n).0, push * at(n).1)).collect();
    equilibrate(&mut d, &mut [&mut NodalLoad::new(loads)], Vec::new(), ROUNDING).expect("a balanced load");
    [growth(&d, &model, 0, facets), growth(&d, &model, layers * facets, facets)]
}

#[test]
fn converges_lame_thick_cylinder() {
    // Timoshenko and Goodier, Theory of Elasticity (1970), §28, plane strain:
    // u(r) = (1 + ν) p a² / (E (b² − a²)) · [(1 − 2ν) r + b²/r].
    let p = 1e6;
    let (e, nu) = (steel().youngs_modulus(), steel().poissons_ratio());
    let (a2, b2) = (INNER * INNER, OUTER * OUTER);
    let exact = |r: f64| (1.0 + nu) * p * a2 / (e * (b2 - a2)) * ((1.0 - 2.0 * nu) * r + b2 / r);
    let found = [(24, 3), (48, 6), (96, 12)].map(|(facets, layers)| under_pressure(facets, layers, p));
    for (i, r, what) in [(0, INNER, "bore"), (1, OUTER, "rim")] {
        let errors = found.map(|u| (u[i] - exact(r)).abs() / exact(r));
        for order in orders(&errors) {
            assert!((1.8..2.3).contains(&order), "{what}: order {order}, errors {errors:?}");
        }
        let source = "Lamé: Timoshenko and Goodier 1970, §28";
        ledger::compare(
            &format!("thick cylinder under pressure, {what}"),
            source,
            "m",
            found[2][i],
            exact(r),
            3e-3,
        );
    }
}

#[test]
fn analytic_spinning_ring() {
    // Timoshenko and Goodier §32, rotating disc with a hole; plane strain by E → E/(1−ν²), ν → ν/(1−ν):
    // σr = (3+ν)/8 ρω² (a² + b² − a²b²/r² − r²), σθ = ρω²/8 [(3+ν)(a² + b² + a²b²/r²) − (1+3ν) r²],
    // u = r (σθ − ν σr)/E.
    let rate = 500.0;
    let s = steel();
    let (e, nu) = (s.plane_strain_modulus(), s.poissons_ratio() / (1.0 - s.poissons_ratio()));
    let (a2, b2) = (INNER * INNER, OUTER * OUTER);
    let q = s.density() * rate * rate / 8.0;
    // Both surfaces are free of radial stress, so that u = r σθ/E.
    let exact = |r: f64| {
        let hoop = q * ((3.0 + nu) * (a2 + b2 + a2 * b2 / (r * r)) - (1.0 + 3.0 * nu) * r * r);
        r * hoop / e
    };
    let (facets, layers) = (96, 12);
    let model = ring(facets, layers);
    let mut d = lay_out(&model);
    let inward = |n: usize| [-rate * rate * d.state.x[n], -rate * rate * d.state.y[n]];
    let acceleration: Vec<_> = (0..d.state.x.len()).map(inward).collect();
    equilibrate(&mut d, &mut [], acceleration, ROUNDING).expect("a balanced load");
    // Second order with 12 layers: see the thick cylinder.
    let source = "Timoshenko and Goodier 1970, §32";
    ledger::compare("spinning ring, bore", source, "m", growth(&d, &model, 0, facets), exact(INNER), 4e-3);
    let rim = growth(&d, &model, layers * facets, facets);
    ledger::compare("spinning ring, rim", source, "m", rim, exact(OUTER), 4e-3);
}

/// Tip deflection [m] of a clamped beam of `columns` × `rows` cells under the end load `p` [N].
fn tip_deflection(length: f64, height: f64, columns: usize, rows: usize, p: f64) -> f64 {
    let mut model = body(&rectangle(length, height, columns, rows));
    for row in 0..=rows {
        model.motion[row * (columns + 1)] = Motion::Held;
    }
    let mut d = lay_out(&model);
    let end = |row: usize| row * (columns + 1) + columns;
    let share = -p / (rows + 1) as f64;
    let loads = (0..=rows).map(|r| (slot(&d, end(r)) as u32, 0.0, share)).collect();
    equilibrate(&mut d, &mut [&mut NodalLoad::new(loads)], Vec::new(), ROUNDING).expect("a held beam");
    -(0..=rows).map(|r| d.state.y[slot(&d, end(r))] - model.mesh.y[end(r)]).sum::<f64>() / (rows + 1) as f64
}

#[test]
fn analytic_cantilever() {
    // Timoshenko and Goodier §21 with Cowper's shear coefficient (J. Appl. Mech. 33, 1966) of a rectangle in plane
    // strain, κ = 5/6: δ = P L³/(3 E' I) + P L/(κ µ A).
    let (length, height, p) = (0.1_f64, 0.01_f64, 1.0);
    let inertia = THICKNESS * height.powi(3) / 12.0;
    let bending = p * length.powi(3) / (3.0 * steel().plane_strain_modulus() * inertia);
    let shear = p * length / (5.0 / 6.0 * steel().shear() * THICKNESS * height);
    // Four square cells through the height: one-point elements with the exact bending stiffness of a square leave
    // what linear shear misses of the parabola, and the clamp, which lets no section warp.
    let found = tip_deflection(length, height, 40, 4, p);
    assert_close(found, bending + shear, 0.01, "tip deflection");
    // One cell through the height is right for the same reason: no shear locking.
    let found = tip_deflection(length, height, 10, 1, p);
    assert_close(found, bending + shear, 0.02, "tip deflection, one cell through the height");
}

#[test]
fn example_column_under_its_weight() {
    // A column on a base without friction at its sides (held in x: uniaxial strain): the top sinks by
    // ρ g H²/(2 (λ + 2µ)), with lumped masses exactly.
    let height = 0.2;
    let mut model = body(&rectangle(0.02, height, 2, 20));
    model.gravity = [0.0, -9.81];
    for n in 0..model.mesh.x.len() {
        model.motion[n] = if n < 3 { Motion::Held } else { Motion::HeldX };
    }
    let mut d = lay_out(&model);
    equilibrate(&mut d, &mut [], Vec::new(), ROUNDING).expect("a held column");
    let s = steel();
    let sinks = s.density() * 9.81 * height * height / (2.0 * (s.lame() + 2.0 * s.shear()));
    let top = slot(&d, model.mesh.x.len() - 1);
    assert_close(height - d.state.y[top], sinks, 1e-5, "the top sinks");
}

#[test]
fn example_a_run_from_equilibrium_does_not_ring() {
    // The column again, now in time: what was in equilibrium stays.
    let mut model = body(&rectangle(0.02, 0.2, 2, 20));
    model.gravity = [0.0, -9.81];
    for n in 0..3 {
        model.motion[n] = Motion::Held;
    }
    let mut d = ready(&model, 0.9);
    equilibrate(&mut d, &mut [], Vec::new(), ROUNDING).expect("a held column");
    let before = d.state.y.clone();
    run(&mut d, &mut [], 5000);
    let moved = d.state.y.iter().zip(&before).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    // Without preload the top would swing by twice its static 7 nm.
    assert!(moved < 1e-12, "{moved:e} m");
}
