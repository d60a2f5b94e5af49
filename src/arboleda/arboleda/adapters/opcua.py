"""The driver `opcua`: servers of OPC UA, by asyncua in a loop of its own.

A method that does not return at once holds up nothing but itself: every call is a task of that loop.
"""

from __future__ import annotations

import asyncio
import logging
import threading
from collections.abc import Iterable, Sequence
from concurrent.futures import Future
from concurrent.futures import TimeoutError as TooLate
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from arboleda.drivers import Clock, Command, Hear, NotSent, Report, Robot, Stop, driver, lost
from arboleda.drivers.opcua.machine import Call, OpcUaDevice, Read
from arboleda.drivers.opcua.settings import Settings
from arboleda.drivers.plc.plc_snapshot import UnreadableValue
from arboleda.drivers.port import DriverError

from .opcua_login import Login, login

if TYPE_CHECKING:
    from asyncua import Client
    from asyncua.ua import DataValue

MISSING = "asyncua is not installed, which it needs: pip install 'arboleda[opcua]'"
BEAT_S = 0.2  # period of reads and reports without a change
AGAIN_S = 0.5
CONNECT_S = 4.0  # for a session with its certificates
SESSION_MS = 30_000  # a server drops a silent session after this time: it has few of them
GOODBYE_S = 0.5
END_S = 1.0
ORDER_S = 1.0  # for the loop to take a command, which it does between two others
BEATS = 2**16
ENDS = (
    "BadSessionIdInvalid",
    "BadSessionClosed",
    "BadSessionNotActivated",
    "BadSecureChannelIdInvalid",
    "BadSecureChannelClosed",
    "BadConnectionClosed",
    "BadCommunicationError",
    "BadTimeout",
)
"""Status codes that say nothing of the method that was called: there is no session."""
MODES = {"sign": "Sign", "sign_and_encrypt": "SignAndEncrypt"}
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


