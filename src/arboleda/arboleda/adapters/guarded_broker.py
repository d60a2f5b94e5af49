"""amqtt's broker with what it lacks: who may do what, takeover, keep-alive, no stray retained messages.

amqtt 0.12.1 checks a password only after it has dropped the session of the same client id, lets a last will
go anywhere, leaves the older of two connections alive (its will then overwrites the newer one's presence),
ignores keep-alives, sends every newcomer the retained messages of everybody's subscriptions, and can lose
messages when a topic plugin suspends its loop over the subscriptions. So methods are replaced here instead.
"""

from __future__ import annotations

import asyncio
import hmac
import socket
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from math import ceil
from typing import Any
from weakref import WeakValueDictionary

from amqtt.adapters import StreamReaderAdapter, StreamWriterAdapter
from amqtt.broker import Broker, Server
from amqtt.contexts import Action, BrokerConfig
from amqtt.errors import AMQTTError
from amqtt.mqtt.protocol.broker_handler import BrokerProtocolHandler
from amqtt.session import Session
from amqtt.utils import gen_client_id

from arboleda.wire.topics import Channel, topic

HELLO_S = 5.0  # an open connection has this long to say CONNECT
BOARDS_WRITE = (Channel.TELEMETRY, Channel.PRESENCE)


@dataclass(frozen=True, kw_only=True)
class Access:
    """A board writes its own telemetry and presence and reads its own topics; `trusted` does everything;
    any other user reads everything and writes nothing."""

    passwords: Mapping[str, str]
    boards: frozenset[str]
    trusted: str

    def knows(self, session: Session) -> bool:
        """Whether the client may come in; its last will is held to the same rules as its messages."""
        expected = self.passwords.get(session.username or "")
        if expected is None or not hmac.compare_digest(expected.encode(), (session.password or "").encode()):
            return False
        return not session.will_flag or self.may(session.username, session.will_topic or "", Action.PUBLISH)

    def may(self, user: str | None, name: str, action: Action) -> bool:
        """Whether `user` may publish to or receive from the topic, or subscribe to the filter, `name`."""
        if user == self.trusted:
            return True
        if user not in self.boards:
            return action != Action.PUBLISH
        if action == Action.PUBLISH:
            return name in {topic(user, channel) for channel in BOARDS_WRITE}
        return name.split("/")[0] == user


class AbortableWriter(StreamWriterAdapter):
    """A connection that can be cut without waiting for the other side."""

    def abort(self) -> None:
        self._writer.transport.abort()


class GuardedBroker(Broker):
    """Serves `listener`; without `access` anybody may do anything. Every session is clean: no goal outlives
    the connection it was meant for."""

    def __init__(self, listener: socket.socket, access: Access | None) -> None:
        super().__init__(BrokerConfig(plugins={}), loop=asyncio.get_running_loop())
        self._listener = listener
        self._access = access
        self._newest: dict[str, AbortableWriter] = {}
        self._turns: WeakValueDictionary[str, asyncio.Lock] = WeakValueDictionary()
        self._open: set[AbortableWriter] = set()
        self._ending = False

    def abort_all(self) -> None:
        """Cut every connection, and those that still wait to be accepted."""
        self._ending = True
        for writer in tuple(self._open):
            writer.abort()

    async def _create_server_instance(self, listener_name: str, *_: Any) -> asyncio.Server:
        connected = partial(self.stream_connected, listener_name=listener_name)
        return await asyncio.start_server(connected, sock=self._listener)

    async def stream_connected(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, listener_name: str
    ) -> None:
        # asyncio sets it only on sockets that it made itself
        writer.get_extra_info("socket").setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        connection = AbortableWriter(writer)
        self._open.add(connection)
        if self._ending:
            connection.abort()
        try:
            await self._client_connected(listener_name, StreamReaderAdapter(reader), connection)
        finally:
            self._open.discard(connection)
            writer.close()

    async def _initialize_client_session(
        self, reader: Any, writer: Any, *_: Any
    ) -> tuple[BrokerProtocolHandler, Session]:
        hello = BrokerProtocolHandler.init_from_connect(reader, writer, self.plugins_manager)
        try:
            handler, session = await asyncio.wait_for(hello, HELLO_S)
        except asyncio.TimeoutError:
            raise AMQTTError("no CONNECT in time") from None
        session.client_id = session.client_id or gen_client_id()
        session.clean_session = True
        return handler, session

    async def _handle_client_session(
        self,
        reader: Any,
        writer: Any,
        session: Session,
        handler: BrokerProtocolHandler,
        server: Server,
        name: str,
    ) -> None:
        if not await self._authenticate(session):
            handler.attach(session, reader, writer)
            await handler.mqtt_connack_authorize(False)
            return
        client = str(session.client_id)
        if client in self._newest:
            self._newest[client].abort()
        self._newest[client] = writer
        async with self._turns.setdefault(
            client, asyncio.Lock()
        ):  # the one before has ended, its will is out
            try:
                self._enforce_keep_alive(session, handler, writer)
                await super()._handle_client_session(reader, writer, session, handler, server, name)
            finally:
                self._sessions.pop(client, None)
                await self._del_all_subscriptions(session)
                if self._newest[client] is writer:
                    del self._newest[client]

    @staticmethod
    def _enforce_keep_alive(
        session: Session, handler: BrokerProtocolHandler, writer: AbortableWriter
    ) -> None:
        session.keep_alive = ceil(1.5 * session.keep_alive)
        handler.handle_read_timeout = writer.abort

    async def _authenticate(self, session: Session, *_: Any) -> bool:
        session.is_anonymous = self._access is None
        return self._access is None or self._access.knows(session)

    async def _topic_filtering(self, session: Session, topic: str, action: Action) -> bool:
        return self._access is None or self._access.may(session.username, topic, action)

    async def _publish_retained_messages_for_subscription(
        self, subscription: tuple[str, int], session: Session
    ) -> None:
        holders = self._subscriptions.get(subscription[0], ())
        if any(holder is session for holder, _qos in holders):
            await super()._publish_retained_messages_for_subscription(subscription, session)
