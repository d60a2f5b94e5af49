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
from dataclasses import replace
from typing import Any

from arboleda.drivers import Clock, Command, DriverError, Hear, NotSent, Report, Robot, Stop, driver, lost
from arboleda_drivers.opcua.machine import Call, NodeValue, OpcUaDevice, Writing
from arboleda_drivers.opcua.settings import Settings
from arboleda_drivers.plc.plc_snapshot import UnreadableValue
from arboleda_drivers.plc.variables import FORMS, LIMITS, Form

from .login import login
from .session import Session, WriteRefused, opened

MISSING = "asyncua is not installed, which it needs: pip install 'arboleda[opcua]'"
BEAT_S = 0.2  # period of reads and reports without a change
AGAIN_S = 0.5
END_S = 1.0
ORDER_S = 1.0  # for the loop to take a command, which it does between two others
MOST_BEATS = 2**16
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


@driver("opcua", settings=Settings)
class OpcUa:
    """Driver of one device, in a session of its own: a change wakes it, and it reads all values at once."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._thread: threading.Thread | None = None
        self._changed, self._ending = asyncio.Event(), asyncio.Event()
        self._session: Session | None = None
        self._broken: Exception | None = None
        self._calls: set[asyncio.Task[None]] = set()
        self._beats = self._stops = 0
        self._last: Report | None = None

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
        if self._session is None:
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
            self._broken = self._last = None
            try:
                await self._serve()
            except Exception as error:  # noqa: BLE001 - asyncua raises its own and others; all mean: no link
                if self._ending.is_set():
                    return
                self._hear(lost(self._name, at=self._clock(), why=_why(self._settings, error)))
            await asyncio.sleep(AGAIN_S)

    async def _serve(self) -> None:
        """Report the values of the server until something breaks."""
        session = await opened(self._settings, self._login)
        try:
            nodes = self._device.places
            await session.subscribe(nodes, self._settings.publish_s, Changes(self._changed))
            self._device.begin(await session.read(nodes))
            self._session = session
            while self._broken is None:
                self._changed.clear()
                at = self._clock()
                self._say(self._device.report(at, await session.read(nodes)))
                await self._beat(session)
                await self._rest()
            raise self._broken
        finally:
            self._session = None
            for call in self._calls:
                call.cancel()
            await session.leave()

    async def _rest(self) -> None:
        """Wait for a change, or until a report is due without one."""
        beat = self._loop.call_later(BEAT_S, self._changed.set)
        await self._changed.wait()
        beat.cancel()

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
        session = self._session
        if session is None:
            raise NotSent(f"{self._settings.url} is not connected")
        order = self._device.order(command)
        if isinstance(command, Stop):
            self._stops += 1
        if order is not None:
            call = self._loop.create_task(self._give(session, command, order, self._stops))
            self._calls.add(call)
            call.add_done_callback(self._calls.discard)

    async def _give(self, session: Session, command: Command, order: Call | Writing, stops: int) -> None:
        """Call or write what a command is; a bad status code rejects it, anything else ends the session.

        A stop that is refused ends it as well: nobody knows any more what the device will do. `stops` is the
        number of stops before the command.
        """
        from asyncua import ua

        try:
            if isinstance(order, Writing):
                await self._write(session, command, order, stops)
            else:
                await session.call(order)
        except (ua.UaStatusCodeError, WriteRefused) as error:
            self._refused(command, order, error)
        except asyncio.TimeoutError:
            what = "the server has not answered a write"
            if isinstance(order, Call):
                what = f"{order.method} has not returned; methods must return at once"
            self._broken = ConnectionError(what)
        except Exception as error:  # noqa: BLE001 - as above; nobody waits for this task
            self._broken = error
        self._changed.set()

    async def _write(self, session: Session, command: Command, order: Writing, stops: int) -> None:
        """Write step by step, unless a stop comes between two: what has not begun then must not begin."""
        for at, step in enumerate(order.steps):
            if self._stops != stops and not isinstance(command, Stop):
                if order.begins_last:
                    self._reject(command, "stopped")
                return
            try:
                await session.write(step)
            except WriteRefused as error:
                if at > 0 and not order.begins_last:
                    raise UnreadableValue(f"{error}; what was written before may have begun") from error
                raise

    def _refused(self, command: Command, order: Call | Writing, error: Exception) -> None:
        """Take a bad status code for a command."""
        from asyncua import ua

        name = error.status if isinstance(error, WriteRefused) else ""
        if isinstance(error, ua.UaStatusCodeError):
            name = ua.status_codes.get_name_and_doc(error.code)[0]
        if name in ENDS:
            self._broken = error
        elif isinstance(command, Stop):
            what = (
                f"{order.method} was refused: {name}" if isinstance(order, Call) else f"{error}, for a stop"
            )
            self._broken = UnreadableValue(what)
        else:
            self._reject(command, str(error) if isinstance(error, WriteRefused) else name)

    def _reject(self, command: Command, refusal: str) -> None:
        self._hear(Report(at=self._clock(), robot=self._name, rejected=command.id, refusal=refusal))

    async def _beat(self, session: Session) -> None:
        """Write the heartbeat to the server, which has to stop by itself once it ends."""
        node, type = self._settings.heartbeat, self._settings.heartbeat_type
        if node is None:
            return
        self._beats = (self._beats + 1) % beats(type)
        value = float(self._beats) if type in FORMS[float] else self._beats
        try:
            await session.write([NodeValue(node=node, type=type, value=value)])
        except WriteRefused as error:
            hint = f"it was written as heartbeat_type: {type}"
            raise UnreadableValue(f"the heartbeat is refused: {error}; {hint}") from error

    def _say(self, report: Report) -> None:
        """Hand over a report if it is news, and otherwise from time to time."""
        before = self._last
        if before is not None and report.again(before.at) == before and report.at - before.at < BEAT_S:
            return
        self._last = report
        self._hear(report)


class Changes:
    """Handler of a subscription: it only notes that something has changed; the values are read then."""

    def __init__(self, changed: asyncio.Event) -> None:
        self._changed = changed

    def datachange_notification(self, node: object, value: object, data: object) -> None:
        self._changed.set()


def beats(type: Form) -> int:
    """After how many heartbeats their number is 0 again: what fits into that type."""
    return min(MOST_BEATS, LIMITS[type][1] + 1) if type in LIMITS else MOST_BEATS


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
        return f"{settings.url}: {str(error) or type(error).__name__}"
    return f"{settings.url} has sent what cannot be read: {str(error) or type(error).__name__}"
