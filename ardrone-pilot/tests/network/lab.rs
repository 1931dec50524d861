//! Two machines that are none: network namespaces, and a wire between them that can be slow, lossy, or cut.

use std::fs::File;
use std::io::{BufRead as _, BufReader, Write as _};
use std::os::fd::AsFd as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

use rustix::thread::{LinkNameSpaceType, move_into_link_name_space};

/// Addresses of the two.
pub(crate) const ADDRESSES: [&str; 2] = ["10.77.0.1", "10.77.0.2"];

/// Two namespaces with a wire, which go when this does.
pub(crate) struct Lab {
    names: [String; 2],
    wire: Child,
}

fn ip(arguments: &[&str]) {
    let output = Command::new("ip").args(arguments).output().unwrap();
    assert!(
        output.status.success(),
        "ip {arguments:?}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
}

impl Lab {
    /// `None` where there is no root, `ip` or `/dev/net/tun`: in CI that is an error.
    pub(crate) fn new() -> Option<Self> {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let is_root = rustix::process::getuid().is_root();
        let has_ip = Command::new("ip").arg("-V").output().is_ok_and(|it| it.status.success());
        let missing = [
            (!is_root).then_some("root"),
            (!has_ip).then_some("iproute2"),
            (!Path::new("/dev/net/tun").exists()).then_some("/dev/net/tun"),
        ];
        let missing: Vec<&str> = missing.into_iter().flatten().collect();
        if !missing.is_empty() {
            assert!(std::env::var_os("CI").is_none(), "no network namespaces without {missing:?}");
            eprintln!("skipped: no network namespaces without {missing:?}");
            return None;
        }
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let names =
            ["one", "two"].map(|end| format!("ardrone-{}-{number}-{end}", std::process::id()));
        for name in &names {
            ip(&["netns", "add", name]);
            ip(&["-n", name, "link", "set", "lo", "up"]);
        }
        let wire = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/network/wire.py");
        let mut wire = Command::new("python3")
            .arg(wire)
            .args(&names)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(wire.stdout.take().unwrap()).read_line(&mut line).unwrap();
        assert_eq!(line, "ready\n");
        for (name, address) in names.iter().zip(ADDRESSES) {
            ip(&["-n", name, "address", "add", &format!("{address}/24"), "dev", "wire"]);
            ip(&["-n", name, "link", "set", "wire", "up"]);
        }
        Some(Self { names, wire })
    }

    /// From now on each packet takes so long, and this part of them is lost.
    pub(crate) fn wire(&mut self, delay_ms: u32, loss: f64) {
        // At once: the other end takes what it reads for a line.
        let line = format!("{delay_ms} {loss}\n");
        self.wire.stdin.as_mut().unwrap().write_all(line.as_bytes()).unwrap();
    }

    /// A program on one of the machines.
    pub(crate) fn command(&self, end: usize, program: &Path) -> Command {
        let mut command = Command::new("ip");
        command.args(["netns", "exec", &self.names[end]]).arg(program);
        command
    }

    /// Does something on one of the machines; sockets and threads that it makes stay there.
    pub(crate) fn on<T: Send>(&self, end: usize, task: impl FnOnce() -> T + Send) -> T {
        let namespace = File::open(Path::new("/run/netns").join(&self.names[end])).unwrap();
        std::thread::scope(|scope| {
            let there = scope.spawn(move || {
                move_into_link_name_space(namespace.as_fd(), Some(LinkNameSpaceType::Network))
                    .unwrap();
                task()
            });
            there.join().unwrap()
        })
    }
}

impl Drop for Lab {
    fn drop(&mut self) {
        // It may have ended already.
        _ = self.wire.kill();
        _ = self.wire.wait();
        for name in &self.names {
            _ = Command::new("ip").args(["netns", "delete", name]).status();
        }
    }
}
