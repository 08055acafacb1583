//! The server over raw sockets: who is refused, and what a page gets.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::sync::LazyLock;
use std::time::Duration;

use gearloss_workbench::disk::Folder;
use gearloss_workbench::{Served, serve};
use serde_json::{Value, json};

use super::common::{example, language};

/// A server for all tests of this file: host, and token.
static SERVER: LazyLock<(String, String)> = LazyLock::new(|| start(&example("two-speed-ev")));

fn start(folder: &Path) -> (String, String) {
    let served = Served::bind(Folder::open(folder).unwrap(), true).unwrap();
    let address = served.address();
    std::thread::spawn(|| serve(language(), served));
    let (host, token) = address.strip_prefix("http://").unwrap().split_once("/#t=").unwrap();
    (host.to_owned(), token.to_owned())
}

/// Sends bytes and reads the answer to its end, or what came until the peer is silent.
fn raw(request: &str) -> String {
    let mut stream = TcpStream::connect(&SERVER.0).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    // A server that refuses early may close before everything is sent.
    let _ = stream.write_all(request.as_bytes());
    let mut answer = Vec::new();
    let _ = stream.read_to_end(&mut answer);
    String::from_utf8_lossy(&answer).into_owned()
}

/// A request for work with changed lines of its head.
fn post(body: &str, change: impl Fn(&str) -> Option<String>) -> String {
    let (host, token) = &*SERVER;
    let head = [
        "POST /api HTTP/1.1".to_owned(),
        format!("Host: {host}"),
        format!("Origin: http://{host}"),
        format!("Authorization: Bearer {token}"),
        "Content-Type: application/json".to_owned(),
        "Connection: close".to_owned(),
        format!("Content-Length: {}", body.len()),
    ];
    let head: Vec<String> = head.iter().filter_map(|line| change(line)).collect();
    format!("{}\r\n\r\n{body}", head.join("\r\n"))
}

fn status(answer: &str) -> u16 {
    answer.split(' ').nth(1).and_then(|code| code.parse().ok()).unwrap_or(0)
}

fn replace<'a>(name: &'a str, new: &'a str) -> impl Fn(&str) -> Option<String> + 'a {
    move |line| {
        if line.starts_with(name) {
            Some(new.to_owned()).filter(|new| !new.is_empty())
        } else {
            Some(line.to_owned())
        }
    }
}

const FOLDER: &str = r#"{"request":"folder"}"#;

#[test]
fn a_page_with_its_token_is_answered() {
    let answer = raw(&post(FOLDER, |line| Some(line.to_owned())));
    assert_eq!(status(&answer), 200, "{answer}");
    assert!(answer.contains("gearbox.yaml"));
    assert!(!answer.to_lowercase().contains("access-control"), "{answer}");
}

