"""Whatever goes into the core comes back from JSON as it was."""

from __future__ import annotations

import json
from dataclasses import fields
from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.model.messages import (
    Check,
    ClockSet,
    Course,
    Event,
    Fact,
    Failure,
    FaultByHand,
    Interference,
    Jog,
    KeptTask,
    LateDeparture,
    MotionState,
    OperatorRequest,
    Reason,
    Receipt,
    Report,
    RestartRequest,
    Revision,
    RevisionName,
    Shutdown,
    TaskAnswer,
    TaskRequest,
    TaskState,
    Uncontested,
    Undelivered,
    Verb,
)
from arboleda.model.sentence import Phrase, Sentence
from arboleda.recorder.errors import NoRecord
from arboleda.recorder.plain_data import EVENTS, event_from, kept_from, memory_from, message_from, plain

NUMBERS = st.floats() | st.sampled_from([5e-324, -0.0, 0.1 + 0.2, float("inf"), float("nan")])
TEXTS = st.text(max_size=8)
VALUES = st.booleans() | st.integers() | NUMBERS | TEXTS
PHRASES = st.builds(Phrase, TEXTS, TEXTS) | st.builds(Phrase, TEXTS, TEXTS, es=TEXTS)
SENTENCES = st.recursive(
    st.builds(Sentence, PHRASES, st.dictionaries(TEXTS, VALUES, max_size=2)),
    lambda inner: st.builds(Sentence, PHRASES, st.dictionaries(TEXTS, inner | st.tuples(inner), max_size=2)),
    max_leaves=3,
)


def maybe(strategy: st.SearchStrategy) -> st.SearchStrategy:
    return st.none() | strategy


ANSWERS = st.builds(TaskAnswer, by=TEXTS, asked=TEXTS, answer=VALUES)
FAILURES = st.builds(Failure, reason=st.sampled_from(Reason), sentence=SENTENCES)
KEPT = st.builds(
    KeptTask,
    id=TEXTS,
    text=TEXTS,
    cell=TEXTS,
    state=st.sampled_from(TaskState),
    failure=maybe(FAILURES),
    started_at=maybe(NUMBERS),
    ended_at=maybe(NUMBERS),
    attempts=st.integers(0, 9),
    answers=st.lists(ANSWERS, max_size=2).map(tuple),
    unchecked=st.sets(st.sampled_from(Check)).map(tuple),
    course=maybe(st.builds(Course, seconds=NUMBERS, begun=st.dictionaries(TEXTS, st.floats(0, 9)))),
)
NUMBER, WORD, FLAG = maybe(st.integers()), maybe(TEXTS), maybe(st.booleans())
REPORTS = st.builds(
    Report,
    at=NUMBERS,
    robot=TEXTS,
    epoch=NUMBER,
    plant=NUMBER,
    boot_id=NUMBER,
    accepted=WORD,
    done=WORD,
    rejected=WORD,
    refusal=WORD,
    failed=WORD,
    failure=WORD,
    answered=WORD,
    answer=maybe(VALUES),
    state=maybe(st.sampled_from(MotionState)),
    q=maybe(st.lists(NUMBERS, max_size=3).map(tuple)),
    node=NUMBER,
    homed=FLAG,
    effector=FLAG,
    piece=FLAG,
    facts=maybe(st.lists(st.tuples(TEXTS, VALUES), max_size=3).map(tuple)),
    receipt=maybe(st.builds(Receipt, st.integers(), st.integers(), NUMBER)),
    lost=maybe(SENTENCES),
    foreign_refused=NUMBER,
    foreign_obeyed=NUMBER,
    foreign=maybe(SENTENCES),
)
STRATEGIES = {
    Report: REPORTS,
    TaskRequest: st.builds(
        TaskRequest, at=NUMBERS, text=TEXTS, request=WORD, trigger=st.booleans(), kept=maybe(KEPT)
    ),
    OperatorRequest: st.builds(
        OperatorRequest,
        at=NUMBERS,
        verb=st.sampled_from(Verb),
        scope=TEXTS,
        arguments=st.just((("station", 7), ("answer", "sí"))),
        by_hand=st.booleans(),
        client=st.booleans(),
        request=WORD,
    ),
    Jog: st.builds(
        Jog,
        at=NUMBERS,
        cell=TEXTS,
        session=st.integers(),
        number=st.integers(),
        robot=TEXTS,
        goal=st.none() | st.integers() | st.lists(NUMBERS, max_size=3).map(tuple),
        word=TEXTS,
        values=st.lists(st.tuples(TEXTS, VALUES), max_size=3).map(tuple),
        held=st.booleans(),
    ),
    Undelivered: st.builds(Undelivered, at=NUMBERS, id=TEXTS, robot=TEXTS, sentence=SENTENCES),
    LateDeparture: st.builds(LateDeparture, at=NUMBERS, id=TEXTS, late_s=NUMBERS),
    ClockSet: st.builds(ClockSet, at=NUMBERS, seconds=NUMBERS),
    FaultByHand: st.builds(FaultByHand, at=NUMBERS, robot=TEXTS, sentence=SENTENCES, is_over=st.booleans()),
    Uncontested: st.builds(
        Uncontested, at=NUMBERS, robot=TEXTS, said=st.lists(st.sampled_from(MotionState)).map(tuple)
    ),
    Interference: st.builds(Interference, at=NUMBERS, robot=TEXTS, sentence=SENTENCES),
    Shutdown: st.builds(Shutdown, at=NUMBERS, drops_waiting=st.booleans()),
    Revision: st.builds(
        Revision,
        at=NUMBERS,
        version=st.builds(RevisionName, digest=TEXTS, number=st.integers(1, 9)),
        by=TEXTS,
        changes=st.just(("one", "dos")),
        request=WORD,
    ),
    RestartRequest: st.builds(RestartRequest, at=NUMBERS, by=TEXTS, wanted=st.booleans()),
}


