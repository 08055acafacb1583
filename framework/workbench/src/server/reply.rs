//! From a request of HTTP to its answer.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use http_body_util::{BodyExt as _, Limited};
use hyper::body::{Bytes, Incoming};
use hyper::header::{
    CACHE_CONTROL, CONNECTION, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HeaderName, HeaderValue, REFERRER_POLICY,
    X_CONTENT_TYPE_OPTIONS,
};
use hyper::{Method, Request, Response, StatusCode};
use tokio::time::timeout;

use super::page::{POLICY, REPORT_POLICY, file};
use super::stream::Answered;
use super::work::Work;

/// Maximum length of a request.
const LONGEST: usize = 4 << 20;

/// How long the body of a request may take.
const SLOWEST: Duration = Duration::from_secs(30);

/// Answers a request, or refuses it and closes the connection. `known` is set once a request has shown the token.
pub async fn reply(work: &Arc<Work>, request: Request<Incoming>, known: &AtomicBool) -> Response<Answered> {
    let answered = match work.guard.check(request.headers()) {
        Ok(()) => routed(work, request, known).await,
        Err(refused) => Err(refused),
    };
    answered.unwrap_or_else(|(status, why)| {
        let mut response = response("text/plain; charset=utf-8", POLICY, whole(format!("{why}\n")));
        *response.status_mut() = status;
        let headers = response.headers_mut();
        headers.insert(CONNECTION, HeaderValue::from_static("close"));
        response
    })
}

type Refused = (StatusCode, &'static str);

async fn routed(
    work: &Arc<Work>,
    request: Request<Incoming>,
    known: &AtomicBool,
) -> Result<Response<Answered>, Refused> {
    let path = request.uri().path();
    if path == "/api" {
        work.guard.check_work(request.method(), request.headers())?;
        known.store(true, Ordering::Relaxed);
        return asked(work, request).await;
    }
    if request.method() != Method::GET {
        return Err((StatusCode::METHOD_NOT_ALLOWED, "only GET is answered here"));
    }
    if let Some(html) = work.report(path) {
        let body = Answered::Whole(Some(html));
        return Ok(response("text/html; charset=utf-8", REPORT_POLICY, body));
    }
    let (kind, text) = file(path).ok_or((StatusCode::NOT_FOUND, "there is no such page"))?;
    Ok(response(
        kind,
        POLICY,
        Answered::Whole(Some(Bytes::from_static(text.as_bytes()))),
    ))
}

async fn asked(work: &Arc<Work>, request: Request<Incoming>) -> Result<Response<Answered>, Refused> {
    let body = Limited::new(request.into_body(), LONGEST).collect();
    let body = timeout(SLOWEST, body).await;
    let body = body.map_err(|_| (StatusCode::REQUEST_TIMEOUT, "the request took too long"))?;
    let body = body.map_err(|_| (StatusCode::PAYLOAD_TOO_LARGE, "the request has more than 4 MB"))?;
    let asked = serde_json::from_slice(&body.to_bytes());
    let asked = asked.map_err(|_| (StatusCode::BAD_REQUEST, "this request is not known"))?;
    let body = work.answer(asked).await;
    let kind = match body {
        Answered::Whole(_) => "application/json",
        Answered::Lines { .. } => "application/x-ndjson",
    };
    Ok(response(kind, POLICY, body))
}

fn whole(text: String) -> Answered {
    Answered::Whole(Some(text.into()))
}

fn response(kind: &'static str, policy: &'static str, body: Answered) -> Response<Answered> {
    let mut response = Response::new(body);
    let headers = response.headers_mut();
    let mut set = |name: HeaderName, value: &'static str| headers.insert(name, HeaderValue::from_static(value));
    set(CONTENT_TYPE, kind);
    set(CONTENT_SECURITY_POLICY, policy);
    set(X_CONTENT_TYPE_OPTIONS, "nosniff");
    set(REFERRER_POLICY, "no-referrer");
    set(CACHE_CONTROL, "no-store");
    set(HeaderName::from_static("cross-origin-resource-policy"), "same-origin");
    set(HeaderName::from_static("cross-origin-opener-policy"), "same-origin");
    response
}
