//! Light in volumes comes out as it must: against known values, other ways to the same value, and
//! what must not change a picture. One binary, so that long tests run side by side.

mod agree;
mod cameras;
mod caustics;
mod closed_forms;
mod common;
mod counts;
mod curves;
mod environment;
mod extremes;
mod fire_light;
mod furnaces;
mod guiding;
mod inside_fire;
mod light_selection;
mod lights;
mod many_fires;
mod march;
mod motion;
mod noise;
mod peers;
mod profile;
mod settings;
mod slabs;
mod techniques;
mod walks;
