"""Each report that a virtual device cannot make is named; of a virtual device nothing is named."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar

import pytest
from tests.packages import ROOT

from arboleda.engine import Plant
from arboleda.model.commands import Command, Stop, StopMode
from arboleda.model.errors import ConfigError
from arboleda.model.messages import LateDeparture, MotionState, OperatorRequest, Report, Undelivered, Verb
from arboleda.model.plant_model import PlantModel
from arboleda.model.sentence import OWN
from arboleda.plant_file import loader
from arboleda.rig.plant_process import Side
from arboleda_proofs.campaigns.faults_file import read
from arboleda_proofs.campaigns.plants import Plant as Simulated
from arboleda_proofs.campaigns.plants import PlantRotation
from arboleda_proofs.campaigns.proof.instants import Instant
from arboleda_proofs.campaigns.proof.proof_request import ProofRequest
from arboleda_proofs.campaigns.proof.single_faults import single_faults
from arboleda_proofs.campaigns.setting import Setting
from arboleda_proofs.playback.unlike.difference import PHRASES
from arboleda_proofs.playback.unlike.reading import PlantWatch
from arboleda_proofs.playback.unlike.writing import as_yaml
from arboleda_proofs.simulator.checks import BadFaults
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.recurring import recurring_from

EXAMPLES = ROOT / "examples"
SMALL = """
name: small
uses: [small.py]
kinds:
  press:
    facts: {ram: [up, down], holds: bool}
    verbs:
      press: {effect: motion, sets: {ram: down}, takes_s: 2}
      lift: {effect: motion, sets: {ram: up}, takes_s: 1}
      clamp: {effect: switch, with: {on: bool}, holds: part, sets: {holds: $on}, takes_s: 0.1}
  lamp:
    facts: {lit: bool}
    verbs: {light: {effect: switch, with: {on: bool}, sets: {lit: $on}}}
cells:
  bench:
    devices:
      margarets_press: {kind: press}
      lamp: {kind: lamp}
"""
SHINE = """
from arboleda.recipes import recipe, work


@recipe("shine", ends_with={"lamp.lit": True})
def shine(cell):
    return work(cell.device("lamp").light(on=True))
