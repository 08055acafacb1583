//! Reading and writing in the opened folder only.

use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use gearloss_workbench::Session;
use gearloss_workbench::disk::Folder;
use gearloss_workbench::form::LAYOUTS;
use gearloss_workbench::store::{Memory, Saved, Store, hash};
use serde_json::{Value, json};

use super::common::{empty, fault, session, value};

#[test]
fn files_are_read_and_saved() {
    let root = empty("saved");
    fs::write(root.join("gearbox.yaml"), "gearloss: gearbox/1\n").unwrap();
    fs::create_dir(root.join("results")).unwrap();
    fs::write(root.join("results/report.html"), "").unwrap();
    fs::write(root.join("results/map.csv"), "a\n").unwrap();
    let session = session(Folder::open(&root.join("gearbox.yaml")).unwrap());
    let folder = value(&session, json!({ "request": "folder" }));
    assert_eq!(folder["open"], "gearbox.yaml");
    assert_eq!(folder["files"], json!([{ "file": "gearbox.yaml", "kind": "gearbox" }]));
    let read = value(&session, json!({ "request": "read", "file": "gearbox.yaml" }));
    assert_eq!(read["hash"], hash("gearloss: gearbox/1\n"));
    let save = |text: &str, hash: &str| json!({ "request": "save", "file": "gearbox.yaml", "text": text, "hash": Some(hash).filter(|hash| !hash.is_empty()) });
    let saved = value(&session, save("ä\n", read["hash"].as_str().unwrap()));
    assert_eq!(saved, json!({ "saved": hash("ä\n") }));
    assert_eq!(fs::read_to_string(root.join("gearbox.yaml")).unwrap(), "ä\n");
    // What the page does not know is not overwritten; the same text needs no question.
    let refused = value(&session, save("other\n", read["hash"].as_str().unwrap()));
    assert_eq!(refused, json!({ "changed": { "text": "ä\n", "hash": hash("ä\n") } }));
    assert_eq!(value(&session, save("other\n", ""))["changed"]["text"], "ä\n");
    assert!(value(&session, save("ä\n", "0")).get("saved").is_some());
    assert_eq!(fs::read_dir(&root).unwrap().count(), 2, "a temporary file is left");
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn nothing_outside_of_the_folder_is_read_or_written() {
    let root = empty("outside");
    let inside = root.join("inside");
    fs::create_dir_all(inside.join("sub")).unwrap();
    fs::write(root.join("secret.yaml"), "secret\n").unwrap();
    fs::write(inside.join("sub/study.yaml"), "").unwrap();
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(root.join("secret.yaml"), inside.join("link.yaml")).unwrap();
        std::os::unix::fs::symlink(&root, inside.join("up")).unwrap();
    }
    let session = session(Folder::open(&inside).unwrap());
    let absolute = root.join("secret.yaml").display().to_string();
    let mut files = vec![
        "../secret.yaml",
        "sub/../../secret.yaml",
        "./secret.yaml",
        "",
        "a\\b.yaml",
        "C:secret.yaml",
        "sub\0.yaml",
        &absolute,
    ];
    if cfg!(unix) {
        files.extend(["link.yaml", "up/secret.yaml", "up/inside/../secret.yaml"]);
    }
    for file in files {
        let read = fault(&session, json!({ "request": "read", "file": file }));
        assert!(!read.to_string().contains("secret\\n"), "{read}");
        fault(
            &session,
            json!({ "request": "save", "file": file, "text": "overwritten", "hash": hash("secret\n") }),
        );
        fault(
            &session,
            json!({ "request": "save", "file": file, "text": "overwritten", "hash": null }),
        );
    }
    // Programs and hidden files are no documents.
    fs::create_dir(inside.join(".git")).unwrap();
    fs::write(inside.join(".git/config.yaml"), "secret\n").unwrap();
    fs::write(inside.join("key.pem"), "secret\n").unwrap();
    for file in [
        "run.sh",
        ".bashrc",
        ".hidden.yaml",
        ".git/config.yaml",
        "key.pem",
        "page.html",
        "noname",
        "no/folder.yaml",
    ] {
        fault(
            &session,
            json!({ "request": "save", "file": file, "text": "x", "hash": null }),
        );
        fault(&session, json!({ "request": "read", "file": file }));
    }
    // Nor do other requests reach out of the folder.
    fs::write(root.join("gearbox.yaml"), LAYOUTS[0].text).unwrap();
    for file in ["../gearbox.yaml", &root.join("gearbox.yaml").display().to_string()] {
        for request in [
            json!({ "request": "controls", "texts": {}, "gearbox": file }),
            json!({ "request": "drawing", "texts": {}, "gearbox": file }),
            json!({ "request": "new_study", "texts": {}, "gearbox": file }),
            json!({ "request": "analyses", "texts": {}, "study": file }),
            json!({ "request": "edit", "texts": {}, "edit": { "request": "findings", "file": file } }),
            json!({
                "request": "point", "texts": {}, "gearbox": file, "gear": "only", "inputs": [], "oil_temperature": null,
                "model_set": "",
            }),
        ] {
            let fault = fault(&session, request);
            assert!(
                fault["message"].as_str().unwrap().contains("not in the opened folder"),
                "{fault}"
            );
        }
    }
    assert_eq!(fs::read_to_string(root.join("secret.yaml")).unwrap(), "secret\n");
    value(
        &session,
        json!({ "request": "save", "file": "sub/new.yaml", "text": "x", "hash": null }),
    );
    fs::remove_dir_all(root).unwrap();
}

