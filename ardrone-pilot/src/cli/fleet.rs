//! Flying several vehicles in one room.

use std::io::IsTerminal as _;
use std::path::PathBuf;

use ardrone_link::DroneAddress;
use autopilot::plan::Step;
use autopilot::vehicle::{Start, Telemetry, VehicleName};
use crossbeam_channel::{Receiver, bounded, never, select};
use mission_agent::MissionAgent;
use mock_drone::server::{Air, MockDrone, Ports};
use serde_json::{Value, json};

use super::arguments::FlyFleet;
use super::elsewhere::{self, Configured, Elsewhere};
use super::fly::{
    SETTINGS, Station, UNSHOWN, Watch, make_folder, mock_address, record_to, since_epoch,
};
use super::keys::{self, Keys};
use super::program::{self, AtEnd, Lines};
use super::progress::Progress;
use super::prompt::PromptLine;
use super::recipients::Recipients;
use super::screen::{Screen, Warnings};
use super::summary::{Summary, TrueWaypoint};
use super::{CommandError, terminal};
use crate::browser::{self, Listener, PageConfig, Planning, SettingsFile};
use crate::fleet::{Fleet, FleetError, Member};
use crate::flight::{
    Connections, Content, FinishedFlight, Flight, FlightError, Message, RemoteAgents, Seat,
};
use crate::json;
use crate::mavlink::MavlinkServer;
use crate::network::{self, Roster, Totals};
use crate::recording::{Header, Recorded, Recorder, Recording, file_name};
use crate::runtime::{Runtime, SecondSignal};
use crate::timing::TimingReport;
use crate::video::Video;

/// Exit statuses of flights, the worst first; 0 is none of them.
const WORST_FIRST: [u8; 8] = [50, 40, 10, 30, 60, 130, 20, 1];

/// Why the vehicles of a fleet cannot be flown.
#[derive(Debug, thiserror::Error)]
pub(super) enum MembersError {
    /// Two have the same drone.
    #[error(
        "{} and {} are both to fly the drone at {host}: give each its own `drone`, or --mock",
        .vehicles[0], .vehicles[1]
    )]
    OneDrone {
        /// Whose.
        vehicles: [VehicleName; 2],
        /// Where.
        host: String,
    },
}

/// A vehicle before its flight.
struct Prepared<'a> {
    member: &'a Member,
    agent: Option<MissionAgent>,
    mock: Option<MockDrone>,
    drone: DroneAddress,
    station: Option<Station>,
    recorder: Option<Recorder>,
    recording: Option<Recording>,
}

/// A vehicle in its flight.
struct Under<'a> {
    member: &'a Member,
    flight: Flight,
    mavlink: Option<MavlinkServer>,
    video: Option<Video>,
}

/// What is shown of a vehicle, and remains of it at the end.
struct Shown {
    mock: Option<MockDrone>,
    start: Start,
    flies_a_plan: bool,
    recording: Option<Recording>,
    steps: Vec<Step>,
    truths: Vec<TrueWaypoint>,
}

