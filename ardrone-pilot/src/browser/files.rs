//! Plans and recorded flights of the page: requests that read and write files, or think for a while.
//!
//! They run on threads of their own with the lowest priority, one at a time of each kind, so that no client takes the
//! processor from the flight.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use axum::body::{Body, to_bytes};
use axum::extract::{Path, State};
use axum::http::header::{
    CONTENT_DISPOSITION, CONTENT_LENGTH, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HeaderMap,
    IF_NONE_MATCH,
};
use axum::http::{StatusCode, Uri};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Extension, Router};
use bytes::BytesMut;
use futures_util::stream;
use serde_json::{Value, json};
use tokio::io::AsyncReadExt as _;
use tokio::sync::Semaphore;
use tokio::time::timeout;

use super::access::Local;
use super::folder::{Entry, Folder, FolderError};
use super::planning::Planning;
use super::settings_file::{ChangeError, SettingsFile};
use crate::flights::{RecordedFlight, flights};
use crate::recording::{Log, LogError, pictures};
use crate::report::{ReportError, Reports};

/// Maximum size of a plan; those that can be flown are much smaller.
pub(super) const PLAN_BYTES: usize = 32 << 10;
/// Maximum size of a recording that is read beside a flight: its memory is locked, which holds up the tick. The command
/// line reads larger ones.
const LOG_BYTES: u64 = 128 << 20;
/// Time for sending a plan.
const BODY_TIME: Duration = Duration::from_secs(5);
/// Size of the parts in which a recording is sent.
const PART_BYTES: usize = 64 << 10;
/// Recordings whose flights are remembered.
const REMEMBERED: usize = 1000;
/// A report's script and style are in it. It is shown in a frame, without access to the page.
const REPORT_POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; \
    style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'; \
    frame-ancestors 'self'; sandbox allow-scripts";

/// Where the files are, and by what plans are checked.
#[derive(Debug)]
pub(super) struct Files {
    /// Of each vehicle.
    plannings: Vec<Planning>,
    plans: Folder,
    flights: Folder,
    /// The recordings that are being written.
    current: Vec<PathBuf>,
    settings: SettingsFile,
    /// Checks of plans, and lists.
    quick: Semaphore,
    /// Simulations and reports.
    slow: Semaphore,
    /// The flights of recordings that were read already.
    known: Mutex<BTreeMap<(String, u64, SystemTime), Value>>,
}

