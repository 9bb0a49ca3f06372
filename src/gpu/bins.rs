//! Sorts the triangles of a draw into tiles, in order.

use ninebit::engine::context::TriangleContext;
use ninebit::engine::walk::triangles;
use ninebit::plan::{Plan, PlannedDraw};
use ninebit::raster::stroke::Figure;
use ninebit_lower::{Field, Setup};

use crate::adapter::TILE;

const SIDE: i64 = TILE as i64;

/// Words of a tile before the triangles of its rows.
pub(crate) const TILE_WORDS: usize = TILE as usize + 2;

/// Pixels of a tile, a bit for each, row by row.
type Mask = [u32; 8];

/// Which pixels of a tile a triangle covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TileCoverage {
    /// Those that the printed function names.
    ByRule,
    /// All of them.
    All,
    /// Those of the mask, for lines, points, patterns and the edges of windows.
    ByMask,
}

/// A triangle in a tile.
#[derive(Clone, Copy, Debug)]
struct Entry {
    tile: u32,
    triangle: u32,
    covered: TileCoverage,
    mask: Mask,
}

/// The triangles of a draw, or some of them, and where they may be seen.
#[derive(Debug, Default)]
pub(crate) struct Bins {
    /// Constants of each triangle, all of them as long.
    pub(crate) constants: Vec<u32>,
    /// Number of triangles.
    pub(crate) triangles: usize,
    entries: Vec<Entry>,
}

/// Lists of tiles for the shader.
#[derive(Debug)]
pub(crate) struct Tiles {
    /// The words.
    pub(crate) words: Vec<u32>,
    /// The lists.
    pub(crate) lists: Vec<List>,
}

/// A list of tiles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct List {
    /// First word.
    pub(crate) first: u32,
    /// Number of tiles.
    pub(crate) count: u32,
    /// The triangle, where a list has one.
    pub(crate) triangle: usize,
    /// Whether the triangle covers all pixels of the tiles.
    pub(crate) is_full: bool,
}

/// Where triangles are drawn.
struct Place<'p> {
    plan: &'p Plan,
    draw: &'p PlannedDraw,
    size: [i64; 2],
}

/// Triangles of one dispatch: their numbers have 16 bits, and their constants stay below the least limit of a buffer's size, 128 MB.
const TRIANGLES: usize = 65_536;

/// Tiles of the triangles of a dispatch, after which no triangle is added: the rows of their masks stay below that limit.
const TILES: usize = 1 << 20;

/// Returns the triangles of a draw in groups for one dispatch each; `None` if they have more than `most` tiles. `fields` are the constants that the
/// shader reads.
pub(crate) fn sorted(
    plan: &Plan,
    draw: &PlannedDraw,
    setup: &Setup,
    fields: &[Field],
    most: usize,
) -> Option<Vec<Bins>> {
    let target = &plan.targets()[draw.target];
    let place = Place { plan, draw, size: [target.width.into(), target.height.into()] };
    let (mut all, mut tiles): (Vec<Bins>, _) = (Vec::new(), 0);
    for ((rows, columns), n) in triangles(draw, (0, place.size[1])) {
        let Some(context) = TriangleContext::new(place.plan, draw, n, rows) else { continue };
        if all.last().is_none_or(|bins| bins.triangles == TRIANGLES || bins.entries.len() >= TILES) {
            all.push(Bins::default());
        }
        let Some(bins) = all.last_mut() else { continue };
        let before = bins.entries.len();
        bins.append_tiles(&place, &context, [columns, rows]);
        tiles += bins.entries.len() - before;
        if tiles > most {
            return None;
        }
        if bins.entries.len() > before {
            let constants = setup.constants(&context);
            let words = fields.iter().flat_map(|field| field.words(constants.get(field).copied().unwrap_or(0)));
            bins.constants.extend(words);
            bins.constants.resize(bins.constants.len().next_multiple_of(4), 0);
            bins.triangles += 1;
        }
    }
    all.retain(|bins| bins.triangles > 0);
    Some(all)
}

