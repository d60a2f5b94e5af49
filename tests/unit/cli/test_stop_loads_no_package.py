"""A command of the runner loads no package of somebody else: a stop waits for none of them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.added_package import register
from typer.testing import CliRunner

from arboleda.cli.commands import commands
from arboleda.cli.main import cli
from arboleda.dashboard.wording import words
from arboleda.web.languages import contents, texts

CACHES = (commands, contents, texts, words)
GROUPS = (
    "commands",
    "drivers",
    "extras",
    "kinds",
    "languages",
    "page",
    "parts",
    "routes",
    "standby",
    "stores",
)

CODE = """
from pathlib import Path

Path(__file__).parents[1].joinpath("loaded").touch()
raise RuntimeError("this takes 15 s")
"""


@pytest.fixture(autouse=True)
def slow(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A package is installed that registers something in each group, and that nobody wants to wait for."""
    package = tmp_path / "site/acme"
    (package / "languages/es").mkdir(parents=True)
    (package / "__init__.py").write_text(CODE, "utf-8")
    (package / "languages/es/cli.yaml").write_text("acme: {acme: de acme}", "utf-8")
    register(tmp_path / "site", "acme", {f"arboleda.{each}": ["acme = acme"] for each in GROUPS})
    monkeypatch.syspath_prepend(tmp_path / "site")
    for each in CACHES:
        each.cache_clear()
    yield
    for each in CACHES:
        each.cache_clear()


@pytest.mark.parametrize("language", ["en", "es"])
@pytest.mark.parametrize("command", ["stop", "clear", "status", "submit", "hold", "reset"])
def test_it_is_not_loaded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str, language: str
) -> None:
    monkeypatch.setenv("ARBOLEDA_LANG", language)
    words = ["lab"] if command == "submit" else []
    ran = CliRunner().invoke(cli, [command, *words, "--state", str(tmp_path / "state")])
    assert "acme" not in ran.output and not (tmp_path / "site/loaded").exists()
    assert ran.exit_code == 1, "no plant runs there"


def test_its_words_are_found_all_the_same() -> None:
    assert contents("es", "cli")["acme"] == {"acme": "de acme"}


def test_it_is_named_where_all_commands_are_listed(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert "up" in commands() and "acme" in capsys.readouterr().err
    assert (tmp_path / "site/loaded").exists()