/// Why a request is not served.
#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error(transparent)]
    Folder(#[from] FolderError),
    #[error("a plan is text of at most {PLAN_BYTES} bytes")]
    NoPlan,
    #[error("there is no such vehicle")]
    NoVehicle,
    #[error("the plan took too long to arrive")]
    Slow,
    #[error("{0}: {1}")]
    Log(String, LogError),
    #[error("{0}: {1}")]
    Report(String, ReportError),
    #[error("{0} has no flight {1}")]
    NoFlight(String, usize),
    #[error("{0} is being recorded")]
    Current(String),
    #[error(transparent)]
    Settings(#[from] ChangeError),
    #[error("settings are changed on the machine that flies")]
    Elsewhere,
    #[error("this cannot be done; the terminal says why")]
    Panicked,
}

impl IntoResponse for Failure {
    fn into_response(self) -> Response {
        let status = match &self {
            Self::Folder(FolderError::Name(..)) | Self::NoPlan => StatusCode::BAD_REQUEST,
            Self::Folder(FolderError::Missing(_)) | Self::NoFlight(..) | Self::NoVehicle => {
                StatusCode::NOT_FOUND
            }
            Self::Folder(FolderError::Exists(_)) => StatusCode::PRECONDITION_FAILED,
            Self::Folder(FolderError::TooLarge(..)) => StatusCode::PAYLOAD_TOO_LARGE,
            Self::Slow => StatusCode::REQUEST_TIMEOUT,
            Self::Current(_) => StatusCode::CONFLICT,
            Self::Elsewhere => StatusCode::FORBIDDEN,
            Self::Settings(ChangeError::File(..)) => StatusCode::INTERNAL_SERVER_ERROR,
            Self::Log(..) | Self::Report(..) | Self::Settings(_) => {
                StatusCode::UNPROCESSABLE_ENTITY
            }
            Self::Folder(FolderError::System(..)) | Self::Panicked => {
                StatusCode::INTERNAL_SERVER_ERROR
            }
        };
        (status, format!("{self}\n")).into_response()
    }
}

type Shared = State<Arc<Files>>;

/// An answer in JSON.
#[derive(Debug)]
struct Json(Value);

impl IntoResponse for Json {
    fn into_response(self) -> Response {
        ([(CONTENT_TYPE, "application/json")], self.0.to_string()).into_response()
    }
}

impl Files {
    pub(super) fn new(
        plannings: Vec<Planning>,
        plans: PathBuf,
        flights: PathBuf,
        current: Vec<PathBuf>,
        settings: SettingsFile,
    ) -> Self {
        Self {
            plannings,
            settings,
            plans: Folder::new(plans, ".txt"),
            flights: Folder::new(flights, ".mcap"),
            current,
            quick: Semaphore::new(1),
            slow: Semaphore::new(1),
            known: Mutex::default(),
        }
    }

    /// Of the vehicle with this name; of the first one if none is asked for.
    fn planning(&self, name: Option<&str>) -> Option<&Planning> {
        match name {
            Some(name) => self.plannings.iter().find(|it| it.config.name.as_str() == name),
            None => self.plannings.first(),
        }
    }

    /// The requests.
    pub(super) fn router(self: &Arc<Self>) -> Router {
        Router::new()
            .route("/plan/check", post(check))
            .route("/plan/simulate", post(simulate))
            .route("/settings", get(show_settings).put(change_settings))
            .route("/plans", get(list_plans))
            .route("/plans/{name}", get(read_plan).put(save_plan))
            .route("/flights", get(list_flights))
            .route("/flights/{name}", get(download).delete(delete))
            .route("/flights/{name}/summary", get(summary))
            .route("/flights/{name}/report", get(show_last_report))
            .route("/flights/{name}/report/{flight}", get(show_report))
            .route("/flights/{name}/track/{flight}", get(track))
            .with_state(Arc::clone(self))
    }

    async fn quickly<T: Send + 'static>(
        self: Arc<Self>,
        work: impl FnOnce(&Self) -> T + Send + 'static,
    ) -> Result<T, Failure> {
        // The semaphores are never closed.
        let _turn = self.quick.acquire().await;
        aside(Arc::clone(&self), work).await
    }

    async fn slowly<T: Send + 'static>(
        self: Arc<Self>,
        work: impl FnOnce(&Self) -> T + Send + 'static,
    ) -> Result<T, Failure> {
        let _turn = self.slow.acquire().await;
        aside(Arc::clone(&self), work).await
    }

    fn is_current(&self, name: &str) -> bool {
        self.current.iter().any(|current| self.flights.is(name, current))
    }

    /// What was decided in a recording.
    fn log(&self, name: &str) -> Result<Log, Failure> {
        let file = self.flights.read(name, LOG_BYTES)?;
        Log::read_decisions(&file).map_err(|error| Failure::Log(name.to_owned(), error))
    }

    /// The page about a flight of a recording, or about its last one.
    fn report(&self, name: String, index: Option<usize>) -> Result<String, Failure> {
        let file = self.flights.read(&name, LOG_BYTES)?;
        let bad = |error| Failure::Log(name.clone(), error);
        let (log, pictures) = (Log::read(&file).map_err(bad)?, pictures(&file).map_err(bad)?);
        let reports = Reports::new(&log, &pictures);
        // Relative to the page that is asked for.
        let folder = if index.is_some() { "" } else { "report/" };
        let page =
            reports.html(index.unwrap_or(reports.count() - 1), |index| format!("{folder}{index}"));
        page.map_err(|error| match error {
            ReportError::NoFlight(number) => Failure::NoFlight(name, number),
            ReportError::Empty => Failure::Report(name, error),
        })
    }

    /// Description of a recording. One that is finished is read once.
    fn summary(&self, name: &str) -> Result<Value, Failure> {
        let (file, bytes) = self.flights.open(name)?;
        let modified = file.metadata().and_then(|metadata| metadata.modified());
        let key = (name.to_owned(), bytes, modified.unwrap_or(SystemTime::UNIX_EPOCH));
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(summary) = known().get(&key) {
            return Ok(summary.clone());
        }
        let log = self.log(name)?;
        let flights: Vec<Value> = flights(&log).iter().map(RecordedFlight::json).collect();
        let summary = json!({
            "name": name,
            "bytes": bytes,
            "start_s": log.start.as_secs(),
            "vehicle": log.vehicle,
            "drone": log.drone,
            "version": log.version,
            "complete": log.complete,
            "current": self.is_current(name),
            "flights": flights,
        });
        if log.complete {
            let mut known = known();
            if known.len() >= REMEMBERED {
                known.clear();
            }
            known.insert(key, summary.clone());
        }
        Ok(summary)
    }
}

