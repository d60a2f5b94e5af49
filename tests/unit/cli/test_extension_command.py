"""`arboleda extension`: what is installed, without an import of it, and what is off for every plant."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.added_package import register
from tests.unit.cli.test_stop_loads_no_package import CACHES, CODE, GROUPS
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.host.packages import entry_points, left_out, why_left_out


@pytest.fixture(autouse=True)
def acme(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """acme-tools adds something to every group, and breaks when imported."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    (tmp_path / "site/acme").mkdir(parents=True)
    (tmp_path / "site/acme/__init__.py").write_text(CODE, "utf-8")
    groups = {f"arboleda.{each}": ["acme = acme"] for each in GROUPS}
    kinds = ["balance = acme", "pump = acme"]
    register(
        tmp_path / "site", "acme-tools", {**groups, "arboleda.kinds": kinds, "arboleda.api": ["1 = acme"]}
    )
    monkeypatch.syspath_prepend(tmp_path / "site")
    for each in CACHES:
        each.cache_clear()
    yield
    for each in CACHES:
        each.cache_clear()
    assert not (tmp_path / "site/loaded").exists(), "nothing of it was imported"


def said(*words: str, status: int = 0) -> str:
    ran = CliRunner().invoke(cli, ["extension", *words])
    assert ran.exit_code == status, ran.output
    return ran.output


def is_there() -> bool:
    return any(point.name == "acme" for each in GROUPS for point in entry_points(f"arboleda.{each}"))


def test_it_is_listed_with_what_it_adds() -> None:
    lines = said("list").splitlines()
    at = lines.index(
        "acme-tools 1 (API 1): commands, drivers acme, extras, kinds balance, pump, languages, the page, "
        "parts, routes, standby, stores acme"
    )
    assert lines[at + 1] == "  in a plant file: extensions: {acme: ...}"


@pytest.mark.parametrize("name", ["acme-tools", "acme_tools", "acme"])
def test_it_is_off_for_every_plant_until_it_is_on_again(name: str) -> None:
    assert is_there()
    assert "acme-tools is off for every plant" in said("off", name)
    assert not is_there() and left_out() == (), "who has put it off is not told of it again"
    assert "  off: " in said("list")
    assert "is off: type arboleda extension on acme-tools" in why_left_out("arboleda.kinds", "pump")
    assert "is on again" in said("on", name)
    assert is_there() and "  off: " not in said("list")


def test_a_variable_puts_it_off_for_one_call(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ARBOLEDA_EXTENSIONS_OFF", "other, acme")
    assert not is_there()
    assert "is off by ARBOLEDA_EXTENSIONS_OFF" in said("on", "acme")
    monkeypatch.delenv("ARBOLEDA_EXTENSIONS_OFF")
    assert is_there()


def test_one_for_another_api_is_listed_with_why_it_is_left_out(tmp_path: Path) -> None:
    register(tmp_path / "site", "late", {"arboleda.parts": ["late = late"], "arboleda.api": ["7 = late"]})
    lines = said("list").splitlines()
    at = lines.index("late 1 (API 7): parts")
    assert "it is written for API 7, and here is API 1" in lines[at + 1]


def test_one_with_the_name_of_another_is_left_out_and_both_are_named(tmp_path: Path) -> None:
    register(tmp_path / "site", "late", {"arboleda.parts": ["acme.more = late"]})
    lines = said("list").splitlines()
    at = lines.index("late 1: parts")
    assert "acme-tools 1 is registered as acme, too; remove one of them" in lines[at + 1] and is_there()


@pytest.mark.parametrize("verb", ["on", "off"])
def test_a_name_that_nobody_has_is_refused_with_the_nearest(verb: str) -> None:
    ran = CliRunner().invoke(cli, ["extension", verb, "acme-tool"])
    assert "there is no package 'acme-tool'; " in str(ran.exception)
    assert "did you mean acme-tools?" in str(ran.exception)


def test_it_speaks_spanish(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ARBOLEDA_LANG", "es")
    assert "acme-tools 1 (API 1): comandos, drivers acme, extras, clases balance, pump, idiomas" in said(
        "list"
    )
    assert "queda desactivado en todas las plantas" in said("off", "acme")
