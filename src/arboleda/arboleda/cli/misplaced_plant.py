"""Plant file in the place of another argument: people name it there, and most commands take it as --plant."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, TypeVar

import typer

from arboleda.model.outside import plain
from arboleda.model.sentence import Phrase

from .language import say

OPTION = "--plant"
SUFFIXES = (".yaml", ".yml")
LONGEST = 500  # characters of a file's name
TOO_MANY = re.compile(r"\((\S+)\)$")  # the end of typer's sentence on one word too many
BY_OPTION = Phrase("cli.plant_by_option", "a plant file is named with {option}: {option} {file}")

Words = TypeVar("Words", str, "list[str] | None")


def no_plant_file(words: Words) -> Words:
    """The words of an argument that wants no file; BadParameter where one is a plant file."""
    for word in [words] if isinstance(words, str) else words or ():
        if Path(word).suffix in SUFFIXES:
            raise typer.BadParameter(_sentence(word))
    return words


def advised(message: str, command: Any) -> str:
    """A sentence of typer on wrong arguments of a command; how to name the plant file where that was one."""
    found = TOO_MANY.search(message)
    if found is None or Path(found[1]).suffix not in SUFFIXES:
        return message
    return _sentence(found[1]) if any(OPTION in each.opts for each in command.params) else message


def _sentence(file: str) -> str:
    return say(BY_OPTION(option=OPTION, file=plain(file, LONGEST)))
