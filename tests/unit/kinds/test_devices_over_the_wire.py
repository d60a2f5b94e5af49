"""Declared devices through bridge and network: what is lost, repeated, refused and given up."""

from __future__ import annotations

import json
from typing import Any

import pytest

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.declared import DeviceKind, DeviceVerb, Effect, FactType, MotionCall
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.facts import Value
from arboleda.model.messages import Heartbeat, MotionState, Reason, Report, TaskState, Verb
from arboleda.model.plant_model import Evidence
from arboleda.recipes import Kit, parallel, recipe, work
from arboleda.wire.bridge import Bridge, Message
from arboleda.wire.hop import FromPlant
from arboleda.wire.mqtt_limits import objections
from arboleda.wire.payloads import Telemetry, encode
from arboleda.wire.rejections import Rejection
from arboleda.wire.transport import Connection, Delivery, Publication

from ...plants import made
from .lab import EYE, OVEN, Bench, model
from .station import STATION, plant


@recipe("all")
def all_at_once(cell: Kit):  # type: ignore[no-untyped-def]
    station = cell.device("station")
    return parallel(station.light(on=True), station.go(), station.weigh())


warm = made("warm", lambda cell, station: work(station.go(), station.warm(celsius=40.5)))


def telemetry(publication: Publication) -> bool:
    return publication.topic == "st_1/sensores"


def ended(here: Bench) -> None:
    here.wait(30.0, lambda: here.changes[-1].state.value in ("done", "failed"))


def test_an_order_names_its_verb_and_values_and_has_the_numbers_of_every_command() -> None:
    here = Bench(plant(warm))
    here.submit("bench warm")
    ended(here)
    orders = [json.loads(said.payload) for _, said in here.to_boards if said.topic == "st_1/orden"]
    epoch, heard = orders[0]["epoca"], [order.pop("visto") for order in orders]
    tokens = {order.pop("ficha") for order in orders}
    assert orders == [
        {"verbo": "go", "seq": 1, "epoca": epoch},
        {"verbo": "warm", "valores": {"celsius": 40.5}, "seq": 2, "epoca": epoch},
    ]
    assert 0 < heard[0] < heard[1] and len(tokens) == 2
    assert here.changes[-1].state is TaskState.DONE


def test_a_device_that_works_hears_the_heartbeat() -> None:
    here = Bench(plant(warm))
    heard: list[Publication] = []
    here.carry = lambda publication: keep(heard, publication, "/latido")
    here.submit("bench warm")
    here.wait(1.9)
    assert len(heard) >= 7
    assert here.boards["st_1"].body.moving  # after 1 s without a heartbeat it would have stopped


def keep(kept: list[Publication], publication: Publication, what: str) -> list[Publication]:
    kept += [publication] if publication.topic.endswith(what) else []
    return [publication]


def test_ends_of_all_three_lanes_are_proven_though_every_message_between_was_lost() -> None:
    here = Bench(plant(all_at_once))
    here.submit("bench all")
    here.wait(0.9)
    here.lost = telemetry
    here.wait(1.2)  # query and switch end at 1 s, the motion at 2 s
    here.lost = lambda publication: False
    ended(here)
    assert here.changes[-1].state is TaskState.DONE


def test_everything_that_is_said_twice_is_done_once() -> None:
    here = Bench(plant(all_at_once, warm))
    here.carry = lambda publication: [publication, publication]
    for task in ("bench all", "bench warm"):
        here.submit(task)
        ended(here)
        assert here.changes[-1].state is TaskState.DONE
    assert here.boards["st_1"].refusals == 0


def test_an_old_copy_of_an_order_does_not_end_the_work_that_it_began() -> None:
    here = Bench(plant(all_at_once))
    kept: list[Publication] = []
    here.carry = lambda publication: keep(kept, publication, "/orden")
    here.submit("bench all")
    here.wait(0.5)
    here.inject(kept[0])
    ended(here)
    assert here.changes[-1].state is TaskState.DONE


def test_work_that_a_device_gives_up_fails_with_its_word() -> None:
    here = Bench(plant(warm))
    here.boards["st_1"].body.fails = lambda goal: "atasco"
    here.submit("bench warm")
    ended(here)
    assert here.changes[-1].reason is Reason.DEVICE_FAULT
    assert str(here.changes[-1].sentence).startswith("station: gave up (atasco) while")


def test_a_need_that_is_unmet_when_the_order_arrives_is_a_precondition_that_failed() -> None:
    here = Bench(plant(warm))
    here.carry = lambda publication: moved_away(here, publication)
    here.submit("bench warm")
    ended(here)
    assert here.changes[-1].reason is Reason.PRECONDITION
    assert str(here.changes[-1].sentence) == "station: refused the command for doing warm 40.5 (condicion)"


