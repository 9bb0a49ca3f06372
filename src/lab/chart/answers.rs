//! Answers to five questions, and verdicts on five claims of 2002, derived from the measurements. The code holds only the questions, the figures that
//! decide them, and the thresholds.

use super::evaluators::Evaluator;
use super::page::{Row, number, row};
use super::questions::Light;
use super::report::Measurements;
use super::tables::degrees;
use super::techniques::Technique;
use ninebit::combiner::mapping::map;
use ninebit::state::{ExpandCentre, InputMapping, Policies};

/// Two errors count as alike if the larger is at most this many times the smaller.
const MAX_ERROR_RATIO: f64 = 1.25;
/// Largest deviation from a claimed relative speed (in per cent) at which the claim counts as confirmed.
const MAX_SPEED_DEVIATION: f64 = 10.0;

/// Describes a technique with its error and its cost on the chip.
fn describe(way: &Technique) -> String {
    let cost = &way.accuracy.cost.asked;
    let counts = [(cost.passes as f64, "pass"), (cost.stages, "stage"), (cost.fetches, "fetch")];
    let [passes, stages, fetches] = counts.map(|(count, what)| match number(count) {
        one if one == "1" => format!("1 {what}"),
        n if what.ends_with("ss") || what.ends_with("ch") => format!("{n} {what}es"),
        n => format!("{n} {what}s"),
    });
    format!("*{}*: {} rms for {passes}, {stages}, {fetches}", way.title, rms(way))
}

/// Returns the error of a technique as text.
fn rms(way: &Technique) -> String {
    number(way.rms())
}

