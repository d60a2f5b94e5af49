"""What is said of a refused command."""

from __future__ import annotations

import pytest

from arboleda.model.commands import Home
from arboleda.testing.plants import shipped
from arboleda.wire.payloads import REFUSALS
from arboleda.wire.rejections import refused


@pytest.mark.parametrize("word", sorted(REFUSALS))
def test_each_word_of_a_board_is_explained(word: str) -> None:
    robot = shipped().cells[0].arm
    said = refused(robot, Home(id="1-1", robot=robot.name), word, "", by_board=True)
    assert said.values["robot"] == robot.name and str(said.values["why"]) not in ("", word)
