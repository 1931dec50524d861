//! The flight in a browser: a page that shows it live and takes operators' orders.
//!
//! The page is served by a thread of its own, which has nothing of the flight but its [`Controls`]:
//! whatever a client does, the tick does not see it. A page that falls behind is told the whole story
//! again; one that cannot be written to is dropped.
//!
//! On the loopback whoever is on this machine may order. At any other address the page wants a token,
//! which is new for each flight. Pages of other sites are refused everywhere.

mod access;
mod requests;
mod server;
mod story;

use std::net::{SocketAddr, TcpListener};

use autopilot::plan::{FlightLimits, Plan};

use self::access::Access;
use self::server::Server;
use self::story::Story;
use crate::flight::{Controls, Message};

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
pub enum BrowserError {
    /// The address cannot be had.
    #[error("cannot serve the page at {address}; give another address as --ui")]
    Bind {
        /// What was asked for.
        address: SocketAddr,
        /// What the system says.
        source: std::io::Error,
    },
    /// The system has no random numbers.
    #[error("cannot make a token for the page: {0}")]
    Token(String),
    /// A thread could not be started.
    #[error("cannot start the page's thread")]
    Thread(#[source] std::io::Error),
}

/// An address that is ours before the flight begins.
#[derive(Debug)]
pub struct Door {
    listener: TcpListener,
    access: Access,
}

impl Door {
    /// Takes the address.
    ///
    /// # Errors
    /// [`BrowserError`] if it cannot be had.
    pub fn bind(address: SocketAddr) -> Result<Self, BrowserError> {
        let error = |source| BrowserError::Bind { address, source };
        let listener = TcpListener::bind(address).map_err(error)?;
        listener.set_nonblocking(true).map_err(error)?;
        let access = Access::new(listener.local_addr().map_err(error)?)?;
        Ok(Self { listener, access })
    }

    /// What to open in a browser.
    pub fn url(&self) -> String {
        self.access.url()
    }

    /// Lets browsers in to watch a flight and to order it.
    ///
    /// # Errors
    /// [`BrowserError::Thread`] if no thread can be had.
    pub fn open(
        self,
        plan: Option<&Plan>,
        limits: &FlightLimits,
        controls: Controls,
    ) -> Result<Browser, BrowserError> {
        let story = Story::new(plan, limits);
        let server = Server::start(self.listener, self.access, story, controls)
            .map_err(BrowserError::Thread)?;
        Ok(Browser { server })
    }
}

/// Browsers that watch a flight. When it goes, they have been told everything.
#[derive(Debug)]
pub struct Browser {
    server: Server,
}

impl Browser {
    /// Tells them what the flight tells; never waits for any of them.
    pub fn show(&self, message: &Message) {
        self.server.tell(|story| story.take_in(message));
    }

    /// Tells them how it ended.
    pub fn end(&self, end: &serde_json::Value) {
        self.server.tell(|story| {
            story.end(end.clone());
            end.clone()
        });
    }
}