/// Every row is refused, whatever else is right.
#[test]
fn everybody_else_is_refused() {
    let wrong = format!("Authorization: Bearer {}", "0".repeat(64));
    let short = format!("Authorization: Bearer {}", &SERVER.1[..10]);
    let basic = format!("Authorization: {}", SERVER.1);
    let twice = format!("Host: {}\r\nHost: evil.example", SERVER.0);
    let prefix = format!("Origin: http://{}.evil.example", SERVER.0);
    let long = " ".repeat((4 << 20) + 1);
    let port = SERVER.0.split_once(':').unwrap().1;
    let other = format!("Host: evil.example:{port}");
    for (what, name, new, body, expected) in [
        ("foreign host", "Host:", "Host: evil.example", FOLDER, 400),
        ("foreign host with this port", "Host:", other.as_str(), FOLDER, 400),
        ("host without port", "Host:", "Host: 127.0.0.1", FOLDER, 400),
        ("no host", "Host:", "", FOLDER, 400),
        ("two hosts", "Host:", twice.as_str(), FOLDER, 400),
        ("foreign origin", "Origin:", "Origin: http://evil.example", FOLDER, 403),
        ("origin of a file", "Origin:", "Origin: null", FOLDER, 403),
        (
            "origin with the host as a prefix",
            "Origin:",
            prefix.as_str(),
            FOLDER,
            403,
        ),
        ("no token", "Authorization:", "", FOLDER, 401),
        ("wrong token", "Authorization:", wrong.as_str(), FOLDER, 401),
        ("a part of the token", "Authorization:", short.as_str(), FOLDER, 401),
        ("token of another scheme", "Authorization:", basic.as_str(), FOLDER, 401),
        ("reading method", "POST", "GET /api HTTP/1.1", "", 405),
        ("writing method", "POST", "PUT /api HTTP/1.1", FOLDER, 405),
        ("method before a question", "POST", "OPTIONS /api HTTP/1.1", "", 405),
        ("post elsewhere", "POST", "POST / HTTP/1.1", FOLDER, 405),
        ("unknown path", "POST", "GET /etc/passwd HTTP/1.1", "", 404),
        ("path outside", "POST", "GET /../../etc/passwd HTTP/1.1", "", 404),
        ("unknown report", "POST", "GET /report/0 HTTP/1.1", "", 404),
        ("a form", "Content-Type:", "Content-Type: text/plain", FOLDER, 415),
        ("no type", "Content-Type:", "", FOLDER, 415),
        ("too long", "", "", long.as_str(), 413),
        ("no JSON", "", "", "{", 400),
        ("unknown request", "", "", r#"{"request":"shell"}"#, 400),
    ] {
        let request = if name.is_empty() {
            post(body, |line| Some(line.to_owned()))
        } else {
            post(body, replace(name, new))
        };
        let answer = raw(&request);
        assert_eq!(
            status(&answer),
            expected,
            "{what}: {}",
            answer.lines().next().unwrap_or_default()
        );
        assert!(!answer.contains("gearbox.yaml"), "{what}");
    }
    // Files outside are refused by the answer.
    for request in [
        json!({ "request": "read", "file": "../planetary-reducer/gearbox.yaml" }),
        json!({ "request": "save", "file": "../new.yaml", "text": "", "hash": null }),
        json!({ "request": "controls", "texts": {}, "gearbox": "../planetary-reducer/gearbox.yaml" }),
        json!({ "request": "run", "texts": {}, "study": "../planetary-reducer/study.yaml", "analyses": [] }),
    ] {
        let answer = raw(&post(&request.to_string(), |line| Some(line.to_owned())));
        assert!(answer.contains("is not in the opened folder"), "{answer}");
    }
}

/// Silent connections, and those that ask without reading, do not keep out a page with the token.
#[test]
fn strangers_do_not_keep_out_a_page() {
    let root = super::common::empty("crowded");
    let (host, token) = start(&root);
    let silent: Vec<TcpStream> = (0..60).map(|_| TcpStream::connect(&host).unwrap()).collect();
    let greedy: Vec<TcpStream> = (0..60)
        .map(|_| {
            let mut stream = TcpStream::connect(&host).unwrap();
            let _ = stream.write_all(
                format!("GET /workbench.js HTTP/1.1\r\nHost: {host}\r\n\r\n")
                    .repeat(50)
                    .as_bytes(),
            );
            stream
        })
        .collect();
    let mut page = TcpStream::connect(&host).unwrap();
    page.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    let head = format!(
        "POST /api HTTP/1.1\r\nHost: {host}\r\nAuthorization: Bearer {token}\r\nContent-Type: application/json\r\n\
         Connection: close\r\nContent-Length: {}\r\n\r\n{FOLDER}",
        FOLDER.len()
    );
    page.write_all(head.as_bytes()).unwrap();
    let mut answer = String::new();
    page.read_to_string(&mut answer).unwrap();
    assert_eq!(status(&answer), 200, "{answer}");
    drop((silent, greedy));
    std::fs::remove_dir_all(root).unwrap();
}

/// Two hundred requests at once: each is answered, or told to come again.
#[test]
fn every_request_of_a_flood_is_answered() {
    let (host, token) = start(&example("two-speed-ev"));
    let session = super::common::about("two-speed-ev");
    let point = super::common::first_point(&session, &json!({}), "gearbox.yaml").to_string();
    let ask = |k: usize| -> std::io::Result<String> {
        let body = [FOLDER, &point][k % 2];
        // Half of them keep their connection, as browsers do.
        let connection = ["close", "keep-alive"][k / 2 % 2];
        let mut stream = TcpStream::connect(&host)?;
        stream.set_read_timeout(Some(Duration::from_mins(2)))?;
        let head = format!(
            "POST /api HTTP/1.1\r\nHost: {host}\r\nAuthorization: Bearer {token}\r\nContent-Type: application/json\r\n\
             Connection: {connection}\r\nContent-Length: {}\r\n\r\n{body}",
            body.len()
        );
        stream.write_all(head.as_bytes())?;
        let mut answer = BufReader::new(stream);
        let (mut head, mut line) = (String::new(), String::new());
        while line != "\r\n" {
            line.clear();
            if answer.read_line(&mut line)? == 0 {
                return Err(std::io::ErrorKind::UnexpectedEof.into());
            }
            head.push_str(&line);
        }
        let length = head.lines().find_map(|line| line.strip_prefix("content-length: "));
        let mut body = vec![0; length.and_then(|length| length.parse().ok()).unwrap_or(0)];
        answer.read_exact(&mut body)?;
        // The connection stays open for a while.
        std::thread::sleep(Duration::from_millis(50));
        Ok(head)
    };
    let answers: Vec<_> = std::thread::scope(|scope| {
        let ask = &ask;
        let all: Vec<_> = (0..200).map(|k| scope.spawn(move || ask(k))).collect();
        all.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    let is_answered = |head: &str| status(head) == 200 || (status(head) == 503 && head.contains("retry-after: "));
    let wrong: Vec<_> = answers
        .iter()
        .filter(|answer| !answer.as_ref().is_ok_and(|head| is_answered(head)))
        .collect();
    assert!(wrong.is_empty(), "{} of 200: {:?}", wrong.len(), wrong[0]);
}

/// Answers to who has the token prove that they are of this program; others see no proof.
#[test]
fn answers_prove_their_program() {
    let proof = |answer: &str| {
        let head = answer.split("\r\n\r\n").next().unwrap_or_default();
        let found = head.lines().find_map(|line| line.strip_prefix("gearloss-proof: "));
        found.map(str::to_owned)
    };
    let hello = raw(&post(r#"{"request":"hello"}"#, |line| Some(line.to_owned())));
    let proven = proof(&hello).unwrap();
    assert!(
        proven.len() == 64 && proven != SERVER.1 && hello.ends_with(r#"{"value":null}"#),
        "{hello}"
    );
    // A refusal of a known page, too.
    let unknown = raw(&post(r#"{"request":"shell"}"#, |line| Some(line.to_owned())));
    assert_eq!((status(&unknown), proof(&unknown)), (400, Some(proven)));
    for request in [
        post(FOLDER, replace("Authorization:", "")),
        post(FOLDER, replace("Host:", "Host: evil.example")),
        format!("GET / HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", SERVER.0),
    ] {
        assert_eq!(proof(&raw(&request)), None);
    }
}

#[test]
fn the_page_may_load_nothing_from_elsewhere() {
    let (host, _) = &*SERVER;
    for file in ["/", "/workbench.js", "/workbench.css"] {
        let answer = raw(&format!(
            "GET {file} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"
        ));
        assert_eq!(status(&answer), 200, "{file}");
        let head = answer.split("\r\n\r\n").next().unwrap();
        assert!(
            head.contains("default-src 'self'") && head.contains("frame-ancestors 'none'"),
            "{head}"
        );
        assert!(head.contains("x-content-type-options: nosniff"), "{head}");
        assert!(!answer.contains(&SERVER.1), "{file} contains the token");
    }
}

/// Lines of JSON as they come: progress, sections, the report; the report is in an origin of its own.
#[test]
fn a_run_is_a_stream() {
    let study = "gearloss: study/1\ngearboxes: { ev: gearbox.yaml }\n\
                 grids: { small: { gear: first, torque: [10 Nm], speed: [3000 rpm, 6000 rpm] } }\n\
                 analyses: { losses: { type: map, grid: small } }\n";
    let request = json!({ "request": "run", "texts": { "study.yaml": study }, "study": "study.yaml", "analyses": [] });
    let answer = raw(&post(&request.to_string(), |line| Some(line.to_owned())));
    assert!(answer.contains("application/x-ndjson"), "{answer}");
    let events: Vec<Value> = answer
        .lines()
        .filter_map(|line| serde_json::from_str(line).ok())
        .collect();
    let names: Vec<&str> = events.iter().filter_map(|event| event["event"].as_str()).collect();
    assert_eq!(
        (names.first(), names.last()),
        (Some(&"begin"), Some(&"end")),
        "{answer}"
    );
    let report = events.iter().find(|event| event["event"] == "report").unwrap();
    let (host, address) = (&SERVER.0, report["address"].as_str().unwrap());
    let page = raw(&format!(
        "GET {address} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"
    ));
    let head = page.split("\r\n\r\n").next().unwrap();
    assert!(
        head.contains("sandbox allow-scripts") && !head.contains("allow-same-origin"),
        "{head}"
    );
    assert!(page.contains("<html"), "{head}");
}

/// A changed file is told; the stream goes on.
#[test]
fn changes_on_the_disk_are_told() {
    let root = super::common::empty("watched");
    let file = root.join("gearbox.yaml");
    std::fs::write(&file, "one\n").unwrap();
    let (host, token) = start(&root);
    let body = json!({ "request": "watch", "files": { "gearbox.yaml": "0", "new.yaml": "" } }).to_string();
    let mut stream = TcpStream::connect(&host).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    let head = format!(
        "POST /api HTTP/1.1\r\nHost: {host}\r\nAuthorization: Bearer {token}\r\nContent-Type: application/json\r\n\
         Content-Length: {}\r\n\r\n{body}",
        body.len()
    );
    stream.write_all(head.as_bytes()).unwrap();
    let mut lines = BufReader::new(stream).lines();
    let mut next = |wanted: &str| -> Value {
        let found = lines.by_ref().map_while(Result::ok).find_map(|line| {
            let event: Value = serde_json::from_str(&line).ok()?;
            (event["event"] == wanted).then_some(event)
        });
        found.unwrap()
    };
    assert_eq!(next("changed")["text"], "one\n");
    next("alive");
    std::fs::write(&file, "two\n").unwrap();
    assert_eq!(next("changed")["text"], "two\n");
    std::fs::remove_file(&file).unwrap();
    assert_eq!(next("removed")["file"], "gearbox.yaml");
    std::fs::remove_dir_all(root).unwrap();
}
