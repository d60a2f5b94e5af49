"""Lessons in the reader's language: their programs are in English, what they print need not be."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Mapping
from contextlib import redirect_stdout
from functools import cache
from io import TextIOBase
from typing import TextIO

from arboleda.cli.language import finding_in, language
from arboleda.dashboard.findings import step_names
from arboleda.web.languages import FIRST, contents
from arboleda.web.languages.templates import Templates

PARTS = re.compile(r"(\s*(?:[\d.]+ s  |--> |\{.\} )?)(.*?)( \[.\])?(?:( -- )(.*))?")
"""A line: its time or its sign in a tree, what is said, its status, and why."""


def spoken(main: Callable[[], None]) -> None:
    """Run a lesson, and print in the language of the terminal what it prints."""
    if language() == FIRST:
        main()
        return
    try:
        with redirect_stdout(_Spoken(sys.stdout)):
            main()
    except SystemExit as end:
        raise SystemExit(said(end.code) if isinstance(end.code, str) else end.code) from None


def said(text: str) -> str:
    """A text of a lesson, as the name of a node, in the language of the terminal."""
    if language() == FIRST:
        return text
    return "\n".join(map(_line, text.split("\n")))


def _line(line: str) -> str:
    if (parts := PARTS.fullmatch(line)) is None:
        return line
    head, what, status, joint, why = parts.groups(default="")
    there = language()
    return f"{head}{said_in(there, what)}{status}{joint}{said_in(there, why)}"


def said_in(there: str, text: str) -> str:
    """A text of a lesson, else a name of a step, else what a plant says, in a language."""
    if there == FIRST:
        return text
    if (own := _exact(there).get(text) or _templates(there)(text)) != text:
        return own
    return name if (name := step_names(there)(text)) != text else finding_in(there, text)


@cache
def _exact(language: str) -> Mapping[str, str]:
    found: Mapping[str, str] = contents(language, "lessons")["sentences"]
    return found


@cache
def _templates(language: str) -> Templates:
    slotted = {english: other for english, other in _exact(language).items() if "{" in english}
    return Templates(slotted, part=lambda _, value: said_in(language, value))


class _Spoken(TextIOBase):
    """Output that is said in the language of the terminal, line by line; a question, when it is flushed."""

    def __init__(self, paper: TextIO) -> None:
        self._paper = paper
        self._line = ""

    def write(self, text: str) -> int:
        *lines, self._line = f"{self._line}{text}".split("\n")
        self._paper.write("".join(f"{said(each)}\n" for each in lines))
        return len(text)

    def flush(self) -> None:
        self._paper.write(said(self._line))
        self._line = ""
        self._paper.flush()
