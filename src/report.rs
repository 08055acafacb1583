//! The report of a study: one HTML file that works offline, with interactive figures and their data.

use std::io::Write;

use gearloss_framework::description::AssumedEntry;
use gearloss_report::Figure;
use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, ErrorKind, Value as Filled};
use rayon::prelude::*;
use serde::Serialize;
use serde_json::Value;

/// The built-in template.
const TEMPLATE: &str = include_str!("report/template.html");

/// Maximum number of steps of a template. A large study needs some ten thousand; this limit takes seconds.
const MOST_STEPS: u64 = 10_000_000;

/// The content of a report, collected while a study runs.
#[derive(Debug, Default)]
pub struct Report {
    sections: Vec<Section>,
    gearboxes: Vec<GearboxPage>,
}

/// One analysis.
#[derive(Debug)]
struct Section {
    name: String,
    /// Description of the analysis as a sentence.
    about: String,
    /// Main conclusions.
    verdicts: Vec<String>,
    /// Tables and notes as printed.
    text: String,
    figures: Vec<Figure>,
}

/// Why the report cannot be written.
#[derive(Debug)]
pub enum PageFault {
    /// Error of the template.
    Template(String),
    /// Error of the file.
    Write(String),
}

impl From<minijinja::Error> for PageFault {
    fn from(e: minijinja::Error) -> Self {
        let words = format!("{e:#}");
        match e.kind() {
            ErrorKind::WriteFailure => Self::Write(words),
            ErrorKind::OutOfFuel => Self::Template(format!(
                "it takes more than {} million steps; does it contain nested loops?",
                MOST_STEPS / 1_000_000
            )),
            _ => Self::Template(words),
        }
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

impl Report {
    /// Begins the section of an analysis.
    pub fn begin(&mut self, name: &str, about: &str) {
        self.sections.push(Section {
            name: name.to_owned(),
            about: about.to_owned(),
            verdicts: Vec::new(),
            text: String::new(),
            figures: Vec::new(),
        });
    }

    /// Removes the last section.
    pub fn drop_last(&mut self) {
        self.sections.pop();
    }

    /// Adds a figure to the section.
    pub fn figure(&mut self, figure: Figure) {
        if let Some(section) = self.sections.last_mut() {
            section.figures.push(figure);
        }
    }

    /// Adds a main conclusion to the section.
    pub fn verdict(&mut self, sentence: &str) {
        if let Some(section) = self.sections.last_mut() {
            section.verdicts.push(sentence.to_owned());
        }
    }

    /// Adds printed text to the section.
    pub fn text(&mut self, text: &str) {
        if let Some(section) = self.sections.last_mut() {
            section.text.push_str(text);
        }
    }

    /// Adds a gearbox.
    pub fn gearbox(&mut self, page: GearboxPage) {
        self.gearboxes.push(page);
    }

    /// Writes the page with the user's template, or with the built-in one.
    ///
    /// # Errors
    /// Errors of the template or of the file.
    pub fn html(&self, frame: &Frame, template: Option<&str>, to: impl Write) -> Result<(), PageFault> {
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
        page.render_captured_to(filled, to)?;
        Ok(())
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
    use gearloss_report::plot::Line;

    use super::*;

    fn report() -> Report {
        let mut report = Report::default();
        report.begin("limit", "How far it goes.");
        report.text("a < b");
        report.figure(Figure::Lines {
            title: "<!--<script></script><b>".to_owned(),
            x: "x".to_owned(),
            y: "y".to_owned(),
            lines: vec![Line::default()],
        });
        report
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
        let mut page = Vec::new();
        let written = report.html(&frame(), template, &mut page);
        written.map_err(|fault| format!("{fault:?}"))?;
        Ok(String::from_utf8(page).unwrap())
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
    fn a_template_of_the_user_takes_the_place_and_its_faults_are_told() {
        let own = "{{ frame.title }}: {% for s in sections %}{{ s.name }} {{ s.figures | length }}{% endfor %}";
        assert_eq!(page(&report(), Some(own)).unwrap(), "A &amp; B: limit 1");
        let fault = page(&report(), Some("{% for %}")).unwrap_err();
        assert!(fault.starts_with("Template") && fault.contains("syntax"), "{fault}");
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
