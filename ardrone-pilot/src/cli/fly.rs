//! Flying: one plan and then exit, or a vehicle that stays and takes orders.

use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use ardrone_link::DroneAddress;
use autopilot::plan::{FlightLimits, Plan, Step, TagUse, given_tag_warnings};
use autopilot::vehicle::{Start, SurveyedTag, Telemetry, VehicleName};
use crossbeam_channel::bounded;
use mock_drone::server::{MockDrone, Ports};
use time::UtcDateTime;

use super::arguments::{Fly, WhichDrone};
use super::keys::{self, Keys};
use super::mavlink::Wanted;
use super::program::{self, AtEnd, Lines};
use super::progress::Progress;
use super::prompt::PromptLine;
use super::recipients::Recipients;
use super::screen::{Screen, Warnings};
use super::summary::{Summary, TrueWaypoint};
use super::{CommandError, read, read_settings, terminal};
use crate::browser::{Browser, Listener, PageConfig, Planning, SettingsFile, Shown};
use crate::flight::{Connections, Content, Controls, Flight, Message};
use crate::json;
use crate::mavlink::{self, MavlinkServer};
use crate::network;
use crate::recording::{self, Header, Recorder, Recording};
use crate::runtime::{Runtime, SecondSignal};
use crate::settings::Settings;
use crate::simulation;
use crate::timing::TimingReport;
use crate::video::Video;

/// Folder of the recordings unless another one is given.
const FLIGHTS: &str = "flights";
/// The settings that the page writes where none were given.
pub(super) const SETTINGS: &str = "pilot.toml";
/// Messages that may wait to be printed.
pub(super) const UNSHOWN: usize = 256;

/// Flies the plan, or stays and takes orders; returns the exit status.
pub(super) fn run(arguments: &Fly, warnings: &Warnings) -> Result<u8, CommandError> {
    let mut settings = read_settings(arguments.config.as_deref())?;
    if arguments.tags || !arguments.tag.is_empty() {
        settings.use_tags(&arguments.tag)?;
    }
    let config = settings.pilot_config(arguments.z_origin());
    let mavlink = arguments.interfaces.mavlink.wanted(&config)?;
    let surveyed = settings.surveyed_tags();
    let plan = arguments.plan.as_deref();
    let plan = plan.map(|path| read_plan(path, surveyed.as_deref(), &config.limits)).transpose()?;
    let plain = arguments.interfaces.plain || !std::io::stderr().is_terminal();
    let prompt = PromptLine::default();
    let mut progress = Progress::new(prompt.clone(), plain, [config.name]);
    for note in notes(plan.as_ref(), surveyed.as_deref(), &config.limits) {
        progress.print_line(&format!("note: {note}"));
    }
    let mock = if arguments.drone.mock {
        let ports = Ports { video: Some(0), ..Ports::LOOPBACK };
        Some(MockDrone::start(&simulation::world(&config, plan.as_ref()), ports)?)
    } else {
        None
    };
    let drone = mock.as_ref().map_or_else(|| drone_address(&arguments.drone), mock_address);
    progress.print_line(&beginning(plan.as_ref(), mock.is_some(), &drone));
    let listener = arguments.interfaces.ui.map(Listener::bind).transpose()?;
    let mavlink = mavlink.map(Station::bind).transpose()?;
    let mut stations: Vec<String> =
        listener.iter().map(|listener| format!("watch it at {}", listener.url())).collect();
    stations.extend(mavlink.as_ref().map(|station| station.wanted.to_string()));
    for line in &stations {
        progress.print_line(line);
    }
    if let Some(warning) = mavlink.as_ref().and_then(|station| station.wanted.warning) {
        progress.warn(warning);
    }
    let (recorder, recording) = match record(arguments, &settings, config.name, plan.as_ref())? {
        Some((recorder, recording)) => (Some(recorder), Some(recording)),
        None => (None, None),
    };
    let runtime = Runtime::start(SecondSignal::Exits).map_err(CommandError::Threads)?;
    let video = watch_video(&runtime, arguments, mock.as_ref(), recording.as_ref());
    let connections = Connections { recorder, ..Connections::default() };
    let flight = Flight::start(&runtime, plan.clone(), &config, &drone, connections)?;
    let controls = flight.controls();
    let open = |listener: Listener| {
        let shown = Shown {
            plan: plan.clone(),
            drone: drone_name(arguments).to_owned(),
            planning: Planning { config: config.clone(), surveyed: settings.surveyed_tags() },
            controls: controls.clone(),
            video: video.as_ref().map(Video::feed),
        };
        let page = page_config(arguments, &settings, recording.as_ref());
        listener.open(&runtime, page, vec![shown])
    };
    let browser = listener.map(open);
    let mavlink = mavlink.and_then(|station| station.open(&runtime, &controls, &mut progress));
    let recipients = Recipients::new(vec![controls.clone()]);
    let wanted = !plain && !arguments.interfaces.json && std::io::stdin().is_terminal();
    let screen = || Screen::start([config.limits], recipients.clone(), warnings, prompt.clone());
    let mut watch = Watch::new(progress, wanted.then(screen).flatten(), &stations);
    let keys = Keys::start(recipients.clone(), &config.limits, prompt);
    if keys.is_some() {
        watch.print_line(keys::HELP);
    } else if let Err(error) = read_orders(arguments, &config.limits, recipients) {
        watch.warn(&format!("no orders can be read: {error}"));
    }
    let (steps, truths) = (Vec::new(), Vec::new());
    let start = config.estimator.start.unwrap_or_default();
    let mut outputs = Outputs { arguments, steps, mock, start, browser, recording, truths };
    let unshown = pass_on(&flight, mavlink.as_ref(), |message| outputs.send(&message, &mut watch));
    drop((keys, mavlink));
    watch.end();
    let stays = arguments.plan.is_none();
    let mut finished = flight.finish()?;
    finished.dropped_messages += unshown;
    let status = match finished.outcome.exit_status() {
        _ if stays && controls.has_quit() && finished.is_down => 0,
        status => status,
    };
    // Nothing more is recorded, or shown.
    drop(video);
    let recorded = outputs.recording.and_then(Recording::finish);
    let end = json::end(&finished, recorded.as_ref(), status);
    if let Some(browser) = outputs.browser {
        browser.end(config.name, &end);
    }
    if arguments.interfaces.json {
        terminal::print_object(&end);
        return Ok(status);
    }
    terminal::print(Summary {
        finished: &finished,
        truths: &outputs.truths,
        recorded: recorded.as_ref(),
        flew_a_plan: !stays,
    });
    if arguments.interfaces.timing {
        terminal::print(TimingReport(&finished.ticks));
    }
    Ok(status)
}