/// Flies a fleet; returns the worst exit status.
pub(super) fn run(arguments: &FlyFleet, warnings: &Warnings) -> Result<u8, CommandError> {
    let fleet = Fleet::read(&arguments.fleet, arguments.z_origin())?;
    let plain = arguments.interfaces.plain || !std::io::stderr().is_terminal();
    let prompt = PromptLine::default();
    let roster = elsewhere::roster(&fleet, &arguments.vehicle)?;
    let here: Vec<&Member> = roster.places(true).map(|place| &fleet.members[place]).collect();
    let names = here.iter().map(|member| member.config.name);
    let mut progress = Progress::new(prompt.clone(), plain, names);
    if !fleet.warnings.is_empty() {
        progress.print_line(&fleet.warnings.to_string());
    }
    if !arguments.mock {
        own_drones(&here.iter().copied())?;
    }
    let net = arguments.net.as_deref().map(Configured::read).transpose()?;
    for place in roster.places(false) {
        progress.print_line(&format!("{}: flown elsewhere", roster.vehicles[place].name));
    }
    let prepared = prepare(&fleet, &here, arguments, &mut progress)?;
    let listener = arguments.interfaces.ui.map(Listener::bind).transpose()?;
    let stations: Vec<String> =
        listener.iter().map(|listener| format!("watch it at {}", listener.url())).collect();
    for line in &stations {
        progress.print_line(line);
    }
    let runtime = Runtime::start(SecondSignal::Exits).map_err(CommandError::Threads)?;
    let begin = Begin { runtime: &runtime, roster: &roster, has_page: listener.is_some() };
    let (mut elsewhere, flying, mut shown) = begin.all(prepared, net, &mut progress)?;
    let open = |listener: Listener| {
        let page = page_config(arguments, &fleet, &shown);
        listener.open(&runtime, page, flying.iter().map(Under::on_page).collect())
    };
    let browser = listener.map(open);
    let recipients = Recipients::new(flying.iter().map(|under| under.flight.controls()).collect());
    let limits = here[0].config.limits;
    let wanted = !plain && !arguments.interfaces.json && std::io::stdin().is_terminal();
    let all_limits = here.iter().map(|member| member.config.limits);
    let screen = || Screen::start(all_limits, recipients.clone(), warnings, prompt.clone());
    let mut watch = Watch::new(progress, wanted.then(screen).flatten(), &stations);
    let keys = Keys::start(recipients.clone(), &limits, prompt);
    if keys.is_some() {
        watch.print_line(keys::HELP);
        watch.print_line(keys::HELP_OF_FLEET);
    } else if let Some((lines, at_end)) = input(arguments, &here)
        && let Err(error) = program::read_orders(lines, at_end, &limits, recipients)
    {
        watch.warn(&format!("no orders can be read: {error}"));
    }
    let mut ended = Vec::new();
    pass_on(flying, &elsewhere.news(), |news| {
        for seen in elsewhere.look() {
            if let Some(browser) = &browser {
                browser.show_elsewhere(&seen);
            }
            watch.show_elsewhere(&seen);
        }
        let (place, news) = match news {
            News::Network(told) => {
                let at = elsewhere.time();
                if arguments.interfaces.json {
                    terminal::print_object(&told.json(at));
                }
                if let Some(browser) = &browser {
                    browser.tell_all(at, &told);
                }
                return watch.tell(at, &told);
            }
            News::Of(place, news) => (place, news),
        };
        let one = &mut shown[place];
        match news {
            OfOne::Message(message) => {
                one.take_in(&message, arguments.interfaces.json);
                if let Some(browser) = &browser {
                    browser.show(&message);
                }
                watch.show(&message);
            }
            OfOne::End(end) => {
                let end = one.end(*end);
                if let (Some(browser), Ok(end)) = (&browser, &end) {
                    browser.end(end.finished.vehicle, &end.json());
                }
                if let (true, Ok(end)) = (arguments.interfaces.json, &end) {
                    terminal::print_object(&end.json());
                }
                ended.push((place, end));
            }
        }
        if let Some(problem) = one.recording.as_ref().and_then(Recording::problem) {
            watch.warn(&problem.to_string());
        }
    });
    drop(keys);
    watch.end();
    let totals = elsewhere.end();
    ended.sort_by_key(|(place, _)| *place);
    let status = print_ends(arguments, ended, &shown)?;
    print_end(arguments, status, totals.as_ref());
    Ok(status)
}

/// Says how the program ends, and what became of the network.
fn print_end(arguments: &FlyFleet, status: u8, totals: Option<&Totals>) {
    if arguments.interfaces.json {
        let mut end = json!({ "type": "fleet_end", "exit_status": status });
        if let Some(totals) = totals {
            end["network"] = totals.json();
        }
        terminal::print_object(&end);
    } else if let Some(totals) = totals {
        terminal::print(totals);
    }
}

/// What all flights begin with.
struct Begin<'r> {
    runtime: &'r Runtime,
    roster: &'r Roster,
    has_page: bool,
}

