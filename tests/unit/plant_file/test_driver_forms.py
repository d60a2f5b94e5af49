"""Drivers as forms: the field for each setting, what is said of it, and the value of what was written."""

from __future__ import annotations

from dataclasses import dataclass, field
from importlib.metadata import EntryPoints
from typing import Any, Literal

import pytest

from arboleda.dashboard.findings import findings
from arboleda.drivers.port import DriverSpec
from arboleda.model.errors import ArboledaError
from arboleda.plant_file import driver_forms, package_drivers
from arboleda.web.languages import LANGUAGES, contents, texts


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Where the press
    is."""

    host: str = field(metadata={"about": "its address"})
    port: int = 4711
    slow: bool = False
    limit: float | None = 0.5
    mode: Literal["a", "b"] = "a"
    words: dict[str, int] = field(default_factory=dict)
    password: str | None = field(default=None, metadata={"hidden": True})


class Press:
    """Press behind a socket."""


OWN = {"press": DriverSpec(name="press", made_by=Press, settings=Settings)}


def press() -> dict[str, Any]:
    return next(each for each in driver_forms.forms(OWN, texts("en", "drivers")) if each["name"] == "press")


def test_each_setting_has_its_sort_of_field_and_its_default() -> None:
    rows = [(each["name"], each["form"], each["default"], each["required"]) for each in press()["keys"]]
    assert rows == [
        ("host", "text", "", True),
        ("port", "int", "4711", False),
        ("slow", "bool", "false", False),
        ("limit", "number", "0.5", False),
        ("mode", "choice", "a", False),
        ("words", "yaml", "", False),
    ]


def test_what_the_author_says_stands_beside_it() -> None:
    assert press()["about"] == "Where the press is." and press()["keys"][0]["about"] == "its address"


def test_only_what_is_not_so_anyway_is_written() -> None:
    told = {"host": " 10.0.0.7 ", "port": "4711", "slow": "true", "limit": "null", "words": "{a: 1}"}
    assert driver_forms.written("press", told, OWN) == {
        "press": {"host": "10.0.0.7", "slow": True, "limit": None, "words": {"a": 1}}
    }
    assert driver_forms.written("mqtt", {}, OWN) == "mqtt"


@pytest.mark.parametrize(
    ("told", "sentence"),
    [
        ({}, "the driver press needs host"),
        ({"host": "a", "port": "far"}, "port must be a whole number, is 'far'"),
        ({"host": "a", "port": "true"}, "port must be a whole number"),
        ({"host": "a", "slow": "1"}, "slow must be true or false"),
        ({"host": "a", "mode": "c"}, "mode must be one of a, b"),
        ({"host": "a", "words": "a: 1\nb: ["}, "words, line [23]"),
        ({"host": "a", "words": "a: 1\na: 2"}, "words, line 2"),
        ({"host": "a", "password": "secret"}, "has no key 'password'"),
    ],
)
def test_what_does_not_fit_its_field_is_refused_with_its_name(told: dict[str, str], sentence: str) -> None:
    with pytest.raises(ArboledaError, match=sentence):
        driver_forms.written("press", told, OWN)


def test_an_unknown_driver_is_refused() -> None:
    with pytest.raises(ArboledaError, match="'moon' is no driver"):
        driver_forms.written("moon", {}, OWN)


def test_a_driver_whose_package_is_not_installed_has_the_line_that_installs_it_and_no_keys(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(driver_forms, "entry_points", lambda group: EntryPoints())
    rows = {each["name"]: each for each in driver_forms.forms({}, texts("en", "drivers"))}
    assert set(rows) == {"mqtt", "ros", *package_drivers.OF_DEVICES}
    why = rows["modbus"]["why_not"]
    assert "pip install 'arboleda[drivers]'" in why and rows["modbus"]["keys"] == []
    assert findings("es")(why) == (
        "el driver modbus necesita el paquete drivers, que no está instalado aquí: "
        "escriba pip install 'arboleda[drivers]'"
    )
    assert findings("en")(why) == why


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_comes_with_arboleda_is_said_in_each_language(language: str) -> None:
    rows = [each for each in driver_forms.forms({}, texts(language, "drivers")) if not each["why_not"]]
    keys = {f"{each['name']}.{key['name']}" for each in rows for key in each["keys"]}
    assert {each["name"] for each in rows} >= {"mqtt", "ros"}
    assert keys | {each["name"] for each in rows} <= contents(language, "drivers").keys()
