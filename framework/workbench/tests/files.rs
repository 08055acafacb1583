//! Reading and writing in the opened folder only.

use std::fs;

use gearloss_workbench::disk::Folder;
use gearloss_workbench::form::LAYOUTS;
use gearloss_workbench::store::{Memory, Saved, Store, hash};
use serde_json::json;

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
        let own = usize::from(matches!(saved[1], Saved::Saved(_)));
        assert_eq!(folder.read("gearbox.yaml").unwrap(), texts[own]);
    }
    assert_eq!(fs::read_dir(&root).unwrap().count(), 1, "a temporary file is left");
    fs::remove_dir_all(root).unwrap();
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
