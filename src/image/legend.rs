//! Legend of a map, drawn below it: the ramp with its numbers.

use super::drawing::{Align, Canvas, color};
use crate::error::Result;
use glam::UVec2;

/// Height of a legend in pixels.
pub const HEIGHT: u32 = 112;
/// Margin around the legend in pixels.
const MARGIN: i32 = 16;
/// Height of the bar of colors.
const BAR: i32 = 14;

/// A bar of colors with its numbers.
pub struct Legend<'a> {
    /// Quantity of the map, with its unit.
    pub title: &'a str,
    /// Further remark on the numbers.
    pub note: &'a str,
    /// The 8-bit sRGB color at a place in 0..=1 of the bar.
    pub color: &'a dyn Fn(f32) -> [u8; 3],
    /// Numbers at the start, in the middle and at the end of the bar.
    pub ends: [String; 3],
}

impl Legend<'_> {
    /// Draws the legend over the width of the canvas, from `top` on down.
    pub(super) fn draw(&self, canvas: &mut Canvas, top: i32) -> Result<()> {
        let (left, right) = (MARGIN, canvas.size().x as i32 - MARGIN);
        canvas.text((left, top + 18), Align::Left, color::TEXT, self.title)?;
        let bar = top + 36;
        for x in left..right {
            let place = (x - left) as f32 / (right - left - 1).max(1) as f32;
            let color = (self.color)(place);
            (bar..bar + BAR).for_each(|y| canvas.put(UVec2::new(x as u32, y as u32), color));
        }
        let places =
            [(left, Align::Left), ((left + right) / 2, Align::Center), (right, Align::Right)];
        for ((x, align), text) in std::iter::zip(places, &self.ends) {
            canvas.text((x, bar + BAR + 12), align, color::TEXT, text)?;
        }
        canvas.text((left, bar + BAR + 36), Align::Left, color::DIM, self.note)
    }
}
