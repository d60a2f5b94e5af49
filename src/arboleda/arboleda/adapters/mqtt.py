"""paho-mqtt: one MQTT client that never replays and always says whether it is connected."""

from __future__ import annotations

import logging
import socket
import ssl
import struct
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

from paho.mqtt.client import Client, MQTTMessage, MQTTMessageInfo
from paho.mqtt.enums import CallbackAPIVersion, MQTTErrorCode, MQTTProtocolVersion
from paho.mqtt.packettypes import PacketTypes
from paho.mqtt.properties import Properties
from paho.mqtt.reasoncodes import ReasonCode

from arboleda.model.errors import ArboledaError
from arboleda.model.plant_model import MqttVersion
from arboleda.wire.transport import Connection, Delivery, Publication

from .broker_login import CA, CERTIFICATE, SECURE, Address, Credentials
from .clock import seconds

log = logging.getLogger(__name__)

KEEPALIVE_S = 5
CONNECT_TIMEOUT_S = 3.0
FLUSH_S = 1.0
WAKE_S = 1.0  # paho looks at its keep-alive when its loop wakes
FIRST_RETRY_S, LAST_RETRY_S = 0.2, 5.0
QUEUE_LIMIT = 100
LARGEST_PACKET = 4096  # bytes; all messages of plant and boards are shorter
AT_ONCE = 40  # topics of one SUBSCRIBE: the plant's own broker takes packets of 4 kB
EXPIRY_S = 1
WAITS_S = 1.5  # an older message is out of date, as in a process that was stopped
CHECK = "check its certificate"
MISTRUST = {  # by X509_V_ERR of OpenSSL
    9: "set the clock of this machine",
    10: "renew it, or set the clock of this machine",
    18: f"name the file of its authority in ${CA}",
    19: f"name the file of its authority in ${CA}",
    20: f"name the file of its authority in ${CA}",
    62: "call the broker by a name that its certificate has",
    64: "call the broker by a name that its certificate has",
}
PAHO_VERSION = {MqttVersion.V3_1_1: MQTTProtocolVersion.MQTTv311, MqttVersion.V5: MQTTProtocolVersion.MQTTv5}


class NotConnected(ArboledaError):
    """Error: a publication was refused because the broker is not connected; it will not be sent later."""