impl Measurements {
    /// Returns the table of five questions and their answers. Questions whose scenes were not measured are left out.
    pub(super) fn answers(&self) -> Vec<Row> {
        let lights = self.lights();
        let light = |name: &str| lights.iter().find(|light| light.name == name);
        let (one_pass, cube_map) = (light("diffuse").and_then(one_pass), light("normalisation").and_then(cube_map));
        let (squaring, subtracting) = (self.table_or_squaring(), self.subtracting(&lights));
        let answers = [
            ("Which method for diffuse bumps in one pass?", one_pass, "diffuse-light-on-bumps"),
            ("What does a normalisation cube map buy?", cube_map, "five-claims-of-2002"),
            ("When does a table beat squaring?", squaring, "a-highlight-on-bumps-exponent-8"),
            ("What does subtracting cost without subtract?", subtracting, "a-dot-product-of-signed-vectors"),
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

    /// Compares squaring with a table at each exponent that both were measured with.
    fn table_or_squaring(&self) -> Option<String> {
        let family = "per-pixel-lighting";
        let exponents = [8, 16, 32].into_iter().filter_map(|exponent| {
            let squared = self.find(family, &format!("specular {exponent}"))?;
            let table = self.find(family, &format!("specular table {exponent} 256"))?;
            Some((exponent, squared, table, self.find(family, &format!("specular {exponent} renormalised"))))
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
            let levels = |way: &Technique| way.accuracy.banding.levels;
            let told = |what: &str, way: &Technique| format!("{what} {} rms and {} levels", rms(way), levels(way));
            let also = renormalised.map(|way| format!(", renormalised {} and {}", rms(way), levels(way)));
            let (squared, table) = (told("squared", squared), told("table", table));
            format!("exponent {exponent}: {squared}{}, {table}", also.unwrap_or_default())
        });
        let told: Vec<String> = told.collect();
        Some(format!("At every exponent from {first} on{but}. {}", capital(&told.join("; "))))
    }

    /// Compares the same passes with and without a subtracting blend.
    fn subtracting(&self, lights: &[Light<'_>]) -> Option<String> {
        let family = "orthogonal-illumination-mapping";
        let [with, without] = [self.find(family, "dot 12")?, self.find(family, "dot 12 approximate")?];
        let fields = lights.iter().find(|light| light.name == "signed-arithmetic");
        let fields = fields.and_then(|light| Some([light.way("height 12")?, light.way("height 12 approximate")?]));
        let also = fields.map_or(String::new(), |[with, without]| {
            format!(" on a ball, {} in place of {} on a gentle height field", rms(without), rms(with))
        });
        let (of, makes, passes) = (rms(with), rms(without), with.accuracy.cost.asked.passes);
        Some(format!(
            "No pass, but accuracy: a (1 - b) for a - b makes {makes} rms of {of}{also}; both take {passes} passes"
        ))
    }

    /// Compares the exact evaluators with the others.
    fn exact(&self) -> Option<String> {
        let surface = &self.evaluators.first()?.surface;
        let own: Vec<&Evaluator> = self.evaluators.iter().filter(|e| e.surface == *surface).collect();
        let fastest = |exact: bool| {
            let of = own.iter().filter(|e| (e.largest == 0.0) == exact);
            of.min_by(|a, b| a.time.median.total_cmp(&b.time.median))
        };
        let exact = fastest(true)?;
        let told = |e: &Evaluator| {
            let [time, error, largest] = [e.time.median, e.error, e.largest].map(number);
            format!("*{}* {time} ns a pixel, {error} rms, at most {largest} off", e.name)
        };
        let named = |name: &str| own.iter().find(|e| e.name == name).map(|e| told(e));
        let others: Vec<String> = ["llvmpipe", "float32", "scalar"].into_iter().filter_map(named).collect();
        let verdict = match fastest(false) {
            Some(other) if other.time.median < exact.time.median => {
                format!("{} times the time", number(exact.time.median / other.time.median))
            }
            _ => "Nothing: no evaluator measured here is faster than the exact one".to_owned(),
        };
        Some(format!("{verdict}. {}; {}", capital(&told(exact)), others.join("; ")))
    }

    /// Returns the table of five claims of 2002 and their verdicts. Claims whose scenes were not measured are left out.
    pub(super) fn claims(&self) -> Vec<Row> {
        let lights = self.lights();
        let light = |name: &str| lights.iter().find(|light| light.name == name);
        let (smooth, bumps) = (light("normalisation"), light("normalisation-bumps"));
        let vanished = smooth.zip(bumps).and_then(|(smooth, bumps)| vanish(smooth, bumps));
        let claims = [
            ("Two combiner stages normalise better than a cube map of 8 bits", smooth.and_then(combiners_or_cube)),
            ("A cube map of 16 bits with the texture shader's dot product is best", smooth.and_then(sixteen_bits)),
            ("Squaring bands, and a table does not", smooth.and_then(bands)),
            ("With bump maps the differences vanish", vanished),
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

/// A verdict and the figures behind it; `None` if scenes were not measured.
type Winner = Option<(&'static str, String)>;

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
    Some(format!("Most exact: {}. Cheapest: {}. Furthest off: {}", describe(exact), describe(cheap), describe(worst)))
}

fn cube_map(light: &Light<'_>) -> Option<String> {
    let names = ["smooth plain", "smooth cube 8", "smooth combiners"];
    let [plain, cube, stages] = names.map(|name| light.way(name).map(rms));
    let (plain, cube, stages) = (plain?, cube?, stages?);
    Some(format!(
        "{cube} rms in place of {plain} for one fetch on a coarse mesh; two stages in its place leave {stages}"
    ))
}

/// Describes error, cost, levels and normal angle of a technique.
fn figures(way: &Technique) -> String {
    let turned = degrees(way).map_or(String::new(), |angle| format!(", normals {} degrees off", number(angle)));
    format!("{}, {} levels{turned}", describe(way), way.accuracy.banding.levels)
}

fn combiners_or_cube(smooth: &Light<'_>) -> Winner {
    let (stages, cube) = (smooth.way("smooth combiners")?, smooth.way("smooth cube 8")?);
    let plain = smooth.way("smooth plain")?;
    let text = format!("{}; {}; neither: {}", figures(stages), figures(cube), figures(plain));
    Some((verdict(stages.rms() < cube.rms()), capital(&text)))
}

fn sixteen_bits(smooth: &Light<'_>) -> Winner {
    let best = smooth.ways.first()?;
    let sixteen = smooth.way("smooth cube 16 table")?;
    let eight = smooth.way("smooth cube 8 table")?;
    let text = format!("{}; eight bits and the same dot product: {}", figures(sixteen), figures(eight));
    Some((verdict(best.entry == sixteen.entry), capital(&text)))
}

fn bands(smooth: &Light<'_>) -> Winner {
    let (squared, table) = (smooth.way("smooth cube 8")?, smooth.way("smooth cube 8 table")?);
    let of = |way: &Technique| (way.accuracy.banding.levels, way.accuracy.banding.truth_levels);
    let ((few, wanted), (many, _)) = (of(squared), of(table));
    let text =
        format!("The same cube map: squared three times {few} levels, from a table {many}, of {wanted} in the truth");
    Some((verdict(2 * few < wanted && 10 * many > 8 * wanted), text))
}

/// Decides whether bump maps make the difference between two techniques vanish.
fn vanish(smooth: &Light<'_>, bumps: &Light<'_>) -> Winner {
    let ratio = |light: &Light<'_>, names: [&str; 2]| {
        let [a, b] = names.map(|name| light.way(name).map(Technique::rms));
        let (a, b) = (a?, b?);
        Some(a.max(b) / a.min(b))
    };
    let before = ratio(smooth, ["smooth combiners", "smooth cube 8"])?;
    let after = ratio(bumps, ["bumps combiners", "bumps cube 8"])?;
    let ways = ["bumps cube 8", "bumps combiners", "bumps plain", "bumps table"];
    let [cube, stages, plain, table] = ways.map(|name| bumps.way(name).map_or("-".to_owned(), rms));
    let verdict = verdict(after <= MAX_ERROR_RATIO && after < before);
    let [before, after] = [before, after].map(number);
    let text = format!(
        "Cube map against stages: errors {before} times one another on the smooth ball, {after} times on bumps ({cube} and {stages}; neither \
         {plain}; the texture shader's dot product and a table {table})"
    );
    Some((verdict, text))
}

fn speeds(smooth: &Light<'_>) -> Winner {
    let ways = ["smooth vertex", "smooth combiners", "smooth cube 16 table"].map(|name| smooth.way(name));
    let [Some(vertex), Some(stages), Some(sixteen)] = ways else { return None };
    let all = [vertex, stages, sixteen];
    let speed = all.map(|way| 100.0 * vertex.time.median / way.time.median);
    let near =
        speed.iter().zip([100.0, 80.0, 50.0]).all(|(speed, claimed)| (speed - claimed).abs() <= MAX_SPEED_DEVIATION);
    let (counts, speeds) = (all.map(describe).join("; "), speed.map(number).join(" : "));
    let text = format!("Of a chip's speed counts decide nothing: {counts}. This program's: {speeds}");
    Some((if near { "confirmed here" } else { "refuted here" }, text))
}

/// Returns a sixth claim of the same year: if byte 128 does not mean zero, the neutral normal is tilted.
fn neutral() -> Row {
    let angle = |centre: ExpandCentre| {
        let policies = Policies { expand_centre: centre, ..Policies::DEFAULT };
        let [x, y, z] = map([128_i32, 128, 255], InputMapping::ExpandNormal, &policies).map(|half| f64::from(half.0));
        ((x * x + y * y).sqrt() / z).atan().to_degrees()
    };
    let [centred, literal] = [ExpandCentre::Centred, ExpandCentre::Literal].map(angle);
    let verdict = verdict(literal > 0.0 && centred == 0.0);
    let [centred, literal] = [centred, literal].map(number);
    let text = format!(
        "Bytes 128, 128, 255: {centred} degrees from upright if 128 is zero (`CMB-3=centred`, the rule), {literal} if 127.5 is (`CMB-3=literal`)"
    );
    row(&["The neutral normal is off if 128 is not zero", verdict, &text])
}