"""
MOVING, STOPPED = MotionState.MOVING, MotionState.STOPPED
UP = (("ram", "up"), ("holds", True))
DOWN = (("ram", "down"), ("holds", True))
Row = tuple[float, str, dict[str, Any]]


class WatchedPlant(Plant):
    """Plant whose devices are watched."""

    made: ClassVar[list[WatchedPlant]] = []

    def __init__(self, model: PlantModel, **made_of: Any) -> None:
        super().__init__(model, **made_of)
        self.watch = PlantWatch(model)
        self.made.append(self)

    def step(self, now: float, events: Iterable[Any]) -> list[Any]:
        events = tuple(events)
        messages = super().step(now, events)
        self.watch.take(now, events, [each for each in messages if isinstance(each, Command)])
        return messages


def told(
    model: PlantModel, seed: int = 1, cycles: int = 2, seconds: float | None = None, **faults: Any
) -> PlantWatch:
    """The watch over the virtual devices of a seed with these faults."""
    plants = PlantRotation(plants=(Simulated(declared=model),))
    setting = Setting(plants=plants, cycles=cycles, level="none", faults_data=faults, seconds=seconds)
    setting.run(seed, make_plant=WatchedPlant)
    return WatchedPlant.made.pop().watch


def rules(watch: PlantWatch) -> set[str]:
    return {each.rule for each in watch.differences()}


@pytest.mark.long
@pytest.mark.parametrize(
    "plant", ["plc_conveyor/plant.yaml", "plate_bench/bench.yaml", "gantry/bench.yaml", "shipped"]
)
def test_virtual_devices_without_faults_tell_nothing_unlike(plant: str) -> None:
    model = loader.load(None if plant == "shipped" else EXAMPLES / plant)
    assert [*map(str, (each.sentence for each in told(model).differences()))] == []


SEEN = {  # a fault, and what is seen of it
    "mute": ("silence", {"seconds": 3.0}),
    "brown_out": ("boot", {"seconds": 2.0, "amount": 60.0}),
    "driver_alarm": ("alarm", {"seconds": 4.0}),
    "delay": ("confirmed_late", {"seconds": 20.0, "amount": 0.8, "word": "down"}),
    "gives_up": ("gave_up", {"seconds": 20.0, "word": "torn_belt"}),
    "ends_late": ("takes_longer", {"seconds": 20.0, "amount": 2.0}),
    "stale_fact": ("done_untrue", {"seconds": 15.0, "word": "part_at"}),
    "lying_fact": ("changed_by_itself", {"seconds": 3.0, "word": "mm_s"}),
}


@pytest.mark.long
@pytest.mark.parametrize("kind", SEEN)
def test_a_fault_of_a_virtual_device_is_told_apart_and_named_as_that_fault(kind: str) -> None:
    rule, figures = SEEN[kind]
    model = loader.load(EXAMPLES / "plc_conveyor/plant.yaml")
    (robot,) = model.robots.values()
    faults = [{"kind": kind, "at": 4.0, "target": robot.mqtt, **figures}]
    found = {each.worst.rule: each for each in told(model, seconds=20.0, faults=faults).unlike()}
    assert rule in found
    made = found[rule].fault
    assert made is not None and (made.kind, made.target) == (kind, robot.mqtt)
    assert made.word == figures.get("word", "")
    if kind in ("delay", "ends_late"):
        assert made.amount == pytest.approx(figures["amount"], abs=0.3)


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> PlantModel:
    file = tmp_path_factory.mktemp("small") / "small.yaml"
    file.write_text(SMALL)
    file.with_name("small.py").write_text(SHINE)
    return loader.load(file)


def tells(at: float, **words: Any) -> Row:
    """It tells this at a time, and has told as much before."""
    return at, "tells", {"robot": "margarets_press", "state": STOPPED, "facts": UP, "boot_id": 1} | words


def steadily(began: float, ends: float, **words: Any) -> list[Row]:
    return [tells(began + 0.1 * step, **words) for step in range(round((ends - began) * 10))]


def is_told(at: float, id: str) -> Row:
    return at, "is told", {"robot": "margarets_press", "id": id, "verb": "press", "values": {}}


def halts(at: float) -> Row:
    return at, "halts", {"robot": "margarets_press", "id": "h"}


WORK = [is_told(1.0, "c1"), *steadily(1.0, 3.0, state=MOVING, accepted="c1")]
DONE = {"accepted": "c1", "done": "c1", "facts": DOWN}
PLANTED: dict[str, list[Row]] = {
    "silence": [*steadily(1, 2), *((at, "steps", {}) for at in (2.5, 3.0, 3.5)), *steadily(4, 5)],
    "boot": [*steadily(1, 2), *steadily(2, 3, boot_id=2)],
    "alarm": [*steadily(1, 2, state=MotionState.FAULT), tells(2)],
    "confirmed_late": [is_told(1.0, "c1"), *steadily(1.0, 2.0), tells(2.0, state=MOVING, accepted="c1")],
    "unanswered": [tells(0.5, accepted="c0"), is_told(1.0, "c1"), *steadily(1.0, 6.5)],
    "done_unconfirmed": [
        tells(0.5, accepted="c0"),
        is_told(1.0, "c1"),
        *steadily(1, 3, state=MOVING),
        tells(3, done="c1", facts=DOWN),
    ],
    "stopped_late": [*WORK[:10], halts(2.0), *steadily(2.0, 3.5, state=MOVING), tells(3.5)],
    "begins_after_stop": [is_told(1.0, "c1"), halts(1.1), *steadily(1.0, 2.0), *steadily(2, 3, state=MOVING)],
    "moves_by_itself": [*steadily(1, 2), *steadily(2, 3, state=MOVING), tells(3)],
    "done_moving": [*WORK, tells(3.0, state=MOVING, **DONE), tells(3.1, **DONE)],
    "takes_longer": [*WORK, *steadily(3, 5, state=MOVING), tells(5.0, **DONE)],
    "takes_less": [*WORK[:5], tells(1.5, **DONE)],
    "gave_up": [*WORK, tells(3.0, failed="c1", failure="no_oil")],
    "refused": [is_told(1.0, "c1"), tells(1.1, rejected="c1", refusal="not today")],
    "let_go": [tells(1.0), *steadily(1.1, 2, facts=(("ram", "up"), ("holds", False)))],
    "changed_by_itself": [tells(1.0), *steadily(1.1, 2, facts=DOWN), tells(2)],
    "done_untrue": [*WORK, *steadily(3, 4, done="c1", facts=UP), *steadily(4, 5, **DONE)],
    "unknown": [*steadily(1, 2, unknown=("ram",)), tells(2)],
    "other_fact": [tells(1.0, facts=(*UP, ("oil", "low")))],
}
GANTRY = {"robot": "gantry", "facts": None, "homed": True, "q": (-0.1, 0.0, 0.0)}


def stands_at(at: float, x: float, **words: Any) -> Row:
    return tells(at, **{**GANTRY, "q": (x, 0.0, 0.0), **words})


MOVE = (1.0, "is told", {"robot": "gantry", "id": "c1", "q": (-0.2, 0.0, 0.0)})
PLANTED |= {
    "unhomed": [stands_at(1.0, -0.1), *steadily(1.1, 2, **{**GANTRY, "homed": False}), stands_at(2.0, -0.1)],
    "jumped": [stands_at(1.0, 0.0), stands_at(1.1, -0.29)],
    "beyond": [stands_at(1.0, 0.05), stands_at(1.1, -0.01)],
    "done_elsewhere": [
        stands_at(0.9, -0.1),
        MOVE,
        stands_at(1.1, -0.1, state=MOVING, accepted="c1"),
        stands_at(2.1, -0.15, accepted="c1", done="c1"),
    ],
}


def watched(model: PlantModel, rows: Iterable[Row]) -> PlantWatch:
    """The watch over this, step by step."""
    watch = PlantWatch(model)
    watch.take(0.0, [], [])
    for at, what, words in rows:
        if what == "tells of it":
            watch.take(at, [words["event"]], [])
        elif what == "tells":
            watch.take(at, [Report(at=at, **words)], [])
        else:
            watch.take(at, [], [] if what == "steps" else [command(model, what, words)])
    return watch


def command(model: PlantModel, what: str, words: dict[str, Any]) -> Command:
    if what == "halts":
        return Stop(mode=StopMode.HALT, **words)
    robot: Any = model.robots[words["robot"]]
    return robot.kind.command(**words) if "verb" in words else robot.go(id=words["id"], way=[words["q"]])


@pytest.mark.parametrize("rule", PHRASES)
def test_what_is_planted_is_found(small: PlantModel, rule: str) -> None:
    model = loader.load(EXAMPLES / "gantry/bench.yaml") if "gantry" in str(PLANTED[rule]) else small
    (found,) = (each for each in watched(model, PLANTED[rule]).unlike() if each.worst.rule == rule)
    assert str(found.worst.sentence).startswith(f"{found.worst.robot} ")


def test_what_hands_and_stops_change_is_no_word_about_the_device(small: PlantModel) -> None:
    watch = watched(small, [*WORK[:10], halts(2.0), tells(2.1), tells(2.2)])
    watch.take(2.3, [OperatorRequest(at=2.3, verb=Verb.RELEASE, scope="margarets_press", by_hand=True)], [])
    watch.take(
        2.4,
        [Report(at=2.4, robot="margarets_press", state=STOPPED, facts=(("ram", "up"), ("holds", False)))],
        [],
    )
    assert rules(watch) == set()


def test_a_plant_that_was_away_says_nothing_of_its_devices(small: PlantModel) -> None:
    watch = watched(small, [*WORK[:10], tells(9.0, **DONE)])
    assert rules(watch) == set()


@pytest.mark.parametrize(
    ("rule", "event"),
    [
        ("confirmed_late", LateDeparture(at=1.0, id="c1", late_s=1.0)),
        ("unanswered", Undelivered(at=1.0, id="c1", robot="margarets_press", sentence=OWN(text="no line"))),
    ],
)
def test_a_command_that_left_late_or_never_is_not_the_device_s(
    small: PlantModel, rule: str, event: LateDeparture | Undelivered
) -> None:
    rows = PLANTED[rule]
    number = next(number for number, (_, what, _) in enumerate(rows) if what == "is told")
    excused = [*rows[: number + 1], (1.0, "tells of it", {"event": event}), *rows[number + 1 :]]
    assert rule in rules(watched(small, rows)) and rule not in rules(watched(small, excused))


def test_the_file_has_no_names_and_is_read_again(small: PlantModel, tmp_path: Path) -> None:
    rows = ("changed_by_itself", "gave_up", "refused", "stopped_late")
    for rule in rows:
        watch = watched(small, PLANTED[rule])
        text = as_yaml(watch.unlike(), small, watch.minutes)
        for name in ("margarets_press", "small", "bench", "lamp", "ram", "no_oil", "not today"):
            assert name not in text.partition("unlike:")[2].replace("word_1", "")
        file = tmp_path / f"{rule}.yaml"
        file.write_text(text)
        climate = Climate.from_file(small, 1, read(file, None).climate)
        drawn = [fault for minute in range(30) for fault in climate.faults(minute)]
        wanted = [each.fault for each in watch.unlike() if each.fault is not None]
        assert {(each.kind, each.target, each.seconds) for each in drawn} == {
            (each.kind, each.target, round(each.seconds, 3)) for each in wanted
        }
        assert all(each.word == "word_1" for each in drawn if each.kind == "gives_up")


def test_a_wrong_row_is_a_sentence_with_its_place(small: PlantModel) -> None:
    for row, sentence in (
        ({"fualt": {}}, "a row of unlike has no 'fualt'; there are what, device"),
        ({"device": 3, "fault": {"kind": "mute"}}, "device is 3; the plant has devices 1 to 2"),
        ({"fault": {"kind": "muted"}}, "did you mean mute?"),
        ({"device": 1, "fault": {"kind": "lying_fact", "fact": 3}}, "fact is 3; the device has facts 1 to 2"),
        ({"device": 2, "fault": {"kind": "lost_part"}}, "lost_part cannot befall 'lamp'"),
        ({"device": 1, "fault": {"kind": "gives_up", "word": "no oil"}}, "knows no 'no oil'"),
        ({"per_minute": 99, "fault": {"kind": "mute"}}, "per_minute is 99; a number from 0 to 10 is needed"),
        ({"fault": {"kind": "mute", "seconds": "long"}}, "seconds of a fault is 'long'; a number is needed"),
    ):
        with pytest.raises(BadFaults, match=re.escape(sentence)) as wrong:
            recurring_from(small, [{}, row])
        assert wrong.value.place[:2] == ("unlike", 1)


def test_a_proof_tries_what_was_seen_before_all_others(small: PlantModel, tmp_path: Path) -> None:
    watch = watched(small, PLANTED["stopped_late"])
    file = tmp_path / "unlike.yaml"
    file.write_text(as_yaml(watch.unlike(), small, watch.minutes))
    request = ProofRequest(
        plant=tmp_path / "small.yaml", recipes=(), kinds=(), budget_s=1.0, folder=tmp_path, faults=file
    )
    (tmp_path / "small.yaml").write_text(SMALL)
    (tmp_path / "small.py").write_text(SHINE)
    instant = Instant(at=3.0, side=Side.AFTER, what="")
    (cell,) = small.cells
    first = single_faults(small, cell, instant, seen=request.seen)[0][0]
    (seen,) = (each.fault for each in watch.unlike())
    assert seen is not None
    assert first == replace(seen, at=3.0, seconds=round(seen.seconds, 3), amount=round(seen.amount, 3))
    file.write_text("rates: {loss: 2}\n")
    with pytest.raises(ConfigError, match="is no file that `arboleda record unlike --to` wrote"):
        assert replace(request).seen
