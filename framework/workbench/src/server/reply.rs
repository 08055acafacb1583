//! From a request of HTTP to its answer.

use std::sync::Arc;
use std::time::Duration;

use http_body_util::{BodyExt as _, Limited};
use hyper::body::{Bytes, Incoming};
use hyper::header::{
    CACHE_CONTROL, CONNECTION, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HeaderName, HeaderValue, REFERRER_POLICY,
    RETRY_AFTER, X_CONTENT_TYPE_OPTIONS,
};
use hyper::{Method, Request, Response, StatusCode};
use tokio::time::timeout;

use super::activity::Activity;
use super::page::{POLICY, REPORT_POLICY, file};
use super::stream::{Answer, Answered};
use super::work::Work;

/// Maximum length of a request.
const LONGEST: usize = 4 << 20;

/// How long the body of a request may take.
const SLOWEST: Duration = Duration::from_secs(30);

/// In answers to requests with the token.
const PROOF: HeaderName = HeaderName::from_static("gearloss-proof");

/// When a page may ask again for what is refused because there is too much work. \[s\]
const LATER: HeaderValue = HeaderValue::from_static("1");

/// Answers a request, or refuses it and closes the connection.
pub async fn reply(work: &Arc<Work>, request: Request<Incoming>, activity: &Arc<Activity>) -> Response<Answer> {
    let busy = activity.work();
    let answered = match work.guard.check(request.headers()) {
        Ok(()) => routed(work, request, activity).await,
        Err(refused) => Err(refused),
    };
    let response = answered.unwrap_or_else(refusal);
    response.map(|answered| Answer { answered, _busy: busy })
}

/// Says why a request is refused, and closes the connection.
fn refusal((status, why): Refused) -> Response<Answered> {
    let mut response = response("text/plain; charset=utf-8", POLICY, whole(format!("{why}\n")));
    *response.status_mut() = status;
    let headers = response.headers_mut();
    headers.insert(CONNECTION, HeaderValue::from_static("close"));
    if status == StatusCode::SERVICE_UNAVAILABLE {
        headers.insert(RETRY_AFTER, LATER);
    }
    response
}

type Refused = (StatusCode, &'static str);

async fn routed(
    work: &Arc<Work>,
    request: Request<Incoming>,
    activity: &Activity,
) -> Result<Response<Answered>, Refused> {
    let path = request.uri().path();
    if path == "/api" {
        work.guard.check_work(request.method(), request.headers())?;
        activity.know();
        let mut response = asked(work, request).await.unwrap_or_else(refusal);
        if let Ok(proof) = HeaderValue::from_str(work.guard.proof()) {
            response.headers_mut().insert(PROOF, proof);
        }
        return Ok(response);
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
    let body = body.ok_or((StatusCode::SERVICE_UNAVAILABLE, "the program is busy, ask again"))?;
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
