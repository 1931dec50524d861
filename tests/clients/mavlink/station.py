"""A ground station: one UDP socket, pymavlink's codec, and what was heard, with its time."""

import collections
import contextlib
import socket
import time

from pymavlink.dialects.v20 import all as mavlink

VEHICLE = (1, 1)
ACKNOWLEDGED_WITHIN_S = 0.4


class Silence(AssertionError):
    """What was waited for did not come."""


def message_class(kind):
    """pymavlink's class of the message with this name: what is sent is made by it."""
    return getattr(mavlink, f"MAVLink_{kind.lower()}_message")


class Station:
    """Waiting also sends: its heartbeat once a second, and what `repeat` holds."""

    def __init__(self, port, system=255, component=190, key=None):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        self.socket.bind(("127.0.0.1", port))
        self.system, self.component = system, component
        self.codec = mavlink.MAVLink(None, srcSystem=system, srcComponent=component)
        self.codec.robust_parsing = True
        if key is not None:
            self.sign(key)
        self.vehicle = None
        self.beats = True
        self.repeat = {}
        self.sent_s = collections.defaultdict(float)
        self.heard = collections.deque(maxlen=20_000)
        self.latest = {}

    def sign(self, key):
        signing = self.codec.signing
        signing.secret_key = key
        signing.sign_outgoing = True
        signing.link_id = 7
        # 10 us since 2015-01-01.
        signing.timestamp = int((time.time() - 1_420_070_400) * 100_000)
        # What the vehicle signs is not the question of these tests, except of those that ask for it.
        signing.allow_unsigned_callback = lambda _codec, _number: True

    def close(self):
        self.socket.close()

    # Sending

    def pack(self, kind, *fields, version1=False, **named):
        packed = message_class(kind)(*fields, **named).pack(self.codec, force_mavlink1=version1)
        self.codec.seq = (self.codec.seq + 1) % 256
        return packed

    def send(self, kind, *fields, version1=False, **named):
        self.send_bytes(self.pack(kind, *fields, version1=version1, **named))

    def send_bytes(self, datagram):
        if self.vehicle is None:
            self.wait("HEARTBEAT", 20)
        # Loopback tells a closed port by an error of the next call.
        with contextlib.suppress(ConnectionRefusedError):
            self.socket.sendto(datagram, self.vehicle)

    def beat(self):
        self.send("HEARTBEAT", mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3)

    @contextlib.contextmanager
    def repeating(self, name, period_s, send):
        """While the block runs, `send` is called every `period_s` whenever the station waits."""
        self.repeat[name] = (period_s, send)
        try:
            yield
        finally:
            self.repeat.pop(name, None)

    def send_what_is_due(self):
        if self.vehicle is None:
            return
        due = {"heartbeat": (1.0, self.beat)} if self.beats else {}
        for name, (period_s, send) in (due | self.repeat).items():
            now_s = time.monotonic()
            if now_s - self.sent_s[name] >= period_s:
                self.sent_s[name] = now_s
                send()

    # Hearing

    def hear(self, seconds):
        """Listens for so long."""
        until_s = time.monotonic() + seconds
        while self.hear_once(until_s):
            pass

    def hear_once(self, until_s):
        """Takes one datagram, or gives up after 20 ms; whether there is time left."""
        self.send_what_is_due()
        left_s = until_s - time.monotonic()
        if left_s <= 0:
            return False
        self.socket.settimeout(min(left_s, 0.02))
        try:
            datagram, sender = self.socket.recvfrom(4096)
        except (TimeoutError, ConnectionRefusedError):
            return True
        for message in self.codec.parse_buffer(datagram) or []:
            self.note(message, sender)
        return True

    def note(self, message, sender):
        if (message.get_srcSystem(), message.get_srcComponent()) != VEHICLE:
            return
        self.vehicle = sender
        message.heard_s = time.monotonic()
        self.heard.append(message)
        self.latest[message.get_type()] = message

    def wait(self, kind, within_s, where=lambda _message: True, since_s=None):
        """The first such message from now on (or from `since_s` on)."""
        since_s = time.monotonic() if since_s is None else since_s
        until_s = time.monotonic() + within_s
        looked_at_s = since_s
        while True:
            for message in self.since(looked_at_s, kind):
                if where(message):
                    return message
            looked_at_s = max(looked_at_s, time.monotonic() - 0.1)
            if not self.hear_once(until_s):
                raise Silence(f"no such {kind} within {within_s:.1f} s; the last one: {self.latest.get(kind)}")

    def since(self, since_s, *kinds):
        """What was heard from that time on, oldest first."""
        found = []
        for message in reversed(self.heard):
            if message.heard_s < since_s:
                break
            if not kinds or message.get_type() in kinds:
                found.append(message)
        return found[::-1]

    def texts(self, since_s=0.0):
        return [message.text for message in self.since(since_s, "STATUSTEXT")]

    def wait_until(self, condition, within_s, what):
        """Listens until the condition holds."""
        until_s = time.monotonic() + within_s
        while not condition():
            if not self.hear_once(until_s):
                raise Silence(f"not within {within_s:.1f} s: {what}; last texts: {self.texts()[-4:]}")

    # Commands

    def command(self, number, *parameters, target=VEHICLE, within_s=ACKNOWLEDGED_WITHIN_S, version1=False):
        """Sends COMMAND_LONG; the result in its acknowledgement."""
        seven = [*parameters, *[0] * (7 - len(parameters))]
        return self.ask("COMMAND_LONG", number, [*target, number, 0, *seven], within_s, version1)

    def command_int(self, number, frame, *parameters, target=VEHICLE, within_s=ACKNOWLEDGED_WITHIN_S):
        """Sends COMMAND_INT, with whole numbers as parameters 5 and 6; the result in its acknowledgement."""
        seven = [*parameters, *[0] * (7 - len(parameters))]
        return self.ask("COMMAND_INT", number, [*target, frame, number, 0, 0, *seven], within_s, False)

    def ask(self, kind, number, fields, within_s, version1):
        asked_s = time.monotonic()
        self.send(kind, *fields, version1=version1)
        own = (number, self.system, self.component)

        def answers(ack):
            return (ack.command, ack.target_system, ack.target_component) == own

        return self.wait("COMMAND_ACK", within_s, answers, asked_s).result

    def request(self, number, within_s=ACKNOWLEDGED_WITHIN_S, parameter=0):
        """Asks for one message by its number: the result, and the message if it came."""
        asked_s = time.monotonic()
        result = self.command(mavlink.MAV_CMD_REQUEST_MESSAGE, number, parameter)
        kind = mavlink.mavlink_map[number].msgname if number in mavlink.mavlink_map else None
        if result != mavlink.MAV_RESULT_ACCEPTED or kind is None:
            return result, None
        left_s = max(0.05, within_s - (time.monotonic() - asked_s))
        return result, self.wait(kind, left_s, since_s=asked_s)