/// Does work on a thread that yields to all others.
async fn aside<T: Send + 'static>(
    files: Arc<Files>,
    work: impl FnOnce(&Files) -> T + Send + 'static,
) -> Result<T, Failure> {
    let done = tokio::task::spawn_blocking(move || {
        // Of this thread alone; elsewhere it would be that of the tick, too. A system that refuses it shares the processor
        // more evenly.
        #[cfg(target_os = "linux")]
        {
            _ = rustix::process::setpriority_process(None, 19);
        }
        work(&files)
    });
    done.await.map_err(|error| {
        tracing::error!("a request of the page failed: {error}");
        Failure::Panicked
    })
}

async fn text(body: Body) -> Result<String, Failure> {
    let body = timeout(BODY_TIME, to_bytes(body, PLAN_BYTES)).await.map_err(|_| Failure::Slow)?;
    let body = body.map_err(|_| Failure::NoPlan)?;
    String::from_utf8(body.into()).map_err(|_| Failure::NoPlan)
}

/// The vehicle that a request asks for by `vehicle=NAME`.
pub(super) fn vehicle_of(uri: &Uri) -> Option<&str> {
    let mut parameters = uri.query().unwrap_or_default().split('&');
    parameters.find_map(|parameter| parameter.strip_prefix("vehicle="))
}

async fn check(State(files): Shared, uri: Uri, body: Body) -> Result<Json, Failure> {
    let text = text(body).await?;
    let plans = move |files: &Files| Some(files.planning(vehicle_of(&uri))?.check(&text));
    files.quickly(plans).await?.map(Json).ok_or(Failure::NoVehicle)
}

async fn simulate(State(files): Shared, uri: Uri, body: Body) -> Result<Json, Failure> {
    let text = text(body).await?;
    let plans = move |files: &Files| Some(files.planning(vehicle_of(&uri))?.simulate(&text));
    files.slowly(plans).await?.map(Json).ok_or(Failure::NoVehicle)
}

async fn show_settings(State(files): Shared) -> Result<Json, Failure> {
    Ok(Json(files.quickly(|files| files.settings.json()).await??))
}

/// They decide where later flights may go, which nobody far away does.
async fn change_settings(
    State(files): Shared,
    Extension(Local(is_local)): Extension<Local>,
    body: Body,
) -> Result<(), Failure> {
    if !is_local {
        return Err(Failure::Elsewhere);
    }
    let text = text(body).await?;
    Ok(files.quickly(move |files| files.settings.change(&text)).await??)
}

async fn list_plans(State(files): Shared) -> Result<Json, Failure> {
    let plans = files.quickly(|files| files.plans.list()).await??;
    Ok(Json(plans.into_iter().map(|plan| plan.name).collect()))
}

