"""The contract of all drivers: what every one of them does for its device, case by case.

A driver takes part with a bench in the folder of its maker, which plays its device by hand. The tests of its
machine in tests/fast prove most of the cases. So here each driver does one work, each kind of link
has one story of a stop and a lost connection, and one driver has the whole contract; at night all drivers do.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partialmethod
from pathlib import Path
from typing import Any

import pytest
from tests.lengths import length
from tests.patience import PATIENCE_S

from arboleda.model.messages import Reason, TaskState, Verb
from arboleda.store.act_table import ActTable
from arboleda.store.plant_memory import PlantMemory
from arboleda.store.task_table import TaskTable

from .bench import ASK, HALT, LATCH, OTHER, WORK, Shop
from .benches import BENCHES, SAME_LINK

pytestmark = pytest.mark.system

ALL = list(BENCHES)
LINKS = [name for name in ALL if name not in SAME_LINK]
ASKING = [name for name in ALL if BENCHES[name].asks]
UNWATCHED = [name for name in ALL if not BENCHES[name].watches]


def of(drivers: list[str], *, all_of: list[str] = ALL) -> pytest.MarkDecorator:
    """The case for the shops of these drivers, and at night for those of `all_of`."""
    return pytest.mark.parametrize("shop", length(drivers, all_of), indirect=True)


@pytest.fixture
def shop(
    request: pytest.FixtureRequest, tmp_path: Path, ros_domain: int, quick_discovery: None
) -> Iterator[Shop]:
    """A plant that runs, and whose device is heard."""
    app, device = BENCHES[request.param].open(tmp_path / "plant", tmp_path / "state")
    shop = Shop(app)
    app.start()
    try:
        shop.device = device(app)
        shop.until(online=True)
        yield shop
        shop.device.rests()  # the plant waits for it to stand still
    finally:
        app.stop()
        shop.device.close()


@pytest.mark.smoke
@of(ALL)
def test_accept_and_done(shop: Shop) -> None:
    shop.submit(WORK)
    ref = shop.told(WORK)
    shop.device.accepts(ref)
    shop.device.finishes(ref)
    assert shop.outcome().state is TaskState.DONE


@of(["line_tcp"])
def test_done_is_not_believed_while_the_facts_say_otherwise(shop: Shop) -> None:
    shop.submit(WORK)
    ref = shop.told(WORK)
    shop.device.accepts(ref)
    shop.device.finishes(ref, there=False)
    end = shop.outcome()
    assert (end.state, end.reason) == (TaskState.FAILED, Reason.NOT_REACHED)


@of(["line_tcp"])
def test_reject(shop: Shop) -> None:
    shop.submit(WORK)
    words = shop.device.rejects(shop.told(WORK))
    end = shop.outcome()
    assert (end.state, end.reason) == (TaskState.FAILED, Reason.REJECTED)
    assert words in str(end.sentence)


@of(["line_tcp"])
def test_failed(shop: Shop) -> None:
    shop.submit(WORK)
    ref = shop.told(WORK)
    shop.device.accepts(ref)
    words = shop.device.gives_up(ref)
    end = shop.outcome()
    assert (end.state, end.reason) == (TaskState.FAILED, Reason.DEVICE_FAULT)
    assert words in str(end.sentence)


@of(["line_tcp"])
def test_cancel_before_accept(shop: Shop) -> None:
    """It is halted, and never done."""
    shop.submit(WORK)
    ref = shop.told(WORK)
    shop.cancel()
    shop.told(HALT)
    shop.device.accepts(ref)
    shop.device.rests()
    assert shop.outcome().state is TaskState.CANCELLED


@of(["line_tcp"], all_of=ASKING)
def test_late_answer(shop: Shop) -> None:
    """An answer to an earlier question is none to this one."""
    shop.submit(ASK, "first")
    first = shop.told(ASK)
    shop.device.accepts(first)
    shop.cancel()
    assert shop.outcome("first").state is TaskState.CANCELLED
    shop.submit(ASK, "second")
    second = shop.told(ASK)
    shop.device.answers(first, "bad")
    shop.device.accepts(second)
    shop.device.answers(second, "good")
    assert shop.outcome("second").state is TaskState.DONE


@of(LINKS, all_of=LINKS)
def test_what_was_stopped_or_lost_under_way_is_never_done(shop: Shop) -> None:
    """A device that comes back is told nothing twice."""
    shop.submit(WORK, "first")
    shop.device.accepts(shop.told(WORK))
    shop.cancel()
    shop.told(HALT)
    shop.device.rests()
    assert shop.outcome("first").state is TaskState.CANCELLED
    shop.submit(OTHER, "second")
    shop.device.accepts(shop.told(OTHER))
    shop.device.vanish()
    end = shop.outcome("second")
    assert (end.state, end.reason) == (TaskState.FAILED, Reason.LINK_LOST)
    comes_back_and_is_stopped(shop)


@of(["line_tcp"])
def test_late_end(shop: Shop) -> None:
    """What is told of work that was cancelled ends no other."""
    shop.submit(WORK, "first")
    first = shop.told(WORK)
    shop.device.accepts(first)
    shop.cancel()
    shop.told(HALT)
    shop.device.rests()
    assert shop.outcome("first").state is TaskState.CANCELLED
    shop.submit(OTHER, "second")
    second = shop.told(OTHER)
    shop.device.accepts(second)
    shop.device.finishes(first)
    shop.device.gives_up(second)  # had the first one's end counted as its own, this would be too late
    assert shop.outcome("second").state is TaskState.FAILED


@of(["line_tcp"])
def test_duplicate(shop: Shop) -> None:
    """The end of an order that is told again and again ends no other, and nothing is sent twice."""
    shop.submit(WORK, "first")
    first = shop.told(WORK)
    shop.device.accepts(first)
    shop.device.finishes(first)
    assert shop.outcome("first").state is TaskState.DONE
    shop.submit(OTHER, "second")
    second = shop.told(OTHER)  # the next order, so the first came once
    for _ in range(3):
        shop.device.finishes(first)
    shop.device.accepts(second)
    shop.device.gives_up(second)
    assert shop.outcome("second").state is TaskState.FAILED


@of(["line_tcp"])
def test_silence(shop: Shop) -> None:
    shop.submit(WORK)
    shop.device.accepts(shop.told(WORK))
    shop.device.hush()
    end = shop.outcome()
    assert (end.state, end.reason) == (TaskState.FAILED, Reason.LINK_LOST)
    shop.until(online=False)


@of(["line_tcp"])
def test_reboot(shop: Shop) -> None:
    shop.submit(WORK)
    shop.device.accepts(shop.told(WORK))
    shop.device.boots()
    end = shop.outcome()
    assert (end.state, end.reason) == (TaskState.FAILED, Reason.REBOOTED)


@of(["line_tcp"])
def test_reconnect(shop: Shop) -> None:
    """A device that comes back from the middle of its work is told nothing twice."""
    shop.submit(WORK)
    shop.device.accepts(shop.told(WORK))
    shop.device.vanish()
    end = shop.outcome()
    assert (end.state, end.reason) == (TaskState.FAILED, Reason.LINK_LOST)
    comes_back_and_is_stopped(shop)


def comes_back_and_is_stopped(shop: Shop) -> None:
    """It hears of stops only: those of what was left at work, and its own."""
    shop.device.come_back()
    shop.until(online=True)
    shop.app.plant.operate(Verb.STOP, "shop").result(PATIENCE_S)
    after = [shop.device.told()[0]]
    while after[-1] != LATCH:
        after.append(shop.device.told()[0])
    assert set(after) <= {HALT, LATCH}
    shop.device.latches()


@of(["line_tcp"], all_of=UNWATCHED)
def test_a_plant_that_freezes(shop: Shop) -> None:
    """What moves is halted without it, and nothing moves again by itself."""
    shop.submit(WORK)
    shop.device.accepts(shop.told(WORK))
    with shop.frozen():
        shop.told(HALT)
        shop.device.rests()
    assert shop.outcome().reason is not None


@of(["line_tcp"], all_of=UNWATCHED)
def test_a_disk_that_hangs(shop: Shop, monkeypatch: pytest.MonkeyPatch) -> None:
    """What moves is halted while the plant waits for its memory."""
    shop.submit(WORK)
    shop.device.accepts(shop.told(WORK))
    with hung_disk(monkeypatch):
        stop = shop.app.plant.operate(Verb.STOP, "shop")
        assert shop.device.told()[0] in {HALT, LATCH}
        shop.device.latches()
    assert stop.result(PATIENCE_S).refusal is None


MESSAGES = {
    "dobot": "arboleda_drivers.dobot.machine.FrameReader.feed",
    "ur": "arboleda_drivers.ur.rtde.frame_of",
    "vda5050": "arboleda_drivers.vda5050.machine.read",
    "modbus": "arboleda_drivers.modbus.machine.ModbusDevice.report",
    "opcua": "arboleda_drivers.opcua.machine.OpcUaDevice.report",
    "s7": "arboleda_drivers.s7.machine.S7Device.report",
    "gcode": "arboleda_drivers.gcode.lines.LineReader.feed",
    "gcode_marlin": "arboleda_drivers.gcode.lines.LineReader.feed",
    "gcode_moonraker": "arboleda_drivers.gcode.lines.LineReader.feed",
    "serial_arm": "arboleda_drivers.serial_arm.servos.Feetech.reading",
}
"""Where each driver takes what its device says."""


@pytest.mark.parametrize(
    ("shop", "takes"),
    [(name, MESSAGES[name]) for name in length(("gcode", "modbus", "opcua", "vda5050"), MESSAGES)],
    indirect=["shop"],
)
def test_a_message_that_breaks_what_takes_it(shop: Shop, takes: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is the device's trouble: no thread of the driver ends by it."""
    of_server = "_handle_client"  # python-snap7's has a thread for each connection
    threads = {each for each in threading.enumerate() if of_server not in each.name}
    with monkeypatch.context() as broken:
        broken.setattr(takes, breaks)
        shop.until(online=False)
    shop.until(online=True)
    assert threads <= set(threading.enumerate())


def breaks(*_: object) -> None:
    raise KeyError("lastNodeId")


@contextmanager
def hung_disk(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Nothing that is written to the plant's memory comes back."""
    goes_on = threading.Event()
    for owner in (PlantMemory, ActTable, TaskTable):
        monkeypatch.setattr(owner, "keep", partialmethod(late, goes_on, owner.keep))
    try:
        yield
    finally:
        goes_on.set()


def late(table: object, goes_on: threading.Event, write: Any, *values: Any, **named: Any) -> None:
    goes_on.wait(PATIENCE_S)
    write(table, *values, **named)
