"""Files that `arboleda simulate` is given: read, or refused at once with a sentence."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import pytest
from tests.unit.plant_file.test_user_file import STRANGE, directory, pipe
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.model.errors import ConfigError


@pytest.mark.sampled(3)
@pytest.mark.parametrize(("make", "sentence"), STRANGE.values(), ids=STRANGE)
def test_a_strange_file_is_refused_at_once(
    tmp_path: Path, make: Callable[[Path], str], sentence: str
) -> None:
    answer = CliRunner().invoke(cli, ["simulate", "--faults", make(tmp_path / "strange.json")])
    assert isinstance(answer.exception, ConfigError), answer.output
    assert sentence in str(answer.exception) and len(answer.exception.problems) == 1


def test_a_name_that_no_file_can_have_is_refused() -> None:
    answer = CliRunner().invoke(cli, ["simulate", "--faults", "x" * 300])
    assert "is neither a file nor a level" in str(answer.exception)


def test_anchors_do_not_make_hundreds_of_millions_of_faults(tmp_path: Path) -> None:
    lines = ["faults:", "  - kind: reboot", "    at: 1", "    word:", "      a: &a [x]"]
    for before, name in pairwise("abcdefghij"):
        lines.append(f"      {name}: &{name} [{', '.join([f'*{before}'] * 9)}]")
    file = tmp_path / "faults.yaml"
    file.write_text("\n".join(lines))
    answer = CliRunner().invoke(cli, ["simulate", "--faults", str(file)])
    assert "repeat more than 5000 values" in str(answer.exception)


@pytest.mark.parametrize("option", ["--json", "--record"])
@pytest.mark.parametrize(
    ("make", "sentence"),
    [(pipe, "No such device"), (directory, "Is a directory"), (lambda path: str(path / "x"), "No such file")],
    ids=["pipe without reader", "directory", "no directory"],
)
def test_a_target_that_cannot_be_written_is_refused_before_the_work(
    tmp_path: Path, option: str, make: Callable[[Path], str], sentence: str
) -> None:
    answer = CliRunner().invoke(cli, ["simulate", "--seed", "1", option, make(tmp_path / "target")])
    assert isinstance(answer.exception, ConfigError), answer.output
    assert f"cannot be written: {sentence}" in str(answer.exception)
