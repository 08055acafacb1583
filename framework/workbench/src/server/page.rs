//! The files of the page; built from `web/`.

/// Content type and content of a file.
pub fn file(path: &str) -> Option<(&'static str, &'static str)> {
    match path {
        "/" => Some(("text/html; charset=utf-8", include_str!("../page/workbench.html"))),
        "/workbench.js" => Some(("text/javascript; charset=utf-8", include_str!("../page/workbench.js"))),
        "/workbench.css" => Some(("text/css; charset=utf-8", include_str!("../page/workbench.css"))),
        _ => None,
    }
}

/// What the page may load: its own files, and styles that its editor makes.
pub const POLICY: &str = "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; connect-src 'self'; \
                          base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// What a report may: its own scripts and styles, in an origin of its own that can ask nothing here.
pub const REPORT_POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; \
                                 sandbox allow-scripts allow-downloads allow-modals; frame-ancestors 'none'";
