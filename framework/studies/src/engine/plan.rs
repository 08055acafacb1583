//! What an analysis computes, known before it computes anything.

use std::fmt;
use std::sync::Arc;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::gearbox::Findings;

use super::{Built, Planner, Stopped};
use crate::limits::at_points::Watch;
use crate::points::{Field, Given, Points};

/// The plan of an analysis: everything that its entry asks for, read, built and found right. `check` plans; `run` plans and reduces.
pub trait Plan {
    /// What is computed, in the order in which it is done.
    fn work(&self) -> Vec<Work>;

    /// How other values of each varied quantity get into the gearbox of a sample; empty where it is not stated.
    fn samples(&self, _cx: &Planner<'_>) -> Vec<BuiltAgain> {
        Vec::new()
    }

    /// What is wrong without stopping the rest: `check` refuses it, `run` computes the rest and then fails.
    fn into_failures(self) -> Vec<Findings>
    where
        Self: Sized,
    {
        Vec::new()
    }
}

/// A part of the work of an analysis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Work {
    /// What it belongs to: usually a model set.
    pub of: String,
    /// One of what is counted, such as `point` or `cycle of samples`.
    pub what: &'static str,
    /// How many.
    pub count: usize,
    /// True if the count is a maximum, because a search may end before.
    pub at_most: bool,
}

impl Work {
    /// So many of something.
    pub fn new(of: impl Into<String>, what: &'static str, count: usize) -> Self {
        Self {
            of: of.into(),
            what,
            count,
            at_most: false,
        }
    }

    /// Of a search that may end before.
    pub fn at_most(self) -> Self {
        Self { at_most: true, ..self }
    }

    /// The points of runs.
    pub fn of_runs<'r, 'a: 'r>(runs: impl IntoIterator<Item = &'r Run<'a>>) -> Vec<Self> {
        let work = |run: &Run<'_>| Self::new(run.label(), "point", run.points.field.len());
        runs.into_iter().map(work).collect()
    }
}

impl fmt::Display for Work {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let most = if self.at_most { "at most " } else { "" };
        let (what, rest) = self.what.split_at(self.what.find(' ').unwrap_or(self.what.len()));
        let plural = match self.count {
            1 => "",
            _ if what.ends_with("ch") => "es",
            _ => "s",
        };
        write!(f, "{}: {most}{} {what}{plural}{rest}", self.of, self.count)
    }
}

/// What is built again for another value of a varied quantity.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BuiltAgain {
    /// Model set.
    pub of: String,
    /// The varied quantity.
    pub quantity: String,
    /// Paths of the models that are built again: none if the value is set in what was built before. Absent: everything is.
    pub models: Option<Vec<String>>,
}

impl fmt::Display for BuiltAgain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: another `{}` ", self.of, self.quantity)?;
        let Some(models) = &self.models else {
            return f.write_str("builds the whole gearbox again");
        };
        let names: Vec<&str> = models
            .iter()
            .map(|path| path.strip_suffix(".model").unwrap_or(path))
            .collect();
        match &names[..] {
            [] => f.write_str("is set in the built models"),
            [first, .., last] if names.len() > 4 => {
                write!(f, "builds {} models again: {first} ... {last}", names.len())
            }
            _ => write!(f, "builds again: {}", names.join(", ")),
        }
    }
}

/// Points of a gearbox with one model set. Gear, ports and limits of the study fit the gearbox: this is checked when it is made.
#[derive(Clone)]
pub struct Run<'a> {
    /// The gearbox with the set.
    pub built: Arc<Built<'a>>,
    /// The points.
    pub points: Points,
    /// What is limited at the points.
    pub(crate) watch: Option<Arc<Watch>>,
}

impl<'a> Run<'a> {
    /// Points that fit a gearbox.
    ///
    /// # Errors
    /// Points that do not fit, and wrong limits of the study.
    pub fn new(cx: &Planner<'_>, built: &Arc<Built<'a>>, points: Points) -> Result<Self, Stopped> {
        let run = Self::of_gear(cx, built, points)?;
        cx.add_machine_demand(built, &[&run.points]);
        Ok(run)
    }

    /// The same in one of several gears, of which one is chosen at each point: who chooses adds what they demand of machines.
    ///
    /// # Errors
    /// As [`Run::new`].
    pub(crate) fn of_gear(cx: &Planner<'_>, built: &Arc<Built<'a>>, points: Points) -> Result<Self, Stopped> {
        let run = Self::without_limits(cx, built, points)?;
        Ok(Self {
            watch: cx.watch(built)?.map(Arc::new),
            ..run
        })
    }

    /// The same for an analysis at whose points the limits of the study are not read.
    ///
    /// # Errors
    /// Points that do not fit.
    pub fn without_limits(cx: &Planner<'_>, built: &Arc<Built<'a>>, points: Points) -> Result<Self, Stopped> {
        cx.case(built.gearbox, &built.transmission, &points)?;
        Ok(Self {
            built: Arc::clone(built),
            watch: None,
            points,
        })
    }

    /// The same with a list of points.
    pub fn with_list(&self, list: Vec<Given>) -> Self {
        let Points {
            gear,
            torque_at,
            speed_at,
            oil,
            flow,
            terms,
            field: _,
        } = &self.points;
        Self {
            built: Arc::clone(&self.built),
            watch: self.watch.clone(),
            // Not a copy of the whole field, which may be a large grid.
            points: Points {
                gear: gear.clone(),
                torque_at: torque_at.clone(),
                speed_at: speed_at.clone(),
                field: Field::List(list),
                oil: *oil,
                flow: *flow,
                terms: *terms,
            },
        }
    }

    /// Model set and gear.
    pub fn label(&self) -> String {
        format!("{}, {}", self.built.name, self.points.gear)
    }

    /// Errors of the gearbox.
    pub(crate) fn findings(&self, list: Vec<Diagnostic>) -> Findings {
        self.built.gearbox.findings(list)
    }
}

/// A plan with data beside it, such as measured points.
impl<P: Plan, T> Plan for (P, T) {
    fn work(&self) -> Vec<Work> {
        self.0.work()
    }
}

/// Runs that do not wait for each other: the plan of an analysis that is nothing but points.
pub struct Runs<'a>(pub Vec<Run<'a>>);

impl<'a> Runs<'a> {
    /// One run for each gearbox.
    ///
    /// # Errors
    /// Those of `run`.
    pub fn of_sets(
        built: &[Arc<Built<'a>>],
        run: impl FnMut(&Arc<Built<'a>>) -> Result<Run<'a>, Stopped>,
    ) -> Result<Self, Stopped> {
        Ok(Self(built.iter().map(run).collect::<Result<_, _>>()?))
    }

    /// The gearbox of each run.
    pub fn built(&self) -> Vec<Arc<Built<'a>>> {
        self.0.iter().map(|run| Arc::clone(&run.built)).collect()
    }
}

impl Plan for Runs<'_> {
    fn work(&self) -> Vec<Work> {
        Work::of_runs(&self.0)
    }
}
