//! Explicit integrators beside the leapfrog of the kernel, for comparisons. Nothing here is used in a run.

/// An explicit scheme for ẍ = a(x, ẋ).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scheme {
    /// Central differences in their velocity form; the same positions as leapfrog. Velocities that forces
    /// depend on lag by half a step. Second order, no dissipation.
    CentralDifference,
    /// Tchamwa and Wielgosz: x += Δt v + φ Δt² a, v += Δt a. First order; damps high frequencies for φ > 1
    /// (Maheo, Grolleau and Rio, *Damping efficiency of the Tchamwa–Wielgosz explicit dissipative scheme*,
    /// Computational Mechanics 51 (2013), §2).
    TchamwaWielgosz {
        /// φ ≥ 1; 1.03 is customary.
        phi: f64,
    },
    /// Noh and Bathe: two sub-steps, p and 1 − p, with one evaluation each. Second order; damps waves that a
    /// mesh does not resolve (*An explicit time integration scheme for the analysis of wave propagations*,
    /// Computers & Structures 129 (2013), §2).
    NohBathe {
        /// Split of the step; 0.54 is customary.
        p: f64,
    },
}

/// Gets positions and velocities and fills in accelerations.
pub type Accelerate<'a> = dyn FnMut(&[f64], &[f64], &mut [f64]) + 'a;

/// Positions, velocities and accelerations at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    /// Time [s].
    pub time: f64,
    /// Positions.
    pub x: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Accelerations.
    pub a: Vec<f64>,
}

impl Trajectory {
    /// From positions and velocities; `accelerate` gets (x, v, a) and fills a.
    pub fn start(x: Vec<f64>, v: Vec<f64>, accelerate: &mut Accelerate<'_>) -> Self {
        let mut a = vec![0.0; x.len()];
        accelerate(&x, &v, &mut a);
        Self { time: 0.0, x, v, a }
    }
}

impl Scheme {
    /// Evaluations of forces in one step.
    pub fn evaluations(&self) -> u64 {
        if matches!(self, Self::NohBathe { .. }) { 2 } else { 1 }
    }

    /// Longest stable step times the frequency ω, from the spectral radius of the step of ẍ = −ω² x.
    pub fn limit(&self) -> f64 {
        let stable = |omega: f64| {
            let column = |x: f64, v: f64| {
                let mut accelerate = |x: &[f64], _: &[f64], a: &mut [f64]| a[0] = -omega * omega * x[0];
                let mut t = Trajectory::start(vec![x], vec![v], &mut accelerate);
                self.step(&mut t, 1.0, &mut accelerate);
                [t.x[0], t.v[0]]
            };
            let ([a, c], [b, d]) = (column(1.0, 0.0), column(0.0, 1.0));
            let (half, determinant) = (0.5 * (a + d), a * d - b * c);
            let inside = half * half - determinant;
            let radius = if inside > 0.0 { half.abs() + inside.sqrt() } else { determinant.max(0.0).sqrt() };
            radius <= 1.0 + 1e-9
        };
        // The first loss of stability: schemes of several stages may be stable again beyond it.
        let mut unstable = 0.01;
        while stable(unstable) && unstable < 100.0 {
            unstable += 0.01;
        }
        let mut low = unstable - 0.01;
        for _ in 0..40 {
            let middle = 0.5 * (low + unstable);
            if stable(middle) { low = middle } else { unstable = middle }
        }
        low
    }

    /// One step of `dt` [s].
    pub fn step(&self, t: &mut Trajectory, dt: f64, accelerate: &mut Accelerate<'_>) {
        match *self {
            Self::CentralDifference => {
                for i in 0..t.x.len() {
                    t.v[i] += 0.5 * dt * t.a[i];
                    t.x[i] += dt * t.v[i];
                }
                accelerate(&t.x, &t.v, &mut t.a);
                t.v.iter_mut().zip(&t.a).for_each(|(v, a)| *v += 0.5 * dt * a);
            }
            Self::TchamwaWielgosz { phi } => {
                for i in 0..t.x.len() {
                    t.x[i] += dt * t.v[i] + phi * dt * dt * t.a[i];
                    t.v[i] += dt * t.a[i];
                }
                accelerate(&t.x, &t.v, &mut t.a);
            }
            Self::NohBathe { p } => noh_bathe(p, t, dt, accelerate),
        }
        t.time += dt;
    }
}

fn noh_bathe(p: f64, t: &mut Trajectory, dt: f64, accelerate: &mut Accelerate<'_>) {
    let (first, second) = (p * dt, (1.0 - p) * dt);
    let q1 = (1.0 - 2.0 * p) / (2.0 * p * (1.0 - p));
    let q2 = 0.5 - p * q1;
    let q0 = 0.5 - q1 - q2;
    let start = t.a.clone();
    for i in 0..t.x.len() {
        t.x[i] += first * t.v[i] + 0.5 * first * first * start[i];
        // A first guess, for forces that depend on it.
        t.v[i] += first * start[i];
    }
    accelerate(&t.x, &t.v, &mut t.a);
    let middle = t.a.clone();
    for i in 0..t.x.len() {
        t.v[i] += 0.5 * first * (middle[i] - start[i]);
        t.x[i] += second * t.v[i] + 0.5 * second * second * middle[i];
    }
    let at_middle = t.v.clone();
    t.v.iter_mut().zip(&middle).for_each(|(v, a)| *v += second * a);
    accelerate(&t.x, &t.v, &mut t.a);
    for i in 0..t.x.len() {
        t.v[i] = at_middle[i] + second * (q0 * start[i] + (0.5 + q1) * middle[i] + q2 * t.a[i]);
    }
}
