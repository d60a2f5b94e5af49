"""The driver `pylabrobot`: laboratory devices that PyLabRobot drives, each in an event loop of its own."""

from __future__ import annotations

import asyncio
import inspect
import threading
from collections.abc import Awaitable, Callable, Sequence
from contextlib import suppress
from functools import partial
from importlib import import_module
from typing import Any

from arboleda.drivers import Clock, Command, DriverError, Hear, NotSent, Report, Robot, driver, text_of_error
from arboleda_drivers.connections.link import Close, Closed, CommandNotSent, CommandRequest, Open, Opened
from arboleda_drivers.pylabrobot.machine import Machine
from arboleda_drivers.pylabrobot.messages import (
    BeginCalls,
    Begun,
    CancelCalls,
    Event,
    Look,
    Looked,
    LookFailed,
    Message,
    Raised,
    Returned,
)
from arboleda_drivers.pylabrobot.paths import steps
from arboleda_drivers.pylabrobot.settings import LABWARE, Call, MachineMapping, Settings

MISSING = "PyLabRobot is not installed, which it needs: pip install 'arboleda[pylabrobot]'"
NO_LISTENING = "a machine of PyLabRobot is reached by its setup, which may move it; begin the plant to try it"
END_S = 2.0  # for the machine's own end
LONGEST_WAIT_S = 0.5
MAKING = threading.Lock()
"""Lock of the one place where PyLabRobot is imported, by what makes a machine. Its modules import each other
in circles: two threads at once find modules that the other one has half made."""
Post = Callable[[Event], None]
Make = Callable[[], Any]


class Bench:
    """Machine of PyLabRobot: carries out messages as coroutines, and posts events. It knows no thread.

    Unless its backend takes calls side by side, calls and looks wait for each other; those of a stop do not.
    """

    def __init__(self, make: Make, settings: MachineMapping, post: Post) -> None:
        self._make, self._settings, self._post = make, settings, post
        self._machine: Any = None
        self._turn = asyncio.Lock()
        self._tasks: dict[int, asyncio.Task[None]] = {}

    async def open(self) -> None:
        """Make the machine, and set it up."""
        try:
            with MAKING:
                self._machine = self._make()
            await self._machine.setup(**self._settings.setup)
        except Exception as error:  # noqa: BLE001 - backends raise their own, and all mean: it is not there
            self._post(Closed(why=_text(error)))
        else:
            self._post(Opened())

    async def close(self) -> None:
        """End what is under way, and let go of the machine."""
        for task in self._tasks.values():
            task.cancel()
        if getattr(self._machine, "setup_finished", True) and self._machine is not None:
            with suppress(Exception):  # it is left anyway
                await asyncio.wait_for(self._machine.stop(), END_S)

    async def do(self, message: Message) -> None:
        """Carry out a message; returns once it is under way, but a look once it is over."""
        if isinstance(message, BeginCalls):
            self._tasks[message.number] = asyncio.create_task(self._call(message))
        elif isinstance(message, CancelCalls):
            if message.number in self._tasks:
                self._tasks[message.number].cancel()
        elif isinstance(message, Look):
            await self._look(message)

    async def _call(self, begin: BeginCalls) -> None:
        done = 0
        try:
            async with _nothing() if begin.beside or self._settings.side_by_side else self._turn:
                asyncio.get_running_loop().call_soon(self._begun, begin.number)
                result: object = None
                for done, call in enumerate(begin.calls):  # noqa: B007 - the exception tells which one it was
                    result = await self._one(call)
                shown = await follow(begin.result, result)
        except (Exception, asyncio.CancelledError) as error:  # noqa: BLE001 - backends raise their own
            self._tasks.pop(begin.number, None)
            name = type(error).__name__
            self._post(Raised(number=begin.number, name=name, text=text_of_error(error), first=done == 0))
        else:
            self._tasks.pop(begin.number, None)
            self._post(Returned(number=begin.number, result=shown))

    def _begun(self, number: int) -> None:
        """Say that the calls wait for something; those that are over by now have told their end."""
        if number in self._tasks:
            self._post(Begun(number=number))

    async def _one(self, call: Call) -> object:
        method: Any = await follow(call.call, self._machine)
        given = {name: labware(self._machine, text) for name, text in call.labware.items()}
        result = method(**call.arguments, **given)
        return await result if inspect.isawaitable(result) else result

    async def _look(self, look: Look) -> None:
        try:
            values = {}
            if look.paths:
                async with _nothing() if self._settings.side_by_side else self._turn:
                    values = {path: await follow(path, self._machine) for path in look.paths}
        except Exception as error:  # noqa: BLE001 - backends raise their own, and all mean: it was not read
            self._post(LookFailed(number=look.number, why=_text(error)))
        else:
            self._post(Looked(number=look.number, values=values))


