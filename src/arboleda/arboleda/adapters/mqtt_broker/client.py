"""Connection to the broker, from its first byte to its end."""

from __future__ import annotations

import asyncio
import logging
import socket
from collections.abc import Callable

from . import limits, packets
from .access import ALLOWED, ClientIdentity
from .limits import Allowance, Bucket
from .outbox import Outbox
from .packets import Answer, Kind, Message, Packet, ProtocolError
from .router import Router
from .sessions import Sessions
from .silence import Silence
from .topics import is_filter, is_wild

LOG = logging.getLogger(__name__)
FLUSH_BYTES = 32 * 1024  # bytes of unread answers, beyond which a client's packets have to wait
SEND_BUFFER_BYTES = 128 * 1024  # buffer in the kernel, where a connection could otherwise have megabytes


class Client(asyncio.BufferedProtocol):
    """A client of one broker. All that happens to it happens in the event loop's thread.

    It is cut off (`cut`) for what MQTT or the limits do not allow; its last will goes out then, before
    anything else is done.
    """

    def __init__(self, sessions: Sessions, router: Router) -> None:
        self.who: ClientIdentity | None = None  # until it has logged in
        self.idle = True  # it has neither published nor subscribed
        self._sessions = sessions
        self._router = router
        self._client_id = ""
        self._filters: set[str] = set()
        self._loop = asyncio.get_running_loop()
        self._stream = packets.Stream()
        self._read = bytearray(limits.PACKET_BYTES)
        self._will: Message | None = None
        self._half_received: set[int] = set()  # ids of QoS 2 between PUBLISH and PUBREL
        self._silence = Silence(self._loop, self.cut)
        self._rest: asyncio.TimerHandle | None = None
        self._rest_s = 0.0
        self._reads_slowly = False
        self._over = False
        self._allowed: Allowance | None = None  # None: as much as it wants
        self._bucket: Bucket | None = None

    # --- called by asyncio ---

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)
        self._transport = transport
        self._outbox = Outbox(transport, self.cut)  # the end of a connection needs it, whatever raises here
        sock = transport.get_extra_info("socket")
        # asyncio sets it only on sockets that it made itself
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER_BYTES)
        self._silence.watch(limits.HELLO_S)
        self._sessions.came(self)

    def connection_lost(self, exc: Exception | None) -> None:
        self._end()

    def get_buffer(self, sizehint: int) -> bytearray:
        return self._read

    def buffer_updated(self, nbytes: int) -> None:
        self._silence.last_data_at = self._loop.time()
        self._stream.feed(memoryview(self._read)[:nbytes])
        self._work()

    def pause_writing(self) -> None:
        self._reads_slowly = True

    def resume_writing(self) -> None:
        self._reads_slowly = False
        self._work()

    # --- called by sessions ---

    def cut(self, why: str) -> None:
        """End the connection at once; idempotent."""
        if not self._over:
            LOG.debug("client %.80a is cut off: %s", self._client_id, why)
            self._end()
            self._transport.abort()

    # --- its packets ---

    def _work(self) -> None:
        """Handle the packets received, for no longer than a turn."""
        until = self._loop.time() + limits.TURN_S
        try:
            while not (self._over or self._rest or self._reads_slowly):
                packet = self._stream.next()
                if packet is None:
                    break
                self._handle(packet)
                if self._outbox.waiting_bytes > FLUSH_BYTES:
                    self._outbox.flush()
                if self._rest_s or self._loop.time() > until:
                    self._rest = self._loop.call_later(self._rest_s, self._go_on)
                    self._rest_s = 0.0
        except ProtocolError as error:
            self.cut(str(error))
        if not self._over:
            if self._rest or self._reads_slowly:
                self._transport.pause_reading()
            else:
                self._transport.resume_reading()
        self._outbox.flush()
        self._router.flush()

    def _go_on(self) -> None:
        self._rest = None
        self._work()

    def _handle(self, packet: Packet) -> None:
        if (packet.kind is Kind.CONNECT) is not (self.who is None):
            raise ProtocolError(f"{packet.kind.name} at the wrong time")
        handle = HANDLERS.get(packet.kind)
        if handle is None:
            raise ProtocolError(f"{packet.kind.name} is for brokers to send")
        handle(self, packet)

    def _connect(self, packet: Packet) -> None:
        try:
            connect = packets.read_connect(packet.body)
            id = connect.client_id
            if len(id.encode()) > limits.CLIENT_ID_BYTES or not (id or connect.clean):
                raise packets.ConnectRefused(Answer.CLIENT_ID)
            who = self._sessions.log_in(self, connect, shown_name(self._transport))
        except packets.ConnectRefused as refused:
            self._refuse(refused.answer)
            return
        self.who, self._client_id, self._will = who, connect.client_id, connect.will
        self._allowed = ALLOWED.get(who.role)
        self._bucket = self._sessions.bucket(who)
        self._silence.watch(1.5 * connect.keep_alive_s)
        self._outbox.write(packets.connack(Answer.ACCEPTED))

    def _refuse(self, answer: Answer) -> None:
        """Refuse the login after a pause, in which the client waits with those not logged in yet."""
        self._silence.watch(limits.REFUSED_S, lambda: self._say_no(answer))
        self._rest_s = limits.HELLO_S  # further packets are ignored

    def _say_no(self, answer: Answer) -> None:
        self._transport.write(packets.connack(answer))
        self._transport.close()

    def _publish(self, packet: Packet) -> None:
        message, number = packets.read_publish(packet)
        self.idle = False
        self._use(1.0)
        again = message.qos == 2 and number in self._half_received
        if message.qos == 2:
            self._half_received.add(number)
            if len(self._half_received) > limits.UNACKNOWLEDGED:
                raise ProtocolError("too many messages of QoS 2 without PUBREL")
        if not again:
            self._router.publish(self._known, message)
        if message.qos:
            answer = Kind.PUBACK if message.qos == 1 else Kind.PUBREC
            self._outbox.write(packets.acknowledge(answer, number))

    def _publish_released(self, packet: Packet) -> None:
        number = packets.read_id(packet.body)
        self._half_received.discard(number)
        self._outbox.write(packets.acknowledge(Kind.PUBCOMP, number))

    def _acknowledged(self, packet: Packet) -> None:
        self._outbox.acknowledged(packets.read_id(packet.body))

    def _subscribe(self, packet: Packet) -> None:
        number, wanted = packets.read_subscribe(packet.body)
        self.idle = False
        granted = []
        for pattern, qos in wanted:
            granted.append(min(qos, 1) if self._may_subscribe(pattern) else packets.FAILED)
            if granted[-1] != packets.FAILED:
                self._router.subscribe(self._outbox, pattern, granted[-1])
                self._filters.add(pattern)
            self._use(limits.WILDCARD_COST if is_wild(pattern) else 1.0)
        self._outbox.write(packets.suback(number, granted))
        for (pattern, _), qos in zip(wanted, granted, strict=True):
            if qos != packets.FAILED and not self._over:
                self._router.send_retained(self._outbox, pattern, qos)

    def _may_subscribe(self, pattern: str) -> bool:
        if not is_filter(pattern):
            raise ProtocolError("a filter that is none, or too long")
        if not self._sessions.access.may_read(self._known, pattern):
            return False
        if self._allowed is None or pattern in self._filters:
            return True
        if is_wild(pattern) and sum(map(is_wild, self._filters)) >= self._allowed.wildcards:
            return False
        return len(self._filters) < self._allowed.filters and self._router.has_room(pattern)

    def _unsubscribe(self, packet: Packet) -> None:
        number, filters = packets.read_unsubscribe(packet.body)
        mine = self._filters.intersection(filters)
        self._router.unsubscribe(self._outbox, mine)
        self._filters -= mine
        self._outbox.write(packets.acknowledge(Kind.UNSUBACK, number))

    def _ping(self, packet: Packet) -> None:
        self._use(1.0)
        self._outbox.write(packets.pingresp())

    def _disconnect(self, packet: Packet) -> None:
        self._will = None
        self._outbox.flush()
        self._end()
        if self._transport.get_write_buffer_size():  # closing would wait until all is read
            self._transport.abort()
        else:
            self._transport.close()

    # --- its limits ---

    @property
    def _known(self) -> ClientIdentity:
        assert self.who is not None
        return self.who

    def _use(self, count: float) -> None:
        if self._bucket is not None:
            self._rest_s = self._bucket.take(count, self._loop.time())

    def _end(self) -> None:
        if self._over:
            return
        self._over = True
        self._outbox.over = True
        self._silence.end()
        if self._rest is not None:
            self._rest.cancel()
        will, self._will = self._will, None
        self._sessions.went(self)
        self._router.forget(self._outbox, self._filters)
        if will is not None and self.who is not None:
            self._router.publish_will(self.who, will)
        self._router.flush()


def shown_name(transport: asyncio.Transport) -> str:
    """The name in a client's certificate; "" if it has shown none."""
    subject = (transport.get_extra_info("peercert") or {}).get("subject", ())
    return next((value for part in subject for name, value in part if name == "commonName"), "")


HANDLERS: dict[Kind, Callable[[Client, Packet], None]] = {
    Kind.CONNECT: Client._connect,
    Kind.PUBLISH: Client._publish,
    Kind.PUBREL: Client._publish_released,
    Kind.PUBACK: Client._acknowledged,
    Kind.SUBSCRIBE: Client._subscribe,
    Kind.UNSUBSCRIBE: Client._unsubscribe,
    Kind.PINGREQ: Client._ping,
    Kind.DISCONNECT: Client._disconnect,
}
