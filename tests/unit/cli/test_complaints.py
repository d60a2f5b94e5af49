"""What the command says on standard error about words that it was given."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from arboleda.cli.main import main

EVIL = "\x1b[2J\u202e\x9b31m"


def complained(args: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> str:
    monkeypatch.setattr(sys, "argv", ["arboleda", *args])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
    return capsys.readouterr().err


@pytest.mark.parametrize("task", [EVIL, f"sis_a {EVIL} 7", f"sis_a 0B 7 #{EVIL}", "x" * 100_000])
def test_a_task_reaches_no_terminal_as_it_is(
    task: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    said = complained(["up", "--once", "--no-ros", "--state", str(tmp_path), task], monkeypatch, capsys)
    assert said.startswith("arboleda: ") and len(said) < 2000
    assert all(line.isprintable() for line in said.splitlines())


@pytest.mark.parametrize(
    "written",
    [
        'name: "\\e[2J\\u202e"\n',
        'name: demo\n"\\e[2J": 1\n',
        'name: demo\ncells:\n  "\\e[2J\\u202e":\n    queue_limit: "\\x9b31m"\n',
        f"name: {'x' * 100_000}\n",
    ],
)
def test_a_plant_file_reaches_no_terminal_as_it_is(
    written: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    (tmp_path / f"plant{EVIL}.yaml").write_text(written)
    said = complained(["check", str(tmp_path / f"plant{EVIL}.yaml")], monkeypatch, capsys)
    assert all(line.isprintable() and len(line) <= 1000 for line in said.splitlines())


def is_told_the_option(said: str) -> bool:
    """Whether a plant file without `--plant` was taken for one, and no word of its name did any harm."""
    return (
        said.startswith("a plant file is named with --plant: --plant my")
        and "there is no such file" in said
        and all(line.isprintable() for line in said.splitlines())
    )


@pytest.mark.parametrize("words", [["up"], ["status"], ["submit", "sis_a 0B 7"]], ids=lambda words: words[0])
def test_a_plant_file_without_its_option_is_taken_and_told_the_option(
    words: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    said = complained([*words, f"my{EVIL}.yaml"], monkeypatch, capsys)
    assert is_told_the_option(said), said


def test_the_option_names_the_plant_file(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    said = complained(["check", "--plant", "mine.yaml"], monkeypatch, capsys)
    assert said == "arboleda: mine.yaml: there is no such file\n"


@pytest.mark.parametrize("command", ["up", "up --once"])
def test_a_task_without_quotes_is_shown_with_them(
    command: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    said = complained([*command.split(), "--state", str(tmp_path), "sis_a", "0B", "7"], monkeypatch, capsys)
    assert said == "arboleda: a task of several words needs quotes: 'sis_a 0B 7'\n"