/// The same text is recorded and flown.
fn read_plan(
    path: &Path,
    surveyed: Option<&[SurveyedTag]>,
    limits: &FlightLimits,
) -> Result<Plan, CommandError> {
    let text = read("the plan", path)?;
    // A note is enough if they are not in use.
    let tags = surveyed.map_or(TagUse::Unknown, TagUse::On);
    Ok(Plan::parse_with_tags(&path.display().to_string(), &text, limits, tags)?)
}

/// What is unwise in a plan and in the tags that are given; `None` if tags are not in use.
fn notes(
    plan: Option<&Plan>,
    surveyed: Option<&[SurveyedTag]>,
    limits: &FlightLimits,
) -> Vec<String> {
    let mut notes: Vec<String> = plan.into_iter().flat_map(Plan::notes).cloned().collect();
    let warnings = given_tag_warnings(surveyed.unwrap_or_default(), limits);
    notes.extend(warnings);
    if plan.is_some_and(Plan::uses_tags) && surveyed.is_none() {
        notes.push("the plan asks for tags, but they are not in use: add --tags".to_owned());
    }
    notes
}

fn beginning(plan: Option<&Plan>, mock: bool, drone: &DroneAddress) -> String {
    let drone =
        if mock { "the mock drone".to_owned() } else { format!("the drone at {}", drone.host) };
    match plan {
        Some(plan) => format!("flying {} with {drone}", plan.name()),
        None => format!("waiting for orders to {drone}"),
    }
}

/// Reads orders from standard input if no keys are read from it.
fn read_orders(
    arguments: &Fly,
    limits: &FlightLimits,
    recipients: Recipients,
) -> std::io::Result<()> {
    let lines = match (arguments.interfaces.json, arguments.plan.is_some()) {
        (true, _) => Lines::Json,
        (false, false) => Lines::Typed,
        // With a plan, standard input is ignored.
        (false, true) => return Ok(()),
    };
    let elsewhere = arguments.plan.is_some()
        || arguments.interfaces.ui.is_some()
        || arguments.interfaces.mavlink.is_given();
    let at_end = if elsewhere { AtEnd::GoOn } else { AtEnd::Quit };
    program::read_orders(lines, at_end, limits, recipients)
}

/// MAVLink before the flight.
pub(super) struct Station {
    pub(super) wanted: Wanted,
    listener: mavlink::Listener,
}

impl Station {
    pub(super) fn bind(wanted: Wanted) -> Result<Self, CommandError> {
        let listener = mavlink::Listener::bind(wanted.remotes.clone())?;
        Ok(Self { wanted, listener })
    }

