//! The reduced bearing: the constant data of a run, and the forces that follow from a state (THEORY
//! §9.2–9.4).

use crate::modal::{
    ModalBearing, OVERLOAD, Parameters, Reduction, STICKING, compliance::contact_length, outline::per_angle,
    parameters::Ragged,
};

use crate::{
    cage::Cage,
    contact::{
        outline::Outline,
        penetration::Sides,
        raceway::Raceway,
        round::{Relief, circle_of},
        traction::Traction,
    },
    drive::Operation,
    error::Error,
    housing::Housing,
    law::ContactLaw,
    modes::Structure,
    oil::Lubrication,
    resistance::Resistance,
    rollers::Rollers,
    seat::Springs,
    sensors::Sensors,
    state::State,
};

/// A reduced bearing: the constant data of a run.
#[derive(Debug, Clone)]
pub struct Bearing {
    /// Time step [s].
    pub time_step: f64,
    /// Numbers of the mesh.
    pub reduction: Reduction,
    /// Modes of outer ring and housing.
    pub(crate) structure: Structure,
    /// The outer and the inner raceway.
    pub(crate) raceways: [Raceway; 2],
    pub(crate) law: ContactLaw,
    /// Rollers.
    pub rollers: Rollers,
    pub(crate) cage: Option<Cage>,
    /// Seat of the outer ring, where it may open and slip.
    pub(crate) seat: Option<Springs>,
    pub(crate) oil: Option<Lubrication>,
    /// What the oil takes from the motion.
    pub(crate) resistance: Option<Resistance>,
    pub(crate) sensors: Sensors,
    /// Ragged edges of spalls in the outer and the inner raceway.
    pub(crate) ragged: [Ragged; 2],
    /// Speeds and load.
    pub(crate) operation: Operation,
    /// The housing that stands still, where the shaft is moved.
    pub(crate) housing: Option<Housing>,
}

impl Bearing {
    /// The bearing that moves in steps of `time_step` [s].
    ///
    /// # Errors
    /// When oil finds no smooth surface to lie on.
    pub fn new(modal: ModalBearing, time_step: f64) -> Result<Self, Error> {
        let ModalBearing { reduction, parameters } = modal;
        let Parameters { radii, thickness, contact, .. } = &parameters;
        let mut raceways = raceways(&parameters, &reduction);
        let rollers = Rollers::new(&parameters, reduction.roller_inertia);
        let facets = rollers.rims[0].outline.len() as f64;
        let shadow = if parameters.oil.is_some() { 0.0 } else { time_step * time_step / 12.0 };
        let law = ContactLaw {
            penalty: contact.stiffness * thickness,
            sticking: STICKING * contact.stiffness * thickness,
            damping: contact.damping * thickness,
            friction: contact.friction,
            arm: radii.roller - 2.0 / 3.0 * sag(&parameters, radii.roller, facets),
            time_step,
            ahead: shadow / rollers.inertia[0],
            shadow,
        };
        let resisting = parameters.oil.zip(parameters.oil.and_then(|oil| oil.resistance));
        if let Some((oil, resistance)) = resisting {
            for (raceway, film) in raceways.iter_mut().zip([oil.outer, oil.inner]) {
                let (viscosity, relative) = (oil.viscosity, raceway.relative);
                raceway.traction =
                    Some(Traction::new(&resistance, viscosity, film.least, relative, oil.length));
            }
        }
        let resistance = resisting.map(|(oil, resistance)| {
            Resistance::new(&resistance, oil.viscosity, &raceways, radii.roller, oil.length)
        });
        let oil = parameters.oil.as_ref();
        let oil = oil.map(|oil| {
            let others: Vec<&Outline> = rollers.rims[1..].iter().map(|rim| &rim.outline).collect();
            let rims = (&rollers.rims[0].outline, &others[..]);
            Lubrication::new(oil, &raceways, rims, law.penalty)
        });
        let seat = reduction.springs.as_ref();
        let seat = seat.map(|seat| {
            Springs::new(seat, reduction.padded, parameters.seat_friction, oil.is_some(), time_step)
        });
        let cage = reduction.cage.zip(parameters.pockets.as_ref());
        let cage = cage.map(|((inertia, centre), pockets)| {
            Cage::new(pockets, inertia, centre, &reduction.wall_compliance)
        });
        Ok(Self {
            time_step,
            structure: Structure::new(&reduction, &parameters.damping),
            raceways,
            law,
            rollers,
            cage,
            seat,
            oil: oil.transpose()?,
            resistance,
            sensors: Sensors::new(&reduction),
            ragged: parameters.ragged,
            operation: Operation::new(&parameters, reduction.load.force),
            housing: None,
            reduction,
        })
    }

