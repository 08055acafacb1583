//! The report of a study: one HTML page that works offline, with interactive figures and their data.

mod collect;
mod gearbox;
mod point;
mod template;

use gearloss_framework::description::AssumedEntry;
use gearloss_framework::document::{Diagnostic, visible, visible_json};
use gearloss_framework::evaluate::PowerFlow;
use gearloss_framework::language::Language;
use gearloss_studies::engine::head::{hash, inputs};
use gearloss_studies::study::Study;
use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, Value as Filled};
use rayon::prelude::*;
use serde::Serialize;
use serde_json::Value;

pub use gearbox::gearbox_page;
pub use point::{losses_of_parts, place as point_of_report, waterfall};
pub use template::{LONGEST_PAGE, LONGEST_TEMPLATE, fill_template};

use crate::page::{Block, KeyFigure, Page};
use crate::picture::{Picture, Screen};
use crate::stated_ranges::StatedRanges;
use crate::tested::Tested;
use crate::text::{TextTable, capitalised};

/// The built-in template.
const TEMPLATE: &str = include_str!("html/template.html");

/// The library that draws pictures, and the style of the page; built from `web/`.
const SCRIPT: &str = include_str!("html/report.js");
const STYLE: &str = include_str!("html/report.css");

/// Maximum number of steps of a template. A large study needs some ten thousand; this limit takes seconds.
const MOST_STEPS: u64 = 10_000_000;

/// The content of a report, collected while a study runs.
#[derive(Debug, Default)]
pub struct Report {
    /// Analyses in their order.
    pub sections: Vec<Section>,
    /// Analyses that answer the question of the study, by name.
    pub answers: Vec<String>,
    /// Quantities outside their stated ranges over all analyses.
    pub outside: Option<TextTable>,
    /// The same in short, the worst first.
    pub worst: Vec<String>,
    /// Gearboxes in their order.
    pub gearboxes: Vec<GearboxPage>,
    /// Quantities outside their stated ranges, as the outcomes add them.
    ranges: StatedRanges,
    /// Measured points, and limits that may be beyond them.
    tested: Tested,
}

/// One analysis.
#[derive(Debug, Default, Serialize)]
pub struct Section {
    /// Name of the analysis.
    pub name: String,
    /// Title; the name if the study gives none.
    pub title: String,
    /// The title that the study gives, if it has several analyses of this type, whose results are told apart by it.
    pub which: Option<String>,
    /// Description of the analysis as a sentence.
    pub about: String,
    /// Note of the study on the analysis.
    pub note: Option<String>,
    /// Why the analysis failed, in one line; absent if it did not.
    pub failed: Option<String>,
    /// The result in one sentence.
    pub headline: Option<String>,
    /// The numbers to remember.
    pub key_figures: Vec<KeyFigure>,
    /// Limits of the study that are not kept.
    pub limits: Vec<String>,
    /// The end of `headline` that says which limits are kept, so that the first screen says it once; may be empty.
    pub limits_verdict: String,
    /// What else a reader has to be careful about.
    pub careful: Vec<String>,
    /// Main conclusions.
    pub verdicts: Vec<String>,
    /// Quantities outside their stated ranges, a line for each; the page counts them, and its table names them.
    pub outside: Vec<String>,
    /// Their rows in the table of the page, such as `1-3, 5`.
    pub marks: String,
    /// Text and tables.
    pub blocks: Vec<Block>,
    /// Pictures, the first one shows the result best.
    #[serde(skip)]
    pub pictures: Vec<Picture>,
}

impl Section {
    /// The result in one sentence: the headline, or the first conclusion.
    pub fn result(&self) -> String {
        let first = self.headline.as_ref().or(self.verdicts.first());
        first.map_or_else(|| "done".to_owned(), String::clone)
    }

    /// The result beside those of other analyses.
    pub fn result_of_several(&self) -> String {
        match &self.which {
            Some(which) => format!("{which}: {}", self.result()),
            None => self.result(),
        }
    }

