"""The board of a declared device, virtual: its receipts, refusals, stops, silence and boots."""

from __future__ import annotations

import itertools
import json
from typing import Any

import pytest

from arboleda.kinds import motion, switch
from arboleda.model.commands import StopMode
from arboleda.model.facts import Value
from arboleda.model.messages import MotionState
from arboleda.model.plant_model import Evidence
from arboleda.sim.devices import Devices, Reboot, ToBoard
from arboleda.sim.machine import MachineBody
from arboleda.wire.payloads import Beat, Payload, StopGoal, Telemetry, VerbGoal, decode, encode
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Connection, Delivery

from ...plants import kind_of
from .station import plant

BOARD, EPOCH = "st_1", 50


class Bench:
    """One board at a broker that is played here; `say` numbers what it is told."""

    def __init__(self, evidence: Evidence = Evidence.IDS) -> None:
        boots, self.seqs = itertools.count(7), itertools.count(1)
        self.now = 10.0
        self.devices = Devices(plant(evidence=evidence), now=self.now, boot_ids=lambda: next(boots))
        body = self.devices.boards[BOARD].body
        assert isinstance(body, MachineBody)
        self.body = body
        self.raw: list[bytes] = []
        self._step(ToBoard(board=BOARD, event=Connection(at=self.now, client=BOARD, up=True)))

    def order(self, verb: str, **values: Value) -> int:
        seq = next(self.seqs)
        self.say(Channel.ORDER, VerbGoal(verb=verb, values=tuple(values.items()), seq=seq, epoch=EPOCH))
        return seq

    def stop(self, mode: StopMode) -> None:
        self.say(Channel.STOP, StopGoal(mode=mode, seq=next(self.seqs), epoch=EPOCH))

    def say(self, channel: Channel, payload: Payload | bytes) -> None:
        raw = payload if isinstance(payload, bytes) else encode(payload)
        delivery = Delivery(at=self.now, topic=topic(BOARD, channel), payload=raw)
        self._step(ToBoard(board=BOARD, event=delivery))

    def wait(self, seconds: float) -> None:
        end = self.now + seconds
        while (due := self.devices.next_deadline) is not None and due <= end:
            self.now = max(self.now, due)
            self._step()
        self.now = end

    def reboot(self) -> None:
        self._step(Reboot(at=self.now, board=BOARD))

    @property
    def last(self) -> Telemetry:
        said = decode(Channel.TELEMETRY, self.raw[-1], axes=0)
        assert isinstance(said, Telemetry)
        return said

    def _step(self, *events: Any) -> None:
        sent = self.devices.step(self.now, events)
        self.raw += [each.publication.payload for each in sent if each.publication.topic.endswith("sensores")]


def test_a_motion_is_accepted_then_done_and_its_fact_becomes_true_at_its_end() -> None:
    bench = Bench()
    seq = bench.order("go")
    assert (bench.last.state, bench.last.ack, bench.last.done) == (MotionState.MOVING, seq, None)
    assert dict(bench.last.facts or ())["at"] == "left"
    bench.wait(2.0)
    assert (bench.last.state, bench.last.done) == (MotionState.STOPPED, seq)
    assert dict(bench.last.facts or ())["at"] == "right"


def test_switch_and_query_beside_a_motion_leave_its_receipt_alone() -> None:
    bench = Bench()
    motion = bench.order("go")
    bench.wait(1.5)
    query = bench.order("weigh")
    bench.order("light", on=True)
    bench.wait(1.0)
    said = bench.last
    assert (said.done, said.answered_seq, said.answer) == (motion, query, "light")
    assert dict(said.facts or ())["lamp"] is True


def test_one_work_at_a_time_and_only_when_what_it_needs_is_so() -> None:
    bench = Bench()
    early = bench.order("warm", celsius=40.0)
    assert (bench.last.refusal, bench.last.refused_seq) == ("condicion", early)
    bench.order("go")
    second = bench.order("go")
    assert (bench.last.refusal, bench.last.refused_seq) == ("ocupado", second)


@pytest.mark.parametrize(
    "raw",
    [
        b'{"verbo":"fly","seq":1,"epoca":50}',
        b'{"verbo":"light","seq":1,"epoca":50}',
        b'{"verbo":"light","valores":{"on":1},"seq":1,"epoca":50}',
        b'{"verbo":"go","valores":{"far":true},"seq":1,"epoca":50}',
    ],
    ids=["unknown verb", "value missing", "value of another type", "value too many"],
)
def test_what_the_kind_does_not_know_is_refused_as_formato(raw: bytes) -> None:
    bench = Bench()
    bench.say(Channel.ORDER, raw)
    assert (bench.last.refusal, bench.last.refused_seq, bench.last.ack) == ("formato", 1, None)


def test_a_whole_number_is_a_number_too() -> None:
    bench = Bench()
    bench.order("go")
    bench.wait(2.0)
    bench.say(Channel.ORDER, b'{"verbo":"warm","valores":{"celsius":40},"seq":2,"epoca":50}')
    bench.wait(2.0)
    assert dict(bench.last.facts or ())["celsius"] == 40.0