    /// Critical time step [s] of modes, contacts and springs of friction (own; THEORY §9.4): contacts with
    /// raceways as stiff as at the largest load that the local problem was solved for, friction over those of
    /// the fullest roller, and the cage on corners of all pockets, or on straight walls that lie flush with a
    /// facet of each roller.
    pub fn critical_time_step(&self) -> f64 {
        let highest = self.reduction.squares.iter().copied().fold(0.0, f64::max);
        let [mass, inertia] = self.reduction.roller_inertia;
        let r = self.reduction.padded;
        let both = &self.raceways;
        let [outer, inner] =
            both.each_ref().map(|raceway| raceway.compliance.stiffest(self.law.penalty, raceway.relative));
        let along = |raceway: &Raceway| {
            let fullest = raceway.compliance.largest_load() / OVERLOAD;
            let length = contact_length(fullest, self.law.penalty, raceway.relative);
            let flexibility = raceway.curve.approach(fullest).0[1].max(0.0);
            let stiffness = self.law.sticking * length / (1.0 + self.law.penalty * length * flexibility);
            if self.law.friction > 0.0 || raceway.traction.is_some() { stiffness } else { 0.0 }
        };
        let [along_outer, along_inner] = both.each_ref().map(along);
        // A contact pulls on the roller and on the modes under it; (a − b)² ≤ (1 + c) a² + (1 + 1/c) b².
        let under = |vertex: usize| {
            let shape = &self.reduction.shapes[2 * r * vertex..2 * r * (vertex + 1)];
            (0..r).map(|k| shape[k] * shape[k] + shape[r + k] * shape[r + k]).sum::<f64>()
        };
        let modes = (0..self.raceways[0].outline.len()).map(under).fold(0.0, f64::max);
        let c = (modes * mass).sqrt();
        let of_roller = ((1.0 + c) * outer + inner) / mass;
        // Both raceways hold a roller along the raceway: one way if it spins, the other if it moves on.
        let of_friction = 2.0
            * ((1.0 + c) * along_outer).max(along_inner)
            * (1.0 / mass).max(self.law.arm * self.law.arm / inertia);
        // Few rollers share the modes of highest participation; each adds its own part.
        let of_modes = highest + (1.0 + 1.0 / c) * outer.max(along_outer) * modes;
        // All rollers may press on the cage at once.
        let of_cage = self.cage.as_ref().map_or(0.0, |cage| {
            let arm = cage
                .walls
                .iter()
                .flatten()
                .map(|wall| libm::hypot(wall.inner[0], wall.inner[1]))
                .fold(0.0, f64::max);
            let of_all = self.rollers.count as f64 * (1.0 / cage.mass).max(arm * arm / cage.inertia);
            let corner = 0.5 * self.law.penalty * cage.corners[0].end;
            let facet = if cage.has_flats { self.law.penalty * self.rollers.polygon.facet() } else { 0.0 };
            let facet = facet / (1.0 + facet * cage.curve.approach(0.0).0[1]);
            corner.max(facet) * (1.0 / mass + of_all)
        });
        let square = of_roller.max(of_friction).max(of_modes).max(of_cage);
        // Dampers act half a step late: ω² Δt²/4 + d Δt/2 < 1, where d is the sum over all modes at most.
        let d = self.reduction.dampers.iter().step_by(r + 1).sum::<f64>().max(0.0);
        2.0 * ((0.25 * d * d + square).sqrt() - 0.5 * d) / square
    }

