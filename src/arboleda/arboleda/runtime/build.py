"""The composition root: which parts make up this plant, and how they are joined."""

from __future__ import annotations

import json
import logging
import os
import sys
import threading
import time
from collections.abc import Callable, Collection
from dataclasses import asdict, dataclass, field
from datetime import datetime, timezone
from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from arboleda import __version__
from arboleda.adapters import clock, descriptors
from arboleda.adapters.broker_login import MQTT_PORT, Credentials, address
from arboleda.core.operator import ACTS_TOLD
from arboleda.core.plant import Plant
from arboleda.model.errors import ArboledaError, StartError
from arboleda.model.messages import TaskChanged
from arboleda.model.plant_model import Link, MqttVersion, PlantModel
from arboleda.model.recording import Recording
from arboleda.model.sentence import OWN, Sentence, from_data
from arboleda.oee.rows import OeeQuery, figures
from arboleda.plant_file.draft_process import CheckProcess
from arboleda.recorder.preamble import Beginning
from arboleda.store.plant_memory import JournalEntry, PlantMemory, Superseded
from arboleda.web.access.names import other_address

from . import at_work
from .alarm_options import AlarmOptions
from .demo import Demo
from .draft_desk import DraftDesk
from .fault_desk import PHRASES, FaultDesk
from .log_queue import Output
from .make.bench import MakeBench
from .parts.alarms import alarms_part
from .parts.bridge import BridgePart
from .parts.broker import OtherBroker, OwnBroker
from .parts.cell_times import CellTimes
from .parts.demo import DemoPart
from .parts.devices import DevicesPart
from .parts.drivers import DriversPart
from .parts.garbage import Garbage
from .parts.groot2 import Groot2Options, Groot2Part
from .parts.hang_up import HangUpPart
from .parts.linux_boards import LinuxBoards, on_linux
from .parts.local_plant import LocalPlant
from .parts.memory_pace import MemoryPace
from .parts.opcua_view import OpcUaViewOptions, OpcUaViewPart
from .parts.orchestrator import Orchestrator
from .parts.part import Part
from .parts.periodic import Periodic
from .parts.reports import NO_RECORD, NoReport, ReportsPart
from .parts.router import PlantPort, Router
from .parts.systemd import systemd_part
from .plant_folder import PlantFolder
from .proposals.desk import ProposalDesk
from .proposals.tasks import AssistantTasks
from .rate import at_rate
from .standby.handover import CellResumption, hold_all
from .standby.leader import way_to
from .standby.lease import LeasePart
from .state import StateDir, default_state
from .stores import history_of, memory_of
from .version_desk import VersionDesk
from .waiting import until
from .web_options import WebOptions

if TYPE_CHECKING:  # its libraries are needed only where this part is
    from arboleda.adapters.server_tls import ServerTls

    from .parts.metrics import Metrics
    from .parts.web import WebPart

PARTS = ("broker", "devices", "bridge", "orchestrator", "web")
OF_BOARDS = frozenset({"broker", "devices", "bridge"})  # of no use where no robot is reached over MQTT
# A thread that has to wait for Python's lock gets it so late; a stop over HTTP waits for it a dozen times.
TURN_S = 0.0005
LOG = logging.getLogger(__name__)


@dataclass(frozen=True, kw_only=True)
class Options:
    """The choices of the command line or the ROS parameters; `link` is the ROS 2 link, None without ROS."""

    link: Any | None = None
    broker: str | None = None
    broker_host: str = "127.0.0.1"
    broker_users: dict[str, str] | None = None
    broker_tls: ServerTls | None = None
    credentials: Credentials | None = None
    rate: float = 1.0
    firmware: bool = False  # boards that can be are the firmware's, compiled for Linux
    state_dir: Path | None = None
    store: str = ""  # the address of a database; "": what the plant file says
    web: WebOptions = field(default_factory=WebOptions)
    alarms: AlarmOptions = field(default_factory=AlarmOptions)
    log_name: str = "arboleda.log"
    keeps_waiting: bool = True  # for the next start; else what waits at the end is cancelled
    page: bool = True  # the API needs none, and a page takes a second to load
    recording: Recording | None = None  # None: no record is written
    plant_file: Path | None = None  # None: the shipped one, which nobody changes
    restarts: bool = False  # whoever runs it starts it again, where `App.restart_wanted`
    demo: bool = False  # tasks that never end, and faults, of a plant on virtual boards
    groot2: bool | None = None  # whether trees are shown to Groot2; None: where the plant file says so
    notes: tuple[str, ...] = ()  # what else a person should know of this start


