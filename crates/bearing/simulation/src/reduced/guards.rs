//! Guards of a reduced run besides [the guards of all models](crate::run::guards): energy and penetration.

use crate::run::guards::{self, Placed, PlacedCage, When};
use stribeck_reduced::{bearing::Bearing, motion::BearingInMotion};
use stribeck_scene::{
    housing::HousingScene,
    resolved::ResolvedScene,
    scene::{ContactSurface, GuardsScene},
};
use stribeck_store::run_info::{RunInfo, Topic, Warning};
use stribeck_system::Ledger;

/// Imbalance of a run's ledger, and the energies that it is compared with.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LedgerError {
    /// The imbalance, and the energy stored in rings and contacts [J].
    imbalance: f64,
    stored: f64,
    /// Over the heat since the start.
    of_heat: f64,
    /// Over the energy of motion.
    of_motion: f64,
}

impl LedgerError {
    pub(super) fn of(ledger: &Ledger) -> Self {
        let heat = ledger.friction + ledger.damping + ledger.contact_damping + ledger.film;
        let imbalance = ledger.imbalance.abs();
        Self {
            imbalance,
            stored: ledger.strain + ledger.contact,
            of_heat: imbalance / heat.max(f64::MIN_POSITIVE),
            of_motion: imbalance / ledger.kinetic.max(f64::MIN_POSITIVE),
        }
    }

    /// Its share of the most that rings and contacts have stored, which is `most` [J], in per cent. Rings in
    /// a rigid housing store next to nothing, contacts do.
    fn percent(&self, most: f64) -> f64 {
        100.0 * self.imbalance / most.max(f64::MIN_POSITIVE)
    }

    /// Whether an imbalance of `percent` of the largest stored energy is a divergence. A run that turns
    /// energy into heat for seconds accumulates the error of the time step, one or two thousandths of the
    /// heat, and in time exceeds any share of the stored energy; under a very light load the imbalance is
    /// some billionths of the kinetic energy. Neither is a divergence, which exceeds both other shares at
    /// once.
    fn is_divergence(&self, percent: f64, stop_percent: f64) -> bool {
        let apart = percent > stop_percent && self.of_heat > GATHERED && self.of_motion > OF_MOTION;
        apart || percent.is_nan() || self.of_heat.is_nan()
    }

    /// Its share of the heat, in words.
    fn share_of_heat(&self) -> String {
        match 100.0 * self.of_heat {
            percent if percent < 0.1 => format!("{percent:.3} % of all heat"),
            percent if percent < 100.0 => format!("{percent:.1} % of all heat"),
            // A bearing without friction and damping dissipates next to nothing.
            _ => "more than all heat".to_owned(),
        }
    }
}

/// A divergence exceeds these shares of the heat and of the kinetic energy.
const GATHERED: f64 = 0.01;
const OF_MOTION: f64 = 1e-6;

/// With fewer modes in a seat none may be among them in which the ring bends: two or three are motions of the
/// whole.
const FEW_MODES: usize = 5;

/// A cage that strays by more than this share of a roller's radius is not held by its pockets.
const ASTRAY: f64 = 0.1;

/// With fewer layers of elements in the outer ring forces of rollers differ between both models: in an NU 205 under
/// 1.5 kN by 2.5 % of the largest with three, by 1.2 % with four and by 0.6 % with five.
const LAYERS: f64 = 3.5;

/// Where the model is known to differ from the full one by more than a per cent of the largest roller force or
/// by 3 dB (docs/guide/src/reduced.md).
fn apart(scene: &ResolvedScene) -> Option<String> {
    let on_facets = scene.written.contact.surface == ContactSurface::Facet;
    match scene.written.housing {
        HousingScene::Rigid(_) if on_facets => Some(
            "a rigid housing rings on the contacts as facets pass, and nothing but contact damps it: roller \
             forces may be off the full model's by 4 % of the largest, levels by 5 dB. Take \
             `contact.surface: arc`"
                .to_owned(),
        ),
        HousingScene::Pedestal(_) => Some(
            "accelerations in a pedestal may be up to 13 dB lower than in the full model from 0.5 to 1.6 kHz \
             and from 4 to 6 kHz; roller forces hold"
                .to_owned(),
        ),
        HousingScene::Adapter if scene.outer_ring_thickness < LAYERS * scene.element_size => Some(format!(
            "the outer ring has {:.1} layers of elements: roller forces may be off the full model's by 5 % of \
             the largest. Take a `mesh.size_mm` of {:.2} or less",
            scene.outer_ring_thickness / scene.element_size,
            1e3 * scene.outer_ring_thickness / LAYERS
        )),
        _ => None,
    }
}

#[derive(Debug, Clone)]
pub(super) struct Guards {
    shared: guards::Guards,
    limits: GuardsScene,
    element_size: f64,
    roller_radius: f64,
    placed: Placed,
}

impl Guards {
    pub(super) fn new(scene: &ResolvedScene) -> Self {
        Self {
            shared: guards::Guards::new(scene, "`model.step_us`"),
            limits: GuardsScene {
                penetration_warning_percent: scene.soft_percent(),
                ..scene.written.guards.clone()
            },
            element_size: scene.element_size,
            roller_radius: scene.roller_radius,
            placed: Placed::default(),
        }
    }

