//! The page of times: it names the existing benches, and is written from a run of them. No bench runs here: with
//! `BENCHED=2026-01-31`, the date of the run, the times of the last `cargo bench` are written into the page.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use crate::common::file;
use serde_json::Value;

const PAGE: &str = "docs/performance.md";
const BEGIN: &str = "<!-- figures: BENCHED=DATE cargo test --test all performance:: -->\n";
const END: &str = "<!-- end of figures -->\n";

/// The benches of each file, in their order in the file: their group has the name of the file.
fn benches() -> Vec<(String, Vec<String>)> {
    let mut files: Vec<_> = std::fs::read_dir(file("benches"))
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "rs") && !p.ends_with("main.rs"))
        .collect();
    files.sort();
    let names = |path: &Path| {
        let text = std::fs::read_to_string(path).unwrap();
        let group = path.file_stem().unwrap().to_str().unwrap().to_owned();
        assert!(
            text.contains(&format!("benchmark_group(\"{group}\")")),
            "{group}: the group has the name of the file"
        );
        let named = text.split("bench_function(").skip(1).map(|rest| {
            let name = rest.trim_start().strip_prefix('"').and_then(|r| r.split_once('"'));
            name.unwrap_or_else(|| panic!("{group}: a bench without its name in quotes where it is created"))
                .0
                .to_owned()
        });
        let named: Vec<String> = named.collect();
        assert!(!named.is_empty(), "{group}: no bench");
        (group, named)
    };
    files.iter().map(|path| names(path)).collect()
}

/// A time of nanoseconds with three digits, in a suitable unit.
fn time(ns: f64) -> String {
    let (value, unit) = match ns {
        ns if ns < 1e3 => (ns, "ns"),
        ns if ns < 1e6 => (ns / 1e3, "us"),
        ns if ns < 1e9 => (ns / 1e6, "ms"),
        ns => (ns / 1e9, "s"),
    };
    let digits = 2 - (value.log10().floor() as i32).clamp(0, 2);
    format!("{value:.*} {unit}", digits as usize)
}

/// Criterion's estimates of the last run of every bench, by group and name, and the number of elements of one run.
fn measured(folder: &Path, found: &mut BTreeMap<String, (Value, Option<u64>)>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.map(|e| e.unwrap().path()).filter(|p| p.is_dir()) {
        measured(&entry, found);
    }
    let read = |name: &str| {
        let text = std::fs::read_to_string(folder.join(name)).ok()?;
        Some(serde_json::from_str::<Value>(&text).unwrap())
    };
    if folder.ends_with("new")
        && let (Some(bench), Some(estimates)) = (read("benchmark.json"), read("estimates.json"))
    {
        let elements = bench["throughput"]["Elements"].as_u64();
        found.insert(bench["full_id"].as_str().unwrap().to_owned(), (estimates, elements));
    }
}

/// A line of a system file, or `unknown`.
fn line_or_unknown(line: Option<&str>) -> String {
    line.map_or_else(|| "unknown".to_owned(), |line| line.trim().to_owned())
}

/// Points of the path of each mesh: seven on each of its four smooth sections.
const NODES: f64 = 28.0;
/// Exponentials and logarithms of a point of the two-speed example in first gear under the set `joint`, counted from the formulas: 3 meshes,
/// each evaluated once, with two exponentials at each point of the path and one logarithm; 10 evaluations of the
/// six bearings, of which four are in loops and evaluated twice, with 2 exponentials and, under radial or both loads, 1 or 2 logarithms.
const LAWS: [f64; 2] = [20.0 + 6.0 * NODES, 18.0];
/// Minimum number of exponentials, logarithms and powers of the standard library for speed and oil, computed once: 6 bearings with 5
/// and 3, 3 meshes with 1 and 2, two immersed wheels with four powers each. In a batch all torques share them.
const ONCE: [f64; 3] = [33.0, 24.0, 8.0];