/// Of two pages that save at the same time, one is told what the other has written.
#[test]
fn two_pages_save_one_after_the_other() {
    let root = empty("together");
    fs::write(root.join("gearbox.yaml"), "base\n").unwrap();
    let folder = Folder::open(&root).unwrap();
    for round in 0..50 {
        let known = hash(&folder.read("gearbox.yaml").unwrap());
        let save = |text: &str| folder.save("gearbox.yaml", text, Some(&known)).unwrap();
        let texts = [format!("one {round}\n"), format!("two {round}\n")];
        let saved = std::thread::scope(|scope| {
            let threads = [&texts[0], &texts[1]].map(|text| scope.spawn(|| save(text)));
            threads.map(|thread| thread.join().unwrap())
        });
        let kept = saved.iter().filter(|saved| matches!(saved, Saved::Saved(_))).count();
        assert_eq!(kept, 1, "{saved:?}");
        let saved_one = usize::from(matches!(saved[1], Saved::Saved(_)));
        assert_eq!(folder.read("gearbox.yaml").unwrap(), texts[saved_one]);
    }
    assert_eq!(fs::read_dir(&root).unwrap().count(), 1, "a temporary file is left");
    fs::remove_dir_all(root).unwrap();
}

/// Folder, name and number of saves of a program of the tests below.
const PROGRAM: &str = "GEARLOSS_TEST_SAVES";

/// Not a test: one of the programs that save to one folder. Each adds a line to what it reads, and prints those that were saved.
#[test]
#[ignore = "a program of the tests below"]
fn a_program_saves() {
    let Ok(stated) = std::env::var(PROGRAM) else {
        return;
    };
    let [root, name, count] = stated.split('|').collect::<Vec<_>>().try_into().unwrap();
    let folder = Folder::open(Path::new(root)).unwrap();
    for k in 0..count.parse::<usize>().unwrap() {
        let before = folder.read("gearbox.yaml").unwrap();
        let line = format!("{name} {k}");
        let saved = folder.save("gearbox.yaml", &format!("{before}{line}\n"), Some(&hash(&before)));
        if matches!(saved, Ok(Saved::Saved(_))) {
            writeln!(std::io::stdout(), "\nsaved:{line}").unwrap();
        }
    }
}

/// Starts a program that saves.
fn program(root: &Path, name: &str, count: usize) -> Child {
    Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "files::a_program_saves", "--ignored", "--nocapture"])
        .env(PROGRAM, format!("{}|{name}|{count}", root.display()))
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// The lines that a program has reported as saved.
fn reported(child: Child) -> Vec<String> {
    let output = child.wait_with_output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let lines = text.lines().filter_map(|line| line.strip_prefix("saved:"));
    lines.map(str::to_owned).collect()
}