    /// Warnings before the first step.
    pub(super) fn before(scene: &ResolvedScene, bearing: &Bearing) -> Vec<Warning> {
        let mut warnings = Vec::new();
        let modes = bearing.reduction.modes;
        if bearing.has_seat() && modes < FEW_MODES {
            warnings.push(Topic::Modes.warning(format!(
                "only {modes} modes of ring and housing lie below `model.modes_khz`, and the ring may bend \
                 in none of them: such runs find no start or gain energy with steps of any length. Take a \
                 larger `model.modes_khz`"
            )));
        }
        warnings.extend(apart(scene).map(|words| Topic::Modes.warning(words)));
        warnings
    }

    /// Looks at a bearing after a sample, and at the imbalance of its energy: adds warnings to `info`; the
    /// reason to stop, if there is one.
    pub(super) fn look(
        &mut self,
        info: &mut RunInfo,
        bearing: &BearingInMotion,
        off: LedgerError,
    ) -> Option<String> {
        let when = When::of(info);
        self.place(bearing);
        let share = self.placed.penetration_share;
        if let Some(stop) = self.energy(info, off, when) {
            return Some(stop);
        }
        let stop = self.penetration(info, share, when);
        stop.or(self.shared.look(info, &self.placed))
    }

    /// Places of rollers and cage, and their loads.
    fn place(&mut self, bearing: &BearingInMotion) {
        let Placed { centres, carries, cage, penetration_share } = &mut self.placed;
        centres.clear();
        centres.extend(bearing.centres());
        *carries = bearing.largest_outer_force();
        *cage = bearing.cage_offset().map(|offset| PlacedCage {
            offset,
            spin: bearing.cage_rad_s(),
            push: bearing.largest_cage_force(),
        });
        *penetration_share = bearing.deepest() / self.element_size;
    }

    fn energy(&self, info: &mut RunInfo, off: LedgerError, when: When) -> Option<String> {
        let limits = &self.limits;
        info.guards.stored_j = info.guards.stored_j.max(off.stored);
        let percent = off.percent(info.guards.stored_j);
        if off.is_divergence(percent, limits.energy_stop_percent) {
            return Some(format!(
                "energy is off by {percent:.3} % of the most that rings and contacts have stored and {} \
                 {when}. {}",
                off.share_of_heat(),
                self.advice()
            ));
        }
        None
    }

    fn advice(&self) -> String {
        let astray = self.placed.cage.map_or(0.0, |cage| libm::hypot(cage.offset[0], cage.offset[1]));
        if astray > ASTRAY * self.roller_radius {
            return format!(
                "The cage has strayed by {:.2} mm, and a wall of a pocket that goes past the middle of its \
                 roller lets go of it all at once. Nothing holds it there: take {}",
                1e3 * astray,
                self.shared.holds_cage()
            );
        }
        "Take a smaller `model.step_us`, a larger `model.modes_khz`, or `model: full` to see which of the \
         two models is wrong"
            .to_owned()
    }

    fn penetration(&self, info: &mut RunInfo, share: f64, when: When) -> Option<String> {
        let before = info.guards.penetration_share;
        let [warning, stop] =
            [self.limits.penetration_warning_percent, self.limits.penetration_stop_percent].map(|p| 0.01 * p);
        if share > warning && before <= warning {
            info.warn(Topic::Contact.warning(format!(
                "the penetration of a contact has reached {:.1} % of an element's size {when}: take a larger `contact.penalty_scale`",
                100.0 * share
            )));
        }
        (share > stop).then(|| {
            format!(
                "the penetration of a contact has reached {:.0} % of an element's size {when}: take a larger `contact.penalty_scale` \
                 or less `operation.load_n`",
                100.0 * share
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ledger with this imbalance [J], beside heat and kinetic energy.
    fn off([imbalance, heat, kinetic]: [f64; 3]) -> LedgerError {
        LedgerError::of(&Ledger { imbalance, kinetic, friction: heat, ..Ledger::default() })
    }

    #[test]
    fn issue_what_gathers_and_what_hardly_any_load_leaves_is_no_divergence() {
        for (numbers, stored, apart) in [
            // A ledger that diverges before there is noticeable heat.
            ([0.05, 1e-3, 0.1], 0.1, true),
            // Seconds at a light load: a thousandth of the heat, many times the energy stored in rings and
            // contacts.
            ([0.37, 100.0, 0.1], 5e-3, false),
            // 1 N, 0.03 ms: half of the stored energy, hardly any heat yet.
            ([4e-10, 1e-11, 0.11], 7e-10, false),
            // 193 N in a rigid housing, 4 ms: a quarter of the energy stored in the rings, half a hundredth
            // of that in the contacts.
            ([8.8e-6, 4.9e-4, 6.2], 1.6e-3, false),
            ([f64::NAN, 1.0, 1.0], 1.0, true),
        ] {
            let off = off(numbers);
            assert_eq!(off.is_divergence(off.percent(stored), 25.0), apart, "{numbers:?}");
        }
    }
}