def moved_away(here: Bench, publication: Publication) -> list[Publication]:
    """Somebody moves the station while the order to warm is under way."""
    if b'"warm"' in publication.payload:
        here.boards["st_1"].body.facts["at"] = "left"
    return [publication]


def test_a_device_without_its_plant_halts_its_motion_and_says_so() -> None:
    here = Bench(plant(all_at_once))
    here.submit("bench all")
    here.wait(0.5)
    here.lost = lambda publication: publication.topic.endswith("/latido")
    here.wait(1.2)
    assert not here.boards["st_1"].body.moving
    ended(here)
    assert "gave up (silencio)" in str(here.changes[-1].sentence)


def test_a_boot_fails_the_work_that_it_forgot() -> None:
    here = Bench(plant(warm))
    here.submit("bench warm")
    here.wait(0.5)
    here.power_off("st_1")
    here.power_on("st_1")
    ended(here)
    assert here.changes[-1].reason in (Reason.REBOOTED, Reason.LINK_LOST)
    assert here.boards["st_1"].body.facts["at"] == "left"


@pytest.mark.parametrize("evidence", [Evidence.JOINTS, Evidence.STATE], ids=lambda level: level.value)
def test_a_device_without_numbers_proves_its_work_by_what_it_says(evidence: Evidence) -> None:
    go = made("go", lambda cell: cell.device("station").go())
    here = Bench(plant(go, evidence=evidence))
    here.submit("bench go")
    ended(here)
    assert here.changes[-1].state is TaskState.DONE
    orders = [json.loads(said.payload) for _, said in here.to_boards if said.topic == "st_1/orden"]
    assert orders == [{"verbo": "go"}]


def test_home_of_a_cell_leaves_out_what_has_no_homing() -> None:
    here = Bench(model())
    assert here.operate(Verb.HOME, "bench") == "eye has no homing"
    assert here.operate(Verb.HOME, "oven") == "oven has no homing"
    assert here.operate(Verb.HOME, "oven", by_hand=True) == "oven has no homing"
    assert not [each for each in here.sent if isinstance(each, Home)]


def test_a_device_at_joints_that_reboots_needs_no_homing() -> None:
    here = Bench(model(evidence=Evidence.JOINTS))
    here.power_off("oven")
    here.wait(3.0)
    here.power_on("oven")
    here.wait(3.0)
    assert here.plant.cells["bench"].state is CellState.IDLE
    here.submit("bench bake 10")
    assert here.outcome().state is TaskState.DONE


class Alone:
    """A bridge to the station, its plant and its board played here."""

    def __init__(self) -> None:
        self.bridge = Bridge(plant(), epoch=100, now=0.0)
        self.bridge.step(0.0, [Connection(at=0.0, client="bridge", up=True)])
        self.number = 0
        self.board()

    def board(self, state: MotionState = MotionState.STOPPED, **said: Any) -> list[Message]:
        self.number += 1
        telemetry = Telemetry(state=state, q_deg=None, node=None, boot_id=7, seq=self.number, **said)
        payload = encode(telemetry)
        return self.bridge.step(0.0, [Delivery(at=0.0, topic="st_1/sensores", payload=payload)])

    def hear(self, message: Command | Heartbeat, sender: str = "") -> list[Message]:
        return self.bridge.step(0.0, [FromPlant(at=0.0, message=message, sender=sender)])


def order(id: str, verb: str, **values: Value) -> Command:
    return STATION.command(id=id, robot="station", verb=verb, values=values)


def rejected(messages: list[Message]) -> Rejection:
    (rejection,) = [each for each in messages if isinstance(each, Rejection)]
    return rejection


@pytest.fixture
def alone() -> Alone:
    here = Alone()
    here.hear(Heartbeat(epoch=5))
    return here


def test_each_of_several_failures_is_told_once_and_the_last_one_stays(alone: Alone) -> None:
    for number, command in enumerate((order("5-1", "go"), order("5-2", "light", on=True)), start=1):
        assert alone.hear(command)
        alone.board(ack_epoch=100, ack=number)
    out = alone.board(ack_epoch=100, ack=2, failures=((1, "atasco"), (2, "fundida")))
    assert [(each.failed, each.failure) for each in out if isinstance(each, Report)] == [
        ("5-1", "atasco"),
        ("5-2", "fundida"),
    ]
    again = alone.board(ack_epoch=100, ack=2, failures=((1, "atasco"), (2, "fundida")))
    assert [each.failed for each in again if isinstance(each, Report)] == ["5-2"]