class App:
    """A plant put together; `start`, `wait` until something ends it, `stop`."""

    def __init__(self, model: PlantModel, parts: Collection[str], options: Options) -> None:
        self.model = at_rate(model, options.rate)
        descriptors.raise_limit()
        self._shares = descriptors.shares(len(model.robots))
        self.orchestrator: Orchestrator | None = None
        store = (options.store or model.store) if "orchestrator" in parts else ""
        state = options.state_dir or default_state(model.name)
        self._state = StateDir(state, plant=model.name, store=store)
        self._store = memory_of(store, state, model.name)
        self._history, self._recalled = (
            history_of(store, state, model.name, is_checked=True) for _ in range(2)
        )
        self._reporting: ReportsPart | None = None
        self._keeps_waiting = options.keeps_waiting
        self._broker = _broker(model, options, set(parts))
        self._pace = MemoryPace()
        self._store.timing = self._pace
        self._metrics: Metrics | None = None
        self._web: WebPart | None = None
        options.alarms.check(model, has_broker=model.has_boards or options.broker is not None)
        self._alarms = alarms_part(model, options.alarms, self._broker, self._address_of)
        self._groot2 = _groot2(model, options) if "orchestrator" in parts else None
        self._opcua_view = self._view(model, options) if "orchestrator" in parts else None
        self._bridge: BridgePart | None = None
        self._drivers: DriversPart | None = None
        self._devices: DevicesPart | None = None
        self._demo: DemoPart | None = None
        self._past_acts: list[dict[str, Any]] = []
        self._link = options.link
        self._web_options = options.web
        self._firmware = options.firmware
        self._log_name = options.log_name
        self._notes = options.notes
        self._draft: DraftDesk | None = None
        self._versions: VersionDesk | None = None
        self._make: MakeBench | None = None
        self._faults: FaultDesk | None = None
        self._proposals: ProposalDesk | None = None
        self._folder = PlantFolder(options.plant_file, state)
        if options.recording is not None and "orchestrator" in parts:
            self._open_desks(state, options, virtual=options.recording.virtual)
        self._over = threading.Event()
        self._callbacks: list[Callable[[], None]] = []
        self.restart_wanted = False  # somebody wants it, and nothing is at work any more
        self.port = 0  # of the HTTP API, once it listens
        self._trouble: ArboledaError | None = None
        self._started: list[Part] = []
        self._garbage = Garbage()
        self._turn_s = sys.getswitchinterval()
        self._parts: list[Part] = [self._broker]
        try:
            if "orchestrator" in parts:
                self._state.open()
                self._store.open()
                self._keep_files(options.recording)
                self._past_acts = _acts(self._store)
            self._build(set(parts), options)
        except BaseException:  # whatever it is, the next start finds the state directory free
            self._let_go()
            raise

    @property
    def parts(self) -> tuple[Part, ...]:
        """The parts of this process in the order in which they start; they end in the opposite one."""
        return tuple(self._parts)

    @property
    def notes(self) -> list[str]:
        """The lines that a person should read about this start."""
        notes = [*self._notes, *(self._link.notes if self._link else ())]
        notes += [self._folder.note] if self._folder.note else []
        if self.model.has_boards:
            notes.append(f"MQTT broker: {self._broker.address}")
        if self._web is not None:
            notes += self._web.notes
        if self._groot2 is not None:
            notes += self._groot2.notes
        if self._opcua_view is not None:
            notes += self._opcua_view.notes
        if self._alarms is not None and self.orchestrator is not None:
            notes += self._alarms.notes
        if self._demo is not None:
            notes += self._demo.notes
        return notes

    @property
    def log_file(self) -> Path:
        """The file for details that are too much for a terminal."""
        return self._state.path / self._log_name

    @property
    def log_outputs(self) -> list[Output]:
        """The outputs of the log beside terminal and file."""
        return [self._link.log] if self._link else []

    def start(self) -> None:
        """Start every part in order; where one cannot, nothing is left running."""
        sys.setswitchinterval(TURN_S)
        self._garbage.start(has_steps=self.orchestrator is not None)
        try:
            for part in self._parts:
                self._started.append(part)
                part.start()
        except BaseException:  # Ctrl-C while it starts ends it as cleanly as later
            self.stop()
            raise

    def end(self) -> None:
        """Let `wait` return."""
        self._over.set()
        for callback in self._callbacks:
            callback()

    def _look_for_restart(self, plant: Plant) -> None:
        if plant.may_restart and not self.restart_wanted:
            self.restart_wanted = True
            LOG.warning("the plant restarts, as %s wants: all its cells rest", plant.restart_by)
            self.end()

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
        while self._started:
            self._started.pop().stop()
        self._garbage.stop()
        sys.setswitchinterval(self._turn_s)
        self._let_go()

    def listen(self, *listeners: Callable[[TaskChanged], None]) -> None:
        """Call back with every change of a task, in the plant's thread; before `start`."""
        self.plant.listeners.extend(listeners)

    def _view(self, model: PlantModel, options: Options) -> OpcUaViewPart | None:
        """The part that shows the plant over OPC UA, if wanted; on the address of the HTTP API."""
        view = model.opcua_view
        if view is None:
            return None
        cells = [cell.name for cell in model.cells]
        return OpcUaViewPart(
            OpcUaViewOptions(host=options.web.address, port=view.port, plant=model.name, folders=view.isa95),
            lambda: figures(self._history, OeeQuery(), time.time(), cells),
        )

    def watch(self, watcher: Callable[[dict[str, Any]], None]) -> None:
        """Call back with snapshots if more than a position changed; in the plant's thread, before `start`."""
        self.plant.watchers.append(watcher)

    def links(self) -> dict[str, Any]:
        """Broker, ROS 2, refused messages, standbys, the memory's pace, as `PageApi` has them; from any
        thread."""
        connected, refused = self._bridge.links() if self._bridge else (False, {})
        broker = {"address": str(self._broker.address), "connected": connected} if self._bridge else None
        ros = {"notes": list(self._link.notes)} if self._link else None
        waiting = [{"host": each.host, "url": way_to(each.host, each.url)} for each in self._store.standbys]
        demo = self._demo is not None and self._demo.is_on
        memory = None if self.orchestrator is None else asdict(self._pace.pace)
        faults = () if self._faults is None else self._faults.begun()
        begun = [asdict(each) for each in faults]
        about = {"refused": refused, "standbys": waiting, "demo": demo, "memory": memory, "faults": begun}
        return {"broker": broker, "ros": ros, **about}

    def end_demo(self) -> None:
        """Give no more tasks of the demonstration; from any thread."""
        if self._demo is not None:
            self._demo.end()

    def _open_desks(self, state: Path, options: Options, *, virtual: bool) -> None:
        """Open the desks of its files: of their draft, and of their versions."""

        def as_it_runs(model: PlantModel) -> PlantModel:
            return at_rate(model.on_boards(Link.DRIVER) if virtual else model, options.rate)

        process = CheckProcess()
        versions = VersionDesk(
            self._folder,
            state,
            lambda: self.plant,
            as_it_runs=as_it_runs,
            check=process.check,
            restarts=options.restarts and self._store.renew_s is None,
        )
        self._draft = DraftDesk(
            self._folder, state, process, work_by=versions.work_by, writing=versions.writing
        )
        self._versions = versions
        self._make = MakeBench(self._folder, state, self._draft, self.model.driven)
        self._proposals = ProposalDesk(
            self._folder,
            state,
            versions,
            CheckProcess(),
            lambda: self.plant.plant.model,
            lambda shelf: AssistantTasks(shelf, lambda: self.local, lambda: versions.at_work().digest),
        )

    def _keep_files(self, recording: Recording | None) -> None:
        """Keep what this start is made of, for `arboleda apply`; without a record that is not known."""
        now = datetime.now(timezone.utc).isoformat(timespec="seconds")
        at_work.keep(self._state.path, recording.files if recording else None, now)

    def _web_part(self, options: Options) -> WebPart:
        from .parts import page  # its libraries take half a second, and nodes do without them
        from .parts.metrics import Metrics
        from .parts.web import WebPart

        sources = page.Sources(
            links=self.links,
            positions=self.plant.positions,
            past_acts=lambda: self._past_acts,
            end_demo=self.end_demo if options.demo else None,
            recorded=None if options.recording is None else self._state.path,
            report=self.report,
            draft=self._draft,
            versions=self._versions,
            make=self._make,
            faults=self._faults,
            proposals=self._proposals,
        )
        paged = page.PagePlant(self.plant, self._history, sources) if options.page else None
        metrics = self._metrics = Metrics(self.plant.snapshot, self.links)
        return WebPart(
            paged or self.local,
            self.model.name,
            self._state.path,
            self._announce,
            options.web,
            None if paged is None else paged.mount,
            connections=self._shares.http,
            counts=metrics.text,
        )

    @cached_property
    def local(self) -> LocalPlant:
        """PlantApi of the plant of this process; ArboledaError where it has none."""
        return LocalPlant(
            self.plant,
            self._history,
            self._draft,
            self._versions,
            self._make,
            self.report,
            self._proposals,
            self._faults,
        )

    @property
    def plant(self) -> Orchestrator:
        """The plant of this process; ArboledaError where it has none."""
        if self.orchestrator is None:
            raise ArboledaError("there is no orchestrator in this process")
        return self.orchestrator

    def _recorder(self, epoch: int, plant: Orchestrator, options: Options) -> list[Part]:
        """The parts that write the flight record of this start, if wanted; they end after the plant."""
        wanted = options.recording
        if wanted is None:
            return []
        try:  # its libraries are needed only where a record is written
            from arboleda.recorder.files import FOLDER
            from arboleda.recorder.recorder import Recorder
            from arboleda.recorder.ros_log import RosLog
            from arboleda.recorder.view_log import ViewLog
            from arboleda.recorder.writing import Writing
        except ImportError as error:
            LOG.warning("no record is written: %s; the plant goes on without it", error)
            return []
        beginning = Beginning(
            plant=self.model.name,
            version=__version__,
            epoch=epoch,
            now=plant.began.now,
            rate=options.rate,
            virtual=wanted.virtual,
            memory=plant.began.memory,
            kept=plant.began.kept,
            files=wanted.files,
        )
        logs, view = [RosLog(self.model)], ViewLog(self._past_acts, self.links)
        recorder = Recorder(Writing(self._state.path / FOLDER, beginning, wanted.limits, logs, view=view))
        plant.recorder = recorder
        return [self._reports(wanted), recorder]

    def _reports(self, wanted: Recording) -> ReportsPart:
        """The part that has reports written: those that are asked for and, if wanted, one of each failure."""
        self._reporting = ReportsPart(self._state.path)
        if wanted.reports:
            self.listen(self._reporting.changed)
        return self._reporting

    def report(self, task: str) -> str | None:
        """The report of a task that failed, in HTML; None: it is being written. NoReport says why not."""
        if self._reporting is None:
            raise NoReport(NO_RECORD())
        return self._reporting.report(task)

    def _build(self, parts: set[str], options: Options) -> None:
        """The parts of this process in the order in which they start; they end in the opposite one."""
        now, bridge = int(time.time()), None
        virtual, scout = "devices" in parts, "broker" not in parts
        if "web" in parts and options.page:
            import_module("arboleda.dashboard.page")  # takes longer than a leader may say nothing
        epoch = self._lead(now) if "orchestrator" in parts else now
        if "bridge" in parts:
            bridge = self._bridge = BridgePart(
                self.model,
                max(now, epoch),
                self._broker,
                self._crash,
                waits=virtual and scout,
                has_lease="orchestrator" in parts and self._store.renew_s is not None,
            )
            self._parts.append(bridge)
        if virtual:
            self._parts += self._boards(now, bridge, scout=scout)
        if "orchestrator" in parts:
            self._build_plant(epoch, options)
        if "web" in parts:  # a process has one page, so it is made by who leads
            self._build_page(options)
        self._build_views()
        if options.demo and self._devices is not None and self.orchestrator is not None:
            befall = self._devices.befall
            self._demo = DemoPart(Demo(self.model), self.plant.submit, befall, self._crash)
            self.watch(self._demo.saw)
            self._parts.append(self._demo)
        if self.orchestrator is not None and self._store.renew_s is not None:
            self._parts.append(CellResumption(self.plant, self._store.going, epoch))
        self._join(bridge, self._drivers, self._link)
        if self.orchestrator is not None:
            self._parts += [HangUpPart(self._versions.put_files)] if self._versions else []
            systemd = systemd_part(os.environ, lambda: self.plant.stepped_at)
            self._parts += [systemd] if systemd else []

    def _build_plant(self, epoch: int, options: Options) -> None:
        """The plant with its drivers, its record, its times and its alarms."""
        if self.model.driven:
            self._drivers = DriversPart(self.model, epoch, self._crash)
            self._parts.append(self._drivers)
        plant = self.orchestrator = Orchestrator(
            self.model,
            epoch,
            self._crash,
            self._store,
            history=self._recalled,
            drops_waiting=not self._keeps_waiting,
        )
        plant.diagnoses.append(self._pace.diagnosis)
        plant.observers += [self._garbage.stepped, self._look_for_restart]
        self._parts += self._recorder(epoch, plant, options)
        self._parts.append(Periodic("place", self._looks(), self._crash))  # also while the plant ends
        times = CellTimes(self._store, self.model.history_days)
        self._parts.append(times)  # before the plant, so that it ends after it
        plant.observers.append(times.stepped)
        if self._alarms is not None:
            self._parts.append(self._alarms)
            self.listen(self._alarms.changed)
            self._pace.listeners.append(self._alarms.paced)
            plant.observers.append(self._alarms.stepped)
        self._parts.append(plant)
        self._faults = FaultDesk(self.model, self._devices, plant.hear)
        if self._devices is not None:
            self._devices.noted = self._faults.noted

    def _build_page(self, options: Options) -> None:
        """The page, with what is made and changed on it."""
        self._web = self._web_part(options)
        self.watch(self._web.plant.saw)
        self._count()
        self._parts.append(self._web)
        self._parts += [each for each in (self._draft, self._make, self._proposals) if each]

    def _build_views(self) -> None:
        """The views for other programs: Groot2 and OPC UA."""
        if self._groot2 is not None:
            self.watch(self._groot2.saw)
            self._parts.append(self._groot2)
        if self._opcua_view is not None:
            self.listen(self._opcua_view.changed)
            self.watch(self._opcua_view.saw)
            self._parts.append(self._opcua_view)

    def _looks(self) -> list[Callable[[], None]]:
        """The regular checks: the speed of the memory, and that its files are still in their place."""
        is_leased = self._store.renew_s is not None  # then the thread of the lease finds out
        places = [self._state.confirm] if is_leased else [self._store.confirm, self._state.confirm]
        return [self._pace.look, *places]  # a disk that hangs may hold up the others

    def _lead(self, now: int) -> int:
        """The number of this start, higher than that of any start before, on any host."""
        epoch = self._store.lead(self._state.next_epoch(now))
        if self._store.renew_s is not None:
            self._parts.append(LeasePart(self._store, self._store.renew_s, self._crash, self._hand_over))
        return epoch

    def _hand_over(self) -> None:
        """Hold the cells that are at work, so that the next leader can go on with them, and end."""
        LOG.warning("another process is to lead the plant: what is at work is held")
        try:
            self._store.hand_over(hold_all(self.plant))
        except (ArboledaError, TimeoutError) as error:
            LOG.warning("the next leader is not told what was at work: %s", error)
        self.end()

    def _announce(self, port: int, *, host: str, guarded: bool, certificate: str) -> None:
        self.port = port
        self._state.announce(port, host=host, guarded=guarded, certificate=certificate)
        try:
            self._store.announce(self._web_options.origin(port, self._own_address))
        except ArboledaError as error:
            LOG.warning("standbys are not told where the page is: %s", error)

    def _own_address(self) -> str:
        """The address of this host that hosts which reach the memory may reach it by."""
        return self._store.own_address() or other_address()

    def _address_of(self, cell: str, task: str | None) -> str | None:
        return self._web.address_of(cell, task) if self._web is not None else None

    def _count(self) -> None:
        """Count events for the metrics."""
        if self._metrics is not None and self.orchestrator is not None:
            self.watch(self._metrics.saw)
            self.listen(self._metrics.changed)
            self.orchestrator.reacted = self._metrics.reacted
            self._pace.observers.append(self._metrics.committed)

    def _boards(self, first_boot: int, bridge: BridgePart | None, *, scout: bool) -> list[Part]:
        """The boards that play the real ones: the firmware's where wanted and possible, else virtual."""
        robots = on_linux(self.model) if self._firmware else ()
        if robots and self._broker.secure:
            raise StartError(
                "the firmware's boards speak no TLS: leave out --boards linux, or mqtts:// and --broker-tls"
            )
        compiled = [LinuxBoards(self.model, robots, self._broker, self._crash, scout=scout)] if robots else []
        joined = bridge.join if bridge is not None and scout else _nothing
        elsewhere = [robot.name for robot in robots]
        virtual = self._devices = DevicesPart(
            self.model, first_boot, self._broker, self._crash, scout=scout, joined=joined, elsewhere=elsewhere
        )
        return [virtual, *compiled]

    def _let_go(self) -> None:
        """Give back everything that only one process may have; idempotent."""
        self._history.close()
        self._recalled.close()
        self._store.close()
        self._state.close()

    def _join(self, bridge: BridgePart | None, drivers: DriversPart | None, link: Any | None) -> None:
        """Join the plant and what reaches its robots: its bridge directly or over ROS 2, and drivers."""
        plant = self.orchestrator
        ports: dict[Link, PlantPort] = {}
        if link is not None:
            ports |= self._join_ros(bridge, link)
        elif plant is not None:
            _refuse_ros_robots(self.model)
            if bridge is not None:
                bridge.connect(plant.hear)
                ports[Link.MQTT] = bridge
        if plant is not None and drivers is not None:
            drivers.connect(plant.hear)
            ports[Link.DRIVER] = drivers
        if plant is not None and ports:
            plant.connect(Router(self.model, ports))

    def _join_ros(self, bridge: BridgePart | None, link: Any) -> dict[Link, PlantPort]:
        """Plant and bridge on ROS 2; the plant's port there is that to robots on MQTT and on ROS 2."""
        ports: dict[Link, PlantPort] = {}
        if bridge is not None:
            there = link.bridge(self.model, bridge.loop.post, clock.seconds)
            bridge.connect(there.send, there.mqtt_link, there.tell)
        if self.orchestrator is not None:
            port = link.orchestrator(self.model, self.orchestrator.hear, clock.seconds)
            self.orchestrator.connect_ros(port)
            ports = {Link.MQTT: port, Link.ROS: port}
        self._parts.insert(1, RosPart(link))
        return ports

    def _crash(self, name: str, error: BaseException) -> None:
        LOG.debug("the %s broke down", name, exc_info=error)
        if not isinstance(error, ArboledaError):
            what = f"{type(error).__name__}: {error}"
            error = ArboledaError(f"internal error in the {name} ({what}); details are in {self.log_file}")
        for part in (self._bridge, self._drivers) if isinstance(error, Superseded) else ():
            if part is not None:
                part.leave_robots()
        self._trouble = self._trouble or error
        self.end()


