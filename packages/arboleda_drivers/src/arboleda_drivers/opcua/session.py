"""Session at an OPC UA server: reads and writes below the limits of the server, and ids by namespace URI."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, TypeVar

from arboleda.drivers import Value
from arboleda_drivers.connections.abrupt import end_abruptly
from arboleda_drivers.opcua.machine import Call, NodeValue, Read
from arboleda_drivers.opcua.nodes import namespace
from arboleda_drivers.opcua.settings import Settings
from arboleda_drivers.plc.plc_snapshot import UnreadableValue

from .login import Login

if TYPE_CHECKING:
    from asyncua import Client
    from asyncua.ua import DataValue, NodeId, Variant

CONNECT_S = 4.0  # for a session with its certificates
SESSION_MS = 30_000  # a server drops a silent session after this time: it has few of them
GOODBYE_S = 0.5
NAMESPACES = "i=2255"
PER_READ, PER_WRITE, PER_SUBSCRIPTION = "i=11705", "i=11707", "i=11714"
"""Nodes of the standard that say how many values one request of that kind may have; 0: any number."""
MODES = {"sign": "Sign", "sign_and_encrypt": "SignAndEncrypt"}
POLICIES = {
    "basic256sha256": "SecurityPolicyBasic256Sha256",
    "aes128_sha256_rsaoaep": "SecurityPolicyAes128Sha256RsaOaep",
    "aes256_sha256_rsapss": "SecurityPolicyAes256Sha256RsaPss",
}
TYPES = {
    "bool": "Boolean",
    "sbyte": "SByte",
    "byte": "Byte",
    "int16": "Int16",
    "uint16": "UInt16",
    "int32": "Int32",
    "uint32": "UInt32",
    "int64": "Int64",
    "uint64": "UInt64",
    "float": "Float",
    "double": "Double",
    "string": "String",
}
T = TypeVar("T")


class WriteRefused(Exception):
    """Error: a server has not taken a value; `status` is the name of its status code."""

    def __init__(self, node: str, status: str) -> None:
        super().__init__(f"{node}: {status}")
        self.status = status


class Session:
    """Session with the limits and namespaces of its server; nobody is waited for without a limit."""

    def __init__(self, client: Client, timeout_s: float) -> None:
        self._client, self._timeout_s = client, timeout_s
        self._namespaces: Sequence[str] = ()
        self._limits: Mapping[str, int] = {}

    async def learn(self) -> None:
        """Ask the server for its limits and namespaces; one that has no limits to tell has none."""
        found: dict[str, object] = {}
        for node in (NAMESPACES, PER_READ, PER_WRITE, PER_SUBSCRIPTION):  # one per request is always allowed
            (answer,) = await self._answers([node])
            good = answer.StatusCode is None or answer.StatusCode.is_good()
            found[node] = answer.Value.Value if good and answer.Value is not None else None
        names = found.pop(NAMESPACES)
        self._namespaces = [str(name) for name in names] if isinstance(names, list) else ()
        self._limits = {node: most for node, most in found.items() if isinstance(most, int) and most > 0}

    async def subscribe(self, nodes: Sequence[str], period_s: float, changes: object) -> None:
        """Have the server say when one of these nodes has changed."""
        handler: Any = changes
        watched = await self._client.create_subscription(1000 * period_s, handler)
        for some in batches(nodes, self._limits.get(PER_SUBSCRIPTION)):
            await watched.subscribe_data_change([self._client.get_node(self._id(node)) for node in some])

    async def read(self, nodes: Sequence[str]) -> Read:
        """The values of nodes, read in this order; raises UnreadableValue if one of them is not good."""
        answers: list[DataValue] = []
        for some in batches(nodes, self._limits.get(PER_READ)):
            answers += await self._answers(some)
        return values(nodes, answers)

    async def write(self, puts: Sequence[NodeValue]) -> None:
        """Write values, in any order; raises WriteRefused for the first that the server has not taken."""
        from asyncua import ua

        for some in batches(puts, self._limits.get(PER_WRITE)):
            data = [ua.DataValue(_variant(put.value, put.type)) for put in some]
            nodes = [self._id(put.node) for put in some]
            statuses = await self._in_time(self._client.uaclient.write_attributes(nodes, data))
            if len(statuses) != len(some):
                raise UnreadableValue(f"the server has taken {len(statuses)} values, not {len(some)}")
            for put, status in zip(some, statuses, strict=True):
                if not status.is_good():
                    raise WriteRefused(put.node, status.name)

    async def call(self, order: Call) -> None:
        """Call a method; raises asyncua's error for a bad status."""
        given = [_variant(value, type) for type, value in order.given]
        target = self._client.get_node(self._id(order.on))
        await self._in_time(target.call_method(self._id(order.method), *given))

    async def leave(self) -> None:
        """Disconnect politely, without waiting for an answer."""
        await _goodbye(self._client)

    async def _answers(self, nodes: Sequence[str]) -> list[DataValue]:
        from asyncua import ua

        ids = [self._id(node) for node in nodes]
        return await self._in_time(self._client.uaclient.read_attributes(ids, ua.AttributeIds.Value))

    async def _in_time(self, awaitable: Awaitable[T]) -> T:
        return await asyncio.wait_for(awaitable, self._timeout_s)

    def _id(self, node: str) -> NodeId:
        """The id of a node, with the number that the namespace has in this session."""
        from asyncua import ua

        uri = namespace(node)
        if uri is not None:
            if uri not in self._namespaces:
                known = ", ".join(self._namespaces) or "none"
                raise UnreadableValue(f"{node}: the server has no namespace {uri}; there are {known}")
            node = f"ns={self._namespaces.index(uri)};{node.partition(';')[2]}"
        return ua.NodeId.from_string(node)


