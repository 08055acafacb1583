//! The losses of the two-speed example in first gear over a square map by the library in one thread, as often as asked:
//! `gearloss-peers GEARBOX SIZE REPEATS`, where the gearbox file has the set `joint`. Prints the seconds of each map, then passes and
//! calls of loss models per point and the sum of all losses.

use std::error::Error;
use std::io::Write as _;
use std::path::Path;
use std::time::Instant;

use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_plugins as _;

/// The largest torque and speed of the map, in Nm and rpm; the points divide them evenly.
const MOST: (f64, f64) = (20.0, 22000.0);

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, file, size, repeats] = &arguments[..] else {
        return Err("usage: gearloss-peers GEARBOX SIZE REPEATS".into());
    };
    let (size, repeats): (u32, u32) = (size.parse()?, repeats.parse()?);
    let language = Language::linked()?;
    let gearbox = Gearbox::read(&language, Path::new(file)).map_err(|found| format!("{found:#?}"))?;
    let choice = Choice {
        set: Some("joint".to_owned()),
        ..Choice::default()
    };
    let transmission = gearbox
        .transmission(&language, &choice)
        .map_err(|found| format!("{found:#?}"))?;
    let case = transmission
        .case("first", &[], &["input"])
        .map_err(|found| format!("{found:#?}"))?;
    let mut scratch = transmission.scratch(&case);
    let mut losses = vec![0.0; (size * size) as usize];
    let (mut passes, mut calls) = (0, 0);
    let mut out = std::io::stdout().lock();
    for _ in 0..repeats {
        let begun = Instant::now();
        (passes, calls) = (0, 0);
        for (place, loss) in (0..size * size).zip(&mut losses) {
            let (row, column) = (place / size + 1, place % size + 1);
            let point = Point {
                speeds: &[MOST.1 * f64::from(column) / f64::from(size) * std::f64::consts::PI / 30.0],
                torques: &[MOST.0 * f64::from(row) / f64::from(size)],
                flow: PowerFlow::Real,
                ..Point::default()
            };
            let solution = transmission.evaluate(&case, &point, &[100.0], &mut scratch);
            *loss = solution.loss().ok_or("a point has no loss")?;
            passes += solution.passes();
            calls += scratch.calls();
        }
        writeln!(out, "seconds {}", begun.elapsed().as_secs_f64())?;
    }
    let points = f64::from(size * size);
    writeln!(out, "passes {}", passes as f64 / points)?;
    writeln!(out, "calls {}", calls as f64 / points)?;
    writeln!(out, "sum {}", losses.iter().sum::<f64>())?;
    Ok(())
}