class Session:
    """Bench in a thread with an event loop of its own, which a call that blocks cannot take from others."""

    def __init__(self, name: str, make: Make, settings: MachineMapping, post: Post) -> None:
        self._loop = asyncio.new_event_loop()
        self._bench = Bench(make, settings, post)
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()
        self._begin(self._bench.open())

    def do(self, message: Message) -> None:
        self._begin(self._bench.do(message))

    def close(self) -> None:
        """Begin to let go of the machine; the thread ends once that is done, or is left behind."""

        async def end() -> None:
            await self._bench.close()
            self._loop.call_soon(self._loop.stop)

        self._begin(end())

    def join(self) -> None:
        self._thread.join(END_S + LONGEST_WAIT_S)

    def _begin(self, coroutine: Any) -> None:
        if self._loop.is_closed():
            coroutine.close()
        else:
            asyncio.run_coroutine_threadsafe(coroutine, self._loop)

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        try:
            self._loop.run_forever()
            rest = asyncio.all_tasks(self._loop)
            for task in rest:
                task.cancel()
            self._loop.run_until_complete(asyncio.gather(*rest, return_exceptions=True))
        finally:
            self._loop.close()


class MachineDriver:
    """Driver of one machine; subclasses make it. A thread keeps deadlines, another is its event loop."""

    def __init__(self, settings: MachineMapping) -> None:
        self._settings = settings
        self._changed = threading.Condition()  # around the machine and its messages
        self._ending = False
        self._session: Session | None = None
        self._thread: threading.Thread | None = None

    def make(self) -> Any:
        """The machine of PyLabRobot, not set up yet; called in the thread of its event loop."""
        raise NotImplementedError

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        self._hear, self._clock = hear, clock
        self._machine, self._name = Machine(devices, self._settings), devices[0].name
        self._thread = threading.Thread(target=self._run, name=f"pylabrobot {self._name}", daemon=True)
        self._thread.start()

    def listen(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        raise DriverError(NO_LISTENING)

    def send(self, command: Command) -> None:
        for message in self._step([CommandRequest(command=command)]):
            if isinstance(message, CommandNotSent):
                raise NotSent(message.why)

    def stop(self) -> None:
        with self._changed:
            self._ending = True
            self._changed.notify_all()
            session, self._session = self._session, None
        if session is not None:
            session.close()
            session.join()
        if self._thread is not None:
            self._thread.join()

    def _run(self) -> None:
        with self._changed:
            while not self._ending:
                self._step([])
                wait_s = self._machine.next_deadline - self._clock()
                self._changed.wait(max(0.0, min(wait_s, LONGEST_WAIT_S)))

    def _step(self, events: Sequence[Event]) -> list[Message]:
        with self._changed:
            messages = self._machine.step(self._clock(), events)
            for message in messages:
                self._do(message)
            if events:
                self._changed.notify_all()  # its deadlines have changed
        return messages

    def _do(self, message: Message) -> None:
        if isinstance(message, Report):
            self._hear(message)
        elif isinstance(message, Open):
            mine: list[Session] = []
            post = partial(self._take, mine)
            mine.append(Session(f"pylabrobot loop {self._name}", self.make, self._settings, post))
            self._session = mine[0]
        elif isinstance(message, Close):
            if self._session is not None:
                self._session.close()
                self._session = None
        elif self._session is not None:
            self._session.do(message)

    def _take(self, mine: list[Session], event: Event) -> None:
        """Take an event of a session; one that was left says nothing any more."""
        with self._changed:
            if not self._ending and mine and self._session is mine[0]:
                self._step([event])


@driver("pylabrobot", settings=Settings)
class PyLabRobot(MachineDriver):
    """Driver of a machine that the settings name."""

    def __init__(self, settings: Settings) -> None:
        super().__init__(settings)
        self._named = settings

    def make(self) -> Any:
        named = self._named
        options = dict(named.options)
        if named.backend is not None:
            options["backend"] = _named(named.backend)(**named.backend_options)
        return _named(named.machine)(**options)


def machine(name: str) -> Callable[[Make], type[MachineDriver]]:
    """Decorator that makes a function which returns a machine of PyLabRobot a driver, called `name`.

    Its settings in a plant file are those of `pylabrobot` without what makes the machine.
    """

    def marked(function: Make) -> type[MachineDriver]:
        def make(self: MachineDriver) -> Any:
            return function()

        words = {"make": make, "__doc__": function.__doc__, "__module__": function.__module__}
        made: type[MachineDriver] = type(function.__name__, (MachineDriver,), words)
        return driver(name, settings=MachineMapping)(made)

    return marked


async def follow(path: str, start: object) -> object:
    """The value at a path; None where the way there ends at None."""
    value: Any = start
    for step in steps(path):
        if value is None:
            return None
        if step.kind == "name":
            value = getattr(value, step.key)
        elif step.kind == "item":
            value = value[int(step.key) if step.key.isdecimal() else step.key]
        else:
            value = value()
            value = await value if isinstance(value, Awaitable) else value
    return value


def labware(machine: Any, text: str) -> object:
    """The resource of that name on a machine, or its wells or tips in brackets."""
    found = LABWARE.match(text)
    assert found is not None
    name, items = found.groups()
    there = machine.get_resource(name)
    return there if items is None else there[items]


class _nothing:
    """Context that waits for nobody."""

    async def __aenter__(self) -> None: ...
    async def __aexit__(self, *raised: object) -> None: ...


def _named(place: str) -> Any:
    """The object that `module:name` names."""
    module, _, name = place.partition(":")
    return getattr(import_module(module), name)


def _text(error: Exception) -> str:
    if isinstance(error, ModuleNotFoundError) and error.name == "pylabrobot":
        return MISSING
    return str(error) if isinstance(error, DriverError) else f"{type(error).__name__}: {text_of_error(error)}"
