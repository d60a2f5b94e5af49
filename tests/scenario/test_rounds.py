"""Rounds of retries and repetitions that take no time: as many as were written; no defect of the plant."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.messages import Reason, TaskState
from arboleda.testing import Rig

from ..plants import plant_text, read
from .restarts import ENDED

PLANT = plant_text(__file__, "rounds")
RECIPE = """
from arboleda.recipes import recipe

@recipe("rounds")
def rounds(cell):
    lamp = cell.device("lamp")
    return {body}
"""
REFUSED = "lamp needs lit to be true, and said false: no doing blink"


def ended(folder: Path, file: str, content: str) -> Rig:
    """The plant with its recipe in this file once a task has ended."""
    rig = Rig(read(folder, PLANT.replace("rounds.py", file), beside={file: content}))
    rig.wait(3.0)
    rig.submit("bench rounds #one")
    rig.wait(60.0, until=lambda: rig.outcomes()["one"].state in ENDED)
    return rig


@pytest.mark.parametrize(
    "body",
    [
        "cell.retry(lamp.blink(), times=50, pause_s=0)",
        "cell.retry(cell.retry(lamp.blink(), times=6, pause_s=0), times=6, pause_s=0)",
    ],
)
def test_a_step_that_is_refused_at_once_is_tried_as_often_as_it_says(tmp_path: Path, body: str) -> None:
    outcome = ended(tmp_path, "rounds.py", RECIPE.format(body=body)).outcomes()["one"]
    assert outcome.reason is Reason.PRECONDITION
    assert str(outcome.sentence) == REFUSED


def test_rounds_without_anything_to_do_end(tmp_path: Path) -> None:
    body = "cell.repeat(cell.repeat(lamp.says(lit=False), 20), 20)"
    outcome = ended(tmp_path, "rounds.py", RECIPE.format(body=body)).outcomes()["one"]
    assert outcome.state is TaskState.DONE
