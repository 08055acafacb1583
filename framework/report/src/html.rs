//! The report of a study: one HTML page that works offline, with interactive figures and their data.

mod gearbox;
mod point;

use crate::codes;
use gearloss_framework::description::AssumedEntry;
use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::PowerFlow;
use gearloss_framework::language::Language;
use gearloss_studies::study::Study;
use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, ErrorKind, Value as Filled};
use rayon::prelude::*;
use serde::Serialize;
use serde_json::Value;

pub use gearbox::gearbox_page;

use crate::Figure;
use crate::page::{Page, Text};

/// The built-in template.
const TEMPLATE: &str = include_str!("html/template.html");

/// Maximum number of steps of a template. A large study needs some ten thousand; this limit takes seconds.
const MOST_STEPS: u64 = 10_000_000;

/// The content of a report, collected while a study runs.
#[derive(Debug, Default)]
pub struct Report {
    /// Analyses in their order.
    pub sections: Vec<Section>,
    /// Gearboxes in their order.
    pub gearboxes: Vec<GearboxPage>,
}

/// One analysis.
#[derive(Debug, Default)]
pub struct Section {
    /// Name of the analysis.
    pub name: String,
    /// Description of the analysis as a sentence.
    pub about: String,
    /// Main conclusions.
    pub verdicts: Vec<String>,
    /// Tables and notes as printed.
    pub text: String,
    /// Pictures.
    pub figures: Vec<Figure>,
}

impl Section {
    /// Adds text and verdicts of an outcome; its pictures are taken from the page one by one.
    pub fn add_text(&mut self, page: &Page) {
        for text in &page.text {
            let (Text::Everywhere(text) | Text::InReport(text)) = text;
            self.text.push_str(text);
        }
        self.verdicts.extend(page.verdicts.iter().cloned());
    }
}

/// A section for templates.
#[derive(Serialize)]
struct SectionOfPage<'a> {
    name: &'a str,
    about: &'a str,
    verdicts: &'a [String],
    text: &'a str,
    figures: Vec<FigureOfPage<'a>>,
}

/// A figure for templates; its data are in `figures`.
#[derive(Serialize)]
struct FigureOfPage<'a> {
    id: String,
    title: &'a str,
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
    /// Tables of geometry and kinematics.
    pub tables: Vec<PageTable>,
    /// An operating point as text; empty if there is none.
    pub point: String,
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
    /// The conditions of all analyses as a sentence.
    pub conditions: String,
    /// Version of the program.
    pub version: String,
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
            conditions: conditions(study),
            version: version.to_owned(),
            packages: packages.iter().map(ToString::to_string).collect(),
            study: study.text.clone(),
        }
    }
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

/// The finding about an error of a template.
fn template_fault(fault: minijinja::Error) -> Diagnostic {
    let words = match fault.kind() {
        ErrorKind::OutOfFuel => format!(
            "it takes more than {} million steps; does it contain nested loops?",
            MOST_STEPS / 1_000_000
        ),
        _ => format!("{fault:#}"),
    };
    Diagnostic::error("", format!("the template of the report: {words}"))
        .help("correct it, or omit --template")
        .code(codes::TEMPLATE)
}

impl Report {
    /// The page, by the user's template if there is one.
    ///
    /// # Errors
    /// Error of the template.
    pub fn html(&self, frame: &Frame, template: Option<&str>) -> Result<String, Diagnostic> {
        self.filled(frame, template).map_err(template_fault)
    }

    fn filled(&self, frame: &Frame, template: Option<&str>) -> Result<String, minijinja::Error> {
        let mut environment = Environment::new();
        environment.set_auto_escape_callback(|_| AutoEscape::Html);
        environment.set_fuel(Some(MOST_STEPS));
        // The environment has no named templates, so a template cannot include any, not even itself.
        let page = environment.template_from_named_str("report", template.unwrap_or(TEMPLATE))?;
        let all: Vec<&Figure> = self.sections.iter().flat_map(|section| &section.figures).collect();
        let id = |number: usize| format!("figure-{number}");
        let datum = |(number, shown): (usize, &&Figure)| {
            let [id, title] = [id(number), shown.title().to_owned()].map(Value::from);
            let json = format!(r#"{{"id":{id},"title":{title},"spec":{}}}"#, shown.plotly());
            // A text in the data must neither end the enclosing script nor start a comment or script in it.
            json.replace('<', "\\u003c")
        };
        let data = || all.par_iter().enumerate().map(datum).collect::<Vec<String>>();
        let (data, script) = rayon::join(data, script);
        let mut sections = Vec::new();
        let mut numbers = 0..;
        for section in &self.sections {
            let figures = section.figures.iter().zip(numbers.by_ref());
            let figures = figures.map(|(shown, number)| FigureOfPage {
                id: id(number),
                title: shown.title(),
            });
            sections.push(SectionOfPage {
                name: &section.name,
                about: &section.about,
                verdicts: &section.verdicts,
                text: &section.text,
                figures: figures.collect(),
            });
        }
        let filled = minijinja::context! {
            frame => Filled::from(Serde(frame)),
            sections => Filled::from(Serde(&sections)),
            gearboxes => Filled::from(Serde(&self.gearboxes)),
            plotly => Filled::from_safe_string(script),
            figures => Filled::from_safe_string(format!("[{}]", data.join(","))),
        };
        page.render(filled)
    }
}

/// The plotting library as a script element. The crate also contains a library for formulas, which is not needed.
fn script() -> String {
    let mut both = plotly::Plot::offline_js_sources();
    let end = both.find("</script>").map_or(both.len(), |at| at + "</script>".len());
    both.truncate(end);
    both
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::plot::Line;

    fn report() -> Report {
        let figure = Figure::Lines {
            title: "<!--<script></script><b>".to_owned(),
            x: "x".to_owned(),
            y: "y".to_owned(),
            lines: vec![Line::default()],
        };
        let section = Section {
            name: "limit".to_owned(),
            text: "a < b".to_owned(),
            figures: vec![figure],
            ..Section::default()
        };
        Report {
            sections: vec![section],
            gearboxes: Vec::new(),
        }
    }

    fn frame() -> Frame {
        Frame {
            title: "A & B".to_owned(),
            question: String::new(),
            conditions: String::new(),
            version: "0".to_owned(),
            packages: Vec::new(),
            study: String::new(),
        }
    }

    fn page(report: &Report, template: Option<&str>) -> Result<String, String> {
        report.html(&frame(), template).map_err(|fault| fault.message)
    }

    #[test]
    fn texts_cannot_break_the_page() {
        let page = page(&report(), None).unwrap();
        assert!(page.contains("A &amp; B") && page.contains("a &lt; b"));
        let data = page.split_once("const figures = ").unwrap().1;
        let data = data.split_once(";\n").unwrap().0;
        assert!(
            !data.contains('<'),
            "a title ends the script, or hides what follows it: {data}"
        );
        assert!(data.contains(r"\u003c!--\u003cscript>"), "{data}");
    }

    #[test]
    fn a_template_of_the_user_takes_the_place_and_its_faults_are_reported() {
        let own = "{{ frame.title }}: {% for s in sections %}{{ s.name }} {{ s.figures | length }}{% endfor %}";
        assert_eq!(page(&report(), Some(own)).unwrap(), "A &amp; B: limit 1");
        let fault = page(&report(), Some("{% for %}")).unwrap_err();
        assert!(
            fault.starts_with("the template of the report") && fault.contains("syntax"),
            "{fault}"
        );
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
