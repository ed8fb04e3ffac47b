//! The reader of OpenVDB files against files that OpenVDB wrote, and against files built byte by
//! byte.

mod conformance;
mod damage;
mod fixtures;
mod shared;
mod volumes;
mod writer;
mod written;
