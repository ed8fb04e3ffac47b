//! The readers of OpenVDB and NanoVDB files against files that their libraries wrote, and against
//! files built byte by byte.

mod conformance;
mod damage;
mod fixtures;
mod mutations;
mod nanovdb;
mod shared;
mod volumes;
mod writer;
mod written;
