"""Reach for a device of a draft: its driver is opened beside the plant and listens; no command is sent."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Mapping, Sequence
from contextlib import suppress
from queue import Empty, SimpleQueue
from typing import Any

from arboleda.adapters import clock
from arboleda.drivers import Driver, MotionState, Report, Robot, plain
from arboleda.drivers.port import Listens
from arboleda.drivers.reports import objection
from arboleda.extension import ArboledaError
from arboleda.model.plant_model import DriverUse
from arboleda.plant_file.python_uses import LONGEST, error_text
from arboleda_make.trying.address import address

from .process import errand, write
from .tryout import RESULT

LISTENS_S = 6.0
ENDS_S = 3.0  # of a driver
LONGEST_S = 60  # of all, reading the draft included; then the process is ended by the system
NO_DRIVER = "{name} has no driver that can be opened: over MQTT or ROS 2 a device speaks by itself"
AT_WORK = "{name}: {device} is at work at this address, in the plant that runs; one controller has one driver"
SILENT = "nothing was heard for {seconds:g} s"

Row = dict[str, Any]
Heard = SimpleQueue[object]


def main() -> None:
    """Run the errand of this process; whatever threads a driver leaves behind end with it."""
    signal.alarm(LONGEST_S)
    with errand() as given:
        model, _ = given.plant()
        role = given.wanted["role"]
        device = model.cell(given.wanted["cell"]).roles[role]
        write(given.folder / RESULT, reached(device, given.wanted["at_work"], LISTENS_S))
    os._exit(0)


def reached(device: Robot, at_work: Sequence[Mapping[str, Any]], seconds: float) -> Row:
    """Outcome of listening to a device for that long: `reached`, its `state` and `facts` as it says them,
    the facts that are `missing`, else `why` not. `at_work` are devices with drivers that run: `device`,
    `driver`, `address`. ArboledaError where nothing may be opened."""
    use = device.driver
    if use is None:
        raise ArboledaError(NO_DRIVER.format(name=device.name))
    there = {"driver": use.name, "address": address(use.settings)}
    for other in at_work:
        if there["address"] and {key: other[key] for key in there} == there:
            raise ArboledaError(AT_WORK.format(name=device.name, device=other["device"]))
    reports = Heard()
    made = _opened(use, device, reports)
    try:
        return _listened(device, reports, clock.seconds() + seconds, seconds)
    finally:
        ending = threading.Thread(target=_end, args=(made,), daemon=True)
        ending.start()
        ending.join(ENDS_S)


def _opened(use: DriverUse, device: Robot, reports: Heard) -> SimpleQueue[Driver]:
    """Open the driver in a thread of its own, which may hang; what it says, or its error, is in `heard`."""
    made: SimpleQueue[Driver] = SimpleQueue()

    def run() -> None:
        try:
            driver = use.make()
            made.put(driver)
            begin = driver.listen if isinstance(driver, Listens) else driver.start
            begin((device,), lambda report: reports.put(report), clock.seconds)
        except (Exception, SystemExit) as error:  # noqa: BLE001 - it is user code: whatever it raises is told
            reports.put(error)

    threading.Thread(target=run, daemon=True).start()
    return made


def _listened(device: Robot, reports: Heard, until: float, seconds: float) -> Row:
    """The first report in which the device says how it is; else the last reason why there is none."""
    why = SILENT.format(seconds=seconds)
    with suppress(Empty):
        while True:
            what = reports.get(timeout=max(0.0, until - clock.seconds()))
            if isinstance(what, BaseException):
                return _unreached(error_text(what))
            wrong = objection(what, {device.name: device})
            if wrong is not None:
                why = wrong
                continue
            assert isinstance(what, Report)
            if what.state is MotionState.NO_LINK:
                why = str(what.lost) if what.lost else why
            elif what.state is not None:
                return _reached(device, what, what.state)
    return _unreached(why)


def _reached(device: Robot, report: Report, state: MotionState) -> Row:
    facts = dict(report.facts or ())
    missing = [name for name in device.fact_names if name not in facts]
    return {"reached": True, "state": state.name.lower(), "facts": facts, "missing": missing, "why": ""}


def _unreached(why: str) -> Row:
    return {"reached": False, "state": "", "facts": {}, "missing": [], "why": plain(why, LONGEST)}


def _end(made: SimpleQueue[Driver]) -> None:
    with suppress(Exception):  # it is user code, and nobody asks it for anything any more
        made.get_nowait().stop()