class PromptClient(Client):
    """paho's client, but it writes nothing while `is_late` says so: its connection ends instead.

    Whatever leaves passes here, also what paho itself kept until the broker had the message before.
    """

    def __init__(self, is_late: Callable[[], bool], *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self._is_late = is_late

    def loop_write(self) -> MQTTErrorCode:
        return MQTTErrorCode.MQTT_ERR_CONN_LOST if self._is_late() else super().loop_write()


class MqttClient:
    """Keeps one clean session at a broker, with a new paho client for each connection.

    `on_event` gets Deliveries and Connections in the client's own thread and must not block;
    `Connection(up=True)` comes once the broker has granted every subscription, before any Delivery.
    Where several clients of a process share a broker, all but one are told not to `announce` it in the log.
    """

    def __init__(
        self,
        client_id: str,
        address: Address,
        *,
        on_event: Callable[[Delivery | Connection], None],
        subscriptions: Sequence[str] = (),
        will: Publication | None = None,
        clock: Callable[[], float] = seconds,
        credentials: Credentials | None = None,
        version: MqttVersion | str = MqttVersion.V3_1_1,
        announce: bool = True,
    ) -> None:
        self.client_id = client_id
        self._address = address
        self._on_event = on_event
        self._subscriptions = tuple(subscriptions)
        self._will = will
        self._clock = clock
        self._credentials = credentials
        self._version = PAHO_VERSION[MqttVersion(version)]
        self._announce = announce
        self._logged: str | None = None  # the trouble that the log already names
        self._answered = False  # True once the broker of this connection has answered
        self._refused: str | None = None  # the request that the broker of this connection refused
        self._early: list[Delivery] = []
        self._pending: dict[int | None, tuple[str, ...]] = {}  # by packet id, until the broker has answered
        self._lock = threading.Lock()
        self._paho: Client | None = None  # only while up
        self._last: MQTTMessageInfo | None = None
        self._waits: deque[tuple[float, MQTTMessageInfo]] = deque()  # each since when it waits
        self._late = False  # True if this connection ends because a message waited too long
        self._turned_at = 0.0  # time at which the client's thread was last at work
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"mqtt {client_id}", daemon=True)

    def start(self) -> None:
        """Connect, and reconnect until `close`; returns at once."""
        self._thread.start()

    def publish(self, publication: Publication, since: float | None = None) -> None:
        """Send now or raise NotConnected; nothing is kept for a later connection.

        `since`: when it was right to send it, now where that is not said. What is older than WAITS_S here, or
        once a process that was stopped goes on, never leaves: the connection ends, with all that waits.
        """
        self._sent(publication, since)

    def deliver(self, publication: Publication, within_s: float) -> None:
        """Send now, and return once the broker acknowledges; raises NotConnected if that takes too long."""
        sent = self._sent(publication)
        with suppress(ValueError, RuntimeError):  # the connection is over
            sent.wait_for_publish(within_s)
            if sent.is_published():
                return
        raise NotConnected(f"the MQTT broker at {self._address} did not say that it has it")

    def _sent(self, publication: Publication, since: float | None = None) -> MQTTMessageInfo:
        since = self._clock() if since is None else since
        with self._lock:
            if self._paho is None:
                raise NotConnected(f"the MQTT broker at {self._address} is not connected")
            info = self._paho.publish(
                publication.topic,
                publication.payload,
                publication.qos,
                publication.retain,
                self._properties(publication),
            )
            if info.rc != MQTTErrorCode.MQTT_ERR_SUCCESS:
                raise NotConnected(
                    f"the MQTT broker at {self._address} does not take messages: {info.rc.name}"
                )
            self._last = info
            self._late = self._late or self._clock() - since > WAITS_S
            self._waits.append((since, info))
            self._forget_sent()
            return info

    def _forget_sent(self) -> None:
        while self._waits and self._waits[0][1].is_published():
            self._waits.popleft()

    def _is_late(self) -> bool:
        """True if a message has waited too long to be sent; also notes the time. Called before each write.

        A queue that is long, or a broker that is slow, is no reason while this thread is at work.
        """
        with self._lock:
            now = self._clock()
            was_away, self._turned_at = now - self._turned_at > WAITS_S, now
            self._forget_sent()
            self._late = self._late or (was_away and bool(self._waits) and now - self._waits[0][0] > WAITS_S)
            return self._late

    def close(self) -> None:
        """Let what was published leave, disconnect (no last will) and join; idempotent."""
        with self._lock:
            paho, last = self._paho, self._last
        if paho is not None and last is not None:
            last.wait_for_publish(FLUSH_S)
        self._closing.set()
        if paho is not None:
            paho.disconnect()  # wakes its loop
        if self._thread.ident is not None:
            self._thread.join()

    def _properties(self, publication: Publication) -> Properties | None:
        """The expiry of a command, after which a broker drops it, and its answer; MQTT 5 only, else None."""
        if self._version != MQTTProtocolVersion.MQTTv5:
            return None
        properties = Properties(PacketTypes.PUBLISH)
        if not publication.retain and publication.qos > 0:
            properties.MessageExpiryInterval = EXPIRY_S
        if publication.reply:
            properties.ResponseTopic = publication.reply
        if publication.about:
            properties.CorrelationData = publication.about
        return properties

    # --- the client's thread ---

    def _run(self) -> None:
        delay = FIRST_RETRY_S
        while not self._closing.is_set():
            began = time.monotonic()
            self._serve_one_connection()
            # Only a connection that held starts the back-off anew: two clients with one id fight slowly.
            held = time.monotonic() - began > LAST_RETRY_S
            delay = FIRST_RETRY_S if held else delay
            self._closing.wait(delay)
            delay = min(2 * delay, LAST_RETRY_S)

    def _serve_one_connection(self) -> None:
        self._refused, self._answered, self._early, self._late = None, False, [], False
        paho = self._new_paho()
        try:
            paho.connect(
                self._address.host, self._address.port, KEEPALIVE_S, properties=self._largest_packet()
            )
            self._turned_at = self._clock()
            while paho.loop(WAKE_S) == MQTTErrorCode.MQTT_ERR_SUCCESS and not self._is_late():
                if self._closing.is_set():
                    paho.disconnect()
            trouble = self._end_in_words()
            if self._late and (there := paho.socket()) is not None:
                there.close()
        except (OSError, ValueError, struct.error) as error:
            trouble = self._refusal_of_tls(error) or str(error)
        self._down(paho, trouble)

    def _end_in_words(self) -> str:
        if self._late:
            return f"a message waited in this process for more than {WAITS_S:g} s and must not leave any more"
        return "connection lost" if self._answered else self._silence()

    def _silence(self) -> str:
        """A sentence on the likely cause where a broker ends a connection without an answer."""
        wants = f"a certificate of this client: ${CERTIFICATE}" if self._address.tls else f"TLS: {SECURE}"
        return f"it ended the connection without an answer; it may want {wants}"

    def _refusal_of_tls(self, error: Exception) -> str:
        """The cause of a TLS error and its remedy in one sentence; "" for any other error."""
        if isinstance(error, ssl.SSLCertVerificationError):
            why = error.verify_message.rstrip(".")
            return f"its certificate is not believed: {why}; {MISTRUST.get(error.verify_code, CHECK)}"
        if self._address.tls and isinstance(error, (ssl.SSLError, ConnectionResetError)):
            return f"no TLS there: {error.strerror}; name its port for TLS, or leave out {SECURE}"
        return ""

    def _largest_packet(self) -> Properties | None:
        """The limit of packets for the broker, as paho takes any size into memory; MQTT 5 only, else None."""
        if self._version != MQTTProtocolVersion.MQTTv5:
            return None
        properties = Properties(PacketTypes.CONNECT)
        properties.MaximumPacketSize = LARGEST_PACKET
        return properties

    def _new_paho(self) -> Client:
        paho = PromptClient(
            self._is_late,
            CallbackAPIVersion.VERSION2,
            client_id=self.client_id,
            clean_session=None if self._version == MQTTProtocolVersion.MQTTv5 else True,
            protocol=self._version,
            reconnect_on_failure=False,
        )
        paho.connect_timeout = CONNECT_TIMEOUT_S
        paho.max_inflight_messages_set(1)
        paho.max_queued_messages_set(QUEUE_LIMIT)
        if self._address.tls is not None:
            paho.tls_set_context(self._address.tls)
        if self._credentials is not None:
            paho.username_pw_set(self._credentials.user, self._credentials.password)
        if self._will is not None:
            paho.will_set(self._will.topic, self._will.payload, self._will.qos, self._will.retain)
        paho.on_socket_open = self._no_delay
        paho.on_socket_register_write = self._leave_writing_to_the_loop
        paho.on_connect = self._connected
        paho.on_subscribe = self._subscribed
        paho.on_message = self._received
        return paho

    @staticmethod
    def _no_delay(_paho: Client, _userdata: Any, sock: Any) -> None:
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    @staticmethod
    def _leave_writing_to_the_loop(_paho: Client, _userdata: Any, _sock: Any) -> None:
        """Does nothing; without this callback paho writes to the socket in the thread that publishes."""

    def _connected(
        self, paho: Client, _userdata: Any, _flags: Any, reason: ReasonCode, _properties: Any
    ) -> None:
        self._answered = True
        if reason.is_failure:
            user = f" user {self._credentials.user!r}" if self._credentials else " a client without user name"
            spoken = "5" if self._version == MQTTProtocolVersion.MQTTv5 else "3.1.1"
            self._refused = f"refused{user} over MQTT {spoken}: {reason}"
        elif self._subscriptions:
            self._subscribe(paho)
        else:
            self._up(paho)

    def _subscribe(self, paho: Client) -> None:
        self._pending = {}
        for first in range(0, len(self._subscriptions), AT_ONCE):
            topics = self._subscriptions[first : first + AT_ONCE]
            _, number = paho.subscribe([(topic, 1) for topic in topics])
            self._pending[number] = topics

    def _subscribed(self, paho: Client, _userdata: Any, mid: int, reasons: list[ReasonCode], _: Any) -> None:
        topics = self._pending.pop(mid, ())
        failed = [topic for topic, reason in zip(topics, reasons, strict=False) if reason.is_failure]
        if failed:
            self._refused = f"refused to subscribe {self.client_id} to {', '.join(failed)}"
            paho.disconnect()
        elif not self._pending and self._refused is None:
            self._up(paho)

    def _received(self, paho: Client, _userdata: Any, message: MQTTMessage) -> None:
        about = getattr(message.properties, "CorrelationData", b"")
        delivery = Delivery(self._clock(), message.topic, bytes(message.payload), message.retain, about)
        if paho is self._paho:
            self._on_event(delivery)
        else:  # a broker may deliver before it has answered the subscription
            self._early.append(delivery)

    def _up(self, paho: Client) -> None:
        with self._lock:
            self._paho, self._last = paho, None
        if self._logged is not None:
            self._tell(None, f"The MQTT broker at {self._address} is there.")
        self._on_event(Connection(at=self._clock(), client=self.client_id, up=True))
        for delivery in self._early:
            self._on_event(delivery)

    def _down(self, paho: Client, trouble: str) -> None:
        with self._lock:
            was_up, self._paho, self._last = self._paho is paho, None, None
            self._waits.clear()
        if was_up:
            self._on_event(Connection(at=self._clock(), client=self.client_id, up=False))
        if self._closing.is_set():
            return
        if self._refused is not None:
            self._tell(self._refused, f"The MQTT broker at {self._address} {self._refused}; trying again.")
        else:
            self._tell("gone", f"The MQTT broker at {self._address} is not there ({trouble}); trying again.")

    def _tell(self, trouble: str | None, sentence: str) -> None:
        """Log a change of the connection in one line, not one for each attempt."""
        if self._announce and trouble != self._logged:
            log.warning(sentence)
        self._logged = trouble
