//! Sampled signals in and out of files.
//!
//! It is a crate because a program whose signals are in memory links no format of files.
//!
//! [`Recording::open`] looks at the first bytes of a file and lists its channels. Samples stay in the file
//! and are read in blocks, packed ones of HDF5, MDF, FLAC and Parquet unpacked on the way; those of universal
//! files and of deflated MATLAB 5 and `.npz` files are held in memory.
//! Each format has a module.
//!
//! | format | read | written |
//! |---|---|---|
//! | Texts: CSV, also with semicolons, tabs, bars, decimal commas, quotes and time stamps | [`csv`] | yes |
//! | NumPy `.npy`: arrays and records | [`npy`] | through [`npz`] |
//! | NumPy `.npz`, stored or deflated | [`npz`] | yes |
//! | MATLAB `.mat`, version 4 | [`mat4`] | no |
//! | MATLAB `.mat`, version 5: deflated or not, small elements, structs and cells | [`mat5`] | yes |
//! | Universal file, dataset 58, ASCII and binary (58b) | [`uff58`] | ASCII |
//! | TDMS of LabVIEW | [`tdms`] | no |
//! | Parquet: columns of numbers | [`parquet`] | yes, also of texts |
//! | MATLAB `.mat`, version 7.3, and plain HDF5: numbers, in structs, too | [`mat73`] | no |
//! | MDF 4: sorted groups, plain or deflated, conversions to numbers | [`mdf4`] | no |
//! | FLAC | [`flac`] | no: it holds no floats |
//! | WAV and RF64: 8 to 32 bits, floats | [`wav`] | as 64-bit floats |
//!
//! Channels of time are recognised by their steady rise, and the sample rate follows from them where the file
//! does not state it. Nothing is printed. A damaged file gives an [`Error`] with the file and what to try.

mod axis_structs;
mod clock_columns;
mod curve;
mod hdf5_chunks;
mod hdf5_links;
mod hdf5_version5;
mod literal;
mod mdf4_records;
mod number;
mod open;
mod recording;
mod shape;
mod strided;
mod time;
mod units;

pub mod csv;
pub mod flac;
pub mod mat4;
pub mod mat5;
pub mod mat73;
pub mod mdf4;
pub mod npy;
pub mod npz;
pub mod parquet;
pub mod tdms;
pub mod uff58;
pub mod wav;

pub use number::{Kind, Number};
pub use recording::Recording;
pub use stribeck_dsp::channel::{Channel, Error, Result};
pub use time::says_time;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
