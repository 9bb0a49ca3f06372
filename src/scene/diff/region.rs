//! Finds connected regions of differing pixels.
//!
//! Rows are taken from the top. A region is open while the last row has a run of its pixels. Each run of the next row joins the open
//! regions that it touches. A region that no run of the new row joins is complete. So the memory holds no more open regions than a row
//! has runs, and the regions that are to be kept.

/// A region: differing pixels that touch, even at corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// First column of its bounding rectangle.
    pub x: u32,
    /// First row of its bounding rectangle.
    pub y: u32,
    /// Number of columns of its bounding rectangle.
    pub width: u32,
    /// Number of rows of its bounding rectangle.
    pub height: u32,
    /// Number of pixels of the region.
    pub pixels: u64,
    /// Column and row of its first pixel in reading order.
    pub first: (u32, u32),
    /// Largest absolute differences of R, G, B and A.
    pub largest: [u8; 4],
}

impl Region {
    /// Returns the key by which reports are sorted: most pixels first, then reading order.
    fn key(&self) -> (std::cmp::Reverse<u64>, u32, u32) {
        (std::cmp::Reverse(self.pixels), self.first.1, self.first.0)
    }

    fn join(&mut self, other: &Region) {
        let right = (self.x + self.width).max(other.x + other.width);
        let bottom = (self.y + self.height).max(other.y + other.height);
        (self.x, self.y) = (self.x.min(other.x), self.y.min(other.y));
        (self.width, self.height) = (right - self.x, bottom - self.y);
        self.pixels += other.pixels;
        if (other.first.1, other.first.0) < (self.first.1, self.first.0) {
            self.first = other.first;
        }
        self.largest = std::array::from_fn(|n| self.largest[n].max(other.largest[n]));
    }
}

/// A run of differing pixels in one row: columns `start..end`.
#[derive(Clone, Copy, Debug)]
struct Run {
    start: u32,
    end: u32,
    /// Index of its region in `Regions::open`.
    region: usize,
}

/// Result of a search.
pub(super) struct RegionList {
    pub(super) kept: Vec<Region>,
    pub(super) count: u64,
    pub(super) pixels: u64,
}

/// State of a search.
pub(super) struct Regions {
    /// Regions that reach the last row, followed by those of the current row, one for each run.
    open: Vec<Region>,
    /// Runs of the last row.
    above: Vec<Run>,
    /// Runs of the current row.
    row: Vec<Run>,
    keep: usize,
    kept: Vec<Region>,
    count: u64,
    pixels: u64,
}

impl Regions {
    pub(super) fn new(keep: usize) -> Self {
        Regions { open: Vec::new(), above: Vec::new(), row: Vec::new(), keep, kept: Vec::new(), count: 0, pixels: 0 }
    }

    /// Adds a differing pixel. Pixels are added in reading order.
    pub(super) fn pixel(&mut self, x: u32, y: u32, largest: [u8; 4]) {
        self.pixels += 1;
        let pixel = Region { x, y, width: 1, height: 1, pixels: 1, first: (x, y), largest };
        match self.row.last_mut() {
            Some(run) if run.end == x => {
                run.end += 1;
                self.open[run.region].join(&pixel);
            }
            _ => {
                self.row.push(Run { start: x, end: x + 1, region: self.open.len() });
                self.open.push(pixel);
            }
        }
    }

    /// Ends a row: joins its runs with the open regions that they touch.
    pub(super) fn end_row(&mut self) {
        if self.open.is_empty() {
            return;
        }
        let mut parents: Vec<usize> = (0..self.open.len()).collect();
        let mut first = 0;
        for run in &self.row {
            // A run above touches this one if it ends at its first column or later, and begins at its end or before.
            while self.above.get(first).is_some_and(|above| above.end < run.start) {
                first += 1;
            }
            for above in self.above[first..].iter().take_while(|above| above.start <= run.end) {
                let (one, other) = (root(&mut parents, above.region), root(&mut parents, run.region));
                if one != other {
                    let absorbed = self.open[one.max(other)];
                    self.open[one.min(other)].join(&absorbed);
                    parents[one.max(other)] = one.min(other);
                }
            }
        }
        self.close(&mut parents);
    }

    /// Renumbers the regions that the current row reaches, which stay open, and completes the others.
    fn close(&mut self, parents: &mut [usize]) {
        let mut number = vec![usize::MAX; parents.len()];
        let mut open = Vec::with_capacity(self.row.len());
        for run in &mut self.row {
            let root = root(parents, run.region);
            if number[root] == usize::MAX {
                number[root] = open.len();
                open.push(self.open[root]);
            }
            run.region = number[root];
        }
        for index in 0..parents.len() {
            if parents[index] == index && number[index] == usize::MAX {
                self.complete(self.open[index]);
            }
        }
        self.open = open;
        std::mem::swap(&mut self.above, &mut self.row);
        self.row.clear();
    }

    fn complete(&mut self, region: Region) {
        self.count += 1;
        self.kept.push(region);
        if self.kept.len() > 2 * self.keep + 64 {
            self.cut();
        }
    }

    fn cut(&mut self) {
        self.kept.sort_by_key(Region::key);
        self.kept.truncate(self.keep);
    }

    pub(super) fn finish(mut self) -> RegionList {
        for region in std::mem::take(&mut self.open) {
            self.complete(region);
        }
        self.cut();
        RegionList { kept: self.kept, count: self.count, pixels: self.pixels }
    }
}

/// Returns the representative of a region that may have been joined to others, and shortens the path to it.
fn root(parents: &mut [usize], mut at: usize) -> usize {
    while parents[at] != at {
        parents[at] = parents[parents[at]];
        at = parents[at];
    }
    at
}
