//! The report of a study: one HTML file that opens without a network, with interactive pictures and the data behind them.

use gearloss_framework::description::AssumedEntry;
use gearloss_framework::report::Figure;
use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, Value as Filled};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The template that is used unless the user gives one of his own.
const TEMPLATE: &str = include_str!("report/template.html");

/// Everything that a report shows, collected while a study runs.
#[derive(Debug, Default)]
pub struct Report {
    sections: Vec<Section>,
    gearboxes: Vec<GearboxPage>,
}

/// One analysis.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Section {
    name: String,
    /// What the analysis is, as a sentence.
    about: String,
    /// Sentences that a reader must not miss.
    verdicts: Vec<String>,
    /// Tables and notes as printed.
    text: String,
    figures: Vec<Shown>,
}

impl Section {
    /// Tables and notes as printed.
    pub fn text(&self) -> &str {
        &self.text
    }
}

/// A picture in the page.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Shown {
    title: String,
    /// Traces and layout, as JSON.
    spec: String,
}

/// A section as templates see it.
#[derive(Serialize)]
struct SectionOfPage<'a> {
    name: &'a str,
    about: &'a str,
    verdicts: &'a [String],
    text: &'a str,
    figures: Vec<FigureOfPage<'a>>,
}

/// A picture as templates see it; its data stand in `figures`.
#[derive(Serialize)]
struct FigureOfPage<'a> {
    id: String,
    title: &'a str,
}

/// A gearbox with what its results rest on.
#[derive(Debug, Serialize)]
pub struct GearboxPage {
    /// Name in the study.
    pub name: String,
    /// Title.
    pub title: String,
    /// Where the description comes from.
    pub source: String,
    /// Drawing, as SVG.
    pub drawing: String,
    /// Tables of geometry and kinematics.
    pub tables: Vec<PageTable>,
    /// An operating point in words; empty where there is none.
    pub point: String,
    /// Loads, balances and shares at that point.
    pub point_tables: Vec<PageTable>,
    /// What is assumed and why.
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

/// What stands at head and foot of the page.
#[derive(Debug, Serialize)]
pub struct Frame {
    /// Title of the study.
    pub title: String,
    /// The question that it answers.
    pub question: String,
    /// What every analysis starts from, as a sentence.
    pub conditions: String,
    /// Version of the program.
    pub version: String,
    /// Crates that brought models.
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

    /// Takes back the last section.
    pub fn drop_last(&mut self) -> Option<Section> {
        self.sections.pop()
    }

    /// Adds a section that was made elsewhere.
    pub fn add(&mut self, section: Section) {
        self.sections.push(section);
    }

    /// Adds a picture to the section.
    pub fn figure(&mut self, figure: Figure) {
        if let Some(section) = self.sections.last_mut() {
            section.figures.push(Shown {
                title: figure.title().to_owned(),
                spec: figure.plotly().to_string(),
            });
        }
    }

    /// Adds a sentence that a reader must not miss to the section.
    pub fn verdict(&mut self, sentence: &str) {
        if let Some(section) = self.sections.last_mut() {
            section.verdicts.push(sentence.to_owned());
        }
    }

    /// Adds what was printed to the section.
    pub fn text(&mut self, text: &str) {
        if let Some(section) = self.sections.last_mut() {
            section.text.push_str(text);
        }
    }

    /// Adds a gearbox.
    pub fn gearbox(&mut self, page: GearboxPage) {
        self.gearboxes.push(page);
    }

    /// The page, by the user's template where he gives one.
    ///
    /// # Errors
    /// What is wrong with the template.
    pub fn html(&self, frame: &Frame, template: Option<&str>) -> Result<String, String> {
        let mut environment = Environment::new();
        environment.set_auto_escape_callback(|_| AutoEscape::Html);
        environment
            .add_template("report", template.unwrap_or(TEMPLATE))
            .map_err(|e| format!("{e:#}"))?;
        let page = environment.get_template("report").map_err(|e| format!("{e:#}"))?;
        let mut data: Vec<String> = Vec::new();
        let mut sections = Vec::new();
        for section in &self.sections {
            let mut figures = Vec::new();
            for Shown { title, spec } in &section.figures {
                let id = format!("figure-{}", data.len());
                data.push(format!(
                    r#"{{"id":{},"title":{},"spec":{spec}}}"#,
                    Value::from(id.as_str()),
                    Value::from(title.as_str())
                ));
                figures.push(FigureOfPage { id, title });
            }
            sections.push(SectionOfPage {
                name: &section.name,
                about: &section.about,
                verdicts: &section.verdicts,
                text: &section.text,
                figures,
            });
        }
        let data = format!("[{}]", data.join(","));
        // A text in the data must not end the script that holds it.
        let data = data.replace("</", "<\\/");
        page.render(minijinja::context! {
            frame => Filled::from(Serde(frame)),
            sections => Filled::from(Serde(&sections)),
            gearboxes => Filled::from(Serde(&self.gearboxes)),
            plotly => script(),
            figures => data,
        })
        .map_err(|e| format!("{e:#}"))
    }
}

/// The plotting library as a script element. The crate also brings one for formulas, which no picture here has.
fn script() -> String {
    let both = plotly::Plot::offline_js_sources();
    let end = both.find("</script>").map_or(both.len(), |at| at + "</script>".len());
    both[..end].to_owned()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use gearloss_framework::report::plot::Line;

    use super::*;

    fn report() -> Report {
        let mut report = Report::default();
        report.begin("limit", "How far it goes.");
        report.text("a < b");
        report.figure(Figure::Lines {
            title: "</script><b>".to_owned(),
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

    #[test]
    fn texts_cannot_break_the_page() {
        let page = report().html(&frame(), None).unwrap();
        assert!(page.contains("A &amp; B") && page.contains("a &lt; b"));
        assert!(!page.contains("</script><b>"), "a title ends the script");
    }

    #[test]
    fn a_template_of_the_user_takes_the_place_and_its_faults_are_told() {
        let own = "{{ frame.title }}: {% for s in sections %}{{ s.name }} {{ s.figures | length }}{% endfor %}";
        assert_eq!(report().html(&frame(), Some(own)).unwrap(), "A &amp; B: limit 1");
        assert!(
            report()
                .html(&frame(), Some("{% for %}"))
                .unwrap_err()
                .contains("syntax")
        );
    }
}