    /// Adds the page of an outcome.
    pub fn add(&mut self, page: Page) {
        self.headline = page.headline;
        self.key_figures = page.key_figures;
        self.limits = page.limits;
        self.limits_verdict = page.limits_verdict;
        self.careful = page.careful;
        self.outside = page.outside;
        self.blocks.extend(page.blocks);
        self.verdicts.extend(page.verdicts);
        // The name of the analysis is the heading above its pictures.
        let prefix = format!("{}: ", self.name);
        self.pictures.extend(page.pictures.into_iter().map(|mut picture| {
            if let Some(rest) = picture.title().strip_prefix(&prefix) {
                *picture.title_mut() = capitalised(rest);
            }
            picture
        }));
    }
}

/// Rounds all numbers to the digits that a picture can show, which makes the page several times smaller.
fn shorten(value: &mut Value) {
    match value {
        Value::Number(number) if number.is_f64() => {
            *value = number.as_f64().map_or(Value::Null, |x| Value::from(six_digits(x)));
        }
        Value::Array(list) => list.iter_mut().for_each(shorten),
        Value::Object(map) => map.values_mut().for_each(shorten),
        _ => {}
    }
}

/// A number with six significant digits: the number that is nearest to that decimal.
fn six_digits(x: f64) -> f64 {
    /// The largest power of ten that is exact.
    const EXACT: i32 = 22;
    let formatted = || format!("{x:.5e}").parse().unwrap_or(f64::NAN);
    if !x.is_normal() {
        return formatted();
    }
    let digits = 5 - x.abs().log10().floor() as i32;
    if digits.abs() > EXACT {
        return formatted();
    }
    let power = 10.0_f64.powi(digits.abs());
    let scaled = if digits >= 0 { x * power } else { x / power };
    let whole = scaled.round();
    // The product is rounded, so that it does not decide near a tie; nor does the logarithm near a power of ten.
    if (scaled - whole).abs() > 0.499_999 || !(1e5..1e6).contains(&whole.abs()) {
        return formatted();
    }
    if digits >= 0 { whole / power } else { whole * power }
}

/// A section or a gearbox for templates, with its pictures.
#[derive(Serialize)]
struct WithPictures<'a, T> {
    #[serde(flatten)]
    content: &'a T,
    pictures: Vec<PictureOfPage<'a>>,
}

/// A picture for templates; its data are in `pictures`.
#[derive(Serialize)]
struct PictureOfPage<'a> {
    id: String,
    title: &'a str,
    /// Whether it shows maps.
    panels: bool,
    /// Whether it shows several maps side by side.
    side_by_side: bool,
}

/// A gearbox and the basis of its results.
#[derive(Debug, Serialize)]
pub struct GearboxPage {
    /// Name in the study.
    pub name: String,
    /// Title.
    pub title: String,
    /// Source of the description.
    pub source: String,
    /// Drawing, as SVG.
    pub drawing: String,
    /// Cross-section of the housing with its oil at the point, as SVG; empty if the oil space is not known.
    pub oil: String,
    /// Tables of geometry and kinematics.
    pub tables: Vec<PageTable>,
    /// An operating point as text; empty if there is none.
    pub point: String,
    /// Torque and speed of that point as text.
    pub place: String,
    /// Losses of the parts of the drawing at that point, with the first model set, as JSON: pairs of path and W.
    pub losses: String,
    /// How much of the loss at that point is from models that no measured set judges; absent if it is little.
    pub unjudged: Option<String>,
    /// Pictures of that point.
    #[serde(skip)]
    pub pictures: Vec<Picture>,
    /// Loads, balances and shares at that point.
    pub point_tables: Vec<PageTable>,
    /// Assumptions with their reasons.
    pub assumed: Vec<AssumedEntry>,
    /// The resolved description.
    pub resolved: String,
}

/// A table of the page.
#[derive(Debug, Serialize)]
pub struct PageTable {
    /// Title.
    pub title: String,
    /// Names of the columns.
    pub head: Vec<String>,
    /// Cells.
    pub rows: Vec<Vec<String>>,
}