    pub(super) fn open(
        self,
        runtime: &Runtime,
        controls: &Controls,
        progress: &mut Progress,
    ) -> Option<MavlinkServer> {
        let opened = self.listener.open(runtime, self.wanted.config, controls.clone());
        // Not fatal, because the drone may already be flying.
        opened.map_err(|error| progress.warn(&terminal::Causes(&error).to_string())).ok()
    }
}

/// Passes on the flight's messages until its end; returns how many were not shown because they came too fast.
///
/// Output that nobody takes holds up the thread that prints it. MAVLink's clients hear of the flight nevertheless: they are told
/// by another one.
fn pass_on(flight: &Flight, mavlink: Option<&MavlinkServer>, mut show: impl FnMut(Message)) -> u64 {
    let Some(mavlink) = mavlink else {
        flight.messages().for_each(show);
        return 0;
    };
    let (sender, messages) = bounded(UNSHOWN);
    let tell = move || {
        let told = flight.messages().inspect(|message| mavlink.show(message));
        told.map(|message| u64::from(sender.try_send(message).is_err())).sum()
    };
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().name("messages".to_owned());
        if let Ok(thread) = thread.spawn_scoped(scope, tell) {
            messages.iter().for_each(show);
            return thread.join().unwrap_or(0);
        }
        for message in flight.messages() {
            mavlink.show(&message);
            show(message);
        }
        0
    })
}

/// Distributes the flight's messages to all displays.
struct Outputs<'a> {
    arguments: &'a Fly,
    /// The mission's steps, for messages that refer to one of them.
    steps: Vec<Step>,
    mock: Option<MockDrone>,
    start: Start,
    browser: Option<Browser>,
    recording: Option<Recording>,
    truths: Vec<TrueWaypoint>,
}

impl Outputs<'_> {
    fn send(&mut self, message: &Message, watch: &mut Watch) {
        let telemetry = match &message.content {
            Content::Telemetry(_, telemetry, _) => Some(telemetry),
            Content::Realtime(_)
            | Content::Trouble(..)
            | Content::Said { .. }
            | Content::Heard { .. } => None,
        };
        if let Some(Telemetry::Mission { steps, .. }) = telemetry {
            self.steps.clone_from(steps);
        }
        if self.arguments.interfaces.json {
            terminal::print_object(&json::message(message, &self.steps));
        }
        if let (Some(Telemetry::Waypoint(waypoint)), Some(mock)) = (telemetry, &self.mock) {
            self.truths.push(TrueWaypoint::new(waypoint, &mock.truth(), &self.start));
        }
        if let Some(browser) = &self.browser {
            browser.show(message);
        }
        watch.show(message);
        if let Some(problem) = self.recording.as_ref().and_then(Recording::problem) {
            watch.warn(&problem.to_string());
        }
    }
}

/// Display for people.
pub(super) enum Watch {
    Lines(Progress),
    Screen(Box<Screen>),
}

impl Watch {
    /// A screen covers what was printed before: where the flight can be watched is repeated.
    pub(super) fn new(progress: Progress, screen: Option<Screen>, stations: &[String]) -> Self {
        let Some(mut screen) = screen else { return Self::Lines(progress) };
        for line in stations {
            screen.print_line(line);
        }
        Self::Screen(Box::new(screen))
    }

    pub(super) fn print_line(&mut self, line: &str) {
        match self {
            Self::Lines(progress) => progress.print_line(line),
            Self::Screen(screen) => screen.print_line(line),
        }
    }

    pub(super) fn warn(&mut self, line: &str) {
        match self {
            Self::Lines(progress) => progress.warn(line),
            Self::Screen(screen) => screen.warn(line),
        }
    }

    /// Something happens on the network.
    pub(super) fn tell(&mut self, at: Duration, told: &network::News) {
        let line = format!("{:6.1} s {told}", at.as_secs_f64());
        if told.warns() { self.warn(&line) } else { self.print_line(&line) }
    }

    /// What is seen of a vehicle that is flown elsewhere; lines tell only of what changes.
    pub(super) fn show_elsewhere(&mut self, seen: &network::Seen) {
        if let Self::Screen(screen) = self {
            screen.show_elsewhere(seen);
        }
    }

    pub(super) fn show(&mut self, message: &Message) {
        match self {
            Self::Lines(progress) => progress.show(message),
            Self::Screen(screen) => screen.show(message),
        }
    }

