"""The composition root: which parts make up this plant, and how they are joined."""

from __future__ import annotations

import logging
import sys
import threading
import time
from collections.abc import Callable, Collection
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from arboleda.adapters import descriptors
from arboleda.engine import Plant
from arboleda.host.garbage import none_collected
from arboleda.model.errors import ArboledaError, StartError
from arboleda.model.messages import TaskChanged
from arboleda.model.plant_model import PlantModel
from arboleda.store.lead import Superseded
from arboleda.web.offers import Offers

from . import at_work
from .alarm_options import AlarmOptions
from .factories import faces, plant, reach
from .holdings import Holdings
from .interrupts import until
from .log_queue import Output
from .missing import refuse_missing
from .options import Options
from .part_list import PartList
from .parts.bridge import BridgePart
from .parts.drivers import DeadThreads, DriversPart
from .parts.garbage import Garbage
from .parts.orchestrator import Orchestrator
from .parts.part import PageAddress, Part
from .rate import at_rate
from .registry import Assembly, Factory, Phase

__all__ = ["OF_BOARDS", "PARTS", "App", "Options", "build"]

PARTS = ("broker", "devices", "bridge", "orchestrator", "web")
OF_BOARDS = frozenset({"broker", "devices", "bridge"})  # of no use where no robot is reached over MQTT
OWN = (
    Factory(phase=Phase.LINKS, make=reach.links),
    Factory(phase=Phase.DEVICES, make=reach.bridge),
    Factory(phase=Phase.DEVICES, make=reach.boards),
    Factory(phase=Phase.DEVICES, make=reach.drivers),
    Factory(phase=Phase.DEVICES, make=plant.plant),
    Factory(phase=Phase.RECORD, make=plant.the_record),
    Factory(phase=Phase.RECORD, make=plant.looks),
    Factory(phase=Phase.ALARMS, make=plant.alarms),
    Factory(phase=Phase.PLANT, make=plant.the_plant),
    Factory(phase=Phase.PAGE, make=faces.web),
    Factory(phase=Phase.READY, make=faces.systemd),
)
# A thread that has to wait for Python's lock gets it so late; a stop over HTTP waits for it a dozen times.
TURN_S = 0.0005
LOG = logging.getLogger(__name__)


