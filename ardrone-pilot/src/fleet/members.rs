//! The vehicles of a fleet: read from its file, its settings and its plans.

use std::io;
use std::path::{Path, PathBuf};

use ardrone_link::DroneAddress;
use autopilot::plan::{Plan, PlanError, TagUse, ZOrigin};
use autopilot::separation::{MAX_NEIGHBOURS, unsure_m};
use autopilot::vehicle::{CannotFly, VehicleConfig, VehicleName};
use diagnostic::{Diagnostic, Diagnostics, Severity, SourceText};
use kinematics::Pose;
use mission_agent::{MissionAgent, NoAgent};
use mock_drone::WorldConfig;
use nalgebra::Vector2;
use toml::{Table, Value};

use super::file::{self, Vehicle, Written};
use crate::settings::{Settings, SettingsError};
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
    /// At least one.
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
    /// [`FleetError`].
    pub fn read(path: &Path, z_origin: ZOrigin) -> Result<Self, FleetError> {
        let name = path.display().to_string();
        let text = read("the fleet", path)?;
        let written: Written = toml::from_str(&text).map_err(|error| FleetError::Syntax {
            path: name.clone(),
            message: error.to_string().trim_end().to_owned(),
        })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let config = written.fleet.config.as_ref().map(|config| folder.join(config));
        // What it leaves out of the fence is as in the settings.
        let table: Table = toml::from_str(&text).unwrap_or_default();
        let fence = table.get("fence").and_then(Value::as_table);
        let settings = shared_settings(&written, fence, config.as_deref())?;
        let config_of_all = settings.pilot_config(z_origin);
        let findings = findings(&written, &config_of_all, text.trim_end().len());
        let findings = Diagnostics::new([SourceText { name, text }], findings);
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

/// Those that all have.
fn shared_settings(
    written: &Written,
    fence: Option<&Table>,
    config: Option<&Path>,
) -> Result<Settings, FleetError> {
    let mut settings = Settings::default();
    if let Some(path) = config {
        let name = path.display().to_string();
        settings = Settings::parse(&name, &read("the settings", path)?)?;
        settings.for_all(&name)?;
    }
    settings.share(fence, written.fleet.separation_m)?;
    Ok(settings)
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
    let path = vehicle.plan.as_ref().map(|plan| folder.join(plan));
    let plan = path.map(|path| plan(&path, &settings, &config)).transpose()?;
    let pose = |place: &[f64; 4]| {
        let [x_m, y_m, z_m, yaw_deg] = *place;
        Pose { x_m, y_m, z_m, yaw_deg }
    };
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
        findings.extend(agent_findings(vehicle, &written.vehicle));
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

/// What is wrong with a vehicle's agent.
fn agent_findings(vehicle: &Vehicle, all: &[Vehicle]) -> Vec<Diagnostic> {
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
    if vehicle.places.iter().flatten().any(|number| !number.is_finite()) {
        let message = format!("{name} has a place with a number that is not finite");
        return vec![Diagnostic::error(message, vehicle.name.span())];
    }
    match MissionAgent::new(agent.get_ref(), name.as_str(), Vec::new(), false) {
        Err(problem) => vec![Diagnostic::error(problem.to_string(), agent.span())],
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
            missing.into_iter().collect()
        }
    }
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
