"""Devices and cells of a draft, made, changed and taken away: in one step, and nothing else is cut."""

from __future__ import annotations

from importlib.resources import files
from typing import Any

import pytest

from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file.robot_models import pose_at_home
from arboleda.plant_file.yaml_edit import EditRefused
from arboleda.plant_file.yaml_marks import parse
from arboleda_make.drafts.devices import with_device, without_cell, without_device
from arboleda_make.drafts.draft import Draft, draft_of

STARTER = files("arboleda").joinpath("starter/plant.yaml").read_text("utf-8").replace("NAME", "lab")
LAMP = {"facts": {"lit": "bool"}, "verbs": {"shine": {"effect": "switch", "sets": {"lit": True}}}}
ARM_HOME = {"deg": [0, 0], "mm": 0}


def opened(text: str = STARTER) -> Draft:
    return draft_of(PlantFiles(plant="plant.yaml", contents={"plant.yaml": text.encode()}))


def text_of(draft: Draft) -> str:
    return draft.files.contents["plant.yaml"].decode()


def values_of(draft: Draft) -> Any:
    return parse(draft.files.contents["plant.yaml"])[0].value


def device(cell: str, role: str, kind: str, **more: Any) -> dict[str, Any]:
    return {"cell": cell, "role": role, "kind": kind, "declared": None, "driver": None, "keys": {}} | more


def added(draft: Draft, made: dict[str, Any]) -> Draft:
    return draft.rewritten(
        lambda values: with_device(values, made, pose_at_home(made["kind"], made["keys"].get("model")))
    )


def test_a_device_of_a_new_kind_comes_in_one_step_with_its_lines_alone() -> None:
    draft = added(opened(), device("cell", "lamp", "lamp", declared=LAMP, driver={"modbus": {"host": "h"}}))
    assert [each.words for each in draft.changes] == [
        "new kind lamp: says lit; does shine",
        "new device lamp of cell: lamp with shine, reached by modbus",
    ]
    assert len(draft.past) == 1 and set(STARTER.splitlines()) <= set(text_of(draft).splitlines())


def test_a_device_is_changed_and_what_no_form_shows_stays() -> None:
    text = STARTER.replace("press:  {kind: press}", "press:  {kind: press, evidence: state, link: ros}")
    kind = values_of(opened(text))["kinds"]["press"]
    kind["verbs"]["open"] = {**kind["verbs"]["open"], "takes_s": 3}
    draft = added(opened(text), device("cell", "press", "press", declared=kind, driver="my_plc"))
    assert [each.words for each in draft.changes] == [
        "kind press, open.takes_s: from 2 to 3",
        "cell cell, link of press: gone, it was ros",
        "cell cell, driver of press: new, my_plc",
    ]
    assert values_of(draft)["cells"]["cell"]["devices"]["press"]["evidence"] == "state"
    assert text_of(draft).count("takes_s: 3") == 2 and "# where parts lie" in text_of(draft)


def test_a_cell_is_made_with_its_first_device_under_a_name_of_its_own() -> None:
    keys = {"model": "scara", "base": {"origin_m": [2.0, 0.0]}, "tool_of": ""}
    cell = values_of(added(opened(), device("other", "loader", "arm", keys=keys)))["cells"]["other"]
    assert cell["devices"] == {
        "loader": {"kind": "arm", "model": "scara", "base": {"origin_m": [2.0, 0.0]}, "name": "other_loader"}
    }
    assert cell["targets"] == {"home": {"loader": ARM_HOME}}


def test_homes_are_as_the_robots_that_come_with_arboleda() -> None:
    assert pose_at_home("arm", "scara") == ARM_HOME and pose_at_home("arm", "cr10a") == {"deg": [0] * 6}
    assert pose_at_home("mobile", None) == {"node": 0}
    assert pose_at_home("arm", {"file": "mine.urdf"}) is None and pose_at_home("camera", None) is None


def test_a_device_goes_with_all_that_names_it() -> None:
    values = values_of(opened().rewritten(lambda all: without_device(all, "cell", "press")))
    assert "kinds" not in values and "zones" in values
    assert values["zones"] == {"inside": {"poses": ["cell press"]}}
    assert values["cells"]["cell"]["places"] == {"blanks": {"supply": True}}
    assert set(values["cells"]["cell"]["targets"]) == {"home", "feed", "spare", "press"}


def test_a_robot_goes_with_its_targets_their_groups_places_and_zones() -> None:
    draft = opened().rewritten(lambda all: without_device(all, "cell", "loader"))
    assert values_of(draft)["cells"]["cell"] == {"devices": {"press": {"kind": "press"}}}
    assert "zones" not in values_of(draft) and "press" in values_of(draft)["kinds"]
    assert text_of(draft.undo()) == STARTER


def test_a_cell_goes_with_the_kinds_that_no_other_has() -> None:
    draft = added(opened(), device("other", "lamp", "lamp", declared=LAMP))
    assert set(values_of(draft.rewritten(lambda all: without_cell(all, "cell")))["kinds"]) == {"lamp"}
    last = draft.rewritten(lambda all: without_device(all, "other", "lamp"))
    assert values_of(last) == values_of(opened())


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (lambda all: without_device(all, "cell", "lamp"), "no device of cell"),
        (lambda all: without_cell(all, "shed"), "no cell of this plant"),
        (lambda all: with_device([], device("c", "lamp", "lamp"), None), "only people change"),
    ],
)
def test_what_is_not_there_is_refused_and_nothing_changed(change: Any, why: str) -> None:
    with pytest.raises(EditRefused, match=why):
        opened().rewritten(change)