def batches(rows: Sequence[T], most: int | None) -> Iterator[Sequence[T]]:
    """The rows in their order, so many at a time; all at once if there is no limit."""
    step = most or max(1, len(rows))
    return (rows[at : at + step] for at in range(0, len(rows), step))


def values(nodes: Sequence[str], answers: Sequence[DataValue]) -> Read:
    """The values that a server answered, by node; raises UnreadableValue if one of them is not good."""
    if len(answers) != len(nodes):
        raise UnreadableValue(f"the server has answered with {len(answers)} values, not {len(nodes)}")
    read: dict[str, object] = {}
    for node, answer in zip(nodes, answers, strict=True):
        if answer.StatusCode is not None and not answer.StatusCode.is_good():
            raise UnreadableValue(f"{node} is {answer.StatusCode.name}")
        read[node] = None if answer.Value is None else answer.Value.Value
    return read


async def opened(settings: Settings, found: Login) -> Session:
    """A session at the server, which knows its limits and namespaces."""
    from asyncua import Client, ua
    from asyncua.crypto import security_policies

    client = Client(settings.url, timeout=CONNECT_S)
    client.session_timeout = SESSION_MS
    if found.user is not None:
        client.set_user(found.user)
        client.set_password(found.password)
    if settings.security != "none":
        client.application_uri = found.application
        mode = getattr(ua.MessageSecurityMode, MODES[settings.security])
        policy = getattr(security_policies, POLICIES[settings.policy])
        await client.set_security(policy, found.certificate, found.key, None, found.server, mode=mode)
    session = Session(client, settings.timeout_s)
    try:
        await asyncio.wait_for(client.connect(), CONNECT_S)
        protocol = client.uaclient.protocol
        if protocol is not None and protocol.transport is not None:  # asyncua closes it by itself, too
            end_abruptly(protocol.transport.get_extra_info("socket"))
        await session.learn()
    except AssertionError as error:  # asyncua's, where an answer is a fault in place of a secure channel
        await _goodbye(client)
        hint = f"it may not trust the certificate, want other key usages in it, or not have {settings.policy}"
        raise UnreadableValue(f"{settings.url} has refused the secure channel: {hint}") from error
    except BaseException:  # a cancellation too: a socket that is half open would stay
        await _goodbye(client)
        raise
    return session


async def _goodbye(client: Client) -> None:
    with suppress(Exception):
        await asyncio.wait_for(client.disconnect(), GOODBYE_S)
    client.disconnect_socket()
    await asyncio.sleep(0)  # the loop closes it before anybody is told


def _variant(value: Value, type: str) -> Variant:
    from asyncua import ua

    return ua.Variant(value, getattr(ua.VariantType, TYPES[type]))
