//! The one list of forces on nodes besides those of elements: loads, contact, and laws of the user.

use stribeck_contact::{Contacts, Films};
use stribeck_solver::{
    Force,
    force::RankOne,
    state::{Energy, Moment, NodeForces},
};

use crate::load::Load;

/// All forces of a system, as one.
#[derive(Default)]
pub(crate) struct Forces {
    pub(crate) loads: Vec<Load>,
    /// None without contact pairs.
    pub(crate) contacts: Option<Contacts>,
    /// None without oil.
    pub(crate) films: Option<Films>,
    /// Laws of the user, with their names.
    pub(crate) further: Vec<(String, Box<dyn Force + Send>)>,
}

impl std::fmt::Debug for Forces {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let further: Vec<&str> = self.further.iter().map(|(name, _)| name.as_str()).collect();
        let Self { loads, contacts, films, .. } = self;
        f.debug_struct("Forces")
            .field("loads", loads)
            .field("contacts", contacts)
            .field("films", films)
            .field("further", &further)
            .finish()
    }
}

impl Forces {
    fn all(&self) -> impl Iterator<Item = &dyn Force> {
        let loads = self.loads.iter().map(|load| load as &dyn Force);
        let contacts = self.contacts.iter().map(|contacts| contacts as &dyn Force);
        let films = self.films.iter().map(|films| films as &dyn Force);
        loads.chain(contacts).chain(films).chain(self.further.iter().map(|(_, force)| &**force as &dyn Force))
    }

    /// Energy of contact alone [J].
    pub(crate) fn of_contact(&self) -> Energy {
        self.contacts.as_ref().map_or_else(Energy::default, Contacts::energy)
    }

    /// Energy of oil films alone [J].
    pub(crate) fn of_films(&self) -> Energy {
        self.films.as_ref().map_or_else(Energy::default, Films::energy)
    }

    /// Energy of loads and of the user's laws [J].
    pub(crate) fn of_others(&self) -> Energy {
        let further = self.further.iter().map(|(_, force)| force.energy());
        self.loads.iter().map(Force::energy).chain(further).sum()
    }
}

impl Force for Forces {
    fn accumulate(&mut self, at: Moment<'_>, force: &mut NodeForces) {
        self.loads.iter_mut().for_each(|load| load.accumulate(at, force));
        match (&mut self.contacts, &mut self.films) {
            (Some(contacts), Some(films)) => {
                contacts.accumulate_beside(at, force, || films.evaluate(at));
                films.hand_over(force);
            }
            (contacts, films) => {
                contacts.iter_mut().for_each(|contacts| contacts.accumulate(at, force));
                films.iter_mut().for_each(|films| films.accumulate(at, force));
            }
        }
        self.further.iter_mut().for_each(|(_, law)| law.accumulate(at, force));
    }

    fn energy(&self) -> Energy {
        self.all().map(Force::energy).sum()
    }

    fn stiffness_bound(&self, dt: f64, bound: &mut [f64]) {
        self.all().for_each(|force| force.stiffness_bound(dt, bound));
    }

    fn tangent(&self, x: &[f64], y: &[f64], visit: &mut dyn FnMut(RankOne<'_>)) {
        self.all().for_each(|force| force.tangent(x, y, visit));
    }
}
