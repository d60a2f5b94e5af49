"""Commands that boards accepted of two leaders, tasks that visitors bring, frames on a cable."""

from __future__ import annotations

import os
import random
import time
from typing import ClassVar

import pytest
from tests.threads import AtTheEnd, stand_in

from arboleda.testing import shipped
from arboleda_kills.hosts import visitors as module
from arboleda_kills.hosts.cable import Cable
from arboleda_kills.hosts.entrances import Answer
from arboleda_kills.hosts.visitors import Visitors


class Late(AtTheEnd):
    started: ClassVar[list[Late]] = []

    def start(self) -> None:
        super().start()
        self.started.append(self)


def brought(monkeypatch: pytest.MonkeyPatch, *answers: Answer) -> Visitors:
    """One visitor, who gets these answers and has brought one task then."""
    monkeypatch.setattr("arboleda_kills.hosts.visitors.PACE_S", 0.0)
    stand_in(module, Late, monkeypatch)
    left, texts = list(answers), list[str]()

    def way(text: str) -> Answer:
        texts.append(text)
        visitors.bring = len(left) > 1
        return left.pop(0)

    visitors = Visitors(shipped().cells, {"on foot": way})
    for each in Late.started:
        each.join()
    assert visitors.are_gone and left == [] and len(set(texts)) == 1, "it is one task, with one id"
    return visitors


def test_a_visitor_asks_again_for_the_same_task_until_it_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    nobody = [Answer(sentence=f"process {number} has ended") for number in (7, 8)]
    visitors = brought(monkeypatch, *nobody, Answer(state="queued"))
    assert list(visitors.accepted) == ["v0-1"] and visitors.sent == {"on foot": 1}
    assert visitors.refused == {("on foot", "process N has ended"): 2}
    assert visitors.ends == {} and visitors.contradictions == []


def test_a_visitor_who_waited_in_vain_hears_how_its_task_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    broken_off = Answer(state="queued", sentence="the plant has ended")
    visitors = brought(monkeypatch, broken_off, Answer(state="done"))
    assert visitors.sent == {"on foot": 1} and visitors.ends == {"v0-1": "done"}


def test_an_end_that_becomes_another_one_is_a_contradiction(monkeypatch: pytest.MonkeyPatch) -> None:
    twice = Answer(state="done", sentence="and then it broke off"), Answer(state="failed")
    assert brought(monkeypatch, *twice).contradictions == ["v0-1 was done and then failed"]


class Wires(Cable):
    """A cable whose ends are pipes."""

    def __init__(self, hosts: str) -> None:
        super().__init__((), random.Random(1))
        self.pipes = {host: (os.pipe2(os.O_NONBLOCK), os.pipe2(os.O_NONBLOCK)) for host in hosts}

    def send(self, host: str, frame: bytes) -> None:
        (read, write), _ = self.pipes[host]
        os.write(write, frame)
        self.ends = {host: read} | {
            other: pipes[1][1] for other, pipes in self.pipes.items() if other != host
        }
        self.read(host)

    def heard(self) -> dict[str, bytes]:
        found = {}
        for host, (_, (read, _)) in self.pipes.items():
            try:
                found[host] = os.read(read, 100)
            except BlockingIOError:
                continue
        return found

    def close(self) -> None:
        for pipes in self.pipes.values():
            for each in (*pipes[0], *pipes[1]):
                os.close(each)


TO_ALL, A, B = b"\xff" * 6, b"aaaaaa", b"bbbbbb"


@pytest.fixture
def wires():
    made = Wires("abc")
    yield made
    made.close()


def test_a_frame_goes_to_all_until_its_receiver_was_heard(wires: Wires) -> None:
    wires.send("a", TO_ALL + A)
    assert sorted(wires.heard()) == ["b", "c"]
    wires.send("b", A + B)
    assert wires.heard() == {"a": A + B}


def test_a_link_is_cut_in_one_direction(wires: Wires) -> None:
    wires.links = {("a", "b"): (1.0, 0.0)}
    wires.send("a", TO_ALL + A)
    assert sorted(wires.heard()) == ["c"]
    wires.send("b", TO_ALL + B)
    assert sorted(wires.heard()) == ["a", "c"]


def test_a_late_frame_comes_later_and_in_its_order(wires: Wires, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(time, "monotonic", lambda: 10.0)
    wires.links = {("a", "b"): (0.0, 0.05)}
    wires.send("a", TO_ALL + A + b"1")
    wires.send("a", TO_ALL + A + b"2")
    assert sorted(wires.heard()) == ["c"] and wires.wait_s == pytest.approx(0.05)
    wires.deliver()
    assert wires.heard() == {}
    monkeypatch.setattr(time, "monotonic", lambda: 10.051)
    wires.deliver()
    assert wires.heard() == {"b": TO_ALL + A + b"1" + TO_ALL + A + b"2"}
