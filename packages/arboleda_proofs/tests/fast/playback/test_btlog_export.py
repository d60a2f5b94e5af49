"""A task of a record as a file for viewers of BehaviorTree.CPP."""

from __future__ import annotations

import re
import struct
from pathlib import Path

import pytest
from tests.unit.recorder.recorded import Site
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.model.errors import ConfigError


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A record of a plant in which a cell did one task, and another one waits for ever."""
    with pytest.MonkeyPatch.context() as patch:
        site = Site(tmp_path_factory.mktemp("site"), patch)
        site.work("sis_a 0B 7 #lot", s=40.0)
        site.work("sis_b 0B 7 #long", "sis_b 1C 3 #later", s=1.0)
        site.end()
    return str(site.files[0])


def export(*words: str) -> str:
    return CliRunner().invoke(cli, ["record", "export", *words], catch_exceptions=False).stdout


def test_a_task_that_is_done_has_all_of_its_tree(file: str, tmp_path: Path) -> None:
    output = tmp_path / "lot.btlog"
    assert (
        export(str(output), file, "--task", "lot")
        == f"{output} has {len(output.read_bytes()) / 1e3:.1f} kB\n"
    )
    content = output.read_bytes()
    (number,) = re.findall(rb'name="move to station 7" _uid="(\d+)"', content)
    begin = content.index(b"</root>\n") + len(b"</root>\n") + 8
    told = [struct.unpack("<HB", content[at + 6 : at + 9]) for at in range(begin, len(content), 9)]
    assert [status for node, status in told if node == int(number)] == [1, 2, 0]  # at work, done, idle
    assert set(dict(told).values()) == {0}


def test_a_task_that_runs_is_there_as_far_as_it_came(file: str, tmp_path: Path) -> None:
    output = tmp_path / "long.btlog"
    export(str(output), file, "--task", "long")
    assert output.read_bytes().startswith(b"BTCPP4-FileLogger2")


def test_a_file_that_is_there_stays_as_it_is(file: str, tmp_path: Path) -> None:
    output = tmp_path / "lot.btlog"
    output.touch()
    with pytest.raises(ConfigError, match="is there already: name another file"):
        export(str(output), file, "--task", "lot")
    assert output.read_bytes() == b""


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (["x.btlog"], "a .btlog is of one task; say which with --task ID"),
        (["x.mcap", "--task", "lot"], "--task ID is for files that end in .btlog"),
        (["x.btlog", "--task", "lott"], "has no such task"),
        (["x.btlog", "--task", "later"], "it did not run in"),
        (["/no/such/folder/x.btlog", "--task", "lot"], "cannot be written"),
    ],
)
def test_what_cannot_be_written_is_a_sentence(file: str, words: list[str], why: str) -> None:
    name, *rest = words
    with pytest.raises(ConfigError, match=why):
        export(name, file, *rest)
