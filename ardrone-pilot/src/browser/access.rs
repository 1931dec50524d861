//! Access control: only pages of this server, and only clients with the token.

use std::net::{IpAddr, SocketAddr};

use super::BrowserError;

/// Decides by the headers and the address of a request.
#[derive(Debug)]
pub(super) struct Access {
    address: SocketAddr,
    /// Required where other machines can connect.
    token: Option<String>,
}

/// Whether a client is on this machine.
#[derive(Debug, Clone, Copy)]
pub(super) struct Local(pub(super) bool);

/// Why a request is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(super) enum Refusal {
    /// The host name may belong to another site's page.
    #[error("this machine is not called that here: open the address that ardrone-pilot printed")]
    Host,
    /// Another site's page.
    #[error("only the page of this server may do that")]
    Origin,
    /// The token is missing or wrong.
    #[error("the token is missing or wrong: open the whole address that ardrone-pilot printed")]
    Token,
}

/// The parts of a request that are checked.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Claims<'a> {
    /// The header `Host`.
    pub(super) host: Option<&'a str>,
    /// The header `Origin`; browsers always send it with requests that could do harm.
    pub(super) origin: Option<&'a str>,
    /// The token in the request's address.
    pub(super) token: Option<&'a str>,
}

impl Access {
    /// Access control of a server at this address: without a token on the loopback interface, otherwise with
    /// a new one.
    ///
    /// # Errors
    /// [`BrowserError::Token`] if the system has no random numbers.
    pub(super) fn new(address: SocketAddr) -> Result<Self, BrowserError> {
        if address.ip().is_loopback() {
            return Ok(Self { address, token: None });
        }
        let mut bytes = [0_u8; 16];
        getrandom::fill(&mut bytes).map_err(|error| BrowserError::Token(error.to_string()))?;
        let token = format!("{:032x}", u128::from_ne_bytes(bytes));
        Ok(Self { address, token: Some(token) })
    }

    /// The address to open in a browser.
    pub(super) fn url(&self) -> String {
        match &self.token {
            None => format!("http://{}/", self.address),
            Some(token) => {
                let port = self.address.port();
                let host = match self.address.ip() {
                    ip if ip.is_unspecified() => format!("ADDRESS-OF-THIS-MACHINE:{port}"),
                    _ => self.address.to_string(),
                };
                format!("http://{host}/?token={token}")
            }
        }
    }

    /// Checks whether a request may be served, and with `orders` whether it may watch the flight and give
    /// orders.
    ///
    /// # Errors
    /// The reason for refusing it.
    pub(super) fn check(&self, claims: Claims<'_>, orders: bool) -> Result<(), Refusal> {
        let host = claims.host.ok_or(Refusal::Host)?;
        // Guards against DNS rebinding, by which another site's name leads here. With a token that site would
        // lack it.
        if self.token.is_none() && !self.is_our_name(host) {
            return Err(Refusal::Host);
        }
        // Clients other than browsers send no origin.
        if claims.origin.is_some_and(|origin| origin.strip_prefix("http://") != Some(host)) {
            return Err(Refusal::Origin);
        }
        match &self.token {
            Some(token) if orders && !same(token, claims.token.unwrap_or_default()) => {
                Err(Refusal::Token)
            }
            _ => Ok(()),
        }
    }

    fn is_our_name(&self, host: &str) -> bool {
        let (name, port) = match host.rsplit_once(':') {
            Some((name, port)) if !port.ends_with(']') => (name, port.parse().ok()),
            _ => (host, Some(80)),
        };
        let name = name.trim_start_matches('[').trim_end_matches(']');
        let local = name.eq_ignore_ascii_case("localhost")
            || name.parse().is_ok_and(|ip: IpAddr| ip.is_loopback());
        local && port == Some(self.address.port())
    }
}

/// Compares in constant time, so that the duration reveals nothing about the token.
fn same(one: &str, other: &str) -> bool {
    let differences =
        one.bytes().zip(other.bytes()).fold(0, |all, (one, other)| all | (one ^ other));
    one.len() == other.len() && differences == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn local() -> Access {
        Access::new("127.0.0.1:8080".parse().unwrap()).unwrap()
    }

    fn from(host: &'static str, origin: Option<&'static str>) -> Claims<'static> {
        Claims { host: Some(host), origin, token: None }
    }

    #[test]
    fn only_our_own_page_gives_orders_here() {
        let access = local();
        assert_eq!(access.url(), "http://127.0.0.1:8080/");
        for (host, origin, expected) in [
            ("127.0.0.1:8080", None, Ok(())),
            ("localhost:8080", Some("http://localhost:8080"), Ok(())),
            ("[::1]:8080", Some("http://[::1]:8080"), Ok(())),
            // Another site, another program's page on this machine, a file, and a site using DNS rebinding.
            ("127.0.0.1:8080", Some("http://evil.example"), Err(Refusal::Origin)),
            ("127.0.0.1:8080", Some("http://127.0.0.1:3000"), Err(Refusal::Origin)),
            ("127.0.0.1:8080", Some("https://127.0.0.1:8080"), Err(Refusal::Origin)),
            ("127.0.0.1:8080", Some("null"), Err(Refusal::Origin)),
            ("evil.example:8080", Some("http://evil.example:8080"), Err(Refusal::Host)),
            ("127.0.0.1.evil.example:8080", None, Err(Refusal::Host)),
            ("127.0.0.1:80", None, Err(Refusal::Host)),
            ("127.0.0.1", None, Err(Refusal::Host)),
            ("", None, Err(Refusal::Host)),
        ] {
            assert_eq!(access.check(from(host, origin), true), expected, "{host} {origin:?}");
        }
        assert_eq!(access.check(Claims::default(), true), Err(Refusal::Host));
    }

    #[test]
    fn others_than_this_machine_need_the_token() {
        let access = Access::new("192.168.1.2:8080".parse().unwrap()).unwrap();
        let url = access.url();
        let token = url.strip_prefix("http://192.168.1.2:8080/?token=").unwrap();
        assert_eq!(token.len(), 32);
        let claims = from("pilot.local:8080", Some("http://pilot.local:8080"));
        assert_eq!(access.check(Claims { token: Some(token), ..claims }, true), Ok(()));
        let shorter = token.get(1..);
        for wrong in [None, Some(""), shorter, Some("00112233445566778899aabbccddeeff")] {
            let claims = Claims { token: wrong, ..claims };
            assert_eq!(access.check(claims, true), Err(Refusal::Token), "{wrong:?}");
            assert_eq!(access.check(claims, false), Ok(()));
        }
        let foreign = from("192.168.1.2:8080", Some("http://evil.example"));
        let claims = Claims { token: Some(token), ..foreign };
        assert_eq!(access.check(claims, true), Err(Refusal::Origin));
        let other = Access::new("192.168.1.2:8080".parse().unwrap()).unwrap();
        assert_ne!(other.url(), url);
        let any = Access::new("0.0.0.0:8080".parse().unwrap()).unwrap();
        assert!(any.url().starts_with("http://ADDRESS-OF-THIS-MACHINE:8080/?token="));
    }
}