    /// Speeds and load, where they change.
    pub fn duty(&self) -> Option<&stribeck_theory::duty::Duty> {
        self.operation.duty.as_ref()
    }

    /// Whether the outer ring sits in a seat that may open and slip.
    pub fn has_seat(&self) -> bool {
        self.seat.is_some()
    }

    /// A state before its first step, not in equilibrium yet.
    pub fn rest(&self) -> State {
        let (r, n, path) = (self.reduction.padded, self.rollers.count, self.rollers.path);
        let mut state = State {
            q: vec![0.0; r],
            v: vec![0.0; r],
            branches: vec![vec![0.0; r]; self.structure.branches.len()],
            x: vec![0.0; n],
            y: vec![0.0; n],
            vx: vec![0.0; n],
            vy: vec![0.0; n],
            angle: vec![0.0; n],
            turned: self
                .rollers
                .starts
                .iter()
                .map(|start| [libm::cos(start.vertex_angle), libm::sin(start.vertex_angle)])
                .collect(),
            spin: vec![self.operation.speeds.roller; n],
            slip: [vec![0.0; n], vec![0.0; n]],
            wall_slip: vec![[0.0; 2]; n],
            passive: [vec![[0.0; 3]; n], vec![[0.0; 3]; n]],
            wall_passive: vec![[[0.0; 2]; 2]; n],
            force: [vec![0.0; n], vec![0.0; n]],
            growth: [vec![0.0; n], vec![0.0; n]],
            hints: [vec![[0; 2]; n], vec![[0; 2]; n]],
            cage: [0.0; 3],
            cage_velocity: [0.0, 0.0, self.operation.speeds.cage],
            shaft: 0.0,
            work: Default::default(),
            seat: None,
            films: None,
            steps: 0,
        };
        for (i, start) in self.rollers.starts.iter().enumerate() {
            let (s, c) = libm::sincos(start.angle);
            (state.x[i], state.y[i]) = (path * c, path * s);
        }
        state.seat = self.seat.as_ref().map(|seat| seat.at_rest(r, n));
        state.hints = self.first_hints(&state);
        state.films = self.oil.as_ref().map(|oil| oil.first_films(&self.rollers, &state));
        state
    }

    /// Facets that rays hit, found from nothing.
    pub(crate) fn first_hints(&self, state: &State) -> [Vec<[u32; 2]>; 2] {
        let nearest = |outline: &Outline, d: [f64; 2]| {
            let along = |i: &usize| {
                (outline.x[*i] * d[0] + outline.y[*i] * d[1]) / libm::hypot(outline.x[*i], outline.y[*i])
            };
            (0..outline.len()).max_by(|a, b| along(a).total_cmp(&along(b))).unwrap_or(0) as u32
        };
        let hints = |raceway: &Raceway, turned: f64, outwards: f64| {
            (0..state.x.len())
                .map(|i| {
                    let at = libm::atan2(state.y[i], state.x[i]);
                    let own = at - state.angle[i] - self.rollers.starts[i].vertex_angle
                        + if outwards < 0.0 { std::f64::consts::PI } else { 0.0 };
                    let on_race = at - turned;
                    let of = |angle: f64| [libm::cos(angle), libm::sin(angle)];
                    [nearest(&self.rollers.rim(i).outline, of(own)), nearest(&raceway.outline, of(on_race))]
                })
                .collect()
        };
        [hints(&self.raceways[0], 0.0, 1.0), hints(&self.raceways[1], state.shaft, -1.0)]
    }
}

/// Largest distance of a straight facet from the circle through its vertices [m], where facets do not stand
/// for arcs.
fn sag(parameters: &Parameters, radius: f64, facets: f64) -> f64 {
    if parameters.outlines.arcs { 0.0 } else { radius * (1.0 - libm::cos(std::f64::consts::PI / facets)) }
}

