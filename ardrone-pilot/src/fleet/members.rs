//! The vehicles of a fleet: read from its file, its settings and its plans.

use std::io;
use std::path::{Path, PathBuf};

use ardrone_link::DroneAddress;
use autopilot::plan::{FlightLimits, Plan, PlanError, TagUse, ZOrigin, given_tag_warnings};
use autopilot::separation::{MAX_NEIGHBOURS, unsure_m};
use autopilot::vehicle::{CannotFly, VehicleConfig, VehicleName};
use diagnostic::{Diagnostic, Diagnostics, Severity, SourceText, Span};
use kinematics::Pose;
use mission_agent::{MissionAgent, NoAgent};
use mock_drone::WorldConfig;
use nalgebra::Vector2;
use toml::{Spanned, Table, Value};

use super::file::{self, Vehicle, Written};
use crate::settings::{Settings, SettingsError, read_versioned};
use crate::{simulation, text_file};

/// Most vehicles of a fleet: each keeps apart from all others.
const MOST: usize = MAX_NEIGHBOURS + 1;
/// Drones nearer to each other hear each other's ultrasound if theirs has the same frequency (Parrot's developer guide).
const ULTRASOUND_M: f64 = 3.0;

/// Several vehicles with their plans.
#[derive(Debug)]
pub struct Fleet {
    /// Its name, a part of the name of the folder of its logs.
    pub name: VehicleName,
    /// At least one, and at most 32.
    pub members: Vec<Member>,
    /// The settings that all have in common, and the file of those.
    pub settings: Settings,
    /// See `settings`.
    pub config: Option<PathBuf>,
    /// What is unwise.
    pub warnings: Diagnostics,
}

/// One vehicle of a fleet.
#[derive(Debug)]
pub struct Member {
    /// All its settings: those of the fleet with its own.
    pub settings: Settings,
    /// The same for the vehicle.
    pub config: VehicleConfig,
    /// What it flies; without one it takes orders, of its agent or of operators.
    pub plan: Option<Plan>,
    /// The name of its agent, which is built in, and the places of which that one may ask.
    pub agent: Option<(String, Vec<Pose>)>,
    /// Charge of its drone at the start if it is simulated, in percent; as usual otherwise.
    pub mock_battery: Option<f64>,
    /// Its drone.
    pub drone: DroneAddress,
    /// TCP port of its drone's video.
    pub video_port: u16,
}

