"""Slow answers, shifted answers and alarms are named as what virtual boards cannot tell."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import pytest

from arboleda.engine import Plant
from arboleda.model.commands import Command
from arboleda.model.messages import Report, Verb
from arboleda.model.plant_model import PlantModel
from arboleda_driver_faults import plc, rig
from arboleda_driver_faults.modbus import ModbusRig, Registers
from arboleda_driver_faults.rig import Hear, Result, Rig, World
from arboleda_driver_faults.rigs import rig_of
from arboleda_drivers.modbus.machine import Block, ModbusDevice, Raw
from arboleda_drivers.modbus.settings import Settings
from arboleda_proofs.playback.unlike.reading import PlantWatch, Unlike
from arboleda_proofs.playback.unlike.writing import as_yaml


class WatchedPlant(Plant):
    """Plant whose devices are watched."""

    def __init__(self, model: PlantModel, **made_of: Any) -> None:
        super().__init__(model, **made_of)
        self.watch = PlantWatch(model)

    def step(self, now: float, events: Iterable[Any]) -> list[Any]:
        events = tuple(events)
        messages = super().step(now, events)
        self.watch.take(now, events, [each for each in messages if isinstance(each, Command)])
        return messages


class Slow(plc.Loopback):
    """Line on which each command, and each report, takes a while."""

    late_s = 0.4

    def __init__(self, tried: ModbusRig, hear: Hear, now: float) -> None:
        self._on_its_way: list[tuple[float, Command | Report]] = []
        self._arrive = hear
        super().__init__(tried, tried.wire(), self._send, now)

    def ask(self, command: Command) -> str | None:
        self._send(command)
        return None

    def _send(self, what: Command | Report) -> None:
        self._on_its_way.append((self._now + self.late_s, what))

    def pass_time(self, now: float) -> None:
        super().pass_time(now)
        while self._on_its_way and self._on_its_way[0][0] <= now:
            what = self._on_its_way.pop(0)[1]
            if isinstance(what, Report):
                self._arrive(what)
            else:
                super().ask(what)


class SlowPlc(ModbusRig):
    """PLC behind such a line."""

    def join(self, hear: Hear, now: float) -> Slow:
        return Slow(self, hear, now)


class ShiftedLine(Registers):
    """Line on which, for a while, the answers are read as those of the requests before."""

    is_shifted = False

    def _read(self, blocks: Sequence[Block]) -> Raw:
        """The gate's answer is read as the state, and none as where the part is."""
        raw = super()._read(blocks)
        if not self.is_shifted or ("discrete", 0) not in raw:
            return raw
        return {**raw, ("input", 2): raw["discrete", 0], ("input", 10): 0}


class ShiftedPlc(ModbusRig):
    """PLC behind such a line."""

    def wire(self) -> ShiftedLine:
        assert self.device.driver is not None and isinstance(self.device.driver.settings, Settings)
        self.line = ShiftedLine(ModbusDevice(self.device, self.device.driver.settings), self._memory)
        return self.line


@pytest.fixture(autouse=True)
def watched(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rig, "Plant", WatchedPlant)


def begun(tried: Rig) -> World:
    """A world in which a task has begun."""
    world = World(tried, Result(seed=0, faults=()), tasks=1)
    world.advance(1.0)
    world.submit(tried.task(0))
    return world


def unlike(world: World) -> dict[str, Unlike]:
    """Differences so far, by their rules."""
    assert isinstance(world.plant, WatchedPlant)
    return {each.worst.rule: each for each in world.plant.watch.unlike()}


def belt(of: type[ModbusRig]) -> Any:
    return of(rig_of("modbus").model)


def test_a_plc_on_a_prompt_line_is_unlike_only_in_its_speed() -> None:
    world = begun(rig_of("modbus"))
    world.advance(20.0)
    found = unlike(world)
    assert [(rule, each.worst.word) for rule, each in found.items()] == [("changed_by_itself", "mm_s")]


def test_a_plc_that_answers_slowly_is_named_with_how_late_it_is() -> None:
    """An order is confirmed late, and so is the state after a stop."""
    world = begun(belt(SlowPlc))
    assert isinstance(world.plant, WatchedPlant)
    world.advance(30.0, until=lambda: world.rig.belt.shown.state == 1)
    world.operate(Verb.STOP)
    world.advance(10.0)
    found = unlike(world)
    assert {"confirmed_late", "stopped_late"} <= found.keys()
    for rule in ("confirmed_late", "stopped_late"):
        fault = found[rule].fault
        assert fault is not None and fault.kind == "delay" and 0.7 < fault.amount < 1.2


def test_answers_that_are_read_as_those_of_other_requests_are_named() -> None:
    """The belt moves though nobody has told it to, and its part is gone while it is there."""
    tried = belt(ShiftedPlc)
    world = begun(tried)
    world.advance(30.0, until=lambda: tried.belt.shown.part_at == 1 and tried.belt.shown.gate == 1)
    world.operate(Verb.STOP)
    world.advance(5.0)
    tried.line.is_shifted = True
    world.advance(8.0)
    tried.line.is_shifted = False
    world.advance(3.0)
    found = unlike(world)
    moving, facts = found["begins_after_stop"], found["changed_by_itself"]
    assert moving.worst.seconds == pytest.approx(8.0, abs=0.5)
    assert (facts.worst.word, facts.fault is not None) == ("part_at", True)


@pytest.mark.parametrize(
    ("fault", "word"), [("hard_limit", "hard_limit"), ("homing_fails", "homing_no_switch")]
)
def test_alarms_of_grbl_are_named_in_its_words(fault: str, word: str) -> None:
    tried = rig_of("gcode-grbl")
    world = begun(tried)
    world.advance(2.0)
    if fault == "homing_fails":
        tried.faults.switch("boot", on=True)
        world.advance(0.5)
        tried.faults.switch("boot", on=False)
    tried.faults.switch(fault, on=True)
    world.advance(10.0)
    if fault == "homing_fails":
        world.operate(Verb.HOME)
        world.advance(10.0)
    found = unlike(world)
    assert (found["gave_up"].worst.word, found["alarm"].fault is not None) == (word, True)
    text = as_yaml(found.values(), tried.model, 1.0)
    assert f'what: "gave_up", device: 1, driver: "gcode", word: "{word}"' in text
