"""The causes for which a tree fails, and the names that leaves of one's own know them by."""

from __future__ import annotations

import pytest
from py_trees.behaviours import Success

from arboleda.core.plant import Plant
from arboleda.dispatch.belief import OFFLINE
from arboleda.model.messages import Failure, Reason
from arboleda.testing import shipped
from arboleda.trees.context import Context

FIRST = Failure(reason=Reason.LINK_LOST, sentence=OFFLINE.phrase(robot="ra1"))
THEN = Failure(reason=Reason.DEVICE_FAULT, sentence=OFFLINE.phrase(robot="rm_sis_a"))


@pytest.fixture
def context() -> Context:
    context = Plant(shipped(), epoch=1, now=0.0).cells["sis_a"].context
    context.start_afresh()
    return context


def test_a_task_begins_without_a_failure(context: Context) -> None:
    failures = context.failures
    assert (failures.first, failures.leaf, failures.last) == (None, None, None)
    assert failures.opened_effector() is None


def test_the_first_cause_counts_and_the_last_is_known(context: Context) -> None:
    failures, leaf = context.failures, Success("first")
    failures.add(FIRST, leaf)
    failures.add(THEN, Success("then"))
    assert (failures.first, failures.leaf, failures.last) == (FIRST, leaf, THEN)


def test_what_was_carried_is_for_recovery(context: Context) -> None:
    context.parts.carrier = "ra1"
    context.failures.add(FIRST)
    assert context.parts.carrier is None


def test_after_a_failure_that_is_forgiven_the_next_one_counts(context: Context) -> None:
    failures = context.failures
    failures.add(FIRST, Success("first"))
    failures.forgive()
    assert (failures.first, failures.leaf, failures.last) == (None, None, FIRST)
    failures.add(THEN)
    assert (failures.first, failures.last) == (THEN, THEN)


def test_another_tree_knows_no_failure(context: Context) -> None:
    context.failures.add(FIRST, Success("first"))
    context.start_afresh()
    failures = context.failures
    assert (failures.first, failures.leaf, failures.last) == (None, None, None)


def test_an_effector_that_opened_unbidden_is_a_failure_where_nothing_else_was(context: Context) -> None:
    (robot, *_) = context.cell.holders
    opened = OFFLINE.phrase(robot=robot)
    context.parts._effectors.opened[robot] = opened
    failures = context.failures
    assert failures.opened_effector() == Failure(reason=Reason.PART_LOST, sentence=opened)
    failures.add(FIRST)
    assert failures.opened_effector() is None, "what failed before is the cause"
    failures.clear()
    context.parts.recover()
    assert failures.opened_effector() is None, "a recovery does the rest without the part"


def test_leaves_of_ones_own_name_a_failure_and_a_wake_by_former_names(context: Context) -> None:
    leaf = Success("own")
    context.fail(FIRST, leaf)
    assert (context.failures.first, context.failures.leaf) == (FIRST, leaf)
    at = context.time.now + 2.0
    context.wake_at(at)
    assert context.time.next_deadline == pytest.approx(at)
