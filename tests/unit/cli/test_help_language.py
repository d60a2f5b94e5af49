"""Help of every command in every language: nothing is without its twin, and nothing is left of before."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import pytest
import typer

from arboleda.cli.help_language import PLACEHOLDER, error_words, units
from arboleda.cli.main import cli
from arboleda.cli.overview import SECTIONS
from arboleda.web.languages import FIRST, LANGUAGES, contents

from ...plants import rows

OTHERS = [each for each in LANGUAGES if each != FIRST]
OF_TYPER = "Show this message and exit."
SHELLS = "--install-completion", "--show-completion"


def commands(command: Any, path: str = "arboleda") -> Iterator[tuple[str, Any]]:
    yield path, command
    for name, each in getattr(command, "commands", {}).items():
        yield from commands(each, f"{path} {name}")


EVERY = dict(commands(typer.main.get_command(cli)))


def texts(command: Any) -> Iterator[str]:
    """The help of a command and of each of its parameters."""
    yield from (text for text in (command.help, command.short_help) if text)
    yield from (each.help for each in command.params if getattr(each, "help", None))


def english() -> set[str]:
    return {OF_TYPER, *(unit for each in EVERY.values() for text in texts(each) for unit in units(text))}


def placeholders() -> set[str]:
    """The words in capitals that stand for what a person writes."""
    raw = [str(each.metavar) for command in EVERY.values() for each in command.params if each.metavar]
    return {word for text in raw for word in PLACEHOLDER.findall(text)} | {"OPTIONS", "COMMAND", "ARGS"}


@pytest.mark.parametrize("language", OTHERS)
def test_every_text_of_help_has_its_twin_and_none_is_left_of_before(language: str) -> None:
    known = contents(language, "cli")["help"]
    assert english() - known.keys() == set(), f"say these in {language}/cli.yaml, below help"
    assert known.keys() - english() == set(), f"no command says these any more: take them out of {language}"
    assert [text for text, other in known.items() if not str(other).strip()] == []


@pytest.mark.parametrize("language", OTHERS)
def test_every_word_in_capitals_has_its_twin(language: str) -> None:
    assert placeholders() - contents(language, "cli")["placeholders"].keys() == set()


@pytest.mark.parametrize("language", OTHERS)
def test_what_a_person_copies_stands_in_both(language: str) -> None:
    """Options, addresses, variables and numbers of statuses are the same in every language."""
    copied = re.compile(r"--[a-z-]+|\$?[A-Z]+_[A-Z_]+|\b\d+(?:[.:-]\d+)*\b|https?://\S+")
    for text, other in contents(language, "cli")["help"].items():
        with_points = re.sub(r"(?<=\d),(?=\d)", ".", str(other))
        assert sorted(copied.findall(text)) == sorted(copied.findall(with_points)), text


@pytest.mark.parametrize("language", OTHERS)
def test_every_section_has_its_twin(language: str) -> None:
    assert list(contents(language, "cli")["sections"]) == list(SECTIONS)


@pytest.fixture
def spanish(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ARBOLEDA_LANG", "es")


def status_of(*arguments: str) -> object:
    """The status of a command; all of them are made once, which takes longer than to run one."""
    with pytest.raises(SystemExit) as ended:
        EVERY["arboleda"].main(arguments, prog_name="arboleda")
    return ended.value.code


@pytest.mark.parametrize("path", list(EVERY))
def test_no_english_is_left_in_the_help_of_a_command(
    path: str, spanish: None, capsys: pytest.CaptureFixture[str]
) -> None:
    assert status_of(*path.split()[1:], "--help") == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert shown.startswith(f"Uso: {path} [OPCIONES]")
    known = contents("es", "cli")["help"]
    others = {text for text, other in known.items() if len(text.split()) > 4 and text != other}
    left = [text for text in others if text in shown]
    assert left == []
    assert not re.search(r"\[(default|env var|required)|\b(Options|Arguments|Commands|FILE|FOLDER)\b", shown)


@pytest.mark.parametrize(
    ("arguments", "said"),
    rows(__file__, "wrong_arguments"),
)
def test_wrong_arguments_are_refused_in_the_language(
    arguments: list[str], said: str, spanish: None, capsys: pytest.CaptureFixture[str]
) -> None:
    assert status_of(*arguments) == 2
    assert capsys.readouterr().err.endswith(f"Error: {said}\n")


def test_a_group_without_a_command_shows_its_help_alone(
    spanish: None, capsys: pytest.CaptureFixture[str]
) -> None:
    assert status_of("record") == 2
    shown = capsys.readouterr().err
    assert shown.startswith("Uso: arboleda record") and "Error" not in shown


def test_an_error_that_nobody_knows_stays_as_it_is(spanish: None) -> None:
    assert error_words("no such thing") == "no such thing"
