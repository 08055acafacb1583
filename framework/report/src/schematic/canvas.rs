//! SVG text: shapes, and labels at free positions.

mod words;

use std::fmt::Write as _;

use gearloss_framework::document::visible;
use words::Word;

/// Height of the letters. \[px\]
pub(super) const LETTERS: f64 = 14.0;
/// Mean width of a letter over its height.
const LETTER_WIDTH: f64 = 0.58;
/// Cost of a label per px2 of a thing that it covers; a position further from its owner costs five.
const COVERED: f64 = 4.0;
/// Margin of the drawing. \[px\]
const MARGIN: f64 = 14.0;

/// A rectangle; y points downwards. \[px\]
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rect {
    pub x: [f64; 2],
    pub y: [f64; 2],
}

impl Rect {
    /// From two corners in any order.
    pub(super) fn new(x: [f64; 2], y: [f64; 2]) -> Self {
        let sorted = |v: [f64; 2]| [v[0].min(v[1]), v[0].max(v[1])];
        Self {
            x: sorted(x),
            y: sorted(y),
        }
    }
    /// About a middle.
    pub(super) fn about(x: f64, y: f64, width: f64, height: f64) -> Self {
        Self::new([x - 0.5 * width, x + 0.5 * width], [y - 0.5 * height, y + 0.5 * height])
    }
    pub(super) fn width(&self) -> f64 {
        self.x[1] - self.x[0]
    }
    pub(super) fn height(&self) -> f64 {
        self.y[1] - self.y[0]
    }
    pub(super) fn middle(&self) -> [f64; 2] {
        [0.5 * (self.x[0] + self.x[1]), 0.5 * (self.y[0] + self.y[1])]
    }
    /// The rectangle moved downwards.
    pub(super) fn down(&self, by: f64) -> Self {
        Self {
            x: self.x,
            y: self.y.map(|y| y + by),
        }
    }
    /// Area that both cover.
    pub(super) fn overlap(&self, other: &Self) -> f64 {
        let along = |a: [f64; 2], b: [f64; 2]| (a[1].min(b[1]) - a[0].max(b[0])).max(0.0);
        along(self.x, other.x) * along(self.y, other.y)
    }
    fn join(&self, other: &Self) -> Self {
        let both = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        Self {
            x: both(self.x, other.x),
            y: both(self.y, other.y),
        }
    }
}

/// Style of labels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Voice {
    /// Ids of components.
    Plain,
    /// Names of ports.
    Loud,
    /// Names of shafts.
    Quiet,
}

/// An unfinished drawing.
#[derive(Default)]
pub(super) struct Canvas {
    body: String,
    extent: Option<Rect>,
    /// Things with the cost for a label of a shaft that covers them.
    obstacles: Vec<(Rect, f64)>,
    words: Vec<Word>,
}

/// A text with the special characters of XML and hidden characters escaped.
pub(super) fn escaped(text: &str) -> String {
    let mut safe = String::new();
    for c in visible(text).chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            c => safe.push(c),
        }
    }
    safe
}

impl Canvas {
    /// Begins the group of a component with a tooltip.
    pub(super) fn open(&mut self, path: &str, tip: &str) {
        let (path, tip) = (escaped(path), escaped(tip));
        let _ = writeln!(self.body, "<g data-part=\"{path}\"><title>{tip}</title>");
    }

    /// Ends a group.
    pub(super) fn close(&mut self) {
        self.body.push_str("</g>\n");
    }

    /// A rectangle.
    pub(super) fn rect(&mut self, r: &Rect, style: &str) {
        self.reach(r);
        let (w, h) = (r.width(), r.height());
        let _ = writeln!(
            self.body,
            "<rect x=\"{:.2}\" y=\"{:.2}\" width=\"{w:.2}\" height=\"{h:.2}\" {style}/>",
            r.x[0], r.y[0]
        );
    }

    /// A circle.
    pub(super) fn circle(&mut self, middle: [f64; 2], radius: f64, style: &str) {
        let [x, y] = middle;
        self.reach(&Rect::about(x, y, 2.0 * radius, 2.0 * radius));
        let _ = writeln!(
            self.body,
            "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius:.2}\" {style}/>"
        );
    }

    /// A line through points.
    pub(super) fn line(&mut self, points: &[[f64; 2]], style: &str) {
        self.points("polyline", points, style);
    }

    /// A closed shape.
    pub(super) fn shape(&mut self, points: &[[f64; 2]], style: &str) {
        self.points("polygon", points, style);
    }

    fn points(&mut self, tag: &str, points: &[[f64; 2]], style: &str) {
        let mut list = String::new();
        for [x, y] in points {
            self.reach(&Rect::about(*x, *y, 0.0, 0.0));
            let _ = write!(list, "{x:.2},{y:.2} ");
        }
        let _ = writeln!(self.body, "<{tag} points=\"{}\" {style}/>", list.trim_end());
    }

    /// True if something was drawn in a style.
    pub(super) fn holds(&self, style: &str) -> bool {
        self.body.contains(style)
    }

    /// Labels avoid this rectangle.
    pub(super) fn avoid(&mut self, r: Rect) {
        self.obstacles.push((r, COVERED));
    }

    /// Labels of components avoid this rectangle; labels of shafts may cover it if the alternative is far away.
    pub(super) fn shade(&mut self, r: Rect) {
        self.obstacles.push((r, 0.3));
    }

    /// Adds a label near its owner, or within a gear; it is placed when everything is drawn.
    pub(super) fn word(&mut self, text: impl Into<String>, owner: Rect, within: Option<Rect>, voice: Voice) {
        self.words.push(Word {
            text: text.into(),
            owner,
            within,
            voice,
        });
    }

    fn reach(&mut self, r: &Rect) {
        self.extent = Some(self.extent.map_or(*r, |e| e.join(r)));
    }

    /// Extent of the drawing so far. \[px\]
    pub(super) fn extent(&self) -> Rect {
        self.extent.unwrap_or(Rect::new([0.0, 100.0], [0.0, 100.0]))
    }

    /// A text below the drawing, given by its left end.
    pub(super) fn foot(&mut self, x: f64, y: f64, text: &str) {
        self.reach(&Rect::new([x, x + width_of(text)], [y - LETTERS, y + 0.3 * LETTERS]));
        let _ = writeln!(
            self.body,
            "<text x=\"{x:.2}\" y=\"{y:.2}\" fill=\"#333\">{}</text>",
            escaped(text)
        );
    }

    /// The complete SVG.
    pub(super) fn finish(self, title: &str) -> String {
        let e = self.extent();
        let (x, y) = (e.x[0] - MARGIN, e.y[0] - MARGIN);
        let (w, h) = (e.width() + 2.0 * MARGIN, e.height() + 2.0 * MARGIN);
        let title = escaped(title);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"{x:.2} {y:.2} {w:.2} {h:.2}\" \
             font-family=\"sans-serif\" font-size=\"{LETTERS}\">\n<title>{title}</title>\n\
             <rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{w:.2}\" height=\"{h:.2}\" class=\"ground\" fill=\"#fff\"/>\n{}</svg>\n",
            self.body
        )
    }
}

/// Width of a text. \[px\]
pub(super) fn width_of(text: &str) -> f64 {
    LETTER_WIDTH * LETTERS * text.chars().count() as f64 + 4.0
}