def test_a_halt_ends_a_motion_and_not_a_process_that_finishes() -> None:
    bench = Bench()
    bench.order("go")
    bench.wait(1.0)
    bench.stop(StopMode.HALT)
    assert (bench.last.state, bench.last.done, bench.last.failures) == (MotionState.STOPPED, None, None)
    bench.order("go")
    bench.wait(2.0)
    process = bench.order("warm", celsius=40.0)
    bench.stop(StopMode.LATCH)
    assert bench.last.state is MotionState.MOVING
    bench.wait(2.0)
    assert (bench.last.state, bench.last.done) == (MotionState.STOP_LATCHED, process)


def test_a_latched_device_answers_and_lets_go_and_does_nothing_else() -> None:
    bench = Bench()
    bench.order("hold", on=True)
    bench.wait(1.0)
    bench.stop(StopMode.LATCH)
    for verb, values in (("go", {}), ("light", {"on": False}), ("hold", {"on": True})):
        assert bench.order(verb, **values) == bench.last.refused_seq
        assert bench.last.refusal == "paro"
    query = bench.order("weigh")
    bench.order("hold", on=False)
    bench.wait(1.0)
    assert (bench.last.answered_seq, dict(bench.last.facts or ())["held"]) == (query, False)


def test_silence_breaks_a_motion_off_with_a_word_and_lets_a_process_finish() -> None:
    bench = Bench()
    bench.say(Channel.BEAT, Beat(epoch=EPOCH))
    motion = bench.order("go")
    bench.wait(1.5)
    assert (bench.last.state, bench.last.failures) == (MotionState.STOPPED, ((motion, "silencio"),))
    bench.body.facts["at"] = "right"
    process = bench.order("warm", celsius=40.0)
    bench.wait(2.0)
    assert bench.last.done == process


def test_of_several_that_end_as_failed_each_is_named_in_the_same_message() -> None:
    bench = Bench()
    bench.body.fails = lambda goal: {"go": "atasco", "light": "fundida"}.get(goal.verb)
    motion, light = bench.order("go"), bench.order("light", on=True)
    bench.wait(2.0)
    assert bench.last.failures == ((light, "fundida"), (motion, "atasco"))
    assert (bench.last.state, bench.last.done, bench.body.facts["lamp"]) == (MotionState.STOPPED, None, False)


def test_a_switch_gives_way_to_the_next_one_of_its_fact() -> None:
    bench = Bench()
    first = bench.order("hold", on=True)
    bench.wait(0.5)
    bench.order("hold", on=False)
    assert bench.last.failures == ((first, "relevado"),)
    bench.wait(2.0)
    assert bench.body.facts["held"] is False


def test_a_switch_gives_way_to_a_motion_that_sets_its_fact() -> None:
    pushed = switch(sets={"down": False}, takes_s=2.0, at_most_s=5.0)
    lowered = motion(sets={"down": True}, takes_s=0.1, at_most_s=5.0)
    body = MachineBody(kind_of("lift", {"down": bool}, push=pushed, lower=lowered))
    body.start(0, VerbGoal(verb="push", values=(), seq=1, epoch=EPOCH))
    body.start(1, VerbGoal(verb="lower", values=(), seq=2, epoch=EPOCH))
    assert [end.failure for end in body.take_ends()] == ["relevado"]
    body.advance(5_000_000)
    assert body.facts["down"] is True


def test_an_order_that_comes_twice_is_carried_out_once_whatever_came_between() -> None:
    bench = Bench()
    first = bench.order("go")
    bench.order("weigh")
    bench.say(Channel.ORDER, VerbGoal(verb="go", values=(), seq=first, epoch=EPOCH))
    assert bench.last.refusal is None
    bench.wait(2.0)
    assert bench.last.done == first


def test_a_boot_forgets_work_and_numbers_and_lets_go_but_moves_nothing() -> None:
    bench = Bench()
    bench.order("hold", on=True)
    bench.order("go")
    bench.wait(2.0)
    bench.order("warm", celsius=40.0)
    bench.reboot()
    said = bench.last
    assert (said.boot_id, said.state, said.ack, said.done) == (8, MotionState.STOPPED, None, None)
    assert dict(said.facts or ()) == {"at": "right", "lamp": False, "held": False, "celsius": 20.0}
    bench.wait(5.0)
    assert dict(bench.last.facts or ())["celsius"] == 20.0


def test_an_alarm_breaks_off_even_what_finishes() -> None:
    bench = Bench()
    bench.body.facts["at"] = "right"
    process = bench.order("warm", celsius=40.0)
    bench.devices.boards[BOARD].fail(round(bench.now * 1e6))
    bench.wait(1.0)
    assert (bench.last.state, bench.last.failures) == (MotionState.FAULT, ((process, "alarma"),))


def test_a_seam_says_another_answer() -> None:
    bench = Bench()
    answers = iter(("heavy", "light"))
    bench.body.answer = lambda goal: next(answers)
    bench.order("weigh")
    bench.wait(1.0)
    assert bench.last.answer == "heavy"


@pytest.mark.parametrize(
    ("evidence", "keys"),
    [
        (Evidence.IDS, {"estado", "seq", "epoca_ack", "ack", "hecho", "arranque", "datos"}),
        (Evidence.JOINTS, {"estado", "datos"}),
        (Evidence.STATE, {"estado"}),
    ],
    ids=lambda value: getattr(value, "value", ""),
)
def test_a_device_says_what_its_evidence_allows(evidence: Evidence, keys: set[str]) -> None:
    bench = Bench(evidence)
    bench.order("go")
    bench.wait(2.5)
    assert json.loads(bench.raw[-1]).keys() == keys
