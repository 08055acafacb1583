//! Models that were changed at random: no panic, no value that is not a number, bounded memory and time.
//!
//! 3000 cases; `REXS_CASES=100000 REXS_SEED=5 cargo test --release -p gearloss-exchange --test all fuzz:: -- --nocapture` runs more or others.
#![allow(clippy::print_stdout)]

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

use allocation_counter::measure;
use gearloss_exchange::rexs::import;

use crate::common::{PLANETARY, THREE_STAGE, TWO_STAGE, data, language, text};
use crate::formats::json_of;

/// `SplitMix64` after Steele, Lea and Flood, 2014.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % end.max(1) as u64) as usize
    }
}

fn given(key: &str, usual: u64) -> u64 {
    std::env::var(key)
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(usual)
}

const VALUES: [&str; 16] = [
    "",
    "0",
    "-1",
    "NaN",
    "inf",
    "1e308",
    "-1e308",
    "1e-308",
    "true",
    "false",
    "12",
    "1",
    "both_directions",
    "17",
    "9999999999999999999",
    "\u{202e}x\"y\\",
];

/// A file with a few changes.
fn mutated(sound: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    let mut bytes = sound[random.below(sound.len())].clone();
    for _ in 0..=random.below(4) {
        if bytes.len() < 8 {
            break;
        }
        let at = random.below(bytes.len());
        match random.below(10) {
            0 => bytes[at] = random.below(256) as u8,
            1 => {
                let end = (at + random.below(200)).min(bytes.len());
                bytes.drain(at..end);
            }
            2 => {
                let end = (at + random.below(200)).min(bytes.len());
                let piece = bytes[at..end].to_vec();
                let to = random.below(bytes.len());
                bytes.splice(to..to, piece);
            }
            3 => bytes.truncate(at),
            // A value between `>` and `<`, or in quotes, or after a colon.
            4..=6 => replace_between(&mut bytes, at, [b'>', b'<'], VALUES[random.below(VALUES.len())]),
            7 | 8 => replace_between(&mut bytes, at, [b'"', b'"'], VALUES[random.below(VALUES.len())]),
            _ => replace_between(&mut bytes, at, [b':', b'\n'], VALUES[random.below(VALUES.len())]),
        }
    }
    bytes
}

/// Replaces what is between two signs after a place.
fn replace_between(bytes: &mut Vec<u8>, at: usize, [start, end]: [u8; 2], value: &str) {
    let Some(from) = bytes[at..]
        .iter()
        .position(|byte| *byte == start)
        .map(|place| at + place + 1)
    else {
        return;
    };
    let Some(to) = bytes[from..]
        .iter()
        .position(|byte| *byte == end)
        .map(|place| from + place)
    else {
        return;
    };
    if to - from < 100 {
        bytes.splice(from..to, value.bytes());
    }
}

#[test]
fn changed_models_never_panic() {
    let mut sound: Vec<Vec<u8>> = [TWO_STAGE, PLANETARY, THREE_STAGE]
        .iter()
        .map(|name| data(name))
        .collect();
    sound.extend(
        [TWO_STAGE, PLANETARY]
            .iter()
            .map(|name| json_of(&text(name)).into_bytes()),
    );
    sound.push(data("FVA_Planetary_stage_-_Minus_gearing_1.1.rexsz"));
    let (cases, seed) = (given("REXS_CASES", 3000), given("REXS_SEED", 1));
    let start = Instant::now();
    let (mut accepted, mut most, mut slowest) = (0, 0, 0.0_f64);
    for case in 0..cases {
        let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ case);
        random.below(1);
        let bytes = mutated(&sound, &mut random);
        let one = Instant::now();
        let mut outcome = None;
        let used = measure(|| {
            outcome = catch_unwind(AssertUnwindSafe(|| match import(&bytes, "case.rexs", language()) {
                Ok(imported) => Some(imported),
                Err(found) => {
                    assert!(!found.list.is_empty() && !found.render().is_empty());
                    None
                }
            }))
            .ok();
        });
        most = most.max(used.bytes_max);
        slowest = slowest.max(one.elapsed().as_secs_f64());
        let outcome = outcome.unwrap_or_else(|| panic!("case {case} of seed {seed} panics"));
        if let Some(imported) = outcome {
            accepted += 1;
            for text in [
                Some(&imported.gearbox),
                imported.study.as_ref(),
                imported.load_cases.as_ref(),
            ]
            .into_iter()
            .flatten()
            {
                let values = text
                    .lines()
                    .filter(|line| !line.trim_start().starts_with('#'))
                    .map(|line| line.split(" # ").next().unwrap());
                for line in values {
                    let wrong = [": NaN", ": inf", ": -inf", "[NaN", ",NaN", ",inf"]
                        .iter()
                        .any(|text| line.contains(text));
                    assert!(!wrong, "case {case} of seed {seed}: {line}");
                }
            }
        }
    }
    println!(
        "{cases} cases of seed {seed}: {accepted} accepted, at most {} MB and {slowest:.2} s each, {:.0} s",
        most >> 20,
        start.elapsed().as_secs_f64()
    );
    assert!(most < 100 << 20, "{most} bytes");
    assert!(accepted > cases / 10, "{accepted} of {cases}");
}
