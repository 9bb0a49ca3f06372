//! Placement of the names of marks, so that they cover neither one another nor the marks.

/// A rectangle, in pixels from the top left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rect {
    /// Column of the left edge.
    pub(crate) x: f64,
    /// Row of the upper edge.
    pub(crate) y: f64,
    /// Width in pixels.
    pub(crate) width: f64,
    /// Height in pixels.
    pub(crate) height: f64,
}

impl Rect {
    /// Returns the area that two rectangles share, in square pixels.
    pub(crate) fn overlap(&self, other: &Rect) -> f64 {
        let along = |a: f64, aw: f64, b: f64, bw: f64| ((a + aw).min(b + bw) - a.max(b)).max(0.0);
        along(self.x, self.width, other.x, other.width) * along(self.y, self.height, other.y, other.height)
    }

    /// Returns the area outside `bounds`, in square pixels.
    fn outside(&self, bounds: &Rect) -> f64 {
        self.width * self.height - self.overlap(bounds)
    }

    /// Returns the approximate length of a line segment inside the rectangle, in pixels.
    fn crossed(&self, (from, to): ([f64; 2], [f64; 2])) -> f64 {
        let length = ((to[0] - from[0]).powi(2) + (to[1] - from[1]).powi(2)).sqrt();
        let steps = (length / 3.0).ceil().clamp(1.0, 400.0);
        let inside = (0..=steps as usize).filter(|step| {
            let at = *step as f64 / steps;
            let (x, y) = (from[0] + (to[0] - from[0]) * at, from[1] + (to[1] - from[1]) * at);
            x >= self.x && x <= self.x + self.width && y >= self.y && y <= self.y + self.height
        });
        inside.count() as f64 * length / steps
    }

    fn grown(&self, by: f64) -> Rect {
        Rect { x: self.x - by, y: self.y - by, width: self.width + 2.0 * by, height: self.height + 2.0 * by }
    }
}

/// A mark and the size of its name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Named {
    /// Centre of the mark.
    pub(crate) at: [f64; 2],
    /// Width and height of the name in pixels; a width of 0 means that it has no name.
    pub(crate) size: [f64; 2],
}

/// Half the side of the square that a mark covers, in pixels.
const MARK: f64 = 6.0;
/// Distance in pixels from which on a line joins a name to its mark.
const MIN_LEADER: f64 = 14.0;
/// Candidate distances of a name from its mark, in pixels.
const DISTANCES: [f64; 8] = [8.0, 13.0, 20.0, 30.0, 42.0, 56.0, 74.0, 95.0];
/// Candidate directions, best first: right, left, above, below, and between them.
const DIRECTIONS: [[[f64; 2]; 4]; 4] = [
    [[1.0, 0.0], [-1.0, 0.0], [0.0, -1.0], [0.0, 1.0]],
    [[0.7, -0.7], [0.7, 0.7], [-0.7, -0.7], [-0.7, 0.7]],
    [[0.92, -0.38], [0.92, 0.38], [-0.92, -0.38], [-0.92, 0.38]],
    [[0.38, -0.92], [0.38, 0.92], [-0.38, -0.92], [-0.38, 0.92]],
];
/// Maximum number of rounds in which names are moved.
const ROUNDS: usize = 12;

/// Places each name inside `bounds`, away from other names, marks and, where possible, from `lines`. Between equally good places the order of `marks`
/// decides, and nothing else.
pub(crate) fn place(marks: &[Named], bounds: &Rect, lines: &[([f64; 2], [f64; 2])]) -> Vec<Rect> {
    let squares: Vec<Rect> = marks
        .iter()
        .map(|mark| Rect { x: mark.at[0] - MARK, y: mark.at[1] - MARK, width: 2.0 * MARK, height: 2.0 * MARK })
        .collect();
    let mut places: Vec<Option<Rect>> = vec![None; marks.len()];
    for _ in 0..ROUNDS {
        let mut moved = false;
        for n in 0..marks.len() {
            let cost = |place: &Rect, distance: f64, direction: usize| {
                let roomy = place.grown(1.5);
                let others =
                    || places.iter().enumerate().filter(|(k, _)| *k != n).filter_map(|(k, o)| Some((k, (*o)?)));
                let covered: f64 = others().map(|(_, other)| roomy.overlap(&other)).sum();
                let marked: f64 = squares.iter().map(|square| place.overlap(square)).sum();
                let crossed: f64 = lines.iter().map(|line| place.crossed(*line)).sum();
                // A line from a mark to its name should cross no other name.
                let leads: f64 = others()
                    .map(|(k, other)| {
                        let own = leader(&marks[n], place).map_or(0.0, |line| other.crossed(line));
                        own + leader(&marks[k], &other).map_or(0.0, |line| place.crossed(line))
                    })
                    .sum();
                let passed: f64 = leader(&marks[n], place).map_or(0.0, |line| {
                    squares.iter().enumerate().filter(|(k, _)| *k != n).map(|(_, square)| square.crossed(line)).sum()
                });
                60.0 * covered
                    + 30.0 * marked
                    + 100.0 * place.outside(bounds)
                    + 25.0 * (leads + passed)
                    + 2.0 * crossed
                    + distance
                    + direction as f64 * 0.5
            };
            let mut best: Option<(f64, Rect)> = None;
            for distance in DISTANCES {
                for (direction, toward) in DIRECTIONS.as_flattened().iter().enumerate() {
                    let place = beside(&marks[n], *toward, distance);
                    let cost = cost(&place, distance, direction);
                    if best.is_none_or(|(least, _)| cost < least) {
                        best = Some((cost, place));
                    }
                }
            }
            let best = best.map(|(_, place)| place);
            moved |= best != places[n];
            places[n] = best;
        }
        if !moved {
            break;
        }
    }
    let nowhere = Rect { x: 0.0, y: 0.0, width: 0.0, height: 0.0 };
    places.into_iter().map(|place| place.unwrap_or(nowhere)).collect()
}