/// Head and foot of the page.
#[derive(Debug, Serialize)]
pub struct Frame {
    /// Title of the study.
    pub title: String,
    /// The question that it answers.
    pub question: String,
    /// What its measurements are, in their own words.
    pub measurements: Vec<String>,
    /// The conditions of all analyses as a sentence.
    pub conditions: String,
    /// Version of the program.
    pub version: String,
    /// Hash of the study, its gearboxes and their files.
    pub inputs: String,
    /// Crates with models.
    pub packages: Vec<String>,
    /// The study as written.
    pub study: String,
}

impl Frame {
    /// That of a study, for a version of the program.
    pub fn new(study: &Study, language: &Language, version: &str) -> Self {
        let packages = language.registry().packages();
        Self {
            title: study.entry.title.clone().unwrap_or_else(|| "Study".to_owned()),
            question: study.entry.question.clone().unwrap_or_default(),
            measurements: measurements(study),
            conditions: conditions(study),
            version: version.to_owned(),
            inputs: hash(
                inputs(study)
                    .iter()
                    .flat_map(|file| file.fnv1a_64.bytes())
                    .collect::<Vec<u8>>()
                    .as_slice(),
            ),
            packages: packages.iter().map(ToString::to_string).collect(),
            study: study.text.to_string(),
        }
    }
}

/// What the measurements of a study are, where it says so: a line for each.
pub fn measurements(study: &Study) -> Vec<String> {
    let entries = study.entry.measurements.iter();
    let stated = entries.filter_map(|(name, entry)| Some((name, entry.about.as_ref()?)));
    stated
        .map(|(name, about)| format!("measurement `{name}`: {about}"))
        .collect()
}

/// The conditions of all analyses as a sentence.
fn conditions(study: &Study) -> String {
    let given = &study.entry.conditions;
    let oil = given.oil_temperature.map_or_else(
        || "oil temperature of the gearbox".to_owned(),
        |oil| format!("oil at {oil} °C"),
    );
    let flow = match given.power_flow {
        PowerFlow::Real => "torque reduced by upstream losses (real power flow)",
        PowerFlow::Ideal => "torque without losses (ideal power flow)",
    };
    format!(
        "Torque at `{}`, speed at `{}`, {oil}; {flow}. Model sets are listed in the study at the end of this page.",
        given.torque_at, given.speed_at
    )
}

/// What a template can use besides `script` and `style`.
#[derive(Serialize)]
pub struct Content<'a> {
    frame: &'a Frame,
    sections: Vec<WithPictures<'a, Section>>,
    gearboxes: Vec<WithPictures<'a, GearboxPage>>,
    answers: &'a [String],
    outside: Option<&'a TextTable>,
    worst: &'a [String],
    /// The data of all pictures as JSON.
    pictures: String,
}

impl Report {
    /// The page by the built-in template. Hidden characters of documents are shown as escapes wherever they are.
    ///
    /// # Errors
    /// Error of the template.
    pub fn html(&self, frame: &Frame) -> Result<String, Diagnostic> {
        let content = serde_json::to_value(self.content(frame));
        page(content.map_err(|fault| Diagnostic::error("", format!("the report cannot be encoded: {fault}")))?)
    }

