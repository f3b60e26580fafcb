//! Animated pictures: convex cells filled with colours of one scale, as GIF.

use crate::Error;

/// Colours of the scale; the other entries of the palette are white (0) and black (1).
const SHADES: usize = 240;
/// First shade in the palette.
const FIRST: usize = 2;

/// One picture of an animation, a palette index a pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<u8>,
}

impl Canvas {
    /// White paper.
    pub fn new(width: u16, height: u16) -> Self {
        let (width, height) = (usize::from(width), usize::from(height));
        Self { width, height, pixels: vec![0; width * height] }
    }

    /// Fills a convex polygon [px], of either orientation, with the shade `level` from 0 to 1.
    pub fn fill(&mut self, corners: &[[f64; 2]], level: f64) {
        let shade = (FIRST + (level.clamp(0.0, 1.0) * (SHADES - 1) as f64).round() as usize) as u8;
        let span = |c: usize, limit: usize| {
            let low = corners.iter().map(|p| p[c]).fold(f64::INFINITY, f64::min).floor().max(0.0);
            let high = corners.iter().map(|p| p[c]).fold(f64::NEG_INFINITY, f64::max).ceil();
            low as usize..(high.max(0.0) as usize).min(limit)
        };
        let columns = span(0, self.width);
        for row in span(1, self.height) {
            for column in columns.clone() {
                let at = [column as f64 + 0.5, row as f64 + 0.5];
                if inside(corners, at) {
                    self.pixels[row * self.width + column] = shade;
                }
            }
        }
    }

    /// Draws a straight line in black, in pixels.
    pub fn line(&mut self, from: [f64; 2], to: [f64; 2]) {
        let steps = (to[0] - from[0]).abs().max((to[1] - from[1]).abs()).ceil().max(1.0) as usize;
        for step in 0..=steps {
            let part = step as f64 / steps as f64;
            let at = [0, 1].map(|c| from[c] + part * (to[c] - from[c]));
            if at[0] >= 0.0 && at[1] >= 0.0 {
                let (column, row) = (at[0] as usize, at[1] as usize);
                if column < self.width && row < self.height {
                    self.pixels[row * self.width + column] = 1;
                }
            }
        }
    }
}

/// Whether all sides of a convex polygon, of either orientation, have the point on one hand.
fn inside(corners: &[[f64; 2]], at: [f64; 2]) -> bool {
    let Some(mut from) = corners.last() else { return false };
    let (mut left, mut right) = (true, true);
    for to in corners {
        let side = (to[0] - from[0]) * (at[1] - from[1]) - (to[1] - from[1]) * (at[0] - from[0]);
        left &= side >= 0.0;
        right &= side <= 0.0;
        from = to;
    }
    left || right
}

/// The pictures as an endless GIF, each shown for `hundredths` of a second.
///
/// # Errors
/// [`Error::Drawing`] when they differ in size or there are none.
pub fn gif(name: &str, canvases: &[Canvas], hundredths: u16) -> Result<Vec<u8>, Error> {
    let failed = |why: String| Error::Drawing { figure: name.to_owned(), why };
    let first = canvases.first().ok_or_else(|| failed("it has no pictures".into()))?;
    if canvases.iter().any(|c| (c.width, c.height) != (first.width, first.height)) {
        return Err(failed("its pictures differ in size".into()));
    }
    let (width, height) = (first.width as u16, first.height as u16);
    let mut bytes = Vec::new();
    let mut encoder =
        gif::Encoder::new(&mut bytes, width, height, &palette()).map_err(|why| failed(why.to_string()))?;
    encoder.set_repeat(gif::Repeat::Infinite).map_err(|why| failed(why.to_string()))?;
    for canvas in canvases {
        let mut frame = gif::Frame::from_indexed_pixels(width, height, canvas.pixels.clone(), None);
        frame.delay = hundredths;
        encoder.write_frame(&frame).map_err(|why| failed(why.to_string()))?;
    }
    drop(encoder);
    Ok(bytes)
}

fn palette() -> Vec<u8> {
    let mut palette = vec![255, 255, 255, 0, 0, 0];
    for shade in 0..SHADES {
        palette.extend(shade_rgb(shade as f64 / (SHADES - 1) as f64));
    }
    palette.resize(3 * 256, 0);
    palette
}

/// Colour of a level from 0 to 1: dark blue over green to yellow, evenly bright steps (after matplotlib's
/// viridis).
pub fn shade_rgb(level: f64) -> [u8; 3] {
    const STOPS: [[f64; 3]; 6] = [
        [68.0, 1.0, 84.0],
        [65.0, 68.0, 135.0],
        [42.0, 120.0, 142.0],
        [34.0, 168.0, 132.0],
        [122.0, 209.0, 81.0],
        [253.0, 231.0, 37.0],
    ];
    let at = level.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let below = (at as usize).min(STOPS.len() - 2);
    let part = at - below as f64;
    [0, 1, 2].map(|c| (STOPS[below][c] + part * (STOPS[below + 1][c] - STOPS[below][c])).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_a_square_fills_its_pixels_and_no_other() {
        for corners in [
            [[1.0, 1.0], [4.0, 1.0], [4.0, 3.0], [1.0, 3.0]],
            [[1.0, 3.0], [4.0, 3.0], [4.0, 1.0], [1.0, 1.0]],
        ] {
            let mut canvas = Canvas::new(6, 5);
            canvas.fill(&corners, 1.0);
            assert_eq!(canvas.pixels.iter().filter(|&&p| p != 0).count(), 6);
            assert_eq!(canvas.pixels[6 + 1], (FIRST + SHADES - 1) as u8);
        }
        let mut canvas = Canvas::new(6, 5);
        canvas.fill(&[[-9.0, -9.0], [-2.0, -9.0], [-2.0, -2.0]], 0.5);
        assert!(canvas.pixels.iter().all(|&p| p == 0));
    }

    #[test]
    fn behaves_a_gif_has_its_signature_and_refuses_nothing_or_a_mixture() {
        let bytes = gif("g", &[Canvas::new(4, 4), Canvas::new(4, 4)], 5).unwrap();
        assert!(bytes.starts_with(b"GIF89a") && bytes.ends_with(&[0x3b]));
        stribeck_testing::assert_refused(gif("g", &[], 5), "it has no pictures");
        stribeck_testing::assert_refused(
            gif("g", &[Canvas::new(4, 4), Canvas::new(5, 4)], 5),
            "differ in size",
        );
    }
}