/// Names of the files of a folder, hidden ones too.
fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap().flatten();
    let mut names: Vec<String> = entries
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// What a program reports as saved is in the file, whatever other programs save at the same time.
#[test]
fn programs_with_one_folder_lose_no_save() {
    let root = empty("programs");
    fs::write(root.join("gearbox.yaml"), "").unwrap();
    let programs = ["one", "two", "three"].map(|name| program(&root, name, 60));
    let reported: Vec<String> = programs.into_iter().flat_map(reported).collect();
    let text = fs::read_to_string(root.join("gearbox.yaml")).unwrap();
    let is_lost = |line: &&String| !text.lines().any(|kept| kept == *line);
    let lost: Vec<&String> = reported.iter().filter(is_lost).collect();
    assert!(
        lost.is_empty(),
        "{} of {} are lost: {lost:?}",
        lost.len(),
        reported.len()
    );
    assert_eq!(text.lines().count(), reported.len(), "a save was not reported");
    assert!(["one", "two", "three"].iter().all(|name| text.contains(name)), "{text}");
    assert_eq!(names_in(&root), ["gearbox.yaml"]);
    fs::remove_dir_all(root).unwrap();
}

/// Programs that are killed while they save leave a whole file, and nothing else once the folder is opened again.
#[test]
fn what_a_killed_program_leaves_is_removed() {
    let root = empty("killed");
    fs::create_dir(root.join("sub")).unwrap();
    fs::write(root.join("gearbox.yaml"), "").unwrap();
    fs::write(root.join("sub/study.yaml"), "").unwrap();
    for round in 0..6 {
        let mut child = program(&root, &format!("killed{round}"), 100_000);
        std::thread::sleep(Duration::from_millis(150 + 17 * round));
        child.kill().unwrap();
        child.wait().unwrap();
    }
    // What a save leaves that is killed right before its end.
    let left = [
        ".gearbox.yaml.4242.part",
        "sub/.study.yaml.17.part",
        ".gearloss-save.lock",
    ];
    for part in left {
        fs::write(root.join(part), "half a te").unwrap();
    }
    fs::write(root.join(".mine.part"), "of the user").unwrap();
    let folder = Folder::open(&root).unwrap();
    assert_eq!(names_in(&root), [".mine.part", "gearbox.yaml", "sub"]);
    assert_eq!(names_in(&root.join("sub")), ["study.yaml"]);
    // A save cleans up, too, and the file is whole.
    fs::write(root.join(".gearbox.yaml.4243.part"), "half a te").unwrap();
    let text = folder.read("gearbox.yaml").unwrap();
    assert!(text.is_empty() || text.ends_with('\n'), "half a file");
    folder.save("gearbox.yaml", "new\n", Some(&hash(&text))).unwrap();
    assert_eq!(names_in(&root), [".mine.part", "gearbox.yaml", "sub"]);
    fs::remove_dir_all(root).unwrap();
}

/// The program checks the names of new files as the page does; files that are there keep theirs.
#[test]
fn new_files_have_usual_names() {
    let root = empty("names");
    fs::create_dir(root.join("sub")).unwrap();
    fs::create_dir(root.join("empty")).unwrap();
    fs::write(root.join("sub/study.yaml"), "").unwrap();
    fs::write(root.join("gear (1).yaml"), "one\n").unwrap();
    let folder = Folder::open(&root).unwrap();
    for file in [
        "new\u{202e}.yaml",
        "a*b.yaml",
        "nul.yaml",
        "new.yaml.",
        "empty/new.yaml",
        "SUB/new.yaml",
        "sub/Study.yaml",
        "gear (2).yaml",
    ] {
        folder.save(file, "x", None).unwrap_err();
    }
    for file in ["Größe 2.yaml", "sub/new.yaml"] {
        assert!(matches!(folder.save(file, "x", None), Ok(Saved::Saved(_))), "{file}");
    }
    let saved = folder.save("gear (1).yaml", "two\n", Some(&hash("one\n")));
    assert!(matches!(saved, Ok(Saved::Saved(_))));
    assert_eq!(
        folder.names(),
        ["Größe 2.yaml", "gear (1).yaml", "sub/new.yaml", "sub/study.yaml"]
    );
    fs::remove_dir_all(root).unwrap();
}

/// A request that keeps a draft.
fn keep(tab: &str, file: &str, text: &str) -> Value {
    let draft = json!({ "file": file, "text": text, "hash": null, "base": "", "time": 1.0 });
    json!({ "request": "keep", "tab": tab, "draft": draft })
}

/// Texts of the drafts that a page is offered.
fn drafts(session: &Session<'_>) -> Vec<String> {
    let list = value(session, json!({ "request": "drafts" }));
    let list = list.as_array().unwrap().iter();
    list.map(|kept| kept["draft"]["text"].as_str().unwrap().to_owned())
        .collect()
}