def test_an_answer_is_told_with_its_question_and_that_of_another_epoch_is_not(alone: Alone) -> None:
    alone.hear(order("5-1", "weigh"))
    (report,) = alone.board(ack_epoch=100, ack=1, answer="heavy", answered_seq=1)
    assert isinstance(report, Report)
    assert (report.accepted, report.answered, report.answer) == ("5-1", "5-1", "heavy")
    (stale,) = alone.board(ack_epoch=99, ack=1, answer="heavy", answered_seq=1)
    assert isinstance(stale, Report)
    assert (stale.answered, stale.answer) == (None, None)


def test_a_device_that_gave_its_work_up_needs_no_more_heartbeats(alone: Alone) -> None:
    alone.hear(order("5-1", "go"))
    assert alone.hear(Heartbeat(epoch=5))
    alone.board(ack_epoch=100, ack=1, failures=((1, "atasco"),))
    assert alone.hear(Heartbeat(epoch=5)) == []


def test_facts_are_told_as_the_kind_declares_them(alone: Alone) -> None:
    (report,) = alone.board(facts=(("at", "left"), ("celsius", 40)))
    assert isinstance(report, Report)
    assert [(name, type(value)) for name, value in report.facts or ()] == [("at", str), ("celsius", float)]
    assert alone.board(facts=(("speed", 3),)) == []
    told = "st_1/sensores: datos has 'speed'; this device has at, lamp, held, celsius"
    assert str(alone.bridge.counters["station"].last) == told


@pytest.mark.parametrize(
    ("command", "word", "sentence"),
    [
        (
            Home(id="5-1", robot="station"),
            "no_home",
            "home_cmd was refused (no_home): it has no homing routine",
        ),
        (
            MotionCall(
                id="5-1", robot="station", verb="fly", values=(), definition=STATION.verbs["go"], made=()
            ),
            "formato",
            "order fly was refused (formato): it makes no sense for this robot",
        ),
        (
            SetEffector(id="5-1", robot="station", on=True),
            "formato",
            "effector_cmd 1 was refused (formato): it makes no sense for this robot",
        ),
    ],
    ids=["home", "unknown verb", "command of an arm"],
)
def test_what_a_device_cannot_do_is_refused_at_once(
    alone: Alone, command: Command, word: str, sentence: str
) -> None:
    rejection = rejected(alone.hear(command))
    assert (rejection.reason, str(rejection.sentence)) == (word, f"station: {sentence}")


def test_behind_a_latch_only_questions_and_letting_go_reach_the_board(alone: Alone) -> None:
    alone.hear(Stop(id="5-1", robot="station", mode=StopMode.LATCH))
    work = [order("5-2", "go"), order("5-3", "light", on=True), order("5-4", "hold", on=True)]
    assert [rejected(alone.hear(each)).reason for each in work] == ["paro", "paro", "paro"]
    for command in (order("5-5", "weigh"), order("5-6", "hold", on=False)):
        assert [each.topic for each in alone.hear(command) if isinstance(each, Publication)] == ["st_1/orden"]


def test_an_order_of_another_node_is_refused_by_name_while_a_plant_commands(alone: Alone) -> None:
    rejection = rejected(alone.hear(order("", "light", on=True), sender="panel"))
    told = "station: order light on=true of panel was refused (foreign): "
    assert str(rejection.sentence).startswith(told)


def test_kinds_that_fit_on_the_wire_have_no_objections() -> None:
    assert [objections(kind) for kind in (OVEN, EYE, STATION)] == [[], [], []]


MANY = {f"temperature_of_zone_{number}": FactType(type=float, first=0.0) for number in range(6)}
FITS: dict[str, tuple[DeviceKind, str]] = {
    "too much to say at once": (
        DeviceKind(name="oven", facts=MANY, verbs={}),
        "all that a oven can say at once: the message would have 591 bytes; at most 512 are allowed",
    ),
    "name with a space": (
        DeviceKind(name="oven", facts={"the lid": FactType(type=bool, first=False)}, verbs={}),
        "a fact of oven: its name is 'the lid'; 1 to 32 of A-Z a-z 0-9 _ . - are needed",
    ),
    "switch that sets nothing": (
        DeviceKind(
            name="oven",
            facts={},
            verbs={"beep": DeviceVerb(name="beep", effect=Effect.SWITCH, at_most_s=1.0)},
        ),
        "beep of oven is a switch that sets no fact: nothing would say that it is done",
    ),
}


@pytest.mark.parametrize(("kind", "sentence"), FITS.values(), ids=FITS)
def test_a_kind_that_does_not_fit_on_the_wire_is_told_why(kind: DeviceKind, sentence: str) -> None:
    assert [each.sentence for each in objections(kind)] == [sentence]
