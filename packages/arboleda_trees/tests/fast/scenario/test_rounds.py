"""Rounds in trees that take no time: as many as were written; no defect of the plant."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.scenario.test_rounds import REFUSED, ended

from arboleda.model.messages import Reason, TaskState
from arboleda.testing import Rig


def of_tree(folder: Path, body: str) -> Rig:
    """The plant once a task of this tree has ended."""
    tree = f'<root BTCPP_format="4"><BehaviorTree ID="Rounds">{body}</BehaviorTree></root>'
    return ended(folder, "rounds.xml", tree)


@pytest.mark.parametrize(
    "body",
    [
        '<RetryUntilSuccessful num_attempts="50"><lamp_blink/></RetryUntilSuccessful>',
        '<RetryUntilSuccessful num_attempts="6"><RetryUntilSuccessful num_attempts="6"><lamp_blink/>'
        "</RetryUntilSuccessful></RetryUntilSuccessful>",
    ],
)
def test_a_step_that_is_refused_at_once_is_tried_as_often_as_it_says(tmp_path: Path, body: str) -> None:
    outcome = of_tree(tmp_path, body).outcomes()["one"]
    assert outcome.reason is Reason.PRECONDITION
    assert str(outcome.sentence) == REFUSED


@pytest.mark.parametrize(
    "body",
    [
        "<AsyncSequence>" + '<Script code="n := 1"/>' * 30 + "</AsyncSequence>",
        '<Repeat num_cycles="20"><Repeat num_cycles="20"><AlwaysSuccess/></Repeat></Repeat>',
    ],
)
def test_rounds_without_anything_to_do_end(tmp_path: Path, body: str) -> None:
    assert of_tree(tmp_path, body).outcomes()["one"].state is TaskState.DONE
