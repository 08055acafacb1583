//! `shards`: the tasks of a study, and a sensible number of shards.

use std::time::{Duration, Instant};

use gearloss_studies::distributed::{Collected, Results, Stage, compute};
use gearloss_studies::engine::progress::{Progress, Silent, Steps};
use gearloss_studies::run::StudyRun;

use crate::args::ShardsArgs;
use crate::interrupt;
use crate::output::{End, Failure, Out, Table};

/// Computing time of a shard on one core that is worth its own process.
const WORTHWHILE: Duration = Duration::from_mins(1);

/// No output; stops on Ctrl-C.
struct Interruptible;

impl Progress for Interruptible {
    fn begin(&self, _: &str, _: usize) -> Box<dyn Steps + '_> {
        Box::new(Silent)
    }

    fn should_continue(&self) -> bool {
        !interrupt::pressed()
    }
}

/// What can be said of an analysis before it is run.
enum Work {
    /// Number of tasks of its first stages, and the time of one of them.
    Tasks(usize, Duration),
    /// It is not split.
    Undivided,
    /// It needs a model set that another analysis finds.
    After(String),
}

pub fn run(args: &ShardsArgs, out: &mut Out) -> Result<End, Failure> {
    let language = super::language()?;
    let study = super::run::read(language, &args.study)?;
    interrupt::listen();
    let run = StudyRun::new(language, &study);
    let mut table = Table::new(&["analysis", "tasks", "time of one", "time of all on one core"]);
    let (mut total, mut most) = (Duration::ZERO, 1);
    for (name, analysis) in study.entry.analyses.iter() {
        let work = match study.pending(analysis) {
            Some((_, by)) => Work::After(by),
            None => measured(&run, name)?,
        };
        table.row(match work {
            Work::Tasks(count, one) => {
                let all = one * count as u32;
                total += all;
                most = most.max(count);
                vec![name.to_owned(), count.to_string(), seconds(one), seconds(all)]
            }
            Work::Undivided => vec![name.to_owned(), "not split: `merge` computes it".to_owned()],
            Work::After(by) => vec![name.to_owned(), format!("after `{by}`")],
        });
    }
    out.text(&table.render())?;
    let needed = total.as_secs_f64() / WORTHWHILE.as_secs_f64();
    let sensible = (needed.ceil() as usize).clamp(1, most);
    out.line(match sensible {
        1 => format!("\n{} on one core: one `gearloss run` suffices", seconds(total)),
        _ => format!(
            "\n{} on one core; sensible: N = {sensible}, `gearloss run {} --shard K/{sensible}` for K = 1 to {sensible}; shards above {most} have nothing to do",
            seconds(total),
            args.study.display()
        ),
    })?;
    out.line("Later stages, which depend on results, are not counted.")?;
    Ok(End::Fine)
}

/// Lists the tasks of an analysis and computes one of them.
fn measured(run: &StudyRun<'_>, name: &str) -> Result<Work, Failure> {
    let stages = Collected::default().missing(run, name, &Interruptible)?;
    let count = stages.iter().map(|stage| stage.tasks.len()).sum();
    // One from the middle: the first may be a special case, such as the nominal value of samples.
    let Some(stage) = stages.into_iter().max_by_key(|stage| stage.tasks.len()) else {
        return Ok(Work::Undivided);
    };
    let middle = stage.tasks[stage.tasks.len() / 2];
    let nothing = Stage {
        tasks: Vec::new(),
        ..stage
    };
    let one = Stage {
        tasks: vec![middle],
        ..nothing.clone()
    };
    // Without a task it takes the time of what every shard does before.
    let time = |stage: &Stage| -> Result<Duration, Failure> {
        let start = Instant::now();
        compute(run, name, stage, Results::new(), &Interruptible)?;
        Ok(start.elapsed())
    };
    let before = time(&nothing)?;
    Ok(Work::Tasks(count, time(&one)?.saturating_sub(before)))
}

/// A duration in words.
fn seconds(time: Duration) -> String {
    match time.as_secs_f64() {
        s if s < 0.001 => "< 1 ms".to_owned(),
        s if s < 1.0 => format!("{:.0} ms", s * 1e3),
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.0} h", s / 3600.0),
    }
}
