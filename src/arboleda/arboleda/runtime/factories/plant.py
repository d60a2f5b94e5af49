"""The plant itself, what writes its record and looks after its memory, and its alarms."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict
from typing import Any, Protocol

from arboleda import __version__
from arboleda.adapters import clock
from arboleda.model.errors import StartError
from arboleda.model.plant_model import Link, PlantModel
from arboleda.recorder.preamble import Beginning

from ..alarm_options import AlarmOptions
from ..extensions.alarms import PackageAlarms
from ..extensions.chapters import Chapters
from ..extensions.questions import Questions
from ..parts.alarms import alarms_part
from ..parts.bridge import BridgePart
from ..parts.drivers import DriversPart
from ..parts.local_plant import LocalPlant
from ..parts.orchestrator import Orchestrator
from ..parts.part import Broker, PageAddress, Part
from ..parts.periodic import Periodic
from ..parts.router import PlantPort, Router
from ..parts.screens import FlightRecorder
from ..registry import Assembly

LOG = logging.getLogger(__name__)


class RecordPart(FlightRecorder, Part, Protocol):
    """The writer of the flight record, as a part."""


def plant(assembly: Assembly) -> Iterable[Part]:
    """Make the plant and its record, before whatever listens to it; the plant starts after that."""
    if "orchestrator" in assembly.parts:
        held = assembly.holdings
        made = Orchestrator(
            assembly.model,
            assembly.epoch,
            assembly.crash,
            held.memory,
            history=held.recalled,
            drops_waiting=not assembly.options.keeps_waiting,
            leave_out=assembly.pieces.leave_out,
        )
        made.screens.diagnoses.append(held.pace.diagnosis)
        _people(assembly, made)
        assembly.offer(Orchestrator, made)
        assembly.offer(LocalPlant, LocalPlant(made, held.history, assembly))
        assembly.links.add(lambda: {"memory": asdict(held.pace.pace)})
        _record(assembly, made)
    _join(assembly)
    return ()


def _people(assembly: Assembly, made: Orchestrator) -> None:
    """Join what packages tell people and ask them with the plant, and its screens."""
    alarms, questions = PackageAlarms(), Questions(made, assembly.epoch)
    chapters = Chapters(lambda: made.screens.recorder)
    made.screens.diagnoses.append(alarms.diagnosis)
    made.screens.beside = lambda: {**alarms.rows(), **questions.rows(), **chapters.rows()}
    made.observers.append(questions.stepped)
    assembly.offer(PackageAlarms, alarms)
    assembly.offer(Questions, questions)
    assembly.offer(Chapters, chapters)


def the_record(assembly: Assembly) -> Iterator[Part]:
    """The writer of the record."""
    part = assembly.ask(RecordPart)
    if part is not None:
        yield part


def looks(assembly: Assembly) -> Iterator[Part]:
    """The regular checks, also while the plant ends: the speed of the memory, and that its files are still in
    their place."""
    if assembly.ask(Orchestrator) is None:
        return
    held = assembly.holdings
    is_leased = held.memory.lead.renew_s is not None  # then the thread of the lease finds out
    places = [held.state.confirm] if is_leased else [held.memory.look, held.state.confirm]
    each: list[Callable[[], None]] = [held.pace.look, *places]  # a disk that hangs may hold up the others
    yield Periodic("place", each, assembly.crash)


def alarms(assembly: Assembly) -> Iterator[Part]:
    """The alarms, if anybody wants them."""
    options, running = assembly.options.of(AlarmOptions), assembly.ask(Orchestrator)
    if options is None or running is None:
        return

    def address_of(cell: str, task: str | None) -> str | None:
        page = assembly.ask(PageAddress)
        return None if page is None else page.address_of(cell, task)

    raised, questions = assembly.need(PackageAlarms), assembly.need(Questions)
    part = alarms_part(
        assembly.model,
        options,
        assembly.need(Broker),
        address_of,
        lambda: (*raised.standing, *(each.alarm for each in questions.open)),
    )
    if part is not None:
        assembly.notes.append(lambda: part.notes)
        running.listeners.append(part.changed)
        running.observers.append(part.stepped)
        assembly.holdings.pace.listeners.append(part.paced)
        yield part


def the_plant(assembly: Assembly) -> Iterator[Part]:
    """The plant, which starts once whatever keeps and tells what it does has started."""
    running = assembly.ask(Orchestrator)
    if running is not None:
        yield running


def _record(assembly: Assembly, made: Orchestrator) -> None:
    """Make the writer of the flight record of this start, if wanted."""
    wanted = assembly.options.recording
    if wanted is None:
        return
    try:  # its libraries are needed only where a record is written
        from arboleda.recorder.files import FOLDER
        from arboleda.recorder.recorder import Recorder
        from arboleda.recorder.view_log import ViewLog
        from arboleda.recorder.writing import Writing, ros_logs
    except ImportError as error:
        LOG.warning("no record is written: %s; the plant goes on without it", error)
        return
    beginning = Beginning(
        plant=assembly.model.name,
        version=__version__,
        epoch=assembly.epoch,
        now=made.began.now,
        rate=assembly.options.rate,
        virtual=wanted.virtual,
        memory=made.began.memory,
        kept=made.began.kept,
        files=wanted.files,
    )
    view = ViewLog(assembly.holdings.past_acts, assembly.links)
    logs = ros_logs(assembly.model)
    folder = assembly.holdings.state.path / FOLDER
    recorder = Recorder(Writing(folder, beginning, wanted.limits, logs, view=view, ran_s=made.keeping.ran_s))
    made.screens.recorder = recorder
    assembly.offer(RecordPart, recorder)


def _join(assembly: Assembly) -> None:
    """Join the plant and what reaches its robots: its bridge directly or over ROS 2, and drivers."""
    running, bridge = assembly.ask(Orchestrator), assembly.ask(BridgePart)
    drivers, ports = assembly.ask(DriversPart), dict[Link, PlantPort]()
    if assembly.options.link is not None:
        ports |= _join_ros(assembly.model, running, bridge, assembly.options.link)
    elif running is not None:
        _refuse_ros_robots(assembly.model)
        if bridge is not None:
            bridge.connect(running.hear)
            ports[Link.MQTT] = bridge
    if running is not None and drivers is not None:
        drivers.connect(running.hear)
        ports[Link.DRIVER] = drivers
    if running is not None and ports:
        running.connect(Router(assembly.model, ports))


def _join_ros(
    model: PlantModel, running: Orchestrator | None, bridge: BridgePart | None, link: Any
) -> dict[Link, PlantPort]:
    """Plant and bridge on ROS 2; the plant's port there is that to robots on MQTT and on ROS 2."""
    if bridge is not None:
        there = link.bridge(model, bridge.loop.post, clock.seconds)
        bridge.connect(there.send, there.mqtt_link, there.tell)
    if running is None:
        return {}
    port = link.orchestrator(model, running.hear, clock.seconds)
    running.connect_ros(port)
    return {Link.MQTT: port, Link.ROS: port}


def _refuse_ros_robots(model: PlantModel) -> None:
    names = [robot.name for robot in model.robots.values() if robot.link is Link.ROS]
    if names:
        raise StartError(f"{', '.join(names)}: link ros needs ROS 2; start without --no-ros")
