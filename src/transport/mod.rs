//! How light moves through volumes: the strategies and the paths they sample.

pub mod strategy;