/// Why there is no fleet.
#[derive(Debug, thiserror::Error)]
pub enum FleetError {
    /// A file cannot be read.
    #[error("cannot read {what} {path}")]
    Read {
        /// What it is.
        what: &'static str,
        /// It.
        path: String,
        /// The system's error.
        source: io::Error,
    },
    /// The file is no TOML, or has an unknown key or a wrong type; with line and column.
    #[error("{path}: {message}")]
    Syntax {
        /// The file.
        path: String,
        /// The problem and its place.
        message: String,
    },
    /// What it describes cannot fly.
    #[error("{0}")]
    Invalid(Diagnostics),
    /// The settings of all, or of one, are wrong.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// A plan cannot be flown.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A vehicle has no agent of this name.
    #[error(transparent)]
    Agent(#[from] NoAgent),
    /// A vehicle refuses its plan or its limits.
    #[error(transparent)]
    Refused(#[from] CannotFly),
}

impl Member {
    /// The world of a simulated drone in its place.
    pub fn world(&self) -> WorldConfig {
        let mut world = simulation::world(&self.config, self.plan.as_ref());
        if let Some(percent) = self.mock_battery {
            world.drone.battery_percent = percent;
        }
        world
    }

    /// A new agent for it, if it has one.
    ///
    /// # Errors
    /// [`NoAgent`] if that is not built in, or none of its peers is called like the vehicle.
    pub fn new_agent(&self) -> Result<Option<MissionAgent>, NoAgent> {
        let agent = self.agent.as_ref().map(|(agent, places)| {
            let uses_tags = self.config.estimator.tags.is_some();
            MissionAgent::new(agent, self.config.name.as_str(), places.clone(), uses_tags)
        });
        agent.transpose()
    }

    /// Whether it flies something by itself: a plan, or what its agent wants.
    pub fn has_a_mission(&self) -> bool {
        self.plan.is_some() || self.agent.is_some()
    }
}

impl Fleet {
    /// Reads a fleet with its settings and plans, whose paths are relative to its file.
    ///
    /// # Errors
    /// [`FleetError`] if a file cannot be read or has errors, an agent is not built in, or a plan or its vehicle's limits cannot
    /// be flown.
    pub fn read(path: &Path, z_origin: ZOrigin) -> Result<Self, FleetError> {
        let name = path.display().to_string();
        let text = read("the fleet", path)?;
        let written: Written =
            read_versioned::<_, { file::VERSION }>(&text).map_err(|error| FleetError::Syntax {
                path: name.clone(),
                message: error.to_string().trim_end().to_owned(),
            })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let config = written.fleet.config.as_ref().map(|config| folder.join(config.get_ref()));
        // What it leaves out of the fence is as in the settings.
        let table: Table = toml::from_str(&text).unwrap_or_default();
        let fence = table.get("fence").and_then(Value::as_table);
        let invalid = |findings| {
            let source = SourceText { name: name.clone(), text: text.clone() };
            Diagnostics::new([source], findings)
        };
        let mut settings = settings_of_all(&written, config.as_deref(), &invalid)?;
        if let Err(error) = settings.share(fence, written.fleet.separation_m) {
            let SettingsError::Values { reasons, .. } = error else { return Err(error.into()) };
            let reasons = reasons.iter().map(|reason| out_of_range(&text, reason)).collect();
            return Err(FleetError::Invalid(invalid(reasons)));
        }
        let config_of_all = settings.pilot_config(z_origin);
        let mut findings = findings(&written, &config_of_all, text.trim_end().len());
        findings.extend(file_findings(&written, &settings, &config_of_all, folder));
        let findings = invalid(findings);
        if findings.has_errors() {
            let mut list = findings.clone().into_vec();
            list.retain(|finding| finding.severity == Severity::Error);
            return Err(FleetError::Invalid(findings.with(list)));
        }
        let systems: Vec<u8> = systems(&written).collect();
        let members = written.vehicle.iter().zip(&systems).map(|(vehicle, system)| {
            let peers = systems.iter().copied().filter(|peer| peer != system).collect();
            member(vehicle, *system, peers, &settings, folder, z_origin)
        });
        let members = members.collect::<Result<_, _>>()?;
        let name = written.fleet.name.unwrap_or_else(file::usual_name);
        Ok(Self { name, members, settings, config, warnings: findings })
    }
}

/// The file of settings that all have, or the usual ones; `invalid` is what findings are shown with.
fn settings_of_all(
    written: &Written,
    config: Option<&Path>,
    invalid: &impl Fn(Vec<Diagnostic>) -> Diagnostics,
) -> Result<Settings, FleetError> {
    let (Some(path), Some(place)) = (config, &written.fleet.config) else {
        return Ok(Settings::default());
    };
    let text = text_file::read(path).map_err(|error| {
        let finding = cannot_read("the settings", path, &error, place.span());
        FleetError::Invalid(invalid(vec![finding]))
    })?;
    let name = path.display().to_string();
    let settings = Settings::parse(&name, &text)?;
    settings.for_all(&name)?;
    Ok(settings)
}

fn cannot_read(what: &str, path: &Path, error: &io::Error, place: Span) -> Diagnostic {
    Diagnostic::error(format!("cannot read {what} {}: {error}", path.display()), place)
        .help("its path is relative to the folder of this file")
}

/// A value of the fleet's file that no flight can have, for this reason, which begins with its name in the settings.
fn out_of_range(text: &str, reason: &str) -> Diagnostic {
    let in_file = reason.replace("room.separation_m", "fleet.separation_m");
    let name = in_file.split(' ').next().unwrap_or_default();
    let (section, value) = name.split_once('.').unwrap_or((name, ""));
    let place = file::place_of(text, section, value);
    Diagnostic::error(in_file, place)
}

/// Plans that cannot be read, and tags that nobody may see.
fn file_findings(
    written: &Written,
    settings: &Settings,
    config: &VehicleConfig,
    folder: &Path,
) -> Vec<Diagnostic> {
    let mut findings = Vec::new();
    for plan in written.vehicle.iter().filter_map(|vehicle| vehicle.plan.as_ref()) {
        let path = folder.join(plan.get_ref());
        if let Err(error) = text_file::read(&path) {
            findings.push(cannot_read("the plan", &path, &error, plan.span()));
        }
    }
    let mut tags = settings.clone();
    if let Some(place) = &written.fleet.config
        && written.vehicle.iter().any(|vehicle| vehicle.tags)
        // Wrong ones are told of the vehicle that uses them.
        && tags.use_tags(&[]).is_ok()
    {
        let surveyed = tags.surveyed_tags().unwrap_or_default();
        let warnings = given_tag_warnings(&surveyed, &config.limits);
        findings
            .extend(warnings.into_iter().map(|warning| Diagnostic::warning(warning, place.span())));
    }
    findings
}

fn member(
    vehicle: &Vehicle,
    system: u8,
    peers: Vec<u8>,
    shared: &Settings,
    folder: &Path,
    z_origin: ZOrigin,
) -> Result<Member, FleetError> {
    let mut settings = shared.clone();
    settings.give(*vehicle.name.get_ref(), system, *vehicle.start.get_ref(), peers);
    if let Some(ultrasound) = vehicle.ultrasound {
        settings.set_ultrasound(ultrasound);
    }
    if vehicle.tags {
        settings.use_tags(&[])?;
    }
    let config = settings.pilot_config(z_origin);
    let path = vehicle.plan.as_ref().map(|plan| folder.join(plan.get_ref()));
    let plan = path.map(|path| plan(&path, &settings, &config)).transpose()?;
    let agent = vehicle.agent.as_ref();
    let agent =
        agent.map(|agent| (agent.get_ref().clone(), vehicle.places.iter().map(pose).collect()));
    let mock_battery = vehicle.mock_battery.as_ref().map(|percent| *percent.get_ref());
    let (drone, video_port) = (vehicle.address(), vehicle.video_port);
    Ok(Member { settings, config, plan, agent, mock_battery, drone, video_port })
}

fn plan(path: &Path, settings: &Settings, config: &VehicleConfig) -> Result<Plan, FleetError> {
    let text = read("the plan", path)?;
    let surveyed = settings.surveyed_tags();
    let tags = surveyed.as_deref().map_or(TagUse::Off, TagUse::On);
    Ok(Plan::parse_with_tags(&path.display().to_string(), &text, &config.limits, tags)?)
}

/// The numbers of the vehicles: their own, or their places in the file.
fn systems(written: &Written) -> impl Iterator<Item = u8> + '_ {
    written.vehicle.iter().zip(1..).map(|(vehicle, place)| vehicle.system.unwrap_or(place))
}

/// All that is wrong or unwise, in the order of the file. `end` is the end of its text.
fn findings(written: &Written, config: &VehicleConfig, end: usize) -> Vec<Diagnostic> {
    let count = written.vehicle.len();
    if count == 0 || count > MOST {
        let message = format!("a fleet has 1 to {MOST} vehicles, and this one {count}");
        let vehicle = "write a table [[vehicle]] for each, with name, start and plan";
        // More of them would have no numbers.
        return vec![Diagnostic::error(message, end..end).help(vehicle)];
    }
    let mut findings = Vec::new();
    let systems: Vec<u8> = systems(written).collect();
    for (number, vehicle) in written.vehicle.iter().enumerate() {
        let others = || written.vehicle.iter().zip(&systems).take(number);
        let (name, span) = (vehicle.name.get_ref(), vehicle.name.span());
        if others().any(|(other, _)| other.name.get_ref() == name) {
            findings
                .push(Diagnostic::error(format!("two vehicles are called {name}"), span.clone()));
        }
        if !(1..=250).contains(&systems[number])
            || others().any(|(_, system)| *system == systems[number])
        {
            let message = format!(
                "{name} would be the MAVLink system {}, as another one or none",
                systems[number]
            );
            let help = "give each vehicle its own `system`, 1 to 250; without one it has its place in the file";
            findings.push(Diagnostic::error(message, span).help(help));
        }
        findings.extend(start_findings(vehicle, config, others().map(|(other, _)| other)));
        findings.extend(agent_findings(vehicle, &written.vehicle, &config.limits));
        if let Some(percent) = &vehicle.mock_battery
            && !(0.0..=100.0).contains(percent.get_ref())
        {
            let message = format!("{name} has a charge of {} %", percent.get_ref());
            let help = "write a number from 0 to 100";
            findings.push(Diagnostic::error(message, percent.span()).help(help));
        }
    }
    findings
}

/// A place of which an agent may ask.
fn pose(place: &Spanned<[f64; 4]>) -> Pose {
    let [x_m, y_m, z_m, yaw_deg] = *place.get_ref();
    Pose { x_m, y_m, z_m, yaw_deg }
}

/// A place of an agent at which it cannot fly.
fn place_finding(
    (number, place): (usize, &Spanned<[f64; 4]>),
    vehicle: &Vehicle,
    limits: &FlightLimits,
) -> Option<Diagnostic> {
    let (at, tolerance_m) = (pose(place), FlightLimits::TOLERANCE_M);
    let how = if limits.outside_m(&at) > tolerance_m {
        limits.border.how_far(Vector2::new(at.x_m, at.y_m))
    } else if at.z_m < limits.floor_m - tolerance_m {
        format!("{:.2} m above the floor, below the lowest of {} m", at.z_m, limits.floor_m)
    } else if at.z_m > limits.ceiling_m + tolerance_m {
        format!("{:.2} m above the floor, above the ceiling of {} m", at.z_m, limits.ceiling_m)
    } else {
        return None;
    };
    let message = format!("place {} of {} is {how}", number + 1, vehicle.name.get_ref());
    Some(
        Diagnostic::error(message, place.span())
            .help("the fence is `[fence]` of this file or of the settings"),
    )
}

/// What is wrong with a vehicle's agent.
fn agent_findings(vehicle: &Vehicle, all: &[Vehicle], limits: &FlightLimits) -> Vec<Diagnostic> {
    let name = vehicle.name.get_ref();
    let Some(agent) = &vehicle.agent else {
        let places = (!vehicle.places.is_empty()).then(|| {
            let help = "give it an `agent`, or write the places into its plan";
            Diagnostic::error(format!("{name} has places and no agent"), vehicle.name.span())
                .help(help)
        });
        return places.into_iter().collect();
    };
    if vehicle.plan.is_some() {
        let help = "an agent has the place of a plan: leave one of them out";
        let message = format!("{name} has a plan and an agent");
        return vec![Diagnostic::error(message, agent.span()).help(help)];
    }
    if let Some(place) =
        vehicle.places.iter().find(|place| !place.get_ref().iter().all(|number| number.is_finite()))
    {
        let message = format!("{name} has a place with a number that is not finite");
        return vec![Diagnostic::error(message, place.span())];
    }
    let places = vehicle.places.iter().enumerate();
    let mut findings: Vec<Diagnostic> =
        places.filter_map(|place| place_finding(place, vehicle, limits)).collect();
    match MissionAgent::new(agent.get_ref(), name.as_str(), Vec::new(), false) {
        Err(problem) => findings.push(Diagnostic::error(problem.to_string(), agent.span())),
        Ok(built) => {
            let is_there =
                |peer: &&&str| all.iter().any(|other| other.name.get_ref().as_str() == **peer);
            let missing = built.peers().iter().find(|peer| !is_there(peer));
            let missing = missing.map(|peer| {
                let message = format!(
                    "the agent of {name} talks with `{peer}`, which is no vehicle of this fleet"
                );
                Diagnostic::error(message, agent.span())
                    .help("an agent knows the others by the names of their vehicles")
            });
            findings.extend(missing);
        }
    }
    findings
}

/// What is wrong or unwise in where a vehicle starts.
fn start_findings<'a>(
    vehicle: &Vehicle,
    config: &VehicleConfig,
    others: impl Iterator<Item = &'a Vehicle>,
) -> Vec<Diagnostic> {
    let (name, span) = (vehicle.name.get_ref(), vehicle.start.span());
    let Some(start) = vehicle.start.get_ref().0 else {
        let help = "measure where it stands, from a point that all have in common: start = [right, forward, heading]";
        return vec![Diagnostic::error(format!("{name} has no start"), span).help(help)];
    };
    let mut findings = Vec::new();
    let [x_m, y_m] = start.place_m.into();
    let outside_m = config.limits.outside_m(&Pose { x_m, y_m, ..Pose::default() });
    if outside_m > 0.0 {
        let message = format!("{name} starts {outside_m:.2} m outside the fence");
        findings.push(Diagnostic::error(message, span.clone()));
    }
    for other in others {
        let Some(there) = other.start.get_ref().0 else { continue };
        let apart_m = Vector2::norm(&(there.place_m - start.place_m));
        let pair =
            format!("{name} and {} start {apart_m:.2} m from each other", other.name.get_ref());
        let separation_m = config.separation_m;
        let unsure_m = unsure_m([start.uncertainty_m, there.uncertainty_m]);
        if apart_m < separation_m + unsure_m {
            let (known, help) = if apart_m < separation_m {
                (String::new(), "put them further apart, or give a smaller `separation_m`")
            } else {
                (
                    format!(", give or take {unsure_m:.2} m"),
                    "measure their starts more exactly, put them further apart, or give a smaller `separation_m`",
                )
            };
            let message = format!("{pair}{known}, and fly no nearer than {separation_m} m");
            findings.push(Diagnostic::error(message, span.clone()).help(help));
        } else if apart_m < ULTRASOUND_M && vehicle.ultrasound() == other.ultrasound() {
            let message =
                format!("{pair}, and hear each other's ultrasound: their heights may be wrong");
            let help = "give one of them `ultrasound = 7`, or put them 3 m apart";
            findings.push(Diagnostic::warning(message, span.clone()).help(help));
        }
    }
    findings
}

fn read(what: &'static str, path: &Path) -> Result<String, FleetError> {
    text_file::read(path).map_err(|source| FleetError::Read {
        what,
        path: path.display().to_string(),
        source,
    })
}
