//! The mock drone's other ports, as far as clients need them.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::time::Duration;

use ardrone_link::video::Reader;
use mock_drone::WorldConfig;
use mock_drone::server::{MockDrone, Ports};

fn mock() -> MockDrone {
    let ports = Ports { ftp: Some(0), video: Some(0), presence: Some(0), ..Ports::LOOPBACK };
    MockDrone::start(&WorldConfig::default(), ports).unwrap()
}

fn connect(mock: &MockDrone, port: Option<u16>) -> TcpStream {
    let stream = TcpStream::connect((mock.ports().host, port.unwrap())).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
    stream
}

/// Sends a command and returns the answer.
fn ask(stream: &mut BufReader<TcpStream>, command: &str) -> String {
    stream.get_mut().write_all(format!("{command}\r\n").as_bytes()).unwrap();
    let mut answer = String::new();
    stream.read_line(&mut answer).unwrap();
    answer
}

#[test]
fn the_firmwares_version_is_read_over_ftp() {
    let mock = mock();
    let mut control = BufReader::new(connect(&mock, mock.ports().ftp));
    let mut greeting = String::new();
    control.read_line(&mut greeting).unwrap();
    assert!(greeting.starts_with("220 "), "{greeting}");
    assert!(ask(&mut control, "USER anonymous").starts_with("331 "));
    assert!(ask(&mut control, "PASS x").starts_with("230 "));
    assert!(ask(&mut control, "RETR version.txt").starts_with("425 "), "no data connection yet");
    let passive = ask(&mut control, "PASV");
    let numbers: Vec<u16> =
        passive.split(['(', ')', ',']).filter_map(|part| part.parse().ok()).collect();
    let [.., high, low] = numbers[..] else { panic!("{passive}") };
    let mut data = TcpStream::connect((mock.ports().host, high << 8 | low)).unwrap();
    assert!(ask(&mut control, "RETR version.txt").starts_with("150 "));
    let mut version = String::new();
    data.read_to_string(&mut version).unwrap();
    assert_eq!(version, "2.4.8\n");
    let mut end = String::new();
    control.read_line(&mut end).unwrap();
    assert!(end.starts_with("226 "), "{end}");
    assert!(ask(&mut control, "DELE version.txt").starts_with("502 "));
    assert!(ask(&mut control, "QUIT").starts_with("221 "));
}

#[test]
fn presence_is_answered_and_kept_open() {
    let mock = mock();
    let mut stream = connect(&mock, mock.ports().presence);
    stream.set_read_timeout(Some(Duration::from_millis(200))).unwrap();
    let error = stream.read(&mut [0; 16]).unwrap_err();
    let silent =
        matches!(error.kind(), std::io::ErrorKind::WouldBlock | std::io::ErrorKind::TimedOut);
    assert!(silent, "open and silent: {error}");
}

/// Each client gets pictures from a key picture on, also beside one that reads nothing; a fifth is refused.
#[test]
fn video_is_sent_to_four_clients() {
    let mock = mock();
    let silent = connect(&mock, mock.ports().video);
    let mut clients: Vec<_> = (0..4).map(|_| connect(&mock, mock.ports().video)).collect();
    for (number, stream) in clients.iter_mut().enumerate() {
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        let (mut reader, mut buffer) = (Reader::default(), [0; 4096]);
        let picture = loop {
            let Ok(length @ 1..) = stream.read(&mut buffer) else { break None };
            reader.push(&buffer[..length]);
            if let Some(picture) = reader.next() {
                break Some(picture);
            }
        };
        assert_eq!(picture.map(|picture| picture.is_entry()), (number < 3).then_some(true));
    }
    drop(silent);
}