/// Time of a point compared with that of its transcendental functions.
fn lower_bound(found: &BTreeMap<String, (Value, Option<u64>)>) -> String {
    let of = |name: &str| {
        let (estimates, elements) = &found[name];
        estimates["median"]["point_estimate"].as_f64().unwrap() / elements.unwrap_or(1) as f64
    };
    let costs = |way: &str| {
        [
            of(&format!("elementary/exponentials {way}")),
            of(&format!("elementary/logarithms {way}")),
            of("elementary/powers of the standard library"),
        ]
    };
    let together = [LAWS[0], LAWS[1], 0.0];
    let alone = [together[0] + ONCE[0], together[1] + ONCE[1], ONCE[2]];
    let mut out = String::from(
        "\nLower bound by these times, for a point of the two-speed example with the model set `joint`:\n\n\
         | | exponentials | logarithms | powers | their time | measured | ratio |\n|---|---|---|---|---|---|---|\n",
    );
    for (name, counts, costs, bench) in [
        (
            "batched",
            together,
            costs("in lanes"),
            "point/two-speed example, set joint, batched",
        ),
        (
            "single",
            alone,
            // Those of the framework, which a single point uses for exponentials and logarithms, are timed in lanes only.
            costs("of the standard library"),
            "point/two-speed example, set joint",
        ),
    ] {
        let least: f64 = counts.iter().zip(costs).map(|(n, cost)| n * cost).sum();
        let measured = of(bench);
        let _ = writeln!(
            out,
            "| {name} | {:.0} | {:.0} | {:.0} | {} | {} | {:.1} |",
            counts[0],
            counts[1],
            counts[2],
            time(least),
            time(measured),
            measured / least
        );
    }
    out
}

/// Machine, versions and table.
fn figures(date: &str) -> String {
    let mut found = BTreeMap::new();
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    measured(&target.join("criterion"), &mut found);
    let read = |path: &str| std::fs::read_to_string(path).unwrap_or_default();
    let (cpu, load) = (read("/proc/cpuinfo"), read("/proc/loadavg"));
    let model = cpu.lines().find_map(|l| l.strip_prefix("model name")?.split_once(':'));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let rustc = Command::new("rustc").arg("--version").output();
    let rustc = rustc.map(|o| String::from_utf8_lossy(&o.stdout).into_owned()).ok();
    let load: Vec<&str> = load.split(' ').take(3).collect();
    let mut out = format!(
        "Figures of {date}: gearloss {}, {}, bench profile. Processor {}, {cores} cores; load average {}\nover the last 1, 5 and 15 \
         minutes, read after the benches; load above the number of threads of a bench was other work.\n\n\
         | bench | median | 95 % interval | per element |\n|---|---|---|---|\n",
        env!("CARGO_PKG_VERSION"),
        line_or_unknown(rustc.as_deref()),
        line_or_unknown(model.map(|m| m.1)),
        line_or_unknown(Some(load.join(", ").as_str()).filter(|l| !l.is_empty())),
    );
    for (group, names) in benches() {
        for name in names {
            let (estimates, elements) = found
                .get(&format!("{group}/{name}"))
                .unwrap_or_else(|| panic!("`{name}` was not run: cargo bench -- {group}/"));
            let median = &estimates["median"];
            let [value, low, high] = [
                &median["point_estimate"],
                &median["confidence_interval"]["lower_bound"],
                &median["confidence_interval"]["upper_bound"],
            ]
            .map(|v| v.as_f64().unwrap());
            let one = elements.map_or(String::new(), |n| format!("{} of {n}", time(value / n as f64)));
            let _ = writeln!(
                out,
                "| `{group}`: {name} | {} | {} to {} | {one} |",
                time(value),
                time(low),
                time(high)
            );
        }
    }
    out + &lower_bound(&found)
}

#[test]
fn the_page_names_the_benches_that_exist() {
    let page = std::fs::read_to_string(file(PAGE)).unwrap();
    let (head, rest) = page.split_once(BEGIN).unwrap();
    let (old, tail) = rest.split_once(END).unwrap();
    let shown = match std::env::var("BENCHED") {
        Ok(date) => {
            let new = figures(&date);
            std::fs::write(file(PAGE), format!("{head}{BEGIN}{new}{END}{tail}")).unwrap();
            new
        }
        Err(_) => old.to_owned(),
    };
    let rows = shown
        .lines()
        .filter_map(|line| line.strip_prefix("| `")?.split(" | ").next());
    let exist: Vec<String> = benches()
        .iter()
        .flat_map(|(group, names)| names.iter().map(move |name| format!("{group}`: {name}")))
        .collect();
    let rows: Vec<&str> = rows.collect();
    assert_eq!(
        rows, exist,
        "{PAGE} is stale: run the benches, then `BENCHED=DATE cargo test --test all performance::`"
    );
    // Only those of the modules that the program of benches names are run.
    let main = std::fs::read_to_string(file("benches/main.rs")).unwrap();
    for (group, _) in benches() {
        assert!(main.contains(&format!("    {group}::benches,\n")), "{group}");
    }
}

#[test]
fn times_have_three_digits() {
    let shown = [0.5, 12.34, 999.4, 4821.0, 48210.0, 482_100.0, 2.5e6, 1.234e9, 6.1e10].map(time);
    let expected = [
        "0.50 ns", "12.3 ns", "999 ns", "4.82 us", "48.2 us", "482 us", "2.50 ms", "1.23 s", "61.0 s",
    ];
    assert_eq!(shown, expected);
}
