//! `gearloss open`: its numbers beside those of `solve` and `run`, and its end.

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use assert_cmd::cargo::cargo_bin;
use serde_json::{Value, json};

use crate::common;

/// The program with a folder.
struct Open {
    process: Child,
    host: String,
    token: String,
}

impl Open {
    fn start(folder: &Path) -> Self {
        let mut process = Command::new(cargo_bin("gearloss"))
            .args(["open", "--no-browser"])
            .arg(folder)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        let out = process.stdout.as_mut().unwrap();
        BufReader::new(out).read_line(&mut line).unwrap();
        let address = line.trim().strip_prefix("workbench: http://").unwrap();
        let (host, token) = address.split_once("/#t=").unwrap();
        let (host, token) = (host.to_owned(), token.to_owned());
        Self { process, host, token }
    }

    fn send(&self, request: &str) -> String {
        let mut stream = TcpStream::connect(&self.host).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        let (_, body) = answer.split_once("\r\n\r\n").unwrap();
        body.to_owned()
    }

    fn ask(&self, request: &Value) -> Value {
        let (host, token, body) = (&self.host, &self.token, request.to_string());
        let answer = self.send(&format!(
            "POST /api HTTP/1.1\r\nHost: {host}\r\nAuthorization: Bearer {token}\r\nContent-Type: application/json\r\n\
             Connection: close\r\nContent-Length: {}\r\n\r\n{body}",
            body.len()
        ));
        let mut answer: Value = serde_json::from_str(&answer).unwrap();
        assert!(answer.get("fault").is_none(), "{answer}");
        answer["value"].take()
    }
}

impl Drop for Open {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn printed(args: &[&str]) -> String {
    let output = Command::new(cargo_bin("gearloss")).args(args).output().unwrap();
    String::from_utf8(output.stdout).unwrap()
}

/// The record of a point is that of `gearloss solve`, to the bit: fixed temperature, heat balance and network.
#[test]
fn points_are_those_of_solve() {
    for (example, gear, torque, speed, oil, set) in [
        ("two-speed-ev", "first", 7.3, 4321.0, None, ""),
        ("two-speed-ev", "second", 7.3, 4321.0, Some(61.5), "joint"),
        ("planetary-reducer", "reducing", 11.0, 2345.0, None, ""),
        ("electric-drive-unit", "only", 55.5, 6789.0, None, ""),
    ] {
        let folder = common::file("examples").join(example);
        let file = folder.join("gearbox.yaml").display().to_string();
        let open = Open::start(&folder);
        let controls = open.ask(&json!({ "request": "controls", "texts": {}, "gearbox": "gearbox.yaml" }));
        let mut gears = controls["gears"].as_array().unwrap().iter();
        let state = gears.find(|member| member["name"] == gear).unwrap();
        let (mut inputs, mut args) = (Vec::new(), vec!["solve".to_owned(), file]);
        for input in state["inputs"].as_array().unwrap() {
            let value = if input["quantity"] == "torque" { torque } else { speed };
            inputs.push(json!({ "quantity": input["quantity"], "port": input["port"], "value": value }));
            args.push(format!("--{}", input["quantity"].as_str().unwrap()));
            args.push(format!(
                "{}={value} {}",
                input["port"].as_str().unwrap(),
                input["unit"].as_str().unwrap()
            ));
        }
        args.extend(["--gear".to_owned(), state["name"].as_str().unwrap().to_owned()]);
        if let Some(oil) = oil {
            args.extend(["--oil-temperature".to_owned(), format!("{oil} degC")]);
        }
        if !set.is_empty() {
            args.extend(["--models".to_owned(), set.to_owned()]);
        }
        args.extend(["--format".to_owned(), "json".to_owned()]);
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        let solved: Value = serde_json::from_str(&printed(&args)).unwrap();
        let answer = open.ask(&json!({
            "request": "point", "texts": {}, "gearbox": "gearbox.yaml", "gear": state["name"], "inputs": inputs,
            "oil_temperature": oil, "model_set": set,
        }));
        assert_eq!(answer["point"], solved, "{example}");
        assert!(solved["loss_w"].as_f64().unwrap() > 0.0);
    }
}

/// The report of a run in the page is the file that `gearloss run` writes, byte by byte.
#[test]
fn a_report_is_the_one_of_run() {
    let folder = common::file("examples/planetary-reducer");
    let results = std::env::temp_dir().join(format!("gearloss-open-{}", std::process::id()));
    let study = folder.join("study.yaml").display().to_string();
    printed(&["run", &study, "-o", &results.display().to_string()]);
    let open = Open::start(&folder);
    let (host, token) = (&open.host, &open.token);
    let body = json!({ "request": "run", "texts": {}, "study": "study.yaml", "analyses": [] }).to_string();
    let events = open.send(&format!(
        "POST /api HTTP/1.1\r\nHost: {host}\r\nAuthorization: Bearer {token}\r\nContent-Type: application/json\r\n\
         Connection: close\r\nContent-Length: {}\r\n\r\n{body}",
        body.len()
    ));
    let mut events = events
        .lines()
        .filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let report = events.find(|event| event["event"] == "report").unwrap();
    let address = report["address"].as_str().unwrap();
    let page = open.send(&format!(
        "GET {address} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"
    ));
    let written = fs::read_to_string(results.join("report.html")).unwrap();
    assert!(page == written, "the reports differ");
    fs::remove_dir_all(results).unwrap();
}

#[test]
fn a_folder_that_is_missing_is_an_error() {
    let output = Command::new(cargo_bin("gearloss"))
        .args(["open", "no-such-folder"])
        .output()
        .unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(
        text.contains("cannot open no-such-folder") && text.contains("help"),
        "{text}"
    );
}
