//! Finding with the eyes what to click on in the panel: by colours, as far down as it happens to be.

use std::ops::Range;

/// A picture of a window; the panel is in its right half.
pub(crate) struct Shot {
    pub(crate) width: usize,
    /// RGB row by row.
    pub(crate) pixels: Vec<u8>,
}

/// Buttons, numbers and menus have this grey.
const BUTTON: u8 = 60;

/// Corners are round and letters leave holes: so many pixels of this grey in a row are a button.
const RUN: usize = 8;

/// Rows of the picture that belong to a line of text are no farther apart.
const LINE: usize = 6;

impl Shot {
    fn pixel(&self, x: usize, y: usize) -> [u8; 3] {
        let at = 3 * (y * self.width + x);
        [self.pixels[at], self.pixels[at + 1], self.pixels[at + 2]]
    }

    fn height(&self) -> usize {
        self.pixels.len() / 3 / self.width
    }

    /// The titles of sections, from the top: orange, where they begin and their rows.
    pub(crate) fn titles(&self) -> Vec<(usize, Range<usize>)> {
        let mut titles: Vec<(usize, Range<usize>)> = Vec::new();
        for y in 0..self.height() {
            let Some(x) = (self.width / 2..self.width).find(|&x| is_orange(self.pixel(x, y))) else { continue };
            match titles.last_mut() {
                Some((left, rows)) if y < rows.end + LINE => (*left, rows.end) = (x.min(*left), y + 1),
                _ => titles.push((x, y..y + 1)),
            }
        }
        titles
    }

    /// A place on the button whose upper edge is the first from this row on, and of those the one to the left.
    pub(crate) fn button_below(&self, row: usize) -> Option<[u32; 2]> {
        let is_button = |x: usize, y: usize| self.pixel(x, y).iter().all(|&c| c.abs_diff(BUTTON) <= 1);
        let starts = |y: usize| (self.width / 2..self.width - RUN).find(|&x| (x..x + RUN).all(|x| is_button(x, y)));
        let (top, left) = (row..self.height()).find_map(|y| Some((y, starts(y)?)))?;
        let height = (top..self.height()).take_while(|&y| is_button(left, y)).count();
        Some([left + RUN, top + height / 2].map(|a| a as u32))
    }

    /// The middle of what is clearly brighter or darker than in `other` in these rows, to the right of this column.
    pub(crate) fn changed(&self, other: &Self, left: usize, rows: Range<usize>) -> Option<[u32; 2]> {
        const CLEARLY: u8 = 64;
        let differs = |x, y| (0..3).any(|c| self.pixel(x, y)[c].abs_diff(other.pixel(x, y)[c]) > CLEARLY);
        // At the right end a scroll bar comes and goes.
        let places = rows.flat_map(|y| (left..self.width * 9 / 10).map(move |x| [x, y]));
        let places: Vec<[usize; 2]> = places.filter(|&[x, y]| differs(x, y)).collect();
        let middle = |axis: usize| {
            let along = places.iter().map(|place| place[axis]);
            Some(((along.clone().min()? + along.max()?) / 2) as u32)
        };
        Some([middle(0)?, middle(1)?])
    }
}

/// The colour of titles, over whatever shines through.
fn is_orange([r, g, b]: [u8; 3]) -> bool {
    let [r, g, b] = [r, g, b].map(f32::from);
    r > 150.0 && (g / r - 0.70).abs() < 0.06 && (b / r - 0.29).abs() < 0.12
}
