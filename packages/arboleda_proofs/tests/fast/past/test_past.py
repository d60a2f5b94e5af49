"""A page on a record shows at each moment what the page of the plant showed then."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from tests.unit.recorder.recorded import Site

from arboleda.dashboard.faces import Face
from arboleda.dashboard.page_state import PageState
from arboleda.model.messages import Verb
from arboleda.recorder import reader
from arboleda.views import view
from arboleda_proofs.past.moments import address, moment_of
from arboleda_proofs.past.past import Past
from arboleda_proofs.playback.views import Views

pytestmark = pytest.mark.long

LINKS: dict[str, Any] = {"broker": None, "ros": None, "refused": {}, "standbys": []}


class Recorded:
    """A plant that worked, was stopped and lost a link; what screens got, and its record."""

    def __init__(self, folder: Path, patch: pytest.MonkeyPatch) -> None:
        site = Site(folder, patch)
        site.work("sis_a 0B 7 #one", "sis_b 1C 3 #two", "sis_c 2A 5 #three", "sis_a 1A 1 #four", s=8.0)
        site.rig.operate(Verb.HOLD, "sis_b")
        site.work(s=4.0)
        site.rig.operate(Verb.RESUME, "sis_b")
        site.rig.lost = lambda publication: publication.topic == "ra_3/sensores"
        site.work(s=150.0)
        site.end()
        self.layout = view.layout(site.model)
        self.seen = [(at, snapshot) for at, snapshot, _ in site.seen]
        self.past = Past(Views(reader.opened(site.files[0])), self.layout)

    def stories(self) -> Iterator[tuple[int, PageState]]:
        """At each moment the story of a page that saw everything; of snapshots in one ms after the last."""
        story = PageState(self.layout, [])
        for (at_ns, snapshot), (next_ns, _) in pairwise(self.seen):
            story.see(snapshot, at_ns / 1e9)
            if moment_of(at_ns / 1e9) < moment_of(next_ns / 1e9):
                yield moment_of(at_ns / 1e9), story


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Recorded]:
    with pytest.MonkeyPatch.context() as patch:
        yield Recorded(tmp_path_factory.mktemp("record"), patch)


def shown(face: Face) -> Face:
    """Parts of a face without spans, which are as of another tenth of a second."""
    kinds = ("tree/", "rows/events", "rows/tasks", "rows/zones")
    found = {key: value for key, value in face.items() if key.startswith(kinds)}
    nodes = {key: value["state"] for key, value in face.items() if key.startswith("node/")}
    texts = {key: value for key, value in face.items() if key.endswith((".cause", ".state", ".step"))}
    events = {key: value["texts"] for key, value in face.items() if key.startswith("row/events/")}
    return {**found, **nodes, **texts, **events}


def last_steps(face: Face, cell: str) -> list[Any]:
    """Last steps of a tree, without the numbers that the rows have."""
    return [face[f"row/changes.{cell}/{number}"] for number in face[f"rows/changes.{cell}"]]


def test_at_every_moment_the_trees_and_the_time_line_are_those_of_the_page(recorded: Recorded) -> None:
    for moment, story in recorded.stories():
        then, live = recorded.past.face(moment, "en"), story.face("en", LINKS)
        assert shown(then) == shown(live)
        for cell in ("sis_a", "sis_b", "sis_c"):
            steps = last_steps(then, cell)  # those of the task that is shown
            assert steps == last_steps(live, cell)[: len(steps)]


def test_it_is_the_same_from_wherever_one_comes(recorded: Recorded) -> None:
    moments = [moment for moment, _ in recorded.stories()][::2]
    forth = [recorded.past.face(moment, "es") for moment in moments]
    back = [recorded.past.face(moment, "es") for moment in reversed(moments)]
    assert forth == back[::-1] and len(moments) > 10


def test_a_failure_is_found_with_the_step_that_failed(recorded: Recorded) -> None:
    past = recorded.past
    failed = past.last_failure("sis_c")
    assert failed is not None and past.end_of("three") == failed
    face = past.face(failed, "en", "three")
    cause = "ra3: no telemetry for"
    assert cause in face["text/sis_c.cause"][0] and cause in face["text/task.cause"][0]
    leaves = [key for key, row in face.items() if key.startswith("node/#task/") and row["failed"]]
    assert leaves and face["text/task.state"][1] == "failed"
    before = past.step(failed, way=-1, failures=False, cell="sis_c")
    assert before is not None
    assert past.face(before, "en", "three")["text/task.state"][1] == "running"


def test_a_hold_that_an_operator_wanted_is_no_failure(recorded: Recorded) -> None:
    assert recorded.past.last_failure("sis_b") is None
    events = recorded.past.face(recorded.past.ended, "en")
    assert any(row["state"] == "held" for key, row in events.items() if key.startswith("row/events/"))


def test_steps_lead_through_every_event_and_back(recorded: Recorded) -> None:
    past = recorded.past
    forth = [past.began]
    while (found := past.step(forth[-1], way=1, failures=False)) is not None:
        forth.append(found)
    back = [forth[-1]]
    while (found := past.step(back[-1], way=-1, failures=False)) is not None:
        back.append(found)
    assert back[::-1] == forth[-len(back) :] and len(back) > 8
    assert past.step(past.began, way=1, failures=True) == past.failures()[0]
    assert past.step(past.ended, way=1, failures=True) is None


def test_marks_are_no_more_than_can_be_told_apart(recorded: Recorded) -> None:
    assert recorded.past.marks() == list(recorded.past.failures())


def test_nothing_can_be_done_in_the_past_and_what_could_be_is_told(recorded: Recorded) -> None:
    past = recorded.past
    for moment in (past.began, past.last_failure() or 0, past.ended):
        rows = [row for key, row in past.face(moment, "en").items() if key.startswith("row/")]
        assert rows and not any("act" in each for row in rows for each in row.get("acts", ()))
    ways = past.face(past.last_failure("sis_c") or 0, "en")
    told = [row["texts"][0] for key, row in ways.items() if key.startswith("row/ways.sis_c/")]
    assert told and all(told)


def test_a_row_of_the_time_line_leads_to_its_moment(recorded: Recorded) -> None:
    past = recorded.past
    face = past.face(past.ended, "en")
    first, *_ = face["rows/events"]
    leads = face[f"row/events/{first}"]["link"]["to"]["at"]
    assert leads == address(past.step(past.ended, way=-1, failures=False) or 0)


def test_a_task_that_the_record_does_not_have_is_unknown(recorded: Recorded) -> None:
    past = recorded.past
    assert past.face(past.ended, "en", "none")["text/task.note"][0].startswith("The plant knows no such")
    assert past.end_of("none") is None


def test_the_twin_has_what_it_was_drawn_of(recorded: Recorded) -> None:
    past = recorded.past
    here, there = past.positions(past.began), past.positions(past.ended)
    assert there["now"] - here["now"] == pytest.approx((past.ended - past.began) / 1000, abs=0.01)
    assert {row["name"]: row["online"] for row in there["robots"]}["ra3"] is False