async fn read_plan(State(files): Shared, Path(name): Path<String>) -> Result<Response, Failure> {
    let content = files.quickly(move |files| files.plans.read(&name, PLAN_BYTES as u64)).await??;
    let text = String::from_utf8(content).map_err(|_| Failure::NoPlan)?;
    Ok(([(CONTENT_TYPE, "text/plain; charset=utf-8")], text).into_response())
}

/// With `If-None-Match: *` nothing is replaced.
async fn save_plan(
    State(files): Shared,
    Path(name): Path<String>,
    headers: HeaderMap,
    body: Body,
) -> Result<StatusCode, Failure> {
    let text = text(body).await?;
    let replaces = !headers.contains_key(IF_NONE_MATCH);
    let save = move |files: &Files| files.plans.write(&name, text.as_bytes(), replaces);
    files.quickly(save).await??;
    Ok(StatusCode::NO_CONTENT)
}

/// The names, newest first as they are named after their time.
async fn list_flights(State(files): Shared) -> Result<Json, Failure> {
    let list = |files: &Files| -> Result<Value, FolderError> {
        let entry = |entry: Entry| json!({ "name": entry.name, "bytes": entry.bytes, "current": files.is_current(&entry.name) });
        Ok(files.flights.list()?.into_iter().rev().map(entry).collect())
    };
    Ok(Json(files.quickly(list).await??))
}

async fn summary(State(files): Shared, Path(name): Path<String>) -> Result<Json, Failure> {
    files.slowly(move |files| files.summary(&name)).await?.map(Json)
}

/// The page of the last flight of a recording.
async fn show_last_report(
    State(files): Shared,
    Path(name): Path<String>,
) -> Result<Response, Failure> {
    files.slowly(move |files| files.report(name, None)).await?.map(page)
}

/// The page of a flight, counted as by [`track`].
async fn show_report(
    State(files): Shared,
    Path((name, index)): Path<(String, usize)>,
) -> Result<Response, Failure> {
    files.slowly(move |files| files.report(name, Some(index))).await?.map(page)
}

fn page(page: String) -> Response {
    let headers =
        [(CONTENT_TYPE, "text/html; charset=utf-8"), (CONTENT_SECURITY_POLICY, REPORT_POLICY)];
    (headers, page).into_response()
}

async fn track(
    State(files): Shared,
    Path((name, index)): Path<(String, usize)>,
) -> Result<Json, Failure> {
    let read = move |files: &Files| {
        let log = files.log(&name)?;
        let flights = flights(&log);
        let flight = flights.get(index).ok_or(Failure::NoFlight(name, index))?;
        Ok(json!({ "track": flight.track(&log) }))
    };
    files.slowly(read).await?.map(Json)
}

async fn download(State(files): Shared, Path(name): Path<String>) -> Result<Response, Failure> {
    let disposition = format!("attachment; filename=\"{}\"", name.escape_default());
    let (file, bytes) = files.quickly(move |files| files.flights.open(&name)).await??;
    // A recording may grow meanwhile.
    let file = tokio::fs::File::from_std(file).take(bytes);
    let parts = stream::try_unfold(file, |mut file| async move {
        let mut part = BytesMut::with_capacity(PART_BYTES);
        let read = file.read_buf(&mut part).await?;
        Ok::<_, std::io::Error>((read > 0).then(|| (part.freeze(), file)))
    });
    let headers = [
        (CONTENT_TYPE, "application/octet-stream".to_owned()),
        (CONTENT_DISPOSITION, disposition),
        (CONTENT_LENGTH, bytes.to_string()),
    ];
    Ok((headers, Body::from_stream(parts)).into_response())
}

async fn delete(State(files): Shared, Path(name): Path<String>) -> Result<StatusCode, Failure> {
    let delete = move |files: &Files| {
        if files.is_current(&name) {
            return Err(Failure::Current(name));
        }
        Ok(files.flights.delete(&name)?)
    };
    files.quickly(delete).await??;
    Ok(StatusCode::NO_CONTENT)
}
