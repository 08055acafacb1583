//! The losses of the two-speed example in first gear over a square map by the library in one thread: `gearloss-peers GEARBOX SIZE`, where
//! the gearbox file has the set `joint`. One map for each line that it reads; for each it prints a line with the seconds by the clock, passes
//! and calls of loss models per point and the sum of all losses.

use std::error::Error;
use std::io::Write as _;
use std::path::Path;
use std::time::Instant;

use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::real::LANES;
use gearloss_framework::language::Language;
use gearloss_framework::resolve::Choice;
use gearloss_plugins as _;

/// The largest torque and speed of the map, in Nm and rpm; the points divide them evenly.
const MOST: (f64, f64) = (20.0, 22000.0);

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, file, size] = &arguments[..] else {
        return Err("usage: gearloss-peers GEARBOX SIZE, with a line for each map".into());
    };
    let size: u32 = size.parse()?;
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
    let share = |i: u32| f64::from(i) / f64::from(size);
    let torques: Vec<f64> = (1..=size).map(|i| MOST.0 * share(i)).collect();
    let mut losses = vec![0.0; (size * size) as usize];
    let points = f64::from(size * size);
    let mut out = std::io::stdout().lock();
    for line in std::io::stdin().lines() {
        line?;
        let begun = Instant::now();
        let mut passes = 0;
        let mut scratch = transmission.batch_scratch(&case);
        for (speed, losses) in (1..=size).zip(losses.chunks_mut(size as usize)) {
            let point = Point {
                speeds: &[MOST.1 * share(speed) * std::f64::consts::PI / 30.0],
                torques: &[0.0],
                flow: PowerFlow::Real,
                ..Point::default()
            };
            let mut row = transmission.batch(&case, &point, &[100.0], &mut scratch);
            for (torques, losses) in torques.chunks(LANES).zip(losses.chunks_mut(LANES)) {
                let block = row.solve(torques);
                if (0..torques.len()).any(|point| block.is_alone(point)) {
                    return Err("a point has to be evaluated alone".into());
                }
                losses.copy_from_slice(&block.losses()[..torques.len()]);
                passes += (0..torques.len()).map(|point| block.passes(point)).sum::<usize>();
            }
        }
        let (passes, calls) = (passes as f64 / points, scratch.calls() as f64 / points);
        drop(scratch);
        let seconds = begun.elapsed().as_secs_f64();
        let sum: f64 = losses.iter().sum();
        writeln!(out, "seconds {seconds} passes {passes} calls {calls} sum {sum}")?;
        out.flush()?;
    }
    Ok(())
}