class RosPart:
    """The ROS 2 link as a part."""

    def __init__(self, link: Any) -> None:
        self._link = link

    def start(self) -> None:
        self._link.start()

    def stop(self) -> None:
        self._link.close()


def build(model: PlantModel, parts: Collection[str], options: Options) -> App:
    """A plant of the named PARTS; StartError where there is no such part or they cannot be put together."""
    if unknown := sorted(set(parts) - set(PARTS)):
        raise StartError(f"there is no part {', '.join(unknown)}; there are {', '.join(PARTS)}")
    return App(model, parts, options)


def _refuse_ros_robots(model: PlantModel) -> None:
    names = [robot.name for robot in model.robots.values() if robot.link is Link.ROS]
    if names:
        raise StartError(f"{', '.join(names)}: link ros needs ROS 2; start without --no-ros")


def _nothing() -> None: ...


def _groot2(model: PlantModel, options: Options) -> Groot2Part | None:
    """The part that shows trees to Groot2, if wanted; on the address of the HTTP API."""
    wanted = model.groot2_port is not None if options.groot2 is None else options.groot2
    if not wanted:
        return None
    where = Groot2Options(host=options.web.address, port=model.groot2_port)
    return Groot2Part([cell.name for cell in model.cells], where)


def _acts(store: PlantMemory) -> list[dict[str, Any]]:
    """The acts of operators before this start, oldest first."""
    entries = reversed(store.entries())
    return [
        {"at": each.unix_s, "scope": each.scope, "cell": each.cell, "sentence": _sentence_of(each)}
        for each in entries
    ]


def _sentence_of(entry: JournalEntry) -> Sentence:
    """The sentence about an operator's act; plain text if an older start or another version wrote it."""
    try:
        return from_data(json.loads(entry.said or ""), ACTS_TOLD | PHRASES)
    except ValueError:
        return OWN(text=entry.sentence)


def _broker(model: PlantModel, options: Options, parts: set[str]) -> OwnBroker | OtherBroker:
    own = "broker" in parts
    if own and model.mqtt_version is not MqttVersion.V3_1_1:
        raise StartError("the plant's own broker speaks MQTT 3.1.1 only; name another one with --broker")
    if not own:
        return OtherBroker(address(options.broker or f"127.0.0.1:{MQTT_PORT}"), options.credentials)
    boards = frozenset(robot.mqtt for robot in model.robots.values())
    found_by_port = options.broker_users is not None or "bridge" not in parts
    return OwnBroker(
        options.broker_host, options.broker_users, boards, found_by_port=found_by_port, tls=options.broker_tls
    )