    /// Restores the terminal at the end of the flight.
    pub(super) fn end(self) {
        match self {
            Self::Lines(mut progress) => progress.end(),
            Self::Screen(screen) => {
                for warning in screen.end() {
                    terminal::print_message(warning);
                }
            }
        }
    }
}

/// The time, since the Unix epoch.
pub(super) fn since_epoch() -> Duration {
    (UtcDateTime::now() - UtcDateTime::UNIX_EPOCH).try_into().unwrap_or_default()
}

/// Starts recording the flight unless it is switched off.
fn record(
    arguments: &Fly,
    settings: &Settings,
    vehicle: VehicleName,
    plan: Option<&Plan>,
) -> Result<Option<(Recorder, Recording)>, CommandError> {
    if arguments.no_log {
        return Ok(None);
    }
    let start = since_epoch();
    let path = match &arguments.log {
        Some(path) => path.clone(),
        None => make_folder(FLIGHTS.into())?.join(recording::file_name(start, vehicle)),
    };
    let header = Header {
        vehicle,
        start,
        settings: settings.to_toml()?,
        z_origin: arguments.z_origin(),
        drone: drone_name(arguments).to_owned(),
        ..Header::default()
    };
    Ok(Some(record_to(&path, header, plan)?))
}

/// Starts recording a flight with a plan, or without one.
pub(super) fn record_to(
    path: &Path,
    header: Header,
    plan: Option<&Plan>,
) -> Result<(Recorder, Recording), CommandError> {
    let header = Header {
        plan_name: plan.map_or("", Plan::name).to_owned(),
        plan: plan.map_or("", Plan::text).to_owned(),
        ..header
    };
    let (mut recorder, recording) = Recorder::start(path, &header)?;
    for note in plan.into_iter().flat_map(Plan::notes) {
        recorder.note(Duration::ZERO, note.clone());
    }
    Ok((recorder, recording))
}

/// What the page offers besides the flight.
fn page_config(arguments: &Fly, settings: &Settings, recording: Option<&Recording>) -> PageConfig {
    PageConfig {
        plans: arguments.interfaces.plans.clone(),
        flights: log_folder(arguments),
        recordings: recording.iter().map(|recording| recording.path().to_owned()).collect(),
        settings: SettingsFile {
            path: arguments.config.clone().unwrap_or_else(|| PathBuf::from(SETTINGS)),
            is_used: arguments.config.is_some(),
            is_shared: false,
            in_effect: settings.clone(),
        },
        fleet: Vec::new(),
    }
}

/// The drone, for people.
fn drone_name(arguments: &Fly) -> &str {
    if arguments.drone.mock { "mock drone" } else { &arguments.drone.drone }
}

/// The folder in which this flight and others are recorded.
fn log_folder(arguments: &Fly) -> PathBuf {
    let parent = arguments.log.as_deref().and_then(Path::parent);
    match parent {
        Some(parent) if parent.as_os_str().is_empty() => PathBuf::from("."),
        Some(parent) => parent.to_owned(),
        None => PathBuf::from(FLIGHTS),
    }
}

/// Makes a folder unless there is one.
pub(super) fn make_folder(folder: PathBuf) -> Result<PathBuf, CommandError> {
    std::fs::create_dir_all(&folder).map_err(|source| CommandError::Write {
        what: "the folder",
        path: folder.display().to_string(),
        source,
    })?;
    Ok(folder)
}

/// Starts the video if the page may show it, or it is recorded.
fn watch_video(
    runtime: &Runtime,
    arguments: &Fly,
    mock: Option<&MockDrone>,
    recording: Option<&Recording>,
) -> Option<Video> {
    let recorder = recording.filter(|_| arguments.record_video).map(Recording::video);
    if recorder.is_none() && arguments.interfaces.ui.is_none() {
        return None;
    }
    let (host, port) = match mock.map(MockDrone::ports) {
        Some(ports) => (ports.host.to_string(), ports.video.unwrap_or_default()),
        None => (arguments.drone.drone.clone(), arguments.drone.video_port),
    };
    Some(Video::start(runtime, &host, port, recorder))
}

/// Where the drone is that is not simulated.
pub(super) fn drone_address(arguments: &WhichDrone) -> DroneAddress {
    DroneAddress {
        host: arguments.drone.clone(),
        at_port: arguments.at_port,
        navdata_port: arguments.navdata_port,
        control_port: arguments.control_port,
    }
}

/// Where a simulated drone is.
pub(super) fn mock_address(mock: &MockDrone) -> DroneAddress {
    let ports = mock.ports();
    DroneAddress {
        host: ports.host.to_string(),
        at_port: ports.at,
        navdata_port: ports.navdata,
        control_port: ports.control,
    }
}
