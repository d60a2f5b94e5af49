"""The driver's machine of PyLabRobot: what its events make of a command, under time moved by hand."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.packages import ROOT

from arboleda.drivers import MotionState, Report, Stop, StopMode
from arboleda.drivers.port import DriverError
from arboleda.kinds.declared import Device, FactType
from arboleda.plant_file.loader import load
from arboleda_drivers.connections.link import Close, Closed, CommandNotSent, CommandRequest, Open, Opened
from arboleda_drivers.meaning import UnreadableValue
from arboleda_drivers.pylabrobot import adapter as adapter
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
from arboleda_drivers.pylabrobot.reading import Reading
from arboleda_drivers.pylabrobot.settings import Call, MachineMapping

MODEL = load(ROOT / "examples/plate_bench/bench.yaml")
SHAKER = MODEL.robots["hotplate"]
PATH = "get_temperature()"
WORDS = FactType(type=str, words=("low", "high"), first="low")


class Bench:
    """The machine, and what it said last."""

    def __init__(self, **changes: object) -> None:
        assert isinstance(SHAKER, Device) and SHAKER.driver is not None
        settings = SHAKER.driver.settings
        assert isinstance(settings, MachineMapping)
        known = {"setup_again": False, "refusals": ("ValueError",), **changes}
        self.machine, self.now = Machine([SHAKER], replace(settings, **known)), 100.0  # type: ignore[arg-type]
        self.look, self.call = 0, 0
        self.report = Report(at=0.0, robot="hotplate")
        self.step()
        self.step(Opened())
        self.looks(20.0)

    def step(self, *events: Event, after: float = 0.0) -> list[Message]:
        self.now += after
        out = self.machine.step(self.now, events)
        for message in out:
            if isinstance(message, Report):
                self.report = message
            elif isinstance(message, Look):
                self.look = message.number
            elif isinstance(message, BeginCalls):
                self.call = message.number
        return out

    def looks(self, celsius: object) -> None:
        self.step(Looked(number=self.look, values={PATH: celsius}))

    def heat(self) -> list[Message]:
        assert isinstance(SHAKER, Device)
        command = SHAKER.kind.command(id="c1", robot="hotplate", verb="heat", values={"celsius": 37})
        return self.step(CommandRequest(command=command))

    def stop(self, mode: StopMode = StopMode.HALT) -> list[Message]:
        return self.step(CommandRequest(command=Stop(id="s1", robot="hotplate", mode=mode)))


def test_a_verb_is_its_calls_with_its_values() -> None:
    (begun,) = [each for each in Bench().heat() if isinstance(each, BeginCalls)]
    assert [(call.call, call.arguments) for call in begun.calls] == [
        ("set_temperature", {"temperature": 37}),
        ("wait_for_temperature", {"timeout": 50}),
    ]


def test_it_is_done_once_a_look_after_the_return_has_read_the_facts() -> None:
    bench = Bench()
    bench.heat()
    bench.step(Begun(number=bench.call))
    assert (bench.report.accepted, bench.report.state) == ("c1", MotionState.MOVING)
    bench.step(Returned(number=bench.call))
    assert bench.report.done is None
    bench.looks(37.3)
    assert (bench.report.done, bench.report.facts) == ("c1", (("celsius", 37),))


def test_a_look_that_began_before_the_return_proves_nothing() -> None:
    bench = Bench(side_by_side=True)
    bench.heat()
    bench.step(after=1.1)
    old = bench.look
    bench.step(Returned(number=bench.call))
    bench.step(Looked(number=old, values={PATH: 37.0}))
    assert bench.report.done is None
    bench.looks(37.0)
    assert bench.report.done == "c1"


def test_nothing_is_read_while_a_call_is_under_way() -> None:
    bench = Bench()
    bench.heat()
    (look,) = [each for each in bench.step(after=1.1) if isinstance(each, Look)]
    assert look.paths == ()


@pytest.mark.parametrize(
    ("name", "first", "field"),
    [("ValueError", True, "rejected"), ("ValueError", False, "failed"), ("TypeError", True, "failed")],
)
def test_an_exception_is_a_failure_unless_it_is_known_to_begin_nothing(
    name: str, first: bool, field: str
) -> None:
    bench = Bench()
    bench.heat()
    bench.step(Raised(number=bench.call, name=name, text="no", first=first))
    bench.looks(20.0)
    assert getattr(bench.report, field) == "c1"
    assert (bench.report.refusal or bench.report.failure) == f"{name}: no"


COUNTED = {"celsius": Reading(read=PATH, near=0.5, otherwise=0, counted=True)}


def test_what_is_counted_is_unknown_after_a_call_that_failed_until_one_returns() -> None:
    bench = Bench(facts=COUNTED)
    bench.heat()
    bench.step(Raised(number=bench.call, name="RuntimeError", text="no heat"))
    bench.looks(37.0)
    assert (bench.report.failed, bench.report.facts, bench.report.unknown) == ("c1", (), ("celsius",))
    bench.heat()
    bench.step(Returned(number=bench.call))
    bench.looks(37.0)
    assert (bench.report.facts, bench.report.unknown) == ((("celsius", 37),), ())


def test_what_is_counted_stays_known_where_nothing_has_begun() -> None:
    bench = Bench(facts=COUNTED)
    bench.heat()
    bench.step(Raised(number=bench.call, name="ValueError", text="not so", first=True))
    bench.looks(20.0)
    assert (bench.report.rejected, bench.report.facts) == ("c1", (("celsius", 0),))


def test_what_is_counted_is_unknown_once_the_machine_is_left_at_work() -> None:
    bench = Bench(facts=COUNTED)
    bench.heat()
    bench.step(Closed(why="pulled"))
    bench.step(Opened())
    bench.looks(20.0)
    assert bench.report.unknown == ("celsius",)


def test_what_the_machine_is_asked_for_is_known_after_a_call_that_failed() -> None:
    bench = Bench()
    bench.heat()
    bench.step(Raised(number=bench.call, name="RuntimeError", text="no heat"))
    bench.looks(37.0)
    assert (bench.report.facts, bench.report.unknown) == ((("celsius", 37),), ())


@pytest.mark.parametrize(("path", "counted"), [("head[0].has_tip", True), ("get_temperature()", False)])
def test_a_value_is_counted_unless_something_is_called_for_it(path: str, *, counted: bool) -> None:
    assert Reading(read=path).is_counted is counted
    assert Reading(read=path, counted=not counted).is_counted is not counted


def test_a_call_without_an_end_is_silence_and_is_back_with_its_end() -> None:
    bench = Bench(call_s=10.0)
    bench.heat()
    for _ in range(12):
        bench.step(Looked(number=bench.look, values={}), after=1.0)
    assert bench.report.lost is not None and "a call has not come back" in str(bench.report.lost)
    assert any(isinstance(each, CommandNotSent) for each in bench.heat())
    bench.step(Returned(number=bench.call), after=1.0)
    bench.step(Looked(number=bench.look, values={}), after=2.0)
    bench.looks(37.0)
    assert (bench.report.state, bench.report.done) == (MotionState.STOPPED, None)


def test_a_question_without_an_answer_is_silence() -> None:
    bench = Bench()
    bench.step(after=1.1)
    bench.step(after=5.1)
    assert "has not been read for 5 s" in str(bench.report.lost)


def test_it_is_set_up_again_only_where_that_is_allowed() -> None:
    for allowed in (False, True):
        bench = Bench(setup_again=allowed)
        bench.step(after=1.1)
        out = bench.step(LookFailed(number=bench.look, why="gone"))
        assert any(isinstance(each, Close) for each in out) is allowed
        assert any(isinstance(each, Open) for each in bench.step(after=2.1)) is allowed


def test_a_setup_that_fails_is_told_and_not_repeated() -> None:
    bench = Bench()
    out = bench.step(Closed(why="no such port"))
    assert any(isinstance(each, Close) for each in out), "what it began is left"
    told = str(bench.report.lost)
    assert "no such port; setup is not called again by itself" in told
    assert "then stop hotplate and clear hotplate, which calls it" in told
    assert bench.step(after=100.0) == []


def test_a_setup_that_has_failed_is_called_again_once_a_person_clears_the_device() -> None:
    bench = Bench()
    bench.step(Closed(why="no such port"))
    assert not any(isinstance(each, Open) for each in bench.stop(StopMode.LATCH))
    assert any(isinstance(each, Open) for each in bench.stop(StopMode.CLEAR))
    assert not any(isinstance(each, Open) for each in bench.stop(StopMode.CLEAR)), "it is under way"
    bench.step(Opened())
    bench.looks(20.0)
    assert bench.report.state is MotionState.STOPPED


class Guard:
    """A lock that says whether somebody has it."""

    taken = False

    def __enter__(self) -> None:
        self.taken = True

    def __exit__(self, *raised: object) -> None:
        self.taken = False


class Made:
    """A machine that is set up at once."""

    async def setup(self) -> None: ...


def test_machines_are_made_one_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    guard, seen = Guard(), list[bool]()
    monkeypatch.setattr(adapter, "MAKING", guard)

    def make() -> Made:
        seen.append(guard.taken)
        return Made()

    said: list[object] = []
    settings = SHAKER.driver.settings if SHAKER.driver else None
    assert isinstance(settings, MachineMapping)
    with pytest.raises(StopIteration):
        adapter.Bench(make, settings, said.append).open().send(None)
    assert (seen, guard.taken, said) == ([True], False, [Opened()])


def test_what_is_halted_is_never_done() -> None:
    bench = Bench()
    bench.heat()
    work = bench.call
    out = bench.stop()
    assert [type(each) for each in out if not isinstance(each, Report)] == [CancelCalls, BeginCalls]
    bench.step(Returned(number=bench.call))
    assert (bench.report.accepted, bench.report.state) == ("s1", MotionState.MOVING)
    bench.step(Returned(number=work))
    bench.step(Looked(number=bench.look, values={}))
    bench.looks(37.0)
    assert (bench.report.done, bench.report.state) == (None, MotionState.STOPPED)


def test_a_stop_that_fails_loses_the_link() -> None:
    bench = Bench()
    bench.stop()
    bench.step(Raised(number=bench.call, name="RuntimeError", text="no"))
    assert "its stop was not taken: RuntimeError: no" in str(bench.report.lost)


@pytest.mark.parametrize(
    ("reading", "raw", "value"),
    [
        (Reading(words={"low": [0, 5], "high": [5.1, 9]}), 4.2, "low"),
        (Reading(words={"low": False, "high": True}), True, "high"),
        (Reading(otherwise="high"), None, "high"),
    ],
)
def test_what_a_value_means(reading: Reading, raw: object, value: str) -> None:
    assert reading.value_of(raw, WORDS) == value


@pytest.mark.parametrize("raw", [float("nan"), 10**400, "medium", []])
def test_a_value_without_a_meaning(raw: object) -> None:
    with pytest.raises(UnreadableValue):
        Reading(words={"low": [0, 5]}).value_of(raw, WORDS)


def test_paths_and_calls_that_are_none() -> None:
    assert [step.key for step in steps("head[0].has_tip")] == ["head", "0", "has_tip"]
    for wrong in (".a", "_secret", "a..b", "a[", "a b"):
        with pytest.raises(DriverError, match="is no path"):
            steps(wrong)
    with pytest.raises(DriverError, match="is no method"):
        Call(call="stop()")
