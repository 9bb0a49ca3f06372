//! What the figures say: answers to five questions, and five claims of 2002, decided. Nothing of either is written down here but the
//! question, which figures decide it, and from which difference on.

use super::evaluators::Evaluator;
use super::page::number;
use super::questions::Light;
use super::report::Measured;
use super::tables::degrees;
use super::techniques::Technique;
use ninebit::combiner::mapping::map;
use ninebit::state::{ExpandCentre, InputMapping, Policies};

/// Two errors are alike if the larger is at most so many times the smaller.
const ALIKE: f64 = 1.25;
/// A speed is what is claimed if it is no further off than this, of 100.
const NEAR: f64 = 10.0;

/// A row of words.
type Row = Vec<String>;

fn row(cells: &[&str]) -> Row {
    cells.iter().map(|cell| (*cell).to_owned()).collect()
}

/// A way with its error and what it asks of the chip.
fn told(way: &Technique) -> String {
    let cost = &way.accuracy.cost.asked;
    let count = |count: f64, what: &str| match number(count) {
        one if one == "1" => format!("1 {what}"),
        n if what.ends_with("ss") || what.ends_with("ch") => format!("{n} {what}es"),
        n => format!("{n} {what}s"),
    };
    format!(
        "*{}*: {} rms for {}, {}, {}",
        way.entry.name(),
        number(way.rms()),
        count(cost.passes as f64, "pass"),
        count(cost.stages, "stage"),
        count(cost.fetches, "fetch")
    )
}

impl Measured {
    /// Five people's questions. A question whose scenes were not measured is left out.
    pub(super) fn answers(&self) -> Vec<Row> {
        let lights = self.lights();
        let light = |name: &str| lights.iter().find(|light| light.name == name);
        let answers = [
            (
                "Which method for diffuse bumps in one pass?",
                light("diffuse").and_then(one_pass),
                "diffuse-light-on-bumps",
            ),
            (
                "What does a normalisation cube map buy?",
                light("normalisation").and_then(cube_map),
                "five-claims-of-2002",
            ),
            ("When does a table beat squaring?", self.table_or_squaring(), "a-highlight-on-bumps-exponent-8"),
            (
                "What does subtracting cost without subtract?",
                self.subtracting(&lights),
                "a-dot-product-of-signed-vectors",
            ),
            ("What does exact cost over fast?", self.exact(), "ways-of-evaluating-a-scene"),
        ];
        let rows = answers
            .into_iter()
            .filter_map(|(question, answer, place)| Some(row(&[&format!("[{question}](#{place})"), &answer?])));
        std::iter::once(row(&["asked", "answered"])).chain(rows).collect()
    }

    fn find(&self, family: &str, name: &str) -> Option<&Technique> {
        self.techniques.iter().find(|way| way.entry.family == family && way.entry.name() == name)
    }

    /// For each exponent that both were drawn with: which is nearer.
    fn table_or_squaring(&self) -> Option<String> {
        let family = "per-pixel-lighting";
        let exponents = [8, 16, 32].into_iter().filter_map(|exponent| {
            let squared = self.find(family, &format!("specular {exponent}"))?;
            let table = self.find(family, &format!("specular table {exponent} 256"))?;
            let renormalised = self.find(family, &format!("specular {exponent} renormalised"));
            Some((exponent, squared, table, renormalised))
        });
        let exponents: Vec<_> = exponents.collect();
        let (first, ..) = exponents.iter().find(|(_, squared, table, _)| table.rms() < squared.rms())?;
        let nearer = exponents
            .iter()
            .rfind(|(_, _, table, renormalised)| renormalised.is_some_and(|way: &Technique| way.rms() < table.rms()));
        let but = nearer.map_or(String::new(), |(exponent, ..)| {
            format!("; squares of renormalised vectors are nearer up to {exponent}, but keep the bands")
        });
        let told = exponents.iter().map(|(exponent, squared, table, renormalised)| {
            let also = renormalised.map_or(String::new(), |way| {
                format!(", renormalised {} and {}", number(way.rms()), way.accuracy.banding.levels)
            });
            let levels = |way: &Technique| way.accuracy.banding.levels;
            format!(
                "exponent {exponent}: squared {} rms and {} levels{also}, table {} rms and {} levels",
                number(squared.rms()),
                levels(squared),
                number(table.rms()),
                levels(table)
            )
        });
        let told: Vec<String> = told.collect();
        Some(format!("At every exponent from {first} on{but}. {}", capital(&told.join("; "))))
    }