impl Bins {
    /// Appends the tiles of a triangle within a window.
    fn append_tiles(&mut self, place: &Place<'_>, context: &TriangleContext<'_>, [columns, rows]: [(i64, i64); 2]) {
        let (top, bottom) = (context.triangle.rows.0.max(rows.0), context.triangle.rows.1.min(rows.1));
        let across = place.size[0].div_euclid(SIDE) + i64::from(place.size[0] % SIDE > 0);
        let is_plain = context.triangle.figure == Figure::Triangle && place.draw.polygon_stipple.is_none();
        if top >= bottom {
            return;
        }
        for row in top / SIDE..=(bottom - 1) / SIDE {
            let mut spans = [(0, 0); TILE as usize];
            for j in top.max(row * SIDE)..bottom.min(row * SIDE + SIDE) {
                spans[(j % SIDE) as usize] = context.triangle.span(j, columns);
            }
            let filled = || spans.iter().filter(|span| span.0 < span.1);
            let (Some(left), Some(right)) = (filled().map(|s| s.0).min(), filled().map(|s| s.1).max()) else {
                continue;
            };
            for column in left / SIDE..=(right - 1) / SIDE {
                let corner = [column * SIDE, row * SIDE];
                let end = [0, 1].map(|axis| (corner[axis] + SIDE).min(place.size[axis]));
                let mask = mask(context, &spans, corner);
                let count: u32 = mask.iter().map(|word| word.count_ones()).sum();
                let is_inside = |axis: usize, (from, to): (i64, i64)| from <= corner[axis] && end[axis] <= to;
                let covered = match () {
                    () if count == 0 => continue,
                    () if i64::from(count) == (end[0] - corner[0]) * (end[1] - corner[1]) => TileCoverage::All,
                    () if is_plain && is_inside(0, columns) && is_inside(1, rows) => TileCoverage::ByRule,
                    () => TileCoverage::ByMask,
                };
                let tile = (row * across + column) as u32;
                self.entries.push(Entry { tile, triangle: self.triangles as u32, covered, mask });
            }
        }
    }

    /// Returns how many tiles the triangles have, each counted for itself.
    pub(crate) fn entries(&self) -> usize {
        self.entries.len()
    }

    /// Returns one list of tiles: for each its number, and where the triangles of its rows begin and end in the words. A triangle's number has its
    /// pixels of that row in the upper half.
    pub(crate) fn tiles(&self) -> Tiles {
        let mut entries: Vec<&Entry> = self.entries.iter().collect();
        // Stable: triangles of a tile stay in order.
        entries.sort_by_key(|entry| entry.tile);
        let tiles: Vec<&[&Entry]> = entries.chunk_by(|a, b| a.tile == b.tile).collect();
        let (first, mut rows) = (TILE_WORDS * tiles.len(), Vec::new());
        let mut words = Vec::new();
        for tile in &tiles {
            words.push(tile[0].tile);
            for row in 0..TILE as usize {
                words.push((first + rows.len()) as u32);
                let pixels = |entry: &Entry| entry.mask[row / 2] >> (16 * (row % 2)) & 0xffff;
                let covered = tile.iter().filter(|entry| pixels(entry) != 0);
                rows.extend(covered.map(|entry| pixels(entry) << 16 | entry.triangle));
            }
            words.push((first + rows.len()) as u32);
        }
        words.extend(rows);
        let list = List { first: 0, count: tiles.len() as u32, triangle: 0, is_full: false };
        Tiles { words, lists: vec![list] }
    }

    /// Returns lists for each triangle, of the tiles that it covers and of the others: of each its number, and where its mask stands, or 0. Masks stand at
    /// the end.
    pub(crate) fn tiles_by_triangle(&self) -> Tiles {
        let mut entries: Vec<&Entry> = self.entries.iter().collect();
        let is_full = |entry: &Entry| entry.covered == TileCoverage::All;
        entries.sort_by_key(|entry| (entry.triangle, is_full(entry)));
        let (first, mut masks) = (2 * entries.len(), Vec::<u32>::new());
        let mut words = Vec::new();
        for entry in &entries {
            let is_masked = entry.covered == TileCoverage::ByMask;
            words.extend([entry.tile, if is_masked { (first + masks.len()) as u32 } else { 0 }]);
            masks.extend(entry.mask.iter().filter(|_| is_masked));
        }
        words.extend(masks);
        let mut first = 0;
        let lists = entries.chunk_by(|a, b| (a.triangle, is_full(a)) == (b.triangle, is_full(b))).map(|tiles| {
            let count = tiles.len() as u32;
            first += 2 * count;
            List { first: first - 2 * count, count, triangle: tiles[0].triangle as usize, is_full: is_full(tiles[0]) }
        });
        let lists = lists.collect();
        Tiles { words, lists }
    }
}

/// Returns the pixels of a tile that lie in spans and that no pattern leaves out.
fn mask(context: &TriangleContext<'_>, spans: &[(i64, i64); TILE as usize], [left, top]: [i64; 2]) -> Mask {
    let mut mask = [0; 8];
    for (row, (from, to)) in spans.iter().enumerate() {
        let is_in = |i: &i64| !context.is_left_out(*i, top + row as i64);
        for i in ((*from).max(left)..(*to).min(left + SIDE)).filter(is_in) {
            let bit = row * TILE as usize + (i - left) as usize;
            mask[bit / 32] |= 1 << (bit % 32);
        }
    }
    mask
}