/// Drafts of a program that runs are its own; those of one that has ended are offered by the next one of the folder.
#[test]
fn drafts_survive_their_program() {
    let (root, other, state) = (empty("drafts"), empty("drafts-other"), empty("drafts-state"));
    let open = |root: &Path| session(Folder::open(root).unwrap().with_drafts(Some(&state)));
    let first = open(&root);
    value(&first, keep("0a1b", "gearbox.yaml", "one"));
    let kept = value(&first, keep("0a1b", "gearbox.yaml", "two"));
    assert_eq!(drafts(&first), ["two"]);
    let second = open(&root);
    assert!(
        drafts(&second).is_empty(),
        "the draft of a program that runs is offered"
    );
    drop(first);
    assert_eq!(drafts(&second), ["two"]);
    assert!(
        drafts(&open(&other)).is_empty(),
        "the draft of another folder is offered"
    );
    value(&second, json!({ "request": "forget", "id": kept["id"] }));
    assert!(drafts(&second).is_empty());
    for wrong in [
        keep("0a1b", "../gearbox.yaml", "x"),
        keep("../x", "gearbox.yaml", "x"),
        json!({ "request": "forget", "id": "../../x" }),
        json!({ "request": "forget", "id": "a/../b" }),
    ] {
        fault(&second, wrong);
    }
    // Without a place for them the page is told.
    let without = session(Folder::open(&root).unwrap().with_drafts(None));
    fault(&without, keep("0a1b", "gearbox.yaml", "x"));
    for folder in [root, other, state] {
        fs::remove_dir_all(folder).unwrap();
    }
}

/// No other user of the computer may read drafts, whatever the usual rights of new files are.
#[cfg(unix)]
#[test]
fn drafts_are_files_of_this_user_alone() {
    use std::os::unix::fs::PermissionsExt as _;
    let (root, state) = (empty("private"), empty("private-state"));
    let session = session(Folder::open(&root).unwrap().with_drafts(Some(&state)));
    value(&session, keep("0a1b", "gearbox.yaml", "secret"));
    let mut folders = vec![state.join("drafts")];
    let mut files = 0;
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(&folder).unwrap().flatten().map(|entry| entry.path()) {
            let rights = fs::metadata(&path).unwrap().permissions().mode() & 0o777;
            if path.is_dir() {
                assert_eq!(rights, 0o700, "{}", path.display());
                folders.push(path);
            } else {
                assert_eq!(rights, 0o600, "{}", path.display());
                files += 1;
            }
        }
    }
    assert_eq!(files, 2, "a draft and a lock");
    for folder in [root, state] {
        fs::remove_dir_all(folder).unwrap();
    }
}

/// Rights of a file are kept; one that is read-only is not replaced.
#[cfg(unix)]
#[test]
fn rights_are_kept() {
    use std::os::unix::fs::PermissionsExt as _;
    let root = empty("rights");
    let file = root.join("gearbox.yaml");
    fs::write(&file, "base\n").unwrap();
    let folder = Folder::open(&root).unwrap();
    fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
    folder.save("gearbox.yaml", "new\n", Some(&hash("base\n"))).unwrap();
    assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
    fs::set_permissions(&file, fs::Permissions::from_mode(0o444)).unwrap();
    let fault = folder
        .save("gearbox.yaml", "newer\n", Some(&hash("new\n")))
        .unwrap_err();
    assert!(fault.message.contains("read-only"), "{}", fault.message);
    assert_eq!(fs::read_to_string(&file).unwrap(), "new\n");
    fs::remove_dir_all(root).unwrap();
}

#[test]
fn memory_keeps_texts() {
    let memory = Memory::new("memory", [("a.yaml", "one")]);
    assert_eq!(
        memory.save("a.yaml", "two", Some(&hash("one"))).unwrap(),
        Saved::Saved(hash("two"))
    );
    assert!(matches!(
        memory.save("a.yaml", "three", None).unwrap(),
        Saved::Changed { .. }
    ));
    memory.save("b.yaml", "new", None).unwrap();
    assert_eq!(memory.read("b.yaml").unwrap(), "new");
    assert!(memory.read("c.yaml").is_err());
    assert_eq!(memory.names(), ["a.yaml", "b.yaml"]);
}
