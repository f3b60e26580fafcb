//! A small toolbox for numerical kernels: vectors of f64 for any instruction set, arrays aligned for them,
//! and work shared out over threads.
//!
//! It is a crate because the kernels of several others are written over it.
//!
//! A kernel is written once, over a [`Number`](lanes::Number): a single `f64`, or a [`Vector`](lanes::Vector)
//! of one (plain instructions), four (AVX2) or eight (AVX-512) of them. Which one, [`pulp`] decides when the
//! program runs: the binary holds the kernel for each instruction set and takes the best that the processor
//! has. A caller therefore depends on `pulp` as well, for its traits `Simd` and `WithSimd`.
//!
//! Vectors fuse multiplication and addition on every instruction set
//! ([`times_plus`](lanes::Number::times_plus)), so the results of a kernel have the same bits on all of them.
//! Sums over lanes keep that only if they are taken in columns of [`LANES`](lanes::LANES), whatever the
//! length of a vector.
//!
//! # Example: hardening springs
//!
//! A thousand springs with the force −(k u + c u³) at the stretch u.
//!
//! ```
//! use pulp::{Arch, Scalar, Simd, WithSimd};
//! use stribeck_simd::field::Field;
//! use stribeck_simd::lanes::{Number, Vector};
//!
//! /// Force [N] at the stretch `u` [m]: the kernel, for one spring or for several.
//! #[inline(always)]
//! fn force<T: Number>(u: T, k: T, c: T) -> T {
//!     -(u * (c * u).times_plus(u, k))
//! }
//!
//! /// Stiffness [N/m] and hardening [N/m³].
//! const K: f64 = 2e3;
//! const C: f64 = 5e7;
//!
//! struct Springs<'a> {
//!     stretch: &'a [f64],
//!     forces: &'a mut [f64],
//! }
//!
//! impl WithSimd for Springs<'_> {
//!     type Output = ();
//!
//!     #[inline(always)]
//!     fn with_simd<S: Simd>(self, simd: S) {
//!         let (k, c) = (Vector::all(simd, K), Vector::all(simd, C));
//!         // A thousand is a multiple of eight; `Vector::store_first` writes a last, shorter group.
//!         for at in (0..self.stretch.len()).step_by(Vector::<S>::LEN) {
//!             force(Vector::load(simd, self.stretch, at), k, c).store(self.forces, at);
//!         }
//!     }
//! }
//!
//! let stretch: Field = (0..1000).map(|i| 1e-5 * f64::from(i)).collect();
//! let mut forces = Field::zeros(stretch.len());
//! Arch::new().dispatch(Springs { stretch: &stretch, forces: &mut forces });
//!
//! // One by one, but for rounding; and to the bit on an instruction set without vectors.
//! for (u, f) in stretch.iter().zip(&forces) {
//!     assert!((f - force(*u, K, C)).abs() <= 2.0 * f64::EPSILON * f.abs());
//! }
//! let mut plain = Field::zeros(stretch.len());
//! Springs { stretch: &stretch, forces: &mut plain }.with_simd(Scalar::new());
//! assert_eq!(forces, plain);
//! ```
//!
//! Everything on the way from `with_simd` to an instruction must be `#[inline(always)]`: code in a function
//! or closure of its own would be compiled for the plain instruction set, and each operation of a vector
//! become a call. So is what `map` does to the items of an array, and `map_or` to an option. Programs that
//! were compiled so have such operations among their symbols.
//!
//! # Where to look
//!
//! | Question | File |
//! |---|---|
//! | What can a kernel do with numbers? | `lanes.rs` |
//! | How are cube roots and angles computed in vectors? | `lanes/functions.rs` |
//! | How do values lie in memory, so that eight of them fill a line of cache? | `field.rs` |
//! | How is work shared out over threads, and kept in their caches from step to step? | `threads.rs` |

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod field;
pub mod lanes;
#[cfg(not(target_arch = "wasm32"))]
pub mod threads;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