/// Returns the name's rectangle in a direction and at a distance from its mark.
fn beside(mark: &Named, [dx, dy]: [f64; 2], distance: f64) -> Rect {
    let [width, height] = mark.size;
    // The distance is that of the name's nearest edge or corner.
    let side = |d: f64, size: f64| match d {
        d if d > 0.2 => 0.0,
        d if d < -0.2 => -size,
        _ => -size / 2.0,
    };
    Rect {
        x: mark.at[0] + dx * distance + side(dx, width),
        y: mark.at[1] + dy * distance + if dx.abs() > 0.9 { -height / 2.0 } else { side(dy, height) },
        width,
        height,
    }
}

/// Returns the line from a mark to its name, or `None` if the name is so near that none is drawn.
pub(crate) fn leader(mark: &Named, place: &Rect) -> Option<([f64; 2], [f64; 2])> {
    let end = nearest(place, mark.at);
    let apart = ((end[0] - mark.at[0]).powi(2) + (end[1] - mark.at[1]).powi(2)).sqrt();
    let share = MARK / apart;
    let start = [0, 1].map(|n| mark.at[n] + (end[n] - mark.at[n]) * share);
    (apart > MIN_LEADER).then_some((start, end))
}

/// Returns the point of a rectangle that is nearest to another point.
fn nearest(rect: &Rect, [x, y]: [f64; 2]) -> [f64; 2] {
    [x.clamp(rect.x, rect.x + rect.width), y.clamp(rect.y, rect.y + rect.height)]
}

/// Estimates the width of a text in a sans-serif font of the given size. The estimate is rather too large than too small.
pub fn text_width(text: &str, size: f64) -> f64 {
    let advance = |c: char| match c {
        'i' | 'j' | 'l' | '.' | ',' | ':' | '\'' | '|' | ' ' => 0.33,
        'f' | 'r' | 't' | '-' | '(' | ')' | '/' => 0.43,
        'm' | 'w' | 'M' | 'W' => 0.99,
        c if c.is_uppercase() => 0.74,
        _ => 0.64,
    };
    text.chars().map(advance).sum::<f64>() * size
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOUNDS: Rect = Rect { x: 0.0, y: 0.0, width: 600.0, height: 400.0 };

    #[test]
    fn a_crowd_of_names_stays_apart_and_inside() {
        // Thirty marks on a curve, some of them close together.
        let marks: Vec<Named> = (0..30)
            .map(|n| {
                let t = f64::from(n) / 30.0;
                let at = [40.0 + 520.0 * t * t, 380.0 - 360.0 * t + f64::from(n % 3) * 4.0];
                Named { at, size: [text_width("squaring 16", 11.0), 13.0] }
            })
            .collect();
        let places = place(&marks, &BOUNDS, &[]);
        for (n, place) in places.iter().enumerate() {
            assert!(place.outside(&BOUNDS) < 1e-6, "{place:?}");
            for other in &places[n + 1..] {
                assert_eq!(place.overlap(other), 0.0, "{place:?} and {other:?}");
            }
        }
        assert_eq!(places, super::place(&marks, &BOUNDS, &[]));
    }

    #[test]
    fn a_lone_name_stands_to_the_right_and_off_a_line() {
        let mark = Named { at: [300.0, 200.0], size: [50.0, 12.0] };
        let right = place(&[mark], &BOUNDS, &[])[0];
        assert_eq!((right.x, right.y), (308.0, 194.0));
        let line = ([300.0, 200.0], [600.0, 200.0]);
        assert!(place(&[mark], &BOUNDS, &[line])[0].crossed(line) == 0.0);
        let edge = Named { at: [595.0, 200.0], ..mark };
        assert!(place(&[edge], &BOUNDS, &[])[0].x < 595.0);
    }

    #[test]
    fn rectangles_share_areas() {
        let square = |x, y| Rect { x, y, width: 10.0, height: 10.0 };
        assert_eq!(square(0.0, 0.0).overlap(&square(4.0, 8.0)), 12.0);
        assert_eq!(square(0.0, 0.0).overlap(&square(10.0, 0.0)), 0.0);
        assert_eq!(square(-5.0, 0.0).outside(&BOUNDS), 50.0);
        assert_eq!(nearest(&square(0.0, 0.0), [20.0, 5.0]), [10.0, 5.0]);
    }
}