def exact(value: object) -> str:
    """It with the types and the bits of all that is in it."""
    if isinstance(value, Sentence):
        values = {slot: exact(each) for slot, each in value.values.items()}
        return f"{value.key!r} {value.phrase.english!r} {value.phrase.others!r} {values!r}"
    if isinstance(value, float):
        return value.hex()
    if isinstance(value, tuple):
        return f"{type(value).__name__}{[exact(each) for each in value]}"
    if hasattr(type(value), "__dataclass_fields__"):
        inner = {each.name: exact(getattr(value, each.name)) for each in fields(value)}  # type: ignore[arg-type]
        return f"{type(value).__name__}{inner}"
    return repr(value)


def test_every_event_of_the_core_can_be_recorded() -> None:
    assert set(get_args(Event)) == set(EVENTS.values()) == set(STRATEGIES)


@given(st.one_of(*STRATEGIES.values()))
def test_an_event_comes_back_to_the_last_bit(event: Event) -> None:
    text = json.dumps(plain(event), allow_nan=False)
    assert exact(event_from(json.loads(text))) == exact(event)


@given(KEPT)
def test_a_kept_task_comes_back_to_the_last_bit(task: KeptTask) -> None:
    text = json.dumps(plain(task), allow_nan=False)
    assert exact(kept_from(json.loads(text))) == exact(task)


def test_what_is_remembered_comes_back() -> None:
    memory = {Fact.LATCH: {"ra1": "on"}, Fact.STEP: {}}
    assert memory_from(json.loads(json.dumps(plain(memory)))) == memory


@pytest.mark.parametrize(
    "data",
    [
        None,
        [],
        "Report",
        {},
        {"type": "Sunrise"},
        {"type": "Report", "at": 1.0},
        {"type": "Report", "at": 1.0, "robot": "ra1", "mood": "good"},
        {"type": "Report", "at": 1.0, "robot": "ra1", "state": 77},
        {"type": "Report", "at": 1.0, "robot": "ra1", "lost": {"key": "k"}},
        {"type": "OperatorRequest", "at": 1.0, "verb": "dance"},
        {"type": "TaskRequest", "at": 1.0, "text": "x", "kept": {"type": "KeptTask", "id": "a"}},
    ],
)
def test_an_event_of_another_version_is_one_sentence(data: object) -> None:
    with pytest.raises(NoRecord, match="an event that this version does not know"):
        event_from(data)


def test_what_has_no_row_of_its_own_is_plain_all_the_same() -> None:
    class Odd:
        """Something that a recipe made up."""

    class Count(int):
        """A number that is more than one."""

    assert plain([Count(3), {2, 1}, ValueError("why"), Odd()]) == [3, [1, 2], "ValueError: why", "Odd"]


@pytest.mark.parametrize(
    ("verb", "scope", "of", "arguments"),
    [
        ("unload", "sis_a 7", "sis_a", (("station", 7),)),
        ("unload", "sis_a", "sis_a", ()),
        ("answer", "ana #7-1 not yet", "ana", (("question", "7-1"), ("answer", "not yet"))),
        ("cancel", "no such task", "no such task", ()),
    ],
)
def test_arguments_in_the_scope_of_an_older_record_are_told_apart(verb, scope, of, arguments) -> None:  # type: ignore[no-untyped-def]
    request = event_from({"type": "OperatorRequest", "at": 1.0, "verb": verb, "scope": scope})
    assert isinstance(request, OperatorRequest)
    assert (request.scope, request.arguments) == (of, arguments)
    said = message_from({"type": "OperatorAnswer", "verb": verb, "scope": scope})
    assert (said["scope"], said.get("arguments", [])) == (of, plain(arguments))
    assert message_from(said) == said