    /// What a template of the user gets, to be serialised for [`fill_template`].
    pub fn content<'a>(&'a self, frame: &'a Frame) -> Content<'a> {
        let id = |number: usize| format!("picture-{number}");
        let mut all: Vec<&Picture> = Vec::new();
        let mut placed = |pictures: &'a [Picture]| -> Vec<PictureOfPage<'a>> {
            let pictures = pictures.iter().map(|picture| {
                all.push(picture);
                PictureOfPage {
                    id: id(all.len() - 1),
                    title: picture.title(),
                    panels: matches!(picture, Picture::Screen(Screen::Panels(_))),
                    side_by_side: matches!(
                        picture,
                        Picture::Screen(Screen::Panels(panels)) if panels.rows.len() * panels.columns.len() > 1
                    ),
                }
            });
            pictures.collect()
        };
        let sections = self.sections.iter().map(|section| WithPictures {
            content: section,
            pictures: placed(&section.pictures),
        });
        let sections = sections.collect();
        let gearboxes = self.gearboxes.iter().map(|gearbox| WithPictures {
            content: gearbox,
            pictures: placed(&gearbox.pictures),
        });
        let gearboxes = gearboxes.collect();
        let datum = |(number, picture): (usize, &&Picture)| {
            let json = serde_json::to_value(picture).map(|mut value| {
                shorten(&mut value);
                value.to_string()
            });
            let json = json.unwrap_or_default();
            // A text in the data must neither end the enclosing script nor start a comment or script in it.
            let json = visible_json(&json).replace('<', "\\u003c");
            format!("\"{}\":{json}", id(number))
        };
        let data: Vec<String> = all.par_iter().enumerate().map(datum).collect();
        Content {
            frame,
            sections,
            gearboxes,
            answers: &self.answers,
            outside: self.outside.as_ref(),
            worst: &self.worst,
            pictures: format!("{{{}}}", data.join(",")),
        }
    }
}

/// The page of a report with this content: that of [`Report::content`], also as it was stored.
///
/// # Errors
/// Content that is not that of a report.
pub fn page(content: Value) -> Result<String, Diagnostic> {
    let page = environment()
        .template_from_named_str("report", TEMPLATE)
        .and_then(|page| page.render(filled(content)));
    let page = page.map_err(|fault| template::fault("report", &fault))?;
    Ok(visible(&page).into_owned())
}

/// An environment without named templates, so that a template cannot include any, not even itself.
fn environment<'a>() -> Environment<'a> {
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment
}

/// What a template can use, of serialised [`Content`].
fn filled(mut content: Value) -> Filled {
    let pictures = content.get_mut("pictures").map(Value::take);
    let pictures = pictures.as_ref().and_then(Value::as_str).unwrap_or_default().to_owned();
    let value = |key: &str| Filled::from(Serde(&content[key]));
    minijinja::context! {
        frame => value("frame"),
        sections => value("sections"),
        gearboxes => value("gearboxes"),
        answers => value("answers"),
        outside => value("outside"),
        worst => value("worst"),
        ..fixed(pictures),
    }
}

