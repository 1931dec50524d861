//! HTTP and WebSocket server of the page.

use std::net::TcpListener;
use std::pin::pin;
use std::sync::atomic::{AtomicU16, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use autopilot::vehicle::{Operator, OperatorOrder, Refused, Station, VehicleName};
use axum::extract::ws::{self, WebSocket, WebSocketUpgrade};
use axum::extract::{Request, State};
use axum::http::header::{
    CACHE_CONTROL, CONNECTION, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HOST, HeaderMap, ORIGIN,
    REFERRER_POLICY, X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{HeaderName, HeaderValue, StatusCode, Uri};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use axum::{Extension, Router};
use futures_util::stream::{SplitSink, SplitStream};
use futures_util::{SinkExt as _, StreamExt as _};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use rustix::net::sockopt::set_socket_send_buffer_size;
use serde_json::{Value, json};
use tokio::net::TcpStream;
use tokio::sync::{OwnedSemaphorePermit, Semaphore, broadcast, mpsc, oneshot};
use tokio::task::{JoinSet, block_in_place};
use tokio::time::{Instant, sleep, timeout};
use tokio_io_timeout::TimeoutStream;

use super::access::{Access, Claims, Local, Refusal};
use super::files::{Files, PLAN_BYTES, vehicle_of};
use super::pictures;
use super::planning::Planning;
use super::requests::{Requested, Requests};
use super::snapshot::Snapshot;
use crate::flight::{Controls, answer_of_all};
use crate::runtime::{Runtime, Task};
use crate::video::VideoFeed;

/// Maximum number of simultaneous HTTP connections; further ones wait in the system's queue.
const CONNECTIONS: usize = 64;
/// Maximum number of simultaneous viewers.
const VIEWERS: u32 = 16;
/// Messages that a browser may fall behind before it gets a new snapshot.
const BEHIND: usize = 64;
/// Timeout of sending a request, and of a response of which nothing is taken.
const REQUEST_TIME: Duration = Duration::from_secs(5);
/// A browser that accepts no data for this time is disconnected.
const WRITE_TIME: Duration = Duration::from_secs(2);
/// Time for delivering the last messages at the end of the flight.
const PARTING_TIME: Duration = Duration::from_millis(500);
/// Send buffer of a WebSocket: some seconds of messages.
const SEND_BYTES: usize = 32 << 10;
/// Longest response, a recording over a slow network.
const RESPONSE_TIME: Duration = Duration::from_mins(10);
/// Maximum size of a message of the page: a plan as JSON.
const REQUEST_BYTES: usize = 2 * PLAN_BYTES;
/// How long a page waits between requests that nobody could click so fast: MAVLink's messages share the threads.
const FAST_WAIT: Duration = Duration::from_millis(10);
/// Longest request that is read at once. A longer one is a plan, and reading it is work: they take turns, so that one of the
/// threads that serve all pages is free. Not at a low priority: a landing may stand behind it.
const QUICKLY_READ_BYTES: usize = 512;
/// Maximum data waiting to be written on a connection.
const WRITE_BYTES: usize = 1 << 20;

/// A part of the page, which contains nothing secret.
#[derive(Debug, Clone, Copy)]
struct Asset {
    path: &'static str,
    kind: &'static str,
    text: &'static str,
}

macro_rules! script {
    ($name:literal) => {
        Asset {
            path: concat!("/", $name),
            kind: "text/javascript; charset=utf-8",
            text: include_str!(concat!("page/", $name)),
        }
    };
}

/// The page itself comes first.
const ASSETS: [Asset; 15] = [
    Asset { path: "/", kind: "text/html; charset=utf-8", text: include_str!("page/index.html") },
    Asset {
        path: "/page.css",
        kind: "text/css; charset=utf-8",
        text: include_str!("page/page.css"),
    },
    script!("page.js"),
    script!("fleet.js"),
    script!("talk.js"),
    script!("history.js"),
    script!("heights.js"),
    script!("dangers.js"),
    script!("map.js"),
    script!("video.js"),
    script!("sticks.js"),
    script!("plan.js"),
    script!("flights.js"),
    script!("plots.js"),
    script!("settings.js"),
];
/// No content from elsewhere, and no framing: an invisible button must not be clicked (clickjacking).
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; \
    img-src 'self' data: blob:; frame-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// Serves the page until this is dropped.
#[derive(Debug)]
pub(super) struct Server {
    shared: Arc<Shared>,
    task: Task<()>,
}

impl Server {
    pub(super) fn start(
        runtime: &Runtime,
        listener: TcpListener,
        access: Access,
        files: Files,
        vehicles: Vec<Vehicle>,
    ) -> Self {
        let shared = Arc::new(Shared {
            access,
            files: Arc::new(files),
            vehicles,
            viewers: Arc::new(Semaphore::new(VIEWERS as usize)),
            long_requests: Semaphore::new(1),
            pages: AtomicU16::new(0),
            watchers: Arc::new(Semaphore::new(VIEWERS as usize)),
        });
        let served = Arc::clone(&shared);
        let task = runtime.run("serving the page", |ended| serve_until(ended, listener, served));
        Self { shared, task }
    }

    /// Updates the snapshot of a vehicle and sends the change to all its viewers, and what others see of it to those of the
    /// others.
    pub(super) fn publish(&self, name: VehicleName, change: impl FnOnce(&mut Snapshot) -> Value) {
        let Some(vehicle) = self.shared.named(Some(name.as_str())) else { return };
        let seen = {
            let mut stage = vehicle.stage();
            let object = change(&mut stage.snapshot);
            stage.send(&object);
            stage.snapshot.as_other(&object)
        };
        let Some(seen) = seen else { return };
        for other in self.shared.vehicles.iter().filter(|other| other.name() != name) {
            let mut stage = other.stage();
            stage.snapshot.take_in_other(name, &seen);
            stage.send(&seen);
        }
    }
}

impl Server {
    /// Updates the snapshots of all vehicles, each for its viewers.
    pub(super) fn publish_to_all(&self, change: impl Fn(&mut Snapshot) -> Value) {
        for vehicle in &self.shared.vehicles {
            let mut stage = vehicle.stage();
            let object = change(&mut stage.snapshot);
            stage.send(&object);
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // Dropping the sender ends the viewers' streams after the last message.
        for vehicle in &self.shared.vehicles {
            vehicle.stage().sender = None;
        }
        self.task.end();
    }
}

/// State shared by all connections.
#[derive(Debug)]
struct Shared {
    access: Access,
    files: Arc<Files>,
    vehicles: Vec<Vehicle>,
    viewers: Arc<Semaphore>,
    long_requests: Semaphore,
    /// Pages so far, each of which is an operator.
    pages: AtomicU16,
    /// Places for those who see the video.
    watchers: Arc<Semaphore>,
}

/// A vehicle of the page.
#[derive(Debug)]
pub(super) struct Vehicle {
    planning: Planning,
    controls: Controls,
    stage: Mutex<Stage>,
    video: Option<VideoFeed>,
}

/// The snapshot and the stream of changes, under one lock so that a new viewer misses nothing between the
/// two.
#[derive(Debug)]
struct Stage {
    snapshot: Snapshot,
    sender: Option<broadcast::Sender<ws::Utf8Bytes>>,
}

impl Stage {
    fn send(&self, object: &Value) {
        if let Some(sender) = &self.sender {
            // Without viewers there is no receiver.
            _ = sender.send(ws::Utf8Bytes::from(object.to_string()));
        }
    }
}

impl Shared {
    /// The vehicle with this name; the first one if none is asked for.
    fn named(&self, name: Option<&str>) -> Option<&Vehicle> {
        match name {
            Some(name) => self.vehicles.iter().find(|vehicle| vehicle.name().as_str() == name),
            None => self.vehicles.first(),
        }
    }

    /// Lands all; returns the vehicle's answer if none hears it.
    fn land_all(&self, by: Operator) -> Result<(), Refused> {
        let land = |vehicle: &Vehicle| vehicle.controls.order(by, OperatorOrder::Land);
        answer_of_all(self.vehicles.iter().map(land))
    }
}

impl Vehicle {
    pub(super) fn new(
        snapshot: Snapshot,
        planning: Planning,
        controls: Controls,
        video: Option<VideoFeed>,
    ) -> Self {
        let stage = Stage { snapshot, sender: Some(broadcast::Sender::new(BEHIND)) };
        Self { planning, controls, stage: Mutex::new(stage), video }
    }

    fn name(&self) -> VehicleName {
        self.planning.config.name
    }

    fn stage(&self) -> std::sync::MutexGuard<'_, Stage> {
        self.stage.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The current snapshot and a receiver of later changes; none after the end.
    fn join(&self) -> (ws::Utf8Bytes, Option<broadcast::Receiver<ws::Utf8Bytes>>) {
        let stage = self.stage();
        let snapshot = stage.snapshot.so_far().to_string();
        (snapshot.into(), stage.sender.as_ref().map(broadcast::Sender::subscribe))
    }
}

async fn serve_until(ended: oneshot::Receiver<()>, listener: TcpListener, shared: Arc<Shared>) {
    let viewers = Arc::clone(&shared.viewers);
    tokio::select! {
        () = serve(listener, shared) => {}
        // The flight has ended.
        _ = ended => {}
    }
    // Viewers that are slower than this miss the end.
    _ = timeout(PARTING_TIME, viewers.acquire_many(VIEWERS)).await;
}

/// Accepts connections; never returns. They end with it.
async fn serve(listener: TcpListener, shared: Arc<Shared>) {
    let listener = match tokio::net::TcpListener::from_std(listener) {
        Ok(listener) => listener,
        Err(error) => {
            tracing::error!("no page: {error}");
            return std::future::pending().await;
        }
    };
    let mut app = Router::new().route("/live", get(live)).route("/video", get(video));
    for Asset { path, kind, text } in ASSETS {
        app = app.route(path, get(move || async move { ([(CONTENT_TYPE, kind)], text) }));
    }
    let app = app
        .with_state(Arc::clone(&shared))
        .merge(shared.files.router())
        .layer(middleware::from_fn_with_state(shared, guard));
    let places = Arc::new(Semaphore::new(CONNECTIONS));
    let mut connections = JoinSet::new();
    loop {
        while connections.try_join_next().is_some() {}
        // The semaphore is never closed.
        let Ok(place) = Arc::clone(&places).acquire_owned().await else { return };
        match listener.accept().await {
            Ok((stream, peer)) => {
                let app = app.clone().layer(Extension(Local(peer.ip().is_loopback())));
                drop(connections.spawn(connection(stream, app, place)));
            }
            // Too many open files: waits until some are closed.
            Err(_) => sleep(Duration::from_millis(100)).await,
        }
    }
}

/// Serves one HTTP connection.
async fn connection(stream: TcpStream, app: Router, place: OwnedSemaphorePermit) {
    // Small messages must not be delayed (Nagle), because they would show the past. If the system refuses
    // this option the page is only slower.
    _ = stream.set_nodelay(true);
    _ = set_socket_send_buffer_size(&stream, SEND_BYTES);
    let mut stream = TimeoutStream::new(stream);
    stream.set_write_timeout(Some(REQUEST_TIME));
    let served = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(REQUEST_TIME)
        .serve_connection(TokioIo::new(Box::pin(stream)), TowerToHyperService::new(app))
        .with_upgrades();
    // A client that disconnects or is too slow is not an error here.
    _ = timeout(RESPONSE_TIME, served).await;
    drop(place);
}

/// Checks access, and adds security headers to the response.
async fn guard(State(shared): State<Arc<Shared>>, request: Request, next: Next) -> Response {
    let mut response = match check(&shared.access, request.uri(), request.headers()) {
        Ok(()) => next.run(request).await,
        Err(refusal) => (StatusCode::FORBIDDEN, format!("{refusal}\n")).into_response(),
    };
    // A connection that waits for another request would keep a place from others. One that is upgraded goes on.
    if response.status() != StatusCode::SWITCHING_PROTOCOLS {
        response.headers_mut().insert(CONNECTION, HeaderValue::from_static("close"));
    }
    for (name, value) in [
        (CONTENT_SECURITY_POLICY, POLICY),
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (REFERRER_POLICY, "no-referrer"),
        (CACHE_CONTROL, "no-store"),
        (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
    ] {
        // A report has a policy of its own.
        response.headers_mut().entry(name).or_insert(HeaderValue::from_static(value));
    }
    response
}

fn check(access: &Access, uri: &Uri, headers: &HeaderMap) -> Result<(), Refusal> {
    let mut parameters = uri.query().unwrap_or_default().split('&');
    let claims = Claims {
        host: headers.get(HOST).and_then(|host| host.to_str().ok()),
        // An origin that is not valid text cannot be ours.
        origin: headers.get(ORIGIN).map(|origin| origin.to_str().unwrap_or_default()),
        token: parameters.find_map(|parameter| parameter.strip_prefix("token=")),
    };
    // They load without the token.
    let orders = !ASSETS.iter().skip(1).any(|asset| asset.path == uri.path());
    access.check(claims, orders)
}

/// Opens the WebSocket that carries the flight's messages and the page's orders.
async fn live(
    State(shared): State<Arc<Shared>>,
    Extension(Local(local)): Extension<Local>,
    uri: Uri,
    upgrade: WebSocketUpgrade,
) -> Response {
    let name = vehicle_of(&uri).map(str::to_owned);
    if shared.named(name.as_deref()).is_none() {
        return no_vehicle();
    }
    let Ok(place) = Arc::clone(&shared.viewers).try_acquire_owned() else {
        let full = "too many pages watch this flight: close one\n";
        return (StatusCode::SERVICE_UNAVAILABLE, full).into_response();
    };
    let number = shared.pages.fetch_add(1, Ordering::Relaxed).wrapping_add(1);
    let by = Operator { station: Station::Browser, number, local };
    upgrade
        .max_message_size(REQUEST_BYTES)
        .max_frame_size(REQUEST_BYTES)
        .max_write_buffer_size(WRITE_BYTES)
        .on_upgrade(move |socket| async move {
            // It was there, and none is taken away.
            let Some(vehicle) = shared.named(name.as_deref()) else { return };
            let (sink, stream) = socket.split();
            let (answers, answered) = mpsc::channel(BEHIND);
            reply(&answers, &json!({ "type": "you", "name": by.to_string(), "local": by.local }));
            // Orders are received even while writing is blocked.
            let mut written = pin!(write(sink, vehicle, answered));
            let garbage = tokio::select! {
                () = &mut written => None,
                garbage = read(stream, &shared, vehicle, answers, by) => garbage,
            };
            // Each request is answered before the end. What arrives meanwhile is thrown away: what is left unread would
            // reset the connection, and the answers with it.
            if let Some(mut stream) = garbage {
                let parting = async {
                    tokio::select! {
                        () = written => {}
                        () = discard(&mut stream) => {}
                    }
                    discard(&mut stream).await;
                };
                // Whoever does not end by itself is disconnected.
                _ = timeout(WRITE_TIME, parting).await;
            }
            // A page that is gone must not keep the controls. If the queue is full, a local operator can
            // still take them.
            _ = vehicle.controls.order(by, OperatorOrder::Release);
            drop(place);
        })
}

fn no_vehicle() -> Response {
    (StatusCode::NOT_FOUND, "there is no such vehicle\n").into_response()
}

/// Opens the WebSocket that carries the pictures of the drone's camera.
async fn video(State(shared): State<Arc<Shared>>, uri: Uri, upgrade: WebSocketUpgrade) -> Response {
    let Some(vehicle) = shared.named(vehicle_of(&uri)) else { return no_vehicle() };
    let Some(feed) = vehicle.video.clone() else {
        return (StatusCode::NOT_FOUND, "there is no video\n").into_response();
    };
    let Ok(place) = Arc::clone(&shared.watchers).try_acquire_owned() else {
        let full = "too many pages show the video: close one\n";
        return (StatusCode::SERVICE_UNAVAILABLE, full).into_response();
    };
    upgrade.max_message_size(REQUEST_BYTES).max_frame_size(REQUEST_BYTES).on_upgrade(
        move |socket| async move {
            pictures::show(socket, &feed).await;
            drop(place);
        },
    )
}

/// Sends the snapshot, then changes, until the flight has ended or the page is gone.
async fn write(
    mut sink: SplitSink<WebSocket, ws::Message>,
    vehicle: &Vehicle,
    mut answers: mpsc::Receiver<ws::Utf8Bytes>,
) {
    let (mut text, mut receiver) = vehicle.join();
    loop {
        match timeout(WRITE_TIME, sink.send(ws::Message::Text(text))).await {
            Ok(Ok(())) => {}
            Ok(Err(_)) | Err(_) => return,
        }
        let Some(changes) = &mut receiver else { break };
        text = tokio::select! {
            next = changes.recv() => match next {
                Ok(next) => next,
                Err(broadcast::error::RecvError::Lagged(_)) => {
                    let (snapshot, again) = vehicle.join();
                    receiver = again;
                    snapshot
                }
                Err(broadcast::error::RecvError::Closed) => break,
            },
            answer = answers.recv() => match answer {
                Some(answer) => answer,
                // Nothing more is read, and everything is answered.
                None => break,
            },
        };
    }
    // The page may be gone already.
    _ = timeout(WRITE_TIME, sink.send(ws::Message::Close(None))).await;
}

fn accepted(order: &str) -> Value {
    json!({ "type": "accepted", "order": order })
}

fn refused(order: Option<&str>, reason: &str) -> Value {
    json!({ "type": "refused", "order": order, "reason": reason })
}

/// Queues an answer; dropped if the page does not read.
fn reply(answers: &mpsc::Sender<ws::Utf8Bytes>, answer: &Value) {
    _ = answers.try_send(answer.to_string().into());
}

/// Reads until the other end is gone, no faster than a page's orders.
async fn discard(stream: &mut SplitStream<WebSocket>) {
    while let Some(Ok(_)) = stream.next().await {
        sleep(FAST_WAIT).await;
    }
}

/// Passes on a page's orders until it is gone, or sends garbage: the stream is returned then.
async fn read(
    mut stream: SplitStream<WebSocket>,
    shared: &Shared,
    vehicle: &Vehicle,
    answers: mpsc::Sender<ws::Utf8Bytes>,
    by: Operator,
) -> Option<SplitStream<WebSocket>> {
    let start = Instant::now();
    let mut requests = Requests::default();
    loop {
        if requests.are_fast() {
            sleep(FAST_WAIT).await;
        }
        let Some(Ok(message)) = stream.next().await else { return None };
        let text = match &message {
            ws::Message::Text(text) => text.as_str(),
            ws::Message::Binary(_) => "",
            ws::Message::Ping(_) | ws::Message::Pong(_) => continue,
            ws::Message::Close(_) => return None,
        };
        let now = start.elapsed();
        let mut order = || requests.order(now, text, &vehicle.planning);
        let requested = if text.len() > QUICKLY_READ_BYTES {
            // The semaphore is never closed.
            let _turn = shared.long_requests.acquire().await;
            block_in_place(order)
        } else {
            order()
        };
        let answer = match requested {
            Ok(Requested::Armed) => json!({ "type": "armed" }),
            Ok(Requested::LandAll) => match shared.land_all(by) {
                Ok(()) => accepted("land"),
                Err(why) => refused(Some("land"), &why.to_string()),
            },
            Ok(Requested::Order(order)) => {
                let (answers, name) = (answers.clone(), order.name());
                let ordered = vehicle.controls.order_answered(by, order, move |answer| {
                    let answer = match answer {
                        Ok(()) => accepted(name),
                        Err(why) => refused(Some(name), &why.to_string()),
                    };
                    reply(&answers, &answer);
                });
                match ordered {
                    Ok(()) => continue,
                    Err(why) => refused(Some(name), &why.to_string()),
                }
            }
            Err(error) => refused(None, &error.to_string()),
        };
        reply(&answers, &answer);
        if requests.is_garbage() {
            return Some(stream);
        }
    }
}
