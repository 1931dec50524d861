//! The program under test, and what it says.

use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use serde_json::Value;

/// It.
pub(crate) fn program() -> PathBuf {
    env!("CARGO_BIN_EXE_ardrone-pilot").into()
}

/// The folder of the shipped fleets.
pub(crate) fn fleets() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../fleets"))
}

/// A configuration of Zenoh: where it listens, and whom it connects to. By multicast tests would find each other.
pub(crate) fn zenoh(listen: &str, connect: Option<&str>) -> String {
    let connect = connect.map(|at| format!("\"{at}\"")).unwrap_or_default();
    format!(
        "{{ mode: \"peer\", scouting: {{ multicast: {{ enabled: false }} }}, listen: {{ endpoints: [\"{listen}\"] }}, connect: {{ endpoints: [{connect}] }} }}"
    )
}

/// One that flies, and writes JSON. It is killed when this is dropped.
pub(crate) struct Pilot {
    child: Child,
    /// With when it was read.
    said: Arc<Mutex<Vec<(Instant, Value)>>>,
    reader: Option<JoinHandle<()>>,
}

impl Pilot {
    pub(crate) fn start(command: &mut Command) -> Self {
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::inherit())
            .spawn()
            .unwrap();
        let lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let said = Arc::<Mutex<Vec<(Instant, Value)>>>::default();
        let read = Arc::clone(&said);
        let reader = std::thread::spawn(move || {
            // A program that is killed leaves half a line.
            let objects = lines.map_while(Result::ok);
            let objects = objects.filter_map(|line| serde_json::from_str(&line).ok());
            objects.for_each(|object| read.lock().unwrap().push((Instant::now(), object)));
        });
        Self { child, said, reader: Some(reader) }
    }

    /// All that it has said.
    pub(crate) fn said(&self) -> Vec<Value> {
        self.said.lock().unwrap().iter().map(|(_, object)| object.clone()).collect()
    }

    /// The same, with when it was read.
    pub(crate) fn said_at(&self) -> Vec<(Instant, Value)> {
        self.said.lock().unwrap().clone()
    }

    /// Waits until it has said something.
    pub(crate) fn until(&self, patience: Duration, wanted: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        loop {
            let said = self.said();
            if let Some(object) = said.iter().find(|object| wanted(object)) {
                return object.clone();
            }
            assert!(start.elapsed() < patience, "{:?}", said.last());
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Ends its standard input: one without a plan quits.
    pub(crate) fn quit(&mut self) {
        drop(self.child.stdin.take());
    }

    pub(crate) fn id(&self) -> u32 {
        self.child.id()
    }

    pub(crate) fn kill(&mut self) {
        self.child.kill().unwrap();
    }

    pub(crate) fn is_running(&mut self) -> bool {
        self.child.try_wait().unwrap().is_none()
    }

    /// Its exit status, and all that it said.
    pub(crate) fn end(mut self) -> (Option<i32>, Vec<Value>) {
        let status = self.child.wait().unwrap().code();
        self.reader.take().unwrap().join().unwrap();
        (status, self.said())
    }
}

impl Drop for Pilot {
    fn drop(&mut self) {
        // It may have ended already.
        _ = self.child.kill();
        _ = self.child.wait();
    }
}

/// How often something was refused, by the last object.
pub(crate) fn refused(said: &[Value], why: &str) -> u64 {
    let end = said.iter().rfind(|object| object["type"] == "fleet_end").unwrap();
    let all = end["network"]["refused"].as_array().unwrap();
    all.iter().filter(|it| it["why"] == why).map(|it| it["count"].as_u64().unwrap()).sum()
}

/// Whether the network was told of so.
pub(crate) fn has_told(said: &[Value], key: &str, value: &Value) -> bool {
    said.iter().any(|object| object["type"] == "network" && object[key] == *value)
}
