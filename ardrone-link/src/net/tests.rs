use std::net::Ipv4Addr;
use std::time::Duration;

use bytes::BytesMut;
use tokio::net::UdpSocket;
use tokio::time::{Instant, timeout};

use super::limits::{BUFFER_BYTES, TICK};
use super::link::PARTING_ORDERS;
use super::*;
use crate::DroneAddress;
use crate::at::{Command, Motion, Ref, decode};
use crate::navdata::{DroneState, PacketWriter};
use crate::session::Event;

/// Timeout, longer than any machine should need.
const PATIENCE: Duration = Duration::from_secs(20);

/// The sockets of a fake drone.
struct Ground {
    at: UdpSocket,
    navdata: UdpSocket,
}

impl Ground {
    async fn new() -> Self {
        let bind = async || UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).await.unwrap();
        Self { at: bind().await, navdata: bind().await }
    }

    fn builder(&self) -> ClientBuilder {
        let port = |socket: &UdpSocket| socket.local_addr().unwrap().port();
        Client::builder().address(DroneAddress {
            host: Ipv4Addr::LOCALHOST.to_string(),
            at_port: port(&self.at),
            navdata_port: port(&self.navdata),
            ..DroneAddress::default()
        })
    }

    /// Answers the client's wake-up with one packet.
    async fn answer(&self, state: DroneState) {
        let mut buffer = [0; BUFFER_BYTES];
        let (_, from) = self.navdata.recv_from(&mut buffer).await.unwrap();
        let mut packet = BytesMut::new();
        PacketWriter::new(&mut packet, state, 1, 0).finish();
        self.navdata.send_to(&packet, from).await.unwrap();
    }

    /// Commands of the next datagram.
    async fn hear(&self) -> Vec<Command> {
        let mut buffer = [0; BUFFER_BYTES];
        let length = self.at.recv(&mut buffer).await.unwrap();
        decode(&buffer[..length]).map(|command| command.unwrap().1).collect()
    }
}

#[tokio::test]
async fn a_panic_orders_the_landing_and_ends_every_wait() {
    let ground = Ground::new().await;
    let client = ground.builder().start().await.unwrap();
    ground.answer(DroneState::FLYING).await;
    ground.hear().await;
    let mut events = client.events();
    let mut packets = client.packets();
    assert_eq!(events.next(PATIENCE).await, Ok(Event::Connected));
    let panics = async {
        // Behind the pending requests.
        tokio::task::yield_now().await;
        client.panic();
    };
    let (landing, cut, ()) =
        timeout(PATIENCE, async { tokio::join!(client.land(), client.reset_emergency(), panics) })
            .await
            .unwrap();
    assert_eq!(landing, Err(ClientError::Task.into()));
    assert_eq!(cut, Err(ClientError::Task.into()));
    let mut landings = 0;
    while let Ok(commands) = timeout(PATIENCE, ground.hear()).await {
        landings += u32::from(commands == [Command::Ref(Ref::Land), Command::Pcmd(Motion::Hover)]);
        if landings == PARTING_ORDERS {
            break;
        }
    }
    assert_eq!(landings, PARTING_ORDERS);
    let ended = Err(FlightError::Ended(ClientError::Task));
    assert_eq!(client.take_off().await, ended);
    assert_eq!(client.land().await, ended);
    assert_eq!(client.emergency_stop().await, ended);
    assert_eq!(client.reset_emergency().await, ended);
    assert_eq!(client.steer(Steering::forward(0.1), TICK), ended);
    assert_eq!(client.hover(), ended);
    assert_eq!(client.flat_trim(), ended);
    assert_eq!(client.navdata(), None);
    let ended = WaitError::Ended(ClientError::Task);
    let rest = events.wait_for(PATIENCE, |event| *event == Event::Landed).await;
    assert_eq!(rest, Err(ended.clone()));
    assert_eq!(client.events().next(PATIENCE).await, Err(ended.clone()));
    assert_eq!(packets.next(PATIENCE).await, Err(ended));
    assert_eq!(client.close().await, Err(ClientError::Task));
}

/// Not even if the program ignores the errors.
#[tokio::test]
async fn no_loop_spins_once_the_client_has_ended() {
    let ground = Ground::new().await;
    let client = ground.builder().start().await.unwrap();
    let mut events = client.events();
    let mut packets = client.packets();
    client.close().await.unwrap();
    let (begun, mut turns) = (Instant::now(), 0_u32);
    let careless = async {
        while events.next(PATIENCE).await != Ok(Event::Ready) {
            turns += 1;
            assert_eq!(packets.next(PATIENCE).await, Err(ClientError::Closed.into()));
            turns += 1;
        }
    };
    assert!(timeout(10 * TICK, careless).await.is_err(), "it lets others run");
    assert!(turns > 1 && TICK * turns <= begun.elapsed(), "{turns} in {:?}", begun.elapsed());
}

#[tokio::test]
async fn without_a_drone_every_wait_ends_with_a_reason() {
    let ground = Ground::new().await;
    let limit = Duration::from_millis(200);
    let client = ground.builder().ready_limit(limit).start().await.unwrap();
    let mut events = client.events();
    let mut packets = client.packets();
    let waits = async {
        assert_eq!(client.ready().await, Err(ReadyError::NotHeard { limit }));
        assert_eq!(client.take_off().await, Err(Refusal::NotReady.into()));
        assert_eq!(client.land().await, Err(FlightError::LinkLost));
        assert_eq!(events.next(limit).await, Err(WaitError::TimedOut { limit }));
        assert_eq!(events.wait_for(limit, |_| true).await, Err(WaitError::TimedOut { limit }));
        assert_eq!(packets.next(limit).await, Err(WaitError::TimedOut { limit }));
    };
    timeout(PATIENCE, waits).await.unwrap();
    assert_eq!(client.steer(Steering::up(0.1), limit), Err(Refusal::NotFlying.into()));
    assert_eq!(client.flat_trim(), Err(Refusal::NotStanding.into()));
    client.close().await.unwrap();
    let mut buffer = [0; BUFFER_BYTES];
    assert!(ground.at.try_recv(&mut buffer).is_err(), "nothing is said to a drone never heard");
}

#[tokio::test]
async fn what_cannot_be_sent_or_found_is_reported_at_the_start() {
    let mode = Client::builder().setting(crate::Setting::NavdataDemo(false)).start().await;
    assert!(matches!(mode, Err(StartError::Setting(crate::SettingError::Navdata { .. }))));
    // The type of a port rules out invalid numbers; a host with a space cannot be resolved.
    let nowhere = Client::builder().host("no such host").start().await;
    assert!(matches!(nowhere, Err(StartError::Resolve { host, .. }) if host == "no such host"));
}