@driver("opcua", settings=Settings)
class OpcUa:
    """Driver of one device, in a session of its own: a change wakes it, and it reads all values at once."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._thread: threading.Thread | None = None
        self._changed, self._ending = asyncio.Event(), asyncio.Event()
        self._client: Client | None = None
        self._broken: Exception | None = None
        self._calls: set[asyncio.Task[None]] = set()
        self._beats = 0
        self._said: Report | None = None

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        if len(devices) != 1:
            raise DriverError("a mapping is for one device")
        need_library()
        self._name, self._hear, self._clock = devices[0].name, hear, clock
        self._login = login(self._settings)
        self._device = OpcUaDevice(devices[0], self._settings)
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._run, name=f"opcua {self._name}", daemon=True)
        self._thread.start()

    def listen(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        """The same without a heartbeat: to the PLC nobody is there."""
        self._settings = replace(self._settings, heartbeat=None)
        self.start(devices, hear, clock)

    def send(self, command: Command) -> None:
        if self._client is None:
            raise NotSent(f"{self._settings.url} is not connected")
        taken: Future[None] = Future()
        self._loop.call_soon_threadsafe(self._take, command, taken)
        try:
            taken.result(ORDER_S)
        except TooLate as error:
            if taken.cancel():
                raise NotSent(f"{self._settings.url} is not connected") from error

    def stop(self) -> None:
        if self._thread is not None:
            self._loop.call_soon_threadsafe(self._ending.set)
            self._thread.join()

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._loop.set_exception_handler(_quiet)
        self._loop.run_until_complete(self._live())
        self._loop.close()

    async def _live(self) -> None:
        """Reach the server until `stop`.

        A cancellation can get lost, in `asyncio.wait_for` before Python 3.12 and in asyncua, so the end is
        said as well, and nobody is waited for without a limit.
        """
        reaching = self._loop.create_task(self._reach())
        await self._ending.wait()
        self._broken = ConnectionAbortedError("the driver ends")
        await _ended({reaching})
        await _ended(asyncio.all_tasks() - {asyncio.current_task()})

    async def _reach(self) -> None:
        while not self._ending.is_set():
            self._broken = self._said = None
            try:
                await self._serve()
            except Exception as error:  # noqa: BLE001 - asyncua raises its own and others; all mean: no link
                if self._ending.is_set():
                    return
                self._hear(lost(self._name, at=self._clock(), why=_why(self._settings, error)))
            await asyncio.sleep(AGAIN_S)

    async def _serve(self) -> None:
        """Report the values of the server until something breaks."""
        client = await _connected(self._settings, self._login)
        try:
            nodes = [client.get_node(node) for node in self._device.nodes]
            changes = Changes(self._changed)
            watched = await client.create_subscription(1000 * self._settings.publish_s, changes)
            await watched.subscribe_data_change(nodes)
            self._device.begin(await self._read(client, nodes))
            self._client = client
            while self._broken is None:
                self._changed.clear()
                at = self._clock()
                self._say(self._device.report(at, await self._read(client, nodes)))
                await self._beat(client)
                await self._rest()
            raise self._broken
        finally:
            self._client = None
            for call in self._calls:
                call.cancel()
            await _goodbye(client)

    async def _rest(self) -> None:
        """Wait for a change, or until a report is due without one."""
        beat = self._loop.call_later(BEAT_S, self._changed.set)
        await self._changed.wait()
        beat.cancel()

    async def _read(self, client: Client, nodes: list[Any]) -> Read:
        from asyncua import ua

        asked = client.uaclient.read_attributes([node.nodeid for node in nodes], ua.AttributeIds.Value)
        return values(self._device.nodes, await asyncio.wait_for(asked, self._settings.timeout_s))

    def _take(self, command: Command, taken: Future[None]) -> None:
        """Begin the call of a command, unless its sender has given up."""
        if not taken.set_running_or_notify_cancel():
            return
        try:
            self._begin(command)
            taken.set_result(None)
        except NotSent as error:
            taken.set_exception(error)

    def _begin(self, command: Command) -> None:
        client = self._client
        if client is None:
            raise NotSent(f"{self._settings.url} is not connected")
        order = self._device.order(command)
        if order is not None:
            call = self._loop.create_task(self._call(client, command, order))
            self._calls.add(call)
            call.add_done_callback(self._calls.discard)

    async def _call(self, client: Client, command: Command, order: Call) -> None:
        """Call the method of a command; a bad status code rejects it, anything else ends the session.

        A stop that is refused ends it as well: nobody knows any more what the device will do.
        """
        from asyncua import ua

        try:
            given = [ua.Variant(value, getattr(ua.VariantType, TYPES[type])) for type, value in order.given]
            called = client.get_node(order.on).call_method(ua.NodeId.from_string(order.method), *given)
            await asyncio.wait_for(called, self._settings.timeout_s)
        except ua.UaStatusCodeError as error:
            name = ua.status_codes.get_name_and_doc(error.code)[0]
            if name in ENDS:
                self._broken = error
            elif isinstance(command, Stop):
                self._broken = UnreadableValue(f"{order.method} was refused: {name}")
            else:
                self._hear(Report(at=self._clock(), robot=self._name, rejected=command.id, refusal=name))
        except asyncio.TimeoutError:
            self._broken = ConnectionError(f"{order.method} has not returned; methods must return at once")
        except Exception as error:  # noqa: BLE001 - as above; nobody waits for this task
            self._broken = error
        self._changed.set()

    async def _beat(self, client: Client) -> None:
        """Write the heartbeat to the server, which has to stop by itself once it ends."""
        from asyncua import ua

        if self._settings.heartbeat is not None:
            self._beats = (self._beats + 1) % BEATS
            value = ua.DataValue(ua.Variant(self._beats, ua.VariantType.UInt16))
            written = client.get_node(self._settings.heartbeat).write_value(value)
            await asyncio.wait_for(written, self._settings.timeout_s)

    def _say(self, report: Report) -> None:
        """Hand over a report if it is news, and otherwise from time to time."""
        before = self._said
        if before is not None and report.again(before.at) == before and report.at - before.at < BEAT_S:
            return
        self._said = report
        self._hear(report)


class Changes:
    """Handler of a subscription: it only notes that something has changed; the values are read then."""

    def __init__(self, changed: asyncio.Event) -> None:
        self._changed = changed

    def datachange_notification(self, node: object, value: object, data: object) -> None:
        self._changed.set()


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


async def _connected(settings: Settings, found: Login) -> Client:
    from asyncua import Client, ua
    from asyncua.crypto.security_policies import SecurityPolicyBasic256Sha256

    client = Client(settings.url, timeout=CONNECT_S)
    client.session_timeout = SESSION_MS
    if found.user is not None:
        client.set_user(found.user)
        client.set_password(found.password)
    if settings.security != "none":
        client.application_uri = found.application
        mode = getattr(ua.MessageSecurityMode, MODES[settings.security])
        policy = SecurityPolicyBasic256Sha256
        await client.set_security(policy, found.certificate, found.key, None, found.server, mode=mode)
    try:
        await asyncio.wait_for(client.connect(), CONNECT_S)
    except BaseException:  # a cancellation too: a socket that is half open would stay
        await _goodbye(client)
        raise
    return client


async def _goodbye(client: Client) -> None:
    """Disconnect politely, without waiting for an answer."""
    with suppress(Exception):
        await asyncio.wait_for(client.disconnect(), GOODBYE_S)
    client.disconnect_socket()


async def _ended(tasks: Iterable[asyncio.Task[Any]]) -> None:
    """Cancel tasks and wait for their end, but not for one that refuses to."""
    waited_for = set(tasks)
    for task in waited_for:
        task.cancel()
    if waited_for:
        await asyncio.wait(waited_for, timeout=END_S)


def _quiet(loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
    """Ignores errors of asyncua's own tasks: where one matters, the next read fails and says so."""


def need_library() -> None:
    """Raises DriverError with install advice if asyncua is missing; otherwise silences its log."""
    try:
        import asyncua
    except ImportError as error:
        raise DriverError(MISSING) from error
    logging.getLogger(asyncua.__name__).setLevel(logging.CRITICAL)  # the plant reports the same


def _why(settings: Settings, error: Exception) -> str:
    if isinstance(error, UnreadableValue):
        return str(error)
    if isinstance(error, ConnectionRefusedError):
        return f"{settings.url} is not there"
    if isinstance(error, asyncio.TimeoutError):
        return f"{settings.url} does not answer"
    from asyncua.common.utils import NotEnoughData
    from asyncua.ua.uaerrors import UaError

    if isinstance(error, UaError | OSError) and not isinstance(error, NotEnoughData):
        return f"{settings.url}: {error or type(error).__name__}"
    return f"{settings.url} has sent what cannot be read: {error or type(error).__name__}"