/// The outer and the inner raceway.
fn raceways(parameters: &Parameters, reduction: &Reduction) -> [Raceway; 2] {
    let Parameters { outlines, radii, .. } = parameters;
    let [kr, ko, ki] = [1.0 / radii.roller, 1.0 / radii.outer, 1.0 / radii.inner];
    let [outer, inner] = [&outlines.outer, &outlines.inner].map(|vertices| Outline::new(vertices));
    let sag_of_outer = sag(parameters, radii.outer, outer.len() as f64);
    // The load of the preload has moved the circle that arcs lie on.
    let (centre, radius) = if outlines.arcs && !parameters.outer_turns {
        circle_of(&outer, radii.outer)
    } else {
        ([0.0; 2], radii.outer)
    };
    let about = outer.about(centre);
    let nearest = about.radii().fold(f64::INFINITY, f64::min) - sag_of_outer;
    let farthest = inner.radii().fold(0.0, f64::max);
    let bounds = nearest_about(&about, BESIDE * radii.roller, 1.0 / (kr - ko));
    let bounds = bounds.into_iter().map(|near| near - sag_of_outer).collect();
    let relief = |outline: &Outline, radius: f64, along: bool| {
        let ragged = parameters.ragged[usize::from(!along)].by > 0.0;
        outlines.arcs.then(|| Relief::new(outline, radius, radii.roller, along, ragged))
    };
    let sides = |along: bool, relative: f64| Sides {
        along,
        bulge: if outlines.arcs { 0.5 * relative } else { 0.0 },
        curvature: if outlines.arcs { kr } else { 0.0 },
    };
    [
        Raceway {
            sides: sides(true, kr - ko),
            relief: relief(&about, radius, true),
            centre,
            angle: per_angle(&outlines.outer),
            outline: outer,
            curve: reduction.outer_compliance.curve(),
            compliance: reduction.outer_compliance.clone(),
            bound: nearest,
            bounds,
            relative: 1.0 / (kr - ko),
            traction: None,
        },
        Raceway {
            sides: sides(false, kr + ki),
            relief: relief(&inner, radii.inner, false),
            centre: [0.0; 2],
            angle: per_angle(&outlines.inner),
            outline: inner,
            curve: reduction.inner_compliance.curve(),
            compliance: reduction.inner_compliance.clone(),
            bound: farthest,
            bounds: Vec::new(),
            relative: 1.0 / (kr + ki),
            traction: None,
        },
    ]
}

/// On even ground no contact reaches farther to either side than this share of the roller's radius: it would
/// be a fortieth of it deep.
const BESIDE: f64 = 0.25;

/// Smallest radius of the outline within reach of a roller over each facet [m]:
/// as far to either side as a contact on even ground, and beyond that at parts that stand out so far that the
/// roller, which falls away by u² / 2R over u, meets it, such as the edge of a deep spall. `relative` is R
/// [m].
fn nearest_about(outline: &Outline, beside: f64, relative: f64) -> Vec<f64> {
    let place = |i: usize| [outline.x[i], outline.y[i]];
    let apart = |[ax, ay]: [f64; 2], [bx, by]: [f64; 2]| libm::hypot(bx - ax, by - ay);
    let out = |i: usize| apart([0.0; 2], place(i));
    let reach = |stands_out: f64| (beside * beside + 2.0 * relative * stands_out.max(0.0)).sqrt();
    let nearest_of_all = (0..outline.len()).map(out).fold(f64::INFINITY, f64::min);
    let about = |facet: usize| {
        let mut nearest = f64::INFINITY;
        let ends = [facet, outline.next(facet)];
        let here = out(ends[0]).max(out(ends[1]));
        for (end, ahead) in ends.into_iter().zip([false, true]) {
            let mut vertex = end;
            let mut within = true;
            for _ in 0..outline.len() {
                let away = apart(place(end), place(vertex));
                // The first vertex beyond is taken, too: the facet before it is within.
                if within || away <= reach(here - out(vertex)) {
                    nearest = nearest.min(out(vertex));
                }
                within = away <= beside;
                if away > reach(here - nearest_of_all) {
                    break;
                }
                vertex = if ahead { outline.next(vertex) } else { outline.before(vertex) };
            }
        }
        nearest
    };
    (0..outline.len()).map(about).collect()
}