impl Begin<'_> {
    /// Begins all flights, and to hear the vehicles elsewhere.
    fn all<'a>(
        &self,
        prepared: Vec<Prepared<'a>>,
        net: Option<Configured>,
        progress: &mut Progress,
    ) -> Result<(Elsewhere, Vec<Under<'a>>, Vec<Shown>), CommandError> {
        let vehicles = &self.roster.vehicles;
        let seats: Vec<Seat> = Seat::in_one_room(vehicles.iter().map(|entry| entry.name)).collect();
        let mut elsewhere = Elsewhere::begin(net, self.runtime, self.roster, seats[0].places())?;
        // The seats of vehicles elsewhere are left: nobody here hears what is said to their agents.
        let seats = seats.into_iter().enumerate().filter(|(place, _)| vehicles[*place].is_here);
        let begin = prepared.into_iter().zip(seats).map(|(one, (place, seat))| {
            // Those that have begun land if one cannot.
            one.begin(self, seat, elsewhere.remote_agents(place), progress)
        });
        let begun = begin.collect::<Result<Vec<_>, FlightError>>()?;
        let (flying, shown) = begun.into_iter().unzip();
        Ok((elsewhere, flying, shown))
    }
}

/// Says how the flights ended; returns the worst exit status.
fn print_ends(
    arguments: &FlyFleet,
    ended: Vec<(usize, Result<End, FlightError>)>,
    shown: &[Shown],
) -> Result<u8, FlightError> {
    let mut statuses = Vec::new();
    for (place, end) in ended {
        let end = end?;
        if !arguments.interfaces.json {
            terminal::print(format_args!("{}: ", end.finished.vehicle));
            terminal::print(end.summary(&shown[place].truths));
            if arguments.interfaces.timing {
                terminal::print(TimingReport(&end.finished.ticks));
            }
        }
        statuses.push(end.status);
    }
    Ok(WORST_FIRST.into_iter().find(|status| statuses.contains(status)).unwrap_or(0))
}

impl<'a> Prepared<'a> {
    /// Begins its flight, with what its camera sees for a page.
    fn begin(
        self,
        Begin { runtime, has_page, .. }: &Begin<'_>,
        seat: Seat,
        remote_agents: Option<Box<dyn RemoteAgents>>,
        progress: &mut Progress,
    ) -> Result<(Under<'a>, Shown), FlightError> {
        let Prepared { member, agent, mock, drone, station, recorder, recording } = self;
        let connections = Connections { recorder, agent, remote_agents, seat: Some(seat) };
        let flight =
            Flight::start(runtime, member.plan.clone(), &member.config, &drone, connections)?;
        let controls = flight.controls();
        let mavlink = station.and_then(|station| station.open(runtime, &controls, progress));
        let video = (*has_page).then(|| camera(runtime, member, mock.as_ref()));
        let start = member.config.estimator.start.unwrap_or_default();
        let (steps, truths) = (Vec::new(), Vec::new());
        let flies_a_plan = member.has_a_mission();
        let shown = Shown { mock, start, flies_a_plan, recording, steps, truths };
        Ok((Under { member, flight, mavlink, video }, shown))
    }
}

impl Under<'_> {
    /// Passes on its messages until its end; `show` returns whether there was room for one.
    fn until_its_end(self, show: impl Fn(Message) -> bool) -> Result<Left, FlightError> {
        let Self { flight, mavlink, .. } = self;
        let mut unshown = 0;
        for message in flight.messages() {
            if let Some(mavlink) = &mavlink {
                mavlink.show(&message);
            }
            unshown += u64::from(!show(message));
        }
        let has_quit = flight.controls().has_quit();
        let mut finished = flight.finish()?;
        finished.dropped_messages += unshown;
        Ok(Left { finished, has_quit })
    }

    fn on_page(&self) -> browser::Shown {
        let Member { config, plan, settings, drone, .. } = self.member;
        let planning = Planning { config: config.clone(), surveyed: settings.surveyed_tags() };
        browser::Shown {
            plan: plan.clone(),
            drone: drone.host.clone(),
            planning,
            controls: self.flight.controls(),
            video: self.video.as_ref().map(Video::feed),
        }
    }
}