class App:
    """A plant put together; `start`, `wait` until something ends it, `stop`."""

    def __init__(self, model: PlantModel, parts: frozenset[str], options: Options) -> None:
        self.model = at_rate(model, options.rate)
        self.restart_wanted = False  # somebody wants it, and nothing is at work any more
        self._options = options
        self._has_plant = "orchestrator" in parts
        self._holdings = Holdings(model, options, has_plant=self._has_plant)
        self._over = threading.Event()
        self._callbacks: list[Callable[[], None]] = []
        self._trouble: ArboledaError | None = None
        self._garbage = Garbage()
        self._turn_s = sys.getswitchinterval()
        self._parts = PartList(model.extensions_off)
        try:
            self._assembly = self._begun(parts)
            self._threads = DeadThreads(self._assembly.leave_out_thread)
            self._parts.make(self._assembly, OWN)
            refuse_missing(self._assembly)
            if self.orchestrator is not None:
                self.orchestrator.observers[:0] = [self._garbage.stepped, self._look_for_restart]
        except BaseException:  # whatever it is, the next start finds the state directory free
            self._holdings.close()
            raise

    def _begun(self, parts: frozenset[str]) -> Assembly:
        """The start of this process, with a number of its own if it has the plant."""
        options, began = self._options, int(time.time())
        if self._has_plant:
            self._holdings.open()
            # for `arboleda apply`; without a record it is not known what this start is made of
            now = datetime.now(timezone.utc).isoformat(timespec="seconds")
            files = options.recording.files if options.recording else None
            at_work.keep(self._holdings.state.path, files, now)
            at_work.keep_brought(self.model.name, self.model.brought)
        return Assembly(
            model=self.model,
            parts=parts,
            options=options,
            holdings=self._holdings,
            began=began,
            epoch=self._holdings.lead(began) if self._has_plant else began,
            crash=self._crash,
            end=self.end,
            pieces=self._parts.pieces,
        )

    @property
    def parts(self) -> tuple[Part, ...]:
        """The parts of this process in the order in which they start; they end in the opposite one."""
        return tuple(self._parts)

    @property
    def offers(self) -> Offers:
        """The things that the parts of this process offer."""
        return self._assembly

    @property
    def orchestrator(self) -> Orchestrator | None:
        """The plant of this process, if it has one."""
        return self._assembly.ask(Orchestrator)

    @property
    def plant(self) -> Orchestrator:
        """The plant of this process; ArboledaError where it has none."""
        if self.orchestrator is None:
            raise ArboledaError("there is no orchestrator in this process")
        return self.orchestrator

    @property
    def port(self) -> int:
        """The port of the HTTP API; 0 before it listens."""
        page = self._assembly.ask(PageAddress)
        return 0 if page is None else page.port

    @property
    def notes(self) -> list[str]:
        """The lines that a person should read about this start."""
        told = [line for each in self._assembly.notes for line in each()]
        return [*self._options.notes, *told, *self._parts.notes]

    @property
    def log_file(self) -> Path:
        """The file for details that are too much for a terminal."""
        return self._holdings.state.path / self._options.log_name

    @property
    def log_outputs(self) -> list[Output]:
        """The outputs of the log beside terminal and file."""
        return [self._options.link.log] if self._options.link else []

    def start(self) -> None:
        """Start every part in order; where one cannot, nothing is left running."""
        sys.setswitchinterval(TURN_S)
        self._garbage.start(has_steps=self._has_plant)
        self._threads.watch()
        try:
            self._parts.start()
        except BaseException:  # Ctrl-C while it starts ends it as cleanly as later
            self.stop()
            raise

    def end(self) -> None:
        """Let `wait` return."""
        self._over.set()
        for callback in self._callbacks:
            callback()

    def when_over(self, callback: Callable[[], None]) -> None:
        """Call back at the end of `wait`, too; from any thread, before `start`."""
        self._callbacks.append(callback)

    def wait(self) -> None:
        """Block until `end`; ArboledaError where a part broke down."""
        until(self._over)
        if self._trouble is not None:
            raise self._trouble

    def stop(self) -> None:
        """Halt the robots, then end the parts in reverse order; idempotent."""
        if self.orchestrator is not None:
            self.orchestrator.halt()  # parts that end before it may take their time
        self._parts.stop()
        self._threads.forget()
        self._garbage.stop()
        sys.setswitchinterval(self._turn_s)
        self._holdings.close()

    def listen(self, *listeners: Callable[[TaskChanged], None]) -> None:
        """Call back with every change of a task, in the plant's thread; before `start`."""
        self.plant.listeners.extend(listeners)

    def watch(self, watcher: Callable[[dict[str, Any]], None]) -> None:
        """Call back with snapshots if more than a position changed; in the plant's thread, before `start`."""
        self.plant.screens.watchers.append(watcher)

    def links(self) -> dict[str, Any]:
        """Broker, ROS 2, refused messages, standbys, the memory's pace, as `PageApi` has them; from any
        thread."""
        return self._assembly.links()

    def _look_for_restart(self, plant: Plant) -> None:
        if plant.may_restart and not self.restart_wanted:
            self.restart_wanted = True
            LOG.warning("the plant restarts, as %s wants: all its cells rest", plant.restart_by)
            self.end()

    def _crash(self, name: str, error: BaseException) -> None:
        LOG.debug("the %s broke down", name, exc_info=error)
        if not isinstance(error, ArboledaError):
            what = f"{type(error).__name__}: {error}"
            error = ArboledaError(f"internal error in the {name} ({what}); details are in {self.log_file}")
        reaching = self._assembly.ask(BridgePart), self._assembly.ask(DriversPart)
        for part in reaching if isinstance(error, Superseded) else ():
            if part is not None:
                part.leave_robots()
        self._trouble = self._trouble or error
        self.end()


def build(model: PlantModel, parts: Collection[str], options: Options) -> App:
    """A plant of the named PARTS; StartError where there is no such part or they cannot be put together."""
    wanted = frozenset(parts)
    if unknown := sorted(wanted - set(PARTS)):
        raise StartError(f"there is no part {', '.join(unknown)}; there are {', '.join(PARTS)}")
    descriptors.raise_limit()
    reach.broker_of(model, options, wanted)  # it is refused before anything is opened
    alarms = options.of(AlarmOptions)
    if alarms is not None:
        alarms.check(model, has_broker=model.has_boards or options.broker is not None)
    with none_collected():
        return App(model, wanted, options)
