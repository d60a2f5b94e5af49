from __future__ import annotations

import itertools
import math
import random

import pytest

from arboleda.dispatch.ledger import OPEN, TABLE, Entry, Feed, Ledger, State
from arboleda.kinds.joints import MoveJoints
from arboleda.model.errors import IllegalTransition
from arboleda.model.messages import Failure, Reason

LOST = Failure(reason=Reason.LINK_LOST, sentence="lost")


def opened() -> tuple[Ledger, Entry]:
    ledger = Ledger()
    move = MoveJoints(id="1-1", robot="ra1", q=(0.0, 0.0, 0.0))
    entry = Entry(move, cell="sis_a", doing="moving", sent_at=0.0, deadline=9.0)
    ledger.open(entry)
    return ledger, entry


def test_every_order_of_four_feeds_follows_the_table_at_every_cut() -> None:
    for feeds in itertools.product(Feed, repeat=4):
        ledger, entry = opened()
        for feed in feeds:
            before = entry.state
            ledger.feed("1-1", feed, 1.0, LOST)
            assert entry.state is (TABLE[(before, feed)] if before in OPEN else before), feeds
            assert ("1-1" in ledger.entries) is entry.open, feeds
            assert ledger.of_robot("ra1") == ledger.of_cell("sis_a") == [entry] * entry.open, feeds


def test_the_table_lists_every_open_state_and_feed() -> None:
    assert set(TABLE) == set(itertools.product(OPEN, Feed))


def test_only_a_failure_carries_a_cause() -> None:
    for feed in Feed:
        ledger, entry = opened()
        ledger.feed("1-1", feed, 1.0, LOST)
        assert (entry.failure == LOST) is (entry.state is State.FAILED)


def test_a_command_was_accepted_when_it_was_accepted_first() -> None:
    ledger, entry = opened()
    for at in (1.0, 2.0):
        ledger.feed("1-1", Feed.ACCEPTED, at)
    assert entry.accepted_at == 1.0


def test_a_feed_for_an_unknown_or_finished_id_is_counted_and_ignored() -> None:
    ledger, entry = opened()
    ledger.feed("1-1", Feed.DONE, 1.0)
    ledger.feed("1-1", Feed.FAILED, 2.0, LOST)
    ledger.feed("9-9", Feed.DONE, 2.0)
    assert entry.state is State.DONE
    assert ledger.ignored == {"failed": 1, "done": 1}


def test_an_unlisted_pair_raises_and_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(TABLE, (State.SENT, Feed.HALTED))
    ledger, entry = opened()
    with pytest.raises(IllegalTransition, match="1-1 is sent: no halted there"):
        ledger.feed("1-1", Feed.HALTED, 1.0)
    assert entry.state is State.SENT and "1-1" in ledger.entries


def test_the_next_deadline_is_the_earliest_of_all_that_are_open_whatever_is_planned_anew_and_ends() -> None:
    chance, ledger = random.Random(1), Ledger()
    for number in range(400):
        open_ones = list(ledger.entries.values())
        if len(open_ones) < 5:
            move = MoveJoints(id=f"1-{number}", robot="ra1", q=(0.0, 0.0, 0.0))
            due = float(chance.randrange(9))
            ledger.open(Entry(move, cell="sis_a", doing="moving", sent_at=0.0, deadline=due))
        elif number % 2:
            entry = chance.choice(open_ones)
            entry.deadline = float(chance.randrange(9))
            ledger.plan(entry)
        else:
            ledger.feed(chance.choice(open_ones).command.id, Feed.FAILED, 1.0, LOST)
        deadlines = [entry.next_deadline for entry in ledger.entries.values()]
        assert ledger.next_deadline == min(deadlines, default=math.inf)