    /// The same passes with and without a subtracting blend.
    fn subtracting(&self, lights: &[Light<'_>]) -> Option<String> {
        let family = "orthogonal-illumination-mapping";
        let [with, without] = [self.find(family, "dot 12")?, self.find(family, "dot 12 approximate")?];
        let fields = lights.iter().find(|light| light.name == "signed-arithmetic");
        let fields = fields.and_then(|light| Some([light.way("height 12")?, light.way("height 12 approximate")?]));
        let also = fields.map_or(String::new(), |[with, without]| {
            format!(" on a ball, {} in place of {} on a gentle height field", number(without.rms()), number(with.rms()))
        });
        Some(format!(
            "No pass, but accuracy: a (1 - b) for a - b makes {} rms of {}{also}; both take {} passes",
            number(without.rms()),
            number(with.rms()),
            with.accuracy.cost.asked.passes
        ))
    }

    /// The exact evaluators beside those that are not.
    fn exact(&self) -> Option<String> {
        let surface = &self.evaluators.first()?.surface;
        let own: Vec<&Evaluator> = self.evaluators.iter().filter(|e| e.surface == *surface).collect();
        let fastest = |exact: bool| {
            let of = own.iter().filter(|e| (e.largest == 0.0) == exact);
            of.min_by(|a, b| a.time.median.total_cmp(&b.time.median))
        };
        let exact = fastest(true)?;
        let told = |e: &Evaluator| {
            format!(
                "*{}* {} ns a pixel, {} rms, at most {} off",
                e.name,
                number(e.time.median),
                number(e.error),
                number(e.largest)
            )
        };
        let named = |name: &str| own.iter().find(|e| e.name == name).map(|e| told(e));
        let others = ["llvmpipe", "float32", "scalar"].into_iter().filter_map(named);
        let others: Vec<String> = others.collect();
        let verdict = match fastest(false) {
            Some(other) if other.time.median < exact.time.median => {
                format!("{} times the time", number(exact.time.median / other.time.median))
            }
            _ => "Nothing: no evaluator measured here is faster than the exact one".to_owned(),
        };
        Some(format!("{verdict}. {}; {}", capital(&told(exact)), others.join("; ")))
    }

    /// Five claims of 2002. A claim whose scenes were not measured is left out.
    pub(super) fn claims(&self) -> Vec<Row> {
        let lights = self.lights();
        let light = |name: &str| lights.iter().find(|light| light.name == name);
        let (smooth, bumps) = (light("normalisation"), light("normalisation-bumps"));
        let claims = [
            ("Two combiner stages normalise better than a cube map of 8 bits", smooth.and_then(combiners_or_cube)),
            ("A cube map of 16 bits with the texture shader's dot product is best", smooth.and_then(sixteen_bits)),
            ("Squaring bands, and a table does not", smooth.and_then(bands)),
            (
                "With bump maps the differences vanish",
                smooth.zip(bumps).and_then(|(smooth, bumps)| vanish(smooth, bumps)),
            ),
            ("Light of the vertices, two combiner stages, 16 bits: speeds 100 : 80 : 50", smooth.and_then(speeds)),
        ];
        let rows = claims.into_iter().filter_map(|(claim, decided)| {
            let (verdict, figures) = decided?;
            Some(row(&[claim, verdict, &figures]))
        });
        let rows = rows.chain(smooth.is_some().then(neutral));
        std::iter::once(row(&["claim", "verdict", "figures"])).chain(rows).collect()
    }
}

/// A verdict and the figures that it stands on.
type Decided = Option<(&'static str, String)>;

fn verdict(holds: bool) -> &'static str {
    if holds { "confirmed" } else { "refuted" }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

fn one_pass(light: &Light<'_>) -> Option<String> {
    let ways = || light.ways.iter().filter(|way| way.accuracy.cost.asked.passes == 1);
    let work = |way: &Technique| way.accuracy.cost.asked.stages + way.accuracy.cost.asked.fetches;
    let exact = ways().next()?;
    let cheap = ways().min_by(|a, b| work(a).total_cmp(&work(b)).then(a.rms().total_cmp(&b.rms())))?;
    let worst = ways().next_back()?;
    Some(format!("{}. Most exact: {}. Furthest off: {}", capital(&told(cheap)), told(exact), told(worst)))
}

fn cube_map(light: &Light<'_>) -> Option<String> {
    let [plain, cube, stages] = ["smooth plain", "smooth cube 8", "smooth combiners"].map(|name| light.way(name));
    let (plain, cube, stages) = (plain?, cube?, stages?);
    Some(format!(
        "{} rms in place of {} for one fetch on a coarse mesh; two stages in its place leave {}",
        number(cube.rms()),
        number(plain.rms()),
        number(stages.rms())
    ))
}

/// Error, levels, angle and cost of a way.
fn figures(way: &Technique) -> String {
    let turned = degrees(way).map_or(String::new(), |angle| format!(", normals {} degrees off", number(angle)));
    format!("{}, {} levels{turned}", told(way), way.accuracy.banding.levels)
}

fn combiners_or_cube(smooth: &Light<'_>) -> Decided {
    let (stages, cube) = (smooth.way("smooth combiners")?, smooth.way("smooth cube 8")?);
    let plain = smooth.way("smooth plain")?;
    let text = format!("{}; {}; neither: {}", figures(stages), figures(cube), figures(plain));
    Some((verdict(stages.rms() < cube.rms()), capital(&text)))
}

fn sixteen_bits(smooth: &Light<'_>) -> Decided {
    let best = smooth.ways.first()?;
    let sixteen = smooth.way("smooth cube 16 table")?;
    let eight = smooth.way("smooth cube 8 table")?;
    let text = format!("{}; eight bits and the same dot product: {}", figures(sixteen), figures(eight));
    Some((verdict(best.entry == sixteen.entry), capital(&text)))
}

fn bands(smooth: &Light<'_>) -> Decided {
    let (squared, table) = (smooth.way("smooth cube 8")?, smooth.way("smooth cube 8 table")?);
    let of = |way: &Technique| (way.accuracy.banding.levels, way.accuracy.banding.truth_levels);
    let ((few, wanted), (many, _)) = (of(squared), of(table));
    let text =
        format!("The same cube map: squared three times {few} levels, from a table {many}, of {wanted} in the truth");
    Some((verdict(2 * few < wanted && 10 * many > 8 * wanted), text))
}

/// The ratio of errors that bumps leave of what it was.
fn vanish(smooth: &Light<'_>, bumps: &Light<'_>) -> Decided {
    let ratio = |light: &Light<'_>, names: [&str; 2]| {
        let [a, b] = names.map(|name| light.way(name).map(Technique::rms));
        let (a, b) = (a?, b?);
        Some(a.max(b) / a.min(b))
    };
    let before = ratio(smooth, ["smooth combiners", "smooth cube 8"])?;
    let after = ratio(bumps, ["bumps combiners", "bumps cube 8"])?;
    let rms = |name: &str| bumps.way(name).map_or("-".to_owned(), |way| number(way.rms()));
    let text = format!(
        "Cube map against stages: errors {} times one another on the smooth ball, {} times on bumps ({} and {}; neither {}; the texture \
         shader's dot product and a table {})",
        number(before),
        number(after),
        rms("bumps cube 8"),
        rms("bumps combiners"),
        rms("bumps plain"),
        rms("bumps table")
    );
    Some((verdict(after <= ALIKE && after < before), text))
}

fn speeds(smooth: &Light<'_>) -> Decided {
    let ways = ["smooth vertex", "smooth combiners", "smooth cube 16 table"].map(|name| smooth.way(name));
    let [Some(vertex), Some(stages), Some(sixteen)] = ways else { return None };
    let all = [vertex, stages, sixteen];
    let speed = all.map(|way| 100.0 * vertex.time.median / way.time.median);
    let near = speed.iter().zip([100.0, 80.0, 50.0]).all(|(speed, claimed)| (speed - claimed).abs() <= NEAR);
    let text = format!(
        "Of a chip's speed counts decide nothing: {}. This program's: {}",
        all.map(told).join("; "),
        speed.map(number).join(" : ")
    );
    Some((if near { "confirmed here" } else { "refuted here" }, text))
}

/// Not a claim of the five, but of the same year: bytes of 128 are taken for zero, or the neutral normal leans.
fn neutral() -> Row {
    let angle = |centre: ExpandCentre| {
        let policies = Policies { expand_centre: centre, ..Policies::DEFAULT };
        let [x, y, z] = map([128_i32, 128, 255], InputMapping::ExpandNormal, &policies).map(|half| f64::from(half.0));
        ((x * x + y * y).sqrt() / z).atan().to_degrees()
    };
    let [centred, literal] = [ExpandCentre::Centred, ExpandCentre::Literal].map(angle);
    let text = format!(
        "Bytes 128, 128, 255: {} degrees from upright if 128 is zero (`CMB-3=centred`, the rule), {} if 127.5 is (`CMB-3=literal`)",
        number(centred),
        number(literal)
    );
    row(&["The neutral normal is off if 128 is not zero", verdict(literal > 0.0 && centred == 0.0), &text])
}
