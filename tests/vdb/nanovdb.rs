//! The reader of NanoVDB files against files that NanoVDB wrote, and against files built byte by
//! byte.

mod conformance;
mod volumes;
pub mod writer;
mod written;
