//! Answers to requests.

use std::fmt::Debug;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use gearloss_editor::{Answer as EditAnswer, Request as EditRequest, Workspace};
use gearloss_framework::files::SharedSource;
use gearloss_framework::gearbox::Gearbox;
use gearloss_framework::language::{LUBRICANTS, Language, MATERIALS};
use gearloss_framework::resolve::CatalogueRow;
use gearloss_studies::engine::progress::Progress;
use serde_json::{Value, json};

use crate::answer::Fault;
use crate::controls::controls;
use crate::drawing::drawing;
use crate::form::{Layout, NewStudy, forms, ratios, written};
use crate::map::map;
use crate::point::{explain, point};
use crate::request::{CatalogueOf, Request, Texts};
use crate::store::{FileKind, Store, hash};
use crate::study::{self, Listener};

/// Answers requests about the files of a store. It holds nothing but what is expensive to make.
pub struct Session<'l> {
    language: &'l Language,
    store: Arc<dyn Store>,
    /// Without open texts; its schemas are shared by all requests.
    workspace: Workspace<'l>,
}

impl<'l> Session<'l> {
    /// A session about the files of a store.
    pub fn new(language: &'l Language, store: Arc<dyn Store>) -> Self {
        Self {
            language,
            workspace: Workspace::new(language, store.source()),
            store,
        }
    }

    /// The store.
    pub fn store(&self) -> &dyn Store {
        &*self.store
    }

    /// Answers a request with `{ "value": ... }` or `{ "fault": ... }`. `Run` and `Watch` have streams of events instead of an answer.
    pub fn answer(&self, request: &Request, progress: &dyn Progress) -> Value {
        match self.value(request, progress) {
            Ok(value) => json!({ "value": value }),
            Err(fault) => json!({ "fault": fault }),
        }
    }

    fn value(&self, request: &Request, progress: &dyn Progress) -> Result<Value, Fault> {
        let language = self.language;
        // What documents name is read as on the command line; what the page names is in the folder.
        for file in request.files() {
            self.store.check(file)?;
        }
        // It may have waited for its turn until nobody waits for it.
        if !progress.should_continue() {
            return Err(Fault::interrupted());
        }
        match request {
            Request::Hello => Ok(Value::Null),
            Request::Folder => Ok(self.folder()),
            Request::Read { file } => {
                let text = self.store.read(file)?;
                Ok(json!({ "hash": hash(&text), "text": text }))
            }
            Request::Save { file, text, hash } => Ok(json!(self.store.save(file, text, hash.as_deref())?)),
            Request::Keep { tab, draft } => Ok(json!({ "id": self.store.keep(tab, draft)? })),
            Request::Forget { id } => Ok(json!(self.store.forget(id)?)),
            Request::Drafts => Ok(json!(self.store.drafts())),
            Request::Edit { texts, edit } => self.edit(texts, edit, progress),
            Request::Controls { texts, gearbox } => {
                let (_, files) = self.opened(texts);
                let studies = || {
                    let listed = self.store.list().into_iter();
                    let studies = listed.filter(|file| file.kind == FileKind::Study);
                    studies.map(|file| file.file).collect()
                };
                Ok(json!(controls(language, &files, gearbox, &studies, progress)?))
            }
            Request::Point { texts, point: of } => Ok(json!(point(language, &self.opened(texts).1, of, progress)?)),
            Request::Drawing { texts, gearbox } => {
                let (workspace, files) = self.opened(texts);
                Ok(json!(drawing(language, &workspace, &files, gearbox, progress)?))
            }
            Request::Explain { texts, part, point } => {
                let text = explain(language, &self.opened(texts).1, part, point, progress)?;
                Ok(json!({ "text": text }))
            }
            Request::Map { texts, map: of } => map(language, &self.opened(texts).1, of, progress),
            Request::Analyses { texts, study } => study::analyses(language, &self.opened(texts).1, study),
            Request::New { layout, values } => {
                let known = Layout::named(layout);
                let layout = known
                    .ok_or_else(|| Fault::new(format!("there is no layout `{layout}`"), "choose one of the list"))?;
                let written = written(layout, values)?;
                let ratios = ratios(language, &written.text);
                Ok(json!({ "text": written.text, "followed": written.followed, "ratios": ratios }))
            }
            Request::NewStudy { texts, gearbox } => {
                let file = Path::new(gearbox);
                let read = Gearbox::read_from(language, &self.opened(texts).1, file)?;
                let name = file.file_name().unwrap_or_default();
                Ok(json!({ "text": NewStudy::new(language, &read)?.text(Path::new(name)) }))
            }
            Request::Catalogue { of, text } => Ok(self.catalogue(*of, text)),
            Request::Run { .. } | Request::Watch { .. } => {
                Err(Fault::new("this request is answered by a stream", "read the stream"))
            }
        }
    }

    /// Runs analyses and sends events to a listener.
    pub fn run(&self, texts: &Texts, study: &str, analyses: &[String], listener: &dyn Listener) {
        let (_, files) = self.opened(texts);
        let checked = self.store.check(study);
        let run = checked.and_then(|()| study::run(self.language, &files, study, analyses, listener));
        if let Err(fault) = run {
            listener.event(json!({ "event": "fault", "fault": fault }));
        }
    }

    fn folder(&self) -> Value {
        json!({
            "name": self.store.name(),
            "version": env!("CARGO_PKG_VERSION"),
            "files": self.store.list(),
            "open": self.store.first(),
            "layouts": forms(),
        })
    }

    /// The documents with the texts of a page, and what documents read.
    fn opened(&self, texts: &Texts) -> (Workspace<'l>, SharedSource) {
        let mut workspace = self.workspace.clone();
        for (file, text) in texts {
            workspace.open(file, text.as_str());
        }
        let files = workspace.files();
        (workspace, files)
    }

    fn edit(&self, texts: &Texts, edit: &EditRequest, progress: &dyn Progress) -> Result<Value, Fault> {
        let (mut workspace, _) = self.opened(texts);
        // Only these name other files.
        let needs_names = !matches!(edit, EditRequest::Findings { .. } | EditRequest::Hover { .. });
        for file in self.store.names().into_iter().filter(|_| needs_names) {
            workspace.know(PathBuf::from(file));
        }
        match workspace.answer(edit, progress) {
            EditAnswer::Interrupted => Err(Fault::interrupted()),
            answer => Ok(json!(answer)),
        }
    }

    fn catalogue(&self, of: CatalogueOf, text: &str) -> Value {
        let section = match of {
            CatalogueOf::Bearings => "bearings",
            CatalogueOf::Oils => LUBRICANTS,
            CatalogueOf::Materials => MATERIALS,
        };
        let found = self
            .language
            .catalogue(section)
            .map(|table| table.search(text, of == CatalogueOf::Bearings));
        let row = |(designation, row): (String, CatalogueRow)| {
            let data = row.values.iter().map(|(key, value)| {
                let value = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
                (key.clone(), value)
            });
            json!({
                "designation": designation,
                "data": data.collect::<Vec<_>>(),
                "confidence": row.confidence,
                "origin": row.basis,
            })
        };
        let rows = found.map(|found| found.rows).unwrap_or_default();
        rows.into_iter().map(row).collect()
    }
}

impl Debug for Session<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Session")
            .field("store", &self.store)
            .finish_non_exhaustive()
    }
}