/// What a vehicle's camera sees.
fn camera(runtime: &Runtime, member: &Member, mock: Option<&MockDrone>) -> Video {
    let (host, port) = match mock.map(MockDrone::ports) {
        Some(ports) => (ports.host.to_string(), ports.video.unwrap_or_default()),
        None => (member.drone.host.clone(), member.video_port),
    };
    Video::start(runtime, &host, port, None)
}

/// What the page offers besides the flights.
fn page_config(arguments: &FlyFleet, fleet: &Fleet, shown: &[Shown]) -> PageConfig {
    let names = fleet.members.iter().map(|member| member.config.name);
    let recordings = shown.iter().filter_map(|one| one.recording.as_ref());
    PageConfig {
        plans: arguments.interfaces.plans.clone(),
        flights: arguments.log.clone(),
        recordings: recordings.map(|recording| recording.path().to_owned()).collect(),
        settings: SettingsFile {
            // Where `config` of the fleet would look for it.
            path: fleet.config.clone().unwrap_or_else(|| arguments.fleet.with_file_name(SETTINGS)),
            is_used: fleet.config.is_some(),
            is_shared: true,
            in_effect: fleet.settings.clone(),
        },
        fleet: names.collect(),
    }
}

/// Each vehicle needs a drone of its own.
pub(super) fn own_drones<'a>(
    members: &(impl Iterator<Item = &'a Member> + Clone),
) -> Result<(), MembersError> {
    for (number, member) in members.clone().enumerate() {
        let same = members.clone().take(number).find(|other| other.drone == member.drone);
        if let Some(other) = same {
            let vehicles = [other.config.name, member.config.name];
            return Err(MembersError::OneDrone { vehicles, host: member.drone.host.clone() });
        }
    }
    Ok(())
}

/// Starts all that can fail before the first drone flies.
fn prepare<'a>(
    fleet: &Fleet,
    here: &[&'a Member],
    arguments: &FlyFleet,
    progress: &mut Progress,
) -> Result<Vec<Prepared<'a>>, CommandError> {
    let begun = since_epoch();
    let logs = (!arguments.no_log).then(|| make_folder(arguments.log.clone())).transpose()?;
    // Simulated drones feel and disturb each other.
    let air = Air::default();
    let mut all = Vec::new();
    for member in here {
        let name = member.config.name;
        let mock = if arguments.mock {
            let ports = Ports { video: Some(0), ..Ports::LOOPBACK };
            Some(MockDrone::start_in(&air, &member.world(), ports)?)
        } else {
            None
        };
        let drone = mock.as_ref().map_or_else(|| member.drone.clone(), mock_address);
        let label = if mock.is_some() { "mock drone" } else { &drone.host };
        progress.print_line(&beginning(member, label));
        let station =
            arguments.interfaces.mavlink.wanted(&member.config)?.map(Station::bind).transpose()?;
        if let Some(station) = &station {
            progress.print_line(&format!("{name}: {}", station.wanted));
            if let Some(warning) = station.wanted.warning {
                progress.warn(warning);
            }
        }
        let header = Header {
            vehicle: name,
            start: begun,
            settings: member.settings.to_toml()?,
            z_origin: arguments.z_origin(),
            drone: label.to_owned(),
            mission_agent: member.agent.as_ref().map_or("", |(agent, _)| agent).to_owned(),
            ..Header::default()
        };
        let path = logs
            .as_ref()
            .map(|folder| folder.join(file_name(begun, format_args!("{}-{name}", fleet.name))));
        let record = |path: PathBuf| record_to(&path, header, member.plan.as_ref());
        let (recorder, recording) = path.map(record).transpose()?.unzip();
        let agent = member.new_agent().map_err(FleetError::from)?;
        all.push(Prepared { member, agent, mock, drone, station, recorder, recording });
    }
    Ok(all)
}

fn beginning(member: &Member, drone: &str) -> String {
    let name = member.config.name;
    match (&member.plan, &member.agent) {
        (Some(plan), _) => format!("{name}: flying {} with {drone}", plan.name()),
        (None, Some((agent, _))) => format!("{name}: the agent {agent} flies {drone}"),
        (None, None) => format!("{name}: waiting for orders to {drone}"),
    }
}

