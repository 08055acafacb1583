//! The losses of the two-speed example in first gear over a square map by the library in one thread, as often as asked:
//! `gearloss-peers GEARBOX SIZE REPEATS`, where the gearbox file has the set `joint`. Prints the seconds of each map, then passes and
//! calls of loss models per point and the sum of all losses.

use std::error::Error;
use std::io::Write as _;
use std::path::Path;
use std::time::Instant;

use gearloss_framework::evaluate::{Point, PowerFlow};
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::lanes::LANES;
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
    let share = |i: u32| f64::from(i) / f64::from(size);
    let torques: Vec<f64> = (1..=size).map(|i| MOST.0 * share(i)).collect();
    let mut losses = vec![0.0; (size * size) as usize];
    let (mut passes, mut calls) = (0, 0);
    let mut out = std::io::stdout().lock();
    for _ in 0..repeats {
        let begun = Instant::now();
        passes = 0;
        let mut scratch = transmission.row_scratch(&case);
        for (speed, losses) in (1..=size).zip(losses.chunks_mut(size as usize)) {
            let point = Point {
                speeds: &[MOST.1 * share(speed) * std::f64::consts::PI / 30.0],
                torques: &[0.0],
                flow: PowerFlow::Real,
                ..Point::default()
            };
            let mut row = transmission.row(&case, &point, &[100.0], &mut scratch);
            for (torques, losses) in torques.chunks(LANES).zip(losses.chunks_mut(LANES)) {
                let block = row.follow(torques);
                let alone = (0..torques.len()).any(|lane| block.alone(lane));
                if alone {
                    return Err("a point has to be evaluated alone".into());
                }
                losses.copy_from_slice(&block.losses()[..torques.len()]);
                passes += (0..torques.len()).map(|lane| block.passes(lane)).sum::<usize>();
            }
        }
        calls = scratch.calls();
        writeln!(out, "seconds {}", begun.elapsed().as_secs_f64())?;
    }
    let points = f64::from(size * size);
    writeln!(out, "passes {}", passes as f64 / points)?;
    writeln!(out, "calls {}", calls as f64 / points)?;
    writeln!(out, "sum {}", losses.iter().sum::<f64>())?;
    Ok(())
}
