"""What a person types in the tutorial prints what stands below it, where time is moved by hand."""

from __future__ import annotations

import runpy
import shlex
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from arboleda.cli.main import main
from arboleda.web.languages import LANGUAGES

from ..tutorial_pages import LEFT_OUT, ROOT, commands, differs, is_plain, pages


def cases() -> Iterator[pytest.param]:
    for language in LANGUAGES:
        for page in pages(language):
            for number, (command, expected) in enumerate(commands(page), start=1):
                if is_plain(page, command):
                    yield pytest.param(language, command, expected, id=f"{page.stem}-{number}")


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder that commands are typed in; it keeps what they write."""
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(ROOT / "examples"))
    monkeypatch.setenv("COLUMNS", "200")
    return tmp_path


@pytest.mark.parametrize(("language", "command", "expected"), list(cases()))
def test_a_command_prints_what_the_page_says(
    language: str,
    command: str,
    expected: list[str],
    checkout: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setenv("ARBOLEDA_LANG", language)
    program, *words = shlex.split(command)
    try:
        if program == ".venv/bin/arboleda":
            monkeypatch.setattr(sys, "argv", ["arboleda", *words])
            main()
        else:
            assert program == ".venv/bin/python"
            monkeypatch.setattr(sys, "argv", words)
            runpy.run_path(words[0], run_name="__main__")
    except SystemExit as end:
        if isinstance(end.code, str):
            print(end.code)
    assert not (printed := differs(expected, "".join(capsys.readouterr()))), printed


def test_left_out_lines_may_be_any_and_others_may_not() -> None:
    page = ["one", LEFT_OUT, "port 127.0.0.1:...", "two"]
    assert not differs(page, "one\nsomething\nelse\nport 127.0.0.1:1883\ntwo\n")
    assert not differs(page, "one\nport 127.0.0.1:1\n\ntwo\n")
    assert differs(page, "one\nport 127.0.0.1:1\ntwo\nthree\n")
    assert differs(page, "port 127.0.0.1:1\ntwo\n")
    assert differs(["one", LEFT_OUT], "one\nTraceback (most recent call last)\n")