/// What needs no escaping.
fn fixed(pictures: String) -> Filled {
    minijinja::context! {
        script => Filled::from_safe_string(SCRIPT.to_owned()),
        style => Filled::from_safe_string(STYLE.to_owned()),
        pictures => Filled::from_safe_string(pictures),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::Figure;
    use crate::plot::Line;

    #[test]
    fn six_digits_are_those_of_the_formatted_number() {
        let ties = [
            0.0,
            -0.0,
            1.0,
            123_456.5,
            999_999.5,
            0.999_999_5,
            1.000_005,
            1e22,
            1e-300,
            5e-324,
        ];
        // Numbers of all magnitudes, from the golden ratio.
        let spread = (1..100_000).map(|i| {
            let share = (f64::from(i) * 0.618_033_988_749_894_9).fract();
            10.0_f64.powf(60.0 * share - 30.0) * if i % 2 == 0 { 1.0 } else { -1.0 }
        });
        let halves = (1..10_000).map(|i| (f64::from(i) + 0.5) / 1e4 + 10.0);
        for x in ties.into_iter().chain(spread).chain(halves) {
            let formatted: f64 = format!("{x:.5e}").parse().unwrap();
            assert_eq!(six_digits(x).to_bits(), formatted.to_bits(), "{x}");
        }
    }

    fn report() -> Report {
        let figure = Figure::Lines {
            title: "<!--<script></script><b>".to_owned(),
            x: "x".to_owned(),
            y: "y".to_owned(),
            lines: vec![Line::default()],
        };
        let section = Section {
            name: "limit".to_owned(),
            blocks: vec![Block::Text("a < b".to_owned())],
            pictures: vec![Picture::Figure(figure)],
            ..Section::default()
        };
        Report {
            sections: vec![section],
            ..Report::default()
        }
    }

    fn frame() -> Frame {
        Frame {
            title: "A & B".to_owned(),
            question: String::new(),
            measurements: Vec::new(),
            conditions: String::new(),
            version: "0".to_owned(),
            inputs: String::new(),
            packages: Vec::new(),
            study: String::new(),
        }
    }

    fn page(report: &Report, template: Option<&str>) -> Result<String, String> {
        page_of(report, &frame(), template)
    }

    fn page_of(report: &Report, frame: &Frame, template: Option<&str>) -> Result<String, String> {
        let Some(template) = template else {
            return report.html(frame).map_err(|fault| fault.message);
        };
        let content = serde_json::to_value(report.content(frame)).unwrap();
        let mut page = Vec::new();
        fill_template("own.html", template, content, &mut page).map_err(|fault| fault.message)?;
        Ok(String::from_utf8(page).unwrap())
    }

    /// Neither in the texts of the page nor in the data of its pictures.
    #[test]
    fn no_hidden_character_of_a_document_reaches_the_page() {
        let mut report = report();
        let hidden = "\u{202e}fdp\u{1b}[2J\u{200b}";
        report.sections[0].title = hidden.to_owned();
        *report.sections[0].pictures[0].title_mut() = hidden.to_owned();
        for template in [None, Some("{{ sections[0].title }} {{ frame.study }} {{ pictures }}")] {
            let mut frame = frame();
            frame.study = format!("title: \"{hidden}\" # µ °C\n");
            let page = page_of(&report, &frame, template).unwrap();
            assert_eq!(visible(&page), page);
            assert!(page.contains(r"\u{202e}fdp\u{1b}[2J\u{200b}"), "{template:?}");
            assert!(page.contains(r"\u202efdp\u001b[2J\u200b"), "{template:?}");
            assert!(page.contains("# µ °C"));
        }
    }

    #[test]
    fn texts_cannot_break_the_page() {
        let page = page(&report(), None).unwrap();
        assert!(page.contains("A &amp; B") && page.contains("a &lt; b"));
        let data = page.split_once("id=\"pictures\">").unwrap().1;
        let data = data.split_once("</script>").unwrap().0;
        assert!(
            !data.contains('<'),
            "a title ends the script, or hides what follows it: {data}"
        );
        assert!(data.contains(r"\u003c!--\u003cscript>"), "{data}");
    }

    #[test]
    fn a_template_of_the_user_takes_the_place_and_its_faults_are_reported() {
        let template = "{{ frame.title }}: {% for s in sections %}{{ s.name }} {{ s.pictures | length }}{% endfor %}";
        assert_eq!(page(&report(), Some(template)).unwrap(), "A &amp; B: limit 1");
        let fault = page(&report(), Some("{% for %}")).unwrap_err();
        assert!(
            fault.starts_with("the template own.html: ") && fault.contains("own.html:1") && fault.contains("syntax"),
            "{fault}"
        );
    }

    #[test]
    fn the_built_in_template_is_filled_the_same_from_serialised_content() {
        assert_eq!(page(&report(), Some(TEMPLATE)), page(&report(), None));
    }

    #[test]
    fn a_page_has_a_limit() {
        let long = "{% for a in range(99999) %}{{ script }}{% endfor %}";
        let fault = page(&report(), Some(long)).unwrap_err();
        assert!(fault.contains("the page has more than 256 MB"), "{fault}");
    }

    #[test]
    fn a_template_comes_to_an_end_and_reads_no_other_file() {
        let endless = "{% for a in range(99999) %}{% for b in range(99999) %}{% endfor %}{% endfor %}";
        let fault = page(&report(), Some(endless)).unwrap_err();
        assert!(fault.contains("more than 10 million steps"), "{fault}");
        let deep = "{% macro again() %}{{ again() }}{% endmacro %}{{ again() }}";
        assert!(page(&report(), Some(deep)).is_err());
        for other in [
            "{% include 'report' %}",
            "{% import '/etc/passwd' as x %}",
            "{% extends 'report' %}",
        ] {
            let fault = page(&report(), Some(other)).unwrap_err();
            assert!(fault.contains("template not found"), "{fault}");
        }
    }
}
