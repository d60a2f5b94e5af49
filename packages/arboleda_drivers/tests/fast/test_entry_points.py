"""Entry points of this package, and the names under which its modules were known before."""

from __future__ import annotations

import pytest

from arboleda.drivers.port import GROUP, spec_of
from arboleda.host.packages import entry_points
from arboleda.plant_file import driver_forms, package_drivers
from arboleda.web.languages import texts
from arboleda_drivers.pylabrobot.adapter import machine

OURS = [each for each in entry_points(GROUP) if each.module.startswith("arboleda_drivers.")]


def test_a_plant_file_that_names_one_of_these_drivers_is_told_what_to_install() -> None:
    assert {each.name for each in OURS} == package_drivers.ALL


@pytest.mark.parametrize("point", OURS, ids=lambda point: point.name)
def test_each_is_a_driver_of_its_name_in_the_folder_of_its_maker(point: object) -> None:
    spec = spec_of(point.load())
    assert spec is not None and spec.name == point.name
    assert point.module.split(".")[2:] == ["adapter"]


def test_files_of_plants_that_import_a_machine_of_pylabrobot_as_before_go_on_working() -> None:
    with pytest.warns(DeprecationWarning, match="is arboleda_drivers"):
        from arboleda.adapters.pylabrobot import machine as before
    assert before is machine


def test_each_is_offered_with_its_keys() -> None:
    rows = {each["name"]: each for each in driver_forms.forms({}, texts("en", "drivers"))}
    assert [name for name in package_drivers.OF_DEVICES if rows[name]["why_not"]] == []
