//! Who may ask: only a page of this server, with its token.

use std::fmt::{self, Debug, Write as _};
use std::io;

use hyper::header::{AUTHORIZATION, CONTENT_TYPE, HOST, HeaderMap, HeaderName, ORIGIN};
use hyper::{Method, StatusCode};

/// Names and token that a request must state, and what proves to the page that this program answers.
pub struct Guard {
    hosts: [String; 2],
    origins: [String; 2],
    token: String,
    /// In each answer to a request with the token. The page keeps it in its memory alone and sends nothing to who does not know it: after the
    /// end of this program another user of the computer may listen on its port.
    proof: String,
}

impl Guard {
    /// For a port, with new random secrets.
    pub fn new(port: u16) -> io::Result<Self> {
        let hosts = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
        Ok(Self {
            origins: hosts.clone().map(|host| format!("http://{host}")),
            hosts,
            token: secret()?,
            proof: secret()?,
        })
    }

    /// The address of the page with the token.
    pub fn address(&self) -> String {
        format!("{}/#t={}", self.origins[0], self.token)
    }

    /// What proves that this program answers.
    pub fn proof(&self) -> &str {
        &self.proof
    }

    /// Refuses what does not come from a browser at this address: a page of another origin, or a name that leads here.
    pub fn check(&self, headers: &HeaderMap) -> Result<(), (StatusCode, &'static str)> {
        match only(headers, &HOST) {
            Some(host) if self.hosts.iter().any(|known| known == host) => {}
            _ => return Err((StatusCode::BAD_REQUEST, "open the printed address")),
        }
        if headers.contains_key(ORIGIN) {
            let origin = only(headers, &ORIGIN);
            if !origin.is_some_and(|origin| self.origins.iter().any(|known| known == origin)) {
                return Err((StatusCode::FORBIDDEN, "another page may not ask"));
            }
        }
        Ok(())
    }

    /// Refuses a request for work without token or of another type.
    pub fn check_work(&self, method: &Method, headers: &HeaderMap) -> Result<(), (StatusCode, &'static str)> {
        if method != Method::POST {
            return Err((StatusCode::METHOD_NOT_ALLOWED, "only POST is answered here"));
        }
        let stated = only(headers, &AUTHORIZATION).and_then(|text| text.strip_prefix("Bearer "));
        if !stated.is_some_and(|stated| same(stated.as_bytes(), self.token.as_bytes())) {
            return Err((
                StatusCode::UNAUTHORIZED,
                "open the printed address, which has the token",
            ));
        }
        if only(headers, &CONTENT_TYPE) != Some("application/json") {
            return Err((StatusCode::UNSUPPORTED_MEDIA_TYPE, "send application/json"));
        }
        Ok(())
    }
}

/// Without the secrets.
impl Debug for Guard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Guard")
            .field("hosts", &self.hosts)
            .finish_non_exhaustive()
    }
}

/// The value of a header that occurs once.
fn only<'h>(headers: &'h HeaderMap, name: &HeaderName) -> Option<&'h str> {
    let mut values = headers.get_all(name).iter();
    let value = values.next()?.to_str().ok()?;
    values.next().is_none().then_some(value)
}

/// Compares in a time that does not tell how much is equal.
fn same(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).fold(0, |different, (a, b)| different | (a ^ b)) == 0
}

/// 256 random bits in hexadecimal digits.
pub fn secret() -> io::Result<String> {
    let mut bytes = [0_u8; 32];
    getrandom::fill(&mut bytes).map_err(|error| io::Error::other(error.to_string()))?;
    let mut text = String::new();
    for byte in bytes {
        let _ = write!(text, "{byte:02x}");
    }
    Ok(text)
}
