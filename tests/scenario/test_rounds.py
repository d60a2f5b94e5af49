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
ALWAYS_REFUSED = [
    ("rounds", "cell.retry(lamp.blink(), times=50, pause_s=0)"),
    ("rounds", "cell.retry(cell.retry(lamp.blink(), times=6, pause_s=0), times=6, pause_s=0)"),
    ("tree", '<RetryUntilSuccessful num_attempts="50"><lamp_blink/></RetryUntilSuccessful>'),
    (
        "tree",
        '<RetryUntilSuccessful num_attempts="6"><RetryUntilSuccessful num_attempts="6"><lamp_blink/>'
        "</RetryUntilSuccessful></RetryUntilSuccessful>",
    ),
]
NOTHING_TO_DO = [
    ("rounds", "cell.repeat(cell.repeat(lamp.says(lit=False), 20), 20)"),
    ("tree", "<AsyncSequence>" + '<Script code="n := 1"/>' * 30 + "</AsyncSequence>"),
    ("tree", '<Repeat num_cycles="20"><Repeat num_cycles="20"><AlwaysSuccess/></Repeat></Repeat>'),
]


def ended(folder: Path, recipe: str, body: str) -> Rig:
    """The plant once a task of this recipe, in Python or as XML, has ended."""
    other = "lamp.light(on=True)" if recipe == "tree" else "<lamp_blink/>"
    python, xml = (other, body) if recipe == "tree" else (body, other)
    tree = f'<root BTCPP_format="4"><BehaviorTree ID="Tree">{xml}</BehaviorTree></root>'
    rig = Rig(read(folder, PLANT, beside={"rounds.py": RECIPE.format(body=python), "tree.xml": tree}))
    rig.wait(3.0)
    rig.submit(f"bench {recipe} #one")
    rig.wait(60.0, until=lambda: rig.outcomes()["one"].state in ENDED)
    return rig


@pytest.mark.parametrize(("recipe", "body"), ALWAYS_REFUSED)
def test_a_step_that_is_refused_at_once_is_tried_as_often_as_it_says(
    tmp_path: Path, recipe: str, body: str
) -> None:
    outcome = ended(tmp_path, recipe, body).outcomes()["one"]
    assert outcome.reason is Reason.PRECONDITION
    assert str(outcome.sentence) == "lamp needs lit to be true, and said false: no doing blink"


@pytest.mark.parametrize(("recipe", "body"), NOTHING_TO_DO)
def test_rounds_without_anything_to_do_end(tmp_path: Path, recipe: str, body: str) -> None:
    assert ended(tmp_path, recipe, body).outcomes()["one"].state is TaskState.DONE
