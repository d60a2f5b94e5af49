"""`arboleda --help` and `arboleda help`."""

from __future__ import annotations

from collections import Counter

import pytest
from typer.main import get_command
from typer.testing import CliRunner

from arboleda.cli import overview
from arboleda.cli.commands import OURS, commands
from arboleda.cli.main import cli
from arboleda.web.languages import LANGUAGES, contents

SCREEN = (24, 80)  # lines, columns
HERE = overview.Overview(name="arboleda")  # with what is installed


def help_of(*words: str) -> str:
    shown = CliRunner().invoke(cli, words, env={"COLUMNS": str(SCREEN[1])})
    assert shown.exit_code == 0
    return shown.output


def is_whole(shown: str) -> bool:
    """Whether the help of a group has each sentence to its end."""
    return "..." not in shown.partition("[ARGS]...")[2] and "e.g.\n" not in shown


def test_each_command_is_listed_below_one_heading() -> None:
    listed = Counter(name for names in HERE.sections(None).values() for name in names)
    assert listed == Counter(list(get_command(cli).commands))  # type: ignore[attr-defined]


def test_a_heading_whose_package_is_not_installed_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("arboleda.cli.commands.commands", lambda: OURS)
    monkeypatch.setattr(overview, "commands", lambda: OURS)
    assert "Learn it" not in overview.Overview(name="arboleda").sections(None)
    assert "\n  simulate " not in help_of("--help") and ", learn" not in help_of("--help")


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_first_help_fits_a_screen(language: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ARBOLEDA_LANG", language)
    shown = help_of("--help").rstrip("\n").splitlines()
    lines, columns = SCREEN
    assert len(shown) < lines  # and the prompt below it
    assert max(map(len, shown)) < columns
    named = [line.split()[0] for line in shown if line.startswith("  ")]
    wanted = [name for name in overview.FIRST if name in commands()]
    assert {"up", "check", "stop"} <= {*wanted}
    assert [name for name in named if name in overview.FIRST] == wanted


def test_the_first_help_is_in_every_language() -> None:
    for language in LANGUAGES[1:]:
        words = contents(language, "cli")
        assert list(words["first"]) == list(overview.FIRST)
        assert "{topics}" in words["frame"]["more"]


@pytest.mark.parametrize("topic", HERE.topics())
def test_a_topic_lists_its_commands_with_whole_sentences(topic: str) -> None:
    names = HERE.sections(None)[HERE.topics()[topic]]
    shown = help_of("help", topic)
    assert names and all(f"  {name} " in shown for name in names)
    assert "..." not in shown and "e.g.\n" not in shown


def test_help_of_a_command_is_that_of_the_command() -> None:
    assert help_of("help", "stop") == help_of("stop", "--help")
    assert help_of("help") == help_of("--help")


def test_an_unknown_topic_is_told_with_those_that_there_are() -> None:
    shown = CliRunner().invoke(cli, ["help", "opera"])
    assert shown.exit_code == 2
    assert "did you mean operate?" in " ".join(shown.output.split())


@pytest.mark.parametrize("group", ["extension", "record", "service"])
def test_no_sentence_of_a_group_is_cut_off(group: str) -> None:
    assert is_whole(help_of(group, "--help"))
