"""Plant file among the arguments of a command, without --plant: taken for one minor version, with a line that
says how to name it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import typer

from arboleda.model.outside import plain
from arboleda.model.sentence import Phrase

from .help_language import WrongUse
from .language import say

OPTION = "--plant"
SUFFIXES = (".yaml", ".yml")
LONGEST = 500  # characters of a file's name
FILES = ("FILE", "OUTPUT", "WIRING")  # arguments that are files
BY_OPTION = Phrase(
    "cli.plant_by_option",
    "a plant file is named with {option}: {option} {file}; without the option, only until the next minor "
    "version",
)


def with_option(command: Any, context: Any, words: list[str]) -> list[str]:
    """The words behind a command, with `--plant` before a plant file that is one of its arguments."""
    named = next((each for each in command.params if OPTION in getattr(each, "opts", ())), None)
    if named is None or any(each.metavar in FILES for each in _arguments(command)):
        return words
    parser = command.make_parser(context)
    parser.allow_interspersed_args = True  # as the command has it, and its group has not
    try:
        values, others, _ = parser.parse_args([*words])
    except WrongUse:  # the command says what is wrong
        return words
    given = [values.get(each.name) for each in _arguments(command)] + others
    file = next((each for each in _words(given) if Path(each).suffix in SUFFIXES), None)
    if file is None or isinstance(values.get(named.name), str):
        return words
    typer.echo(say(BY_OPTION(option=OPTION, file=plain(file, LONGEST))), err=True)
    at = len(words) - 1 - words[::-1].index(file)
    return [OPTION, file, *words[:at], *words[at + 1 :]]


def _arguments(command: Any) -> Iterator[Any]:
    return (each for each in command.params if each.param_type_name == "argument")


def _words(values: list[Any]) -> Iterator[str]:
    for value in values:
        yield from [value] if isinstance(value, str) else value if isinstance(value, list | tuple) else []
