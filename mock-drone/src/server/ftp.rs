//! The part of FTP that clients need to read the firmware's version.

use std::io;
use std::net::{IpAddr, SocketAddr};

use tokio::io::{AsyncBufReadExt as _, AsyncWriteExt as _, BufReader};
use tokio::net::{TcpListener, TcpStream};

const VERSION: &str = "2.4.8\n";
/// Maximum length of a command; valid ones are short.
const MAX_COMMAND_BYTES: usize = 512;

/// Serves one client until it disconnects.
pub(super) async fn serve(stream: TcpStream) -> io::Result<()> {
    let host = stream.local_addr()?.ip();
    let mut stream = BufReader::new(stream);
    let mut data: Option<TcpListener> = None;
    reply(&mut stream, "220 mock drone").await?;
    let mut line = Vec::new();
    loop {
        line.clear();
        if stream.read_until(b'\n', &mut line).await? == 0 || line.len() > MAX_COMMAND_BYTES {
            return Ok(());
        }
        let text = String::from_utf8_lossy(&line);
        let (command, argument) = text.trim().split_once(' ').unwrap_or((text.trim(), ""));
        match command.to_ascii_uppercase().as_str() {
            "USER" => reply(&mut stream, "331 any password").await?,
            "PASS" => reply(&mut stream, "230 welcome").await?,
            "TYPE" | "MODE" | "STRU" | "NOOP" => reply(&mut stream, "200 OK").await?,
            "SYST" => reply(&mut stream, "215 UNIX Type: L8").await?,
            "PWD" => reply(&mut stream, "257 \"/\"").await?,
            "CWD" => reply(&mut stream, "250 OK").await?,
            "PASV" | "EPSV" => {
                let listener = TcpListener::bind((host, 0)).await?;
                let address = listener.local_addr()?;
                data = Some(listener);
                reply(&mut stream, &passive(command, address)).await?;
            }
            "SIZE" => reply(&mut stream, &format!("213 {}", VERSION.len())).await?,
            "RETR" | "LIST" | "NLST" => match data.take() {
                Some(listener) => {
                    let retrieving = command.eq_ignore_ascii_case("RETR");
                    let known = argument.trim_start_matches('/') == "version.txt";
                    if retrieving && !known {
                        reply(&mut stream, "550 no such file; only version.txt exists").await?;
                        continue;
                    }
                    reply(&mut stream, "150 sending").await?;
                    let (mut connection, _) = listener.accept().await?;
                    let content = if retrieving { VERSION } else { "version.txt\r\n" };
                    connection.write_all(content.as_bytes()).await?;
                    connection.shutdown().await?;
                    reply(&mut stream, "226 transfer complete").await?;
                }
                None => reply(&mut stream, "425 say PASV first").await?,
            },
            "QUIT" => {
                reply(&mut stream, "221 goodbye").await?;
                return Ok(());
            }
            _ => reply(&mut stream, "502 not implemented").await?,
        }
    }
}

async fn reply(stream: &mut BufReader<TcpStream>, text: &str) -> io::Result<()> {
    stream.get_mut().write_all(format!("{text}\r\n").as_bytes()).await
}

fn passive(command: &str, address: SocketAddr) -> String {
    let port = address.port();
    match address.ip() {
        IpAddr::V4(ip) if command.eq_ignore_ascii_case("PASV") => {
            let [a, b, c, d] = ip.octets();
            format!("227 Entering Passive Mode ({a},{b},{c},{d},{},{})", port >> 8, port & 0xFF)
        }
        _ => format!("229 Entering Extended Passive Mode (|||{port}|)"),
    }
}
