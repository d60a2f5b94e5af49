"""Programs of lessons: run in the worker, with what they print and what breaks them."""

from __future__ import annotations

import os
import runpy
import shlex
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout, suppress
from io import StringIO
from pathlib import Path
from traceback import walk_tb
from typing import Any
from unittest import mock

from .building import Texts, written

LANGUAGE = "ARBOLEDA_LANG"
MOST = 200_000  # characters that a program may print


class TooMuch(BaseException):
    """End of a program that prints without end; an Exception could be caught by it."""


class _Paper(StringIO):
    """Text that a program prints, up to a limit."""

    def write(self, text: str) -> int:
        if self.tell() + len(text) > MOST:
            raise TooMuch
        return super().write(text)


def run(texts: Texts, program: str, arguments: str, typed: str, language: str) -> dict[str, Any]:
    """Run a program with what follows its name on a command line, and with the lines that a person types;
    what a lesson prints is in this language.

    The answer has its `output`, `pictures` (SVG by the name of the file), and a `problem` {file, line, text}
    or None.
    """
    paper, found = _Paper(), None
    with written(texts) as folder:
        try:
            spoken = mock.patch.dict(os.environ, {LANGUAGE: language})
            with _alone(folder), spoken, redirect_stdout(paper), redirect_stderr(paper):
                _run(folder / program, [program, *shlex.split(arguments)], typed)
        except TooMuch:
            found = {"file": "", "line": 0, "text": f"the program printed more than {MOST} characters"}
        except SyntaxError as error:
            found = _problem(folder, error, Path(error.filename or ""), error.lineno or 0, error.msg)
        except Exception as error:  # noqa: BLE001 - whatever a student's program raises is told
            spots = [(Path(frame.f_code.co_filename), line) for frame, line in walk_tb(error.__traceback__)]
            theirs = [(file, line) for file, line in spots if file.is_relative_to(folder)]
            file, line = theirs[-1] if theirs else (Path(), 0)
            found = _problem(folder, error, file, line, str(error))
        pictures = {each.name: each.read_text("utf-8") for each in sorted(folder.glob("*.svg"))}
    return {"output": paper.getvalue(), "pictures": pictures, "problem": found}


def _run(file: Path, words: list[str], typed: str) -> None:
    """Run a file as a program; one that ends Python with a sentence has printed it."""
    with mock.patch.object(sys, "argv", words), mock.patch.object(sys, "stdin", StringIO(typed)):
        try:
            runpy.run_path(str(file), run_name="__main__")
        except SystemExit as end:
            if isinstance(end.code, str):
                print(end.code)


def _problem(folder: Path, error: Exception, file: Path, line: int, text: str) -> dict[str, Any]:
    is_theirs = file.is_relative_to(folder)
    why = f"{type(error).__name__}: {text}".replace(f"{folder}/", "")
    return {
        "file": file.relative_to(folder).as_posix() if is_theirs else "",
        "line": line if is_theirs else 0,
        "text": why,
    }


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """The modules in this folder, and no longer than a program runs."""
    before, where = set(sys.modules), os.getcwd()
    sys.path.insert(0, str(folder))
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(where)
        with suppress(ValueError):  # the program may have taken it out
            sys.path.remove(str(folder))
        for name in set(sys.modules) - before:
            if str(getattr(sys.modules[name], "__file__", "")).startswith(str(folder)):
                del sys.modules[name]
