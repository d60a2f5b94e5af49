"""A package that is written for another API is left out whole, without an import, and people are told."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from tests.added_package import register
from tests.unit.cli.test_stop_loads_no_package import CACHES, CODE, GROUPS
from typer.testing import CliRunner

from arboleda.cli.commands import commands
from arboleda.cli.main import cli
from arboleda.host.packages import entry_points, left_out
from arboleda.runtime.build import Options, build
from arboleda.testing import shipped

NEWER = (
    "Arboleda goes on without acme 1: it is written for API 2, and here is API 1; "
    "type pip install -U arboleda"
)
OLDER = (
    "Arboleda goes on without acme 1: it is written for API 0, and here is API 1; type pip install -U acme"
)
PLANT = Path(__file__).parents[3] / "examples/plants/by_hand.yaml"
Install = Callable[..., None]


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Installs acme, written for these numbers: something in each group, which breaks when imported."""
    site = tmp_path / "site"

    def installed(*numbers: str) -> None:
        (site / "acme").mkdir(parents=True)
        (site / "acme/__init__.py").write_text(CODE, "utf-8")
        groups = {f"arboleda.{each}": ["acme = acme"] for each in GROUPS}
        register(site, "acme", {**groups, "arboleda.api": [f"{each} = acme" for each in numbers]})
        monkeypatch.syspath_prepend(site)
        for each in CACHES:
            each.cache_clear()

    yield installed
    for each in CACHES:
        each.cache_clear()
    assert not (tmp_path / "site/loaded").exists(), "nothing of it was imported"


def brings() -> set[str]:
    """The groups in which acme has something."""
    return {each for each in GROUPS for point in entry_points(f"arboleda.{each}") if point.name == "acme"}


@pytest.mark.parametrize(("number", "told"), [("2", NEWER), ("0", OLDER)])
def test_it_is_left_out_of_every_group(install: Install, number: str, told: str) -> None:
    install(number)
    assert brings() == set() and left_out() == (told,)


@pytest.mark.parametrize("numbers", [(), ("1",), ("1", "2")])
def test_one_for_this_api_or_without_a_number_is_there(install: Install, numbers: tuple[str, ...]) -> None:
    install(*numbers)
    assert brings() == set(GROUPS) and left_out() == ()


def test_a_start_tells_it_once(install: Install, tmp_path: Path) -> None:
    install("2")
    app = build(shipped("sis_a"), {"orchestrator"}, Options(state_dir=tmp_path / "state", page=False))
    app.stop()
    assert [each for each in app.notes if "acme" in each] == [NEWER]


def test_the_list_of_commands_tells_it_once(install: Install, capsys: pytest.CaptureFixture[str]) -> None:
    install("2")
    assert "acme" not in commands() and "acme" not in commands()
    assert capsys.readouterr().err.splitlines() == [NEWER]


@pytest.mark.parametrize(
    ("language", "told"),
    [
        ("en", NEWER),
        (
            "es",
            "Arboleda sigue sin acme 1: está escrito para la API 2, y aquí está la API 1; "
            "escriba pip install -U arboleda",
        ),
    ],
)
def test_a_check_tells_it(
    install: Install, monkeypatch: pytest.MonkeyPatch, language: str, told: str
) -> None:
    install("2")
    monkeypatch.setenv("ARBOLEDA_LANG", language)
    ran = CliRunner().invoke(cli, ["check", str(PLANT)])
    assert ran.exit_code == 0 and ran.stderr.splitlines() == [told]


def test_a_stop_says_nothing_of_it(install: Install, tmp_path: Path) -> None:
    install("2")
    assert "acme" not in CliRunner().invoke(cli, ["stop", "--state", str(tmp_path / "state")]).output