/// How standard input is read if no keys are.
fn input(arguments: &FlyFleet, here: &[&Member]) -> Option<(Lines, AtEnd)> {
    let waits = !here.iter().all(|member| member.has_a_mission());
    let at_end =
        if waits && !arguments.interfaces.mavlink.is_given() { AtEnd::Quit } else { AtEnd::GoOn };
    match (arguments.interfaces.json, waits) {
        (true, _) => Some((Lines::Json, at_end)),
        (false, true) => Some((Lines::Typed, at_end)),
        // With plans, standard input is ignored.
        (false, false) => None,
    }
}

/// What there is to show.
#[allow(clippy::large_enum_variant, reason = "the large one is the usual one")]
enum News {
    /// Of the vehicle with this place among those that are flown here.
    Of(usize, OfOne),
    Network(network::News),
}

/// What comes of a flight.
#[allow(clippy::large_enum_variant, reason = "the large one is the usual one")]
enum OfOne {
    Message(Message),
    End(Box<Result<Left, FlightError>>),
}

/// A flight that has ended, and whether an operator wanted that.
struct Left {
    finished: FinishedFlight,
    has_quit: bool,
}

/// Passes on what comes of all flights until their ends, and of the network meanwhile.
///
/// Output that nobody takes holds up the thread that prints it. MAVLink's clients hear of the flights nevertheless: they are told
/// by the threads that wait for them.
fn pass_on(flying: Vec<Under<'_>>, network: &Receiver<network::News>, mut show: impl FnMut(News)) {
    let (sender, news) = bounded::<News>(UNSHOWN * flying.len());
    std::thread::scope(|scope| {
        for (place, under) in flying.into_iter().enumerate() {
            let sender = sender.clone();
            scope.spawn(move || {
                let end = Box::new(under.until_its_end(|message| {
                    sender.try_send(News::Of(place, OfOne::Message(message))).is_ok()
                }));
                // It is received until all have sent theirs.
                _ = sender.send(News::Of(place, OfOne::End(end)));
            });
        }
        drop(sender);
        let never = never();
        let mut network = network;
        loop {
            select! {
                recv(news) -> told => match told {
                    Ok(told) => show(told),
                    // All have ended.
                    Err(_) => break,
                },
                recv(network) -> told => match told {
                    Ok(told) => show(News::Network(told)),
                    Err(_) => network = &never,
                },
            }
        }
    });
}

/// A vehicle's flight at its end.
struct End {
    finished: FinishedFlight,
    recorded: Option<Recorded>,
    flew_a_plan: bool,
    status: u8,
}

impl End {
    fn json(&self) -> Value {
        json::end(&self.finished, self.recorded.as_ref(), self.status)
    }

    fn summary<'a>(&'a self, truths: &'a [TrueWaypoint]) -> Summary<'a> {
        let Self { finished, recorded, flew_a_plan, .. } = self;
        Summary { finished, truths, recorded: recorded.as_ref(), flew_a_plan: *flew_a_plan }
    }
}

impl Shown {
    fn take_in(&mut self, message: &Message, as_json: bool) {
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
        if as_json {
            terminal::print_object(&json::message(message, &self.steps));
        }
        if let (Some(Telemetry::Waypoint(waypoint)), Some(mock)) = (telemetry, &self.mock) {
            self.truths.push(TrueWaypoint::new(waypoint, &mock.truth(), &self.start));
        }
    }

    /// Nothing more is recorded.
    fn end(&mut self, left: Result<Left, FlightError>) -> Result<End, FlightError> {
        let recorded = self.recording.take().and_then(Recording::finish);
        let (Left { finished, has_quit }, flew_a_plan) = (left?, self.flies_a_plan);
        let status = match finished.outcome.exit_status() {
            _ if !flew_a_plan && has_quit && finished.is_down => 0,
            status => status,
        };
        Ok(End { finished, recorded, flew_a_plan, status })
    }
}
