"""What is shown of a cell that is neither an arm nor a mobile robot: its devices, its tree and its forms."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import pytest

from arboleda.model.plant_model import PlantModel
from arboleda.model.sentence import in_json
from arboleda.recipes import Kit, Number, recipe, work
from arboleda.testing import Rig, shipped
from arboleda.views import diagnostics, forms, geometry, twin_view, view

from ...plants import made
from ..kinds.lab import Bench, model


@pytest.fixture
def bench() -> Bench:
    """Its oven bakes."""
    here = Bench(model())
    here.submit("bench bake 10")
    assert here.wait(30.0, lambda: here.told[-1:] == ["oven bake"])
    return here


def cell_of(bench: Bench) -> dict[str, Any]:
    (cell,) = view.snapshot(bench.plant)["cells"]
    return cell


def device(bench: Bench, name: str) -> dict[str, Any]:
    return next(robot for robot in view.snapshot(bench.plant)["robots"] if robot["name"] == name)


def renamed(plant: PlantModel, role: str) -> PlantModel:
    """The bench with its oven in another role."""
    (cell,) = plant.cells
    (_, oven), eye = cell.members
    return replace(plant, cells=(replace(cell, members=((role, oven), eye)),))


def test_a_cell_names_its_devices_with_role_and_kind(bench: Bench) -> None:
    oven = {
        "role": "oven",
        "name": "oven",
        "kind": "oven",
        "position": None,
        "holds": "clamped",
        "asked": False,
    }
    eye = {"role": "eye", "name": "eye", "kind": "eye", "position": None, "holds": None, "asked": False}
    assert cell_of(bench)["devices"] == [oven, eye]
    (told,) = view.layout(bench.plant.model)["cells"]
    assert told["devices"] == [oven, eye] and not {"arm", "mobile", "grid", "paths"} & set(told)


def test_a_cell_of_storage_keeps_the_keys_that_it_had() -> None:
    plant = shipped("sis_a")
    (told,) = view.layout(plant)["cells"]
    assert (told["arm"], told["mobile"], told["stations"]) == ("ra1", "rm_sis_a", 9)
    assert (told["grid"], told["paths"]["0B"][0]) == ({"rows": 3, "columns": 3}, 0)
    assert [(each["role"], each["position"]) for each in told["devices"]] == [
        ("arm", "q"),
        ("mobile", "node"),
    ]


def test_a_role_hides_nothing_of_its_cell() -> None:
    here = Bench(renamed(model(), "state"))
    assert cell_of(here)["state"] == "idle"
    assert cell_of(here)["devices"][0]["role"] == "state"


def test_a_device_says_its_facts_and_its_answer(bench: Bench) -> None:
    assert device(bench, "oven")["facts"] == {"lid": "closed", "clamped": True, "dose": 5}
    assert (device(bench, "eye")["facts"], device(bench, "eye")["answer"]) == ({}, "good")
    assert str(device(bench, "oven")["command"]["what"]) == "doing bake 10"


def test_a_fact_that_was_not_said_yet_is_shown_as_unknown(bench: Bench) -> None:
    bench.plant.dispatcher.beliefs["oven"].facts.clear()
    assert device(bench, "oven")["facts"] == {"lid": None, "clamped": None, "dose": None}


def test_an_arm_says_its_effector_among_its_facts() -> None:
    rig = Rig(shipped("sis_a"))
    rig.wait(0.5)
    arm, mobile = rig.snapshot()["robots"]
    assert (arm["kind"], arm["facts"]) == ("arm", {"effector": False, "piece": False})
    assert (mobile["kind"], mobile["facts"]) == ("mobile", {})


def test_a_snapshot_is_plain_json_with_what_each_command_was_given(bench: Bench) -> None:
    told = json.loads(json.dumps(view.snapshot(bench.plant), default=in_json))
    given = [row["parameters"] for row in told["cells"][0]["tree"] if row["name"] == "oven bake 10"]
    assert [(each["verb"], each["dose"]) for each in given] == [("bake", 10)]


def test_the_step_is_the_one_that_runs_not_what_frames_it(bench: Bench) -> None:
    assert str(cell_of(bench)["step"]) == "oven bake 10"


def test_progress_counts_the_steps_of_the_way_that_is_taken(bench: Bench) -> None:
    steps = ["system start", "eye look", "is good", "clamp", "close", "bake", "open", "clamp"]
    assert cell_of(bench)["progress"] == 5 / len(steps)


def test_diagnostics_have_each_fact(bench: Bench) -> None:
    bench.plant.dispatcher.beliefs["oven"].facts.pop("dose")
    told = {name: values for name, _, _, _, values in diagnostics.diagnostics(view.snapshot(bench.plant))}
    oven = told["arboleda: oven"]
    facts = {key: value for key, value in oven.items() if key.startswith("facts.")}
    assert facts == {"facts.lid": "closed", "facts.clamped": "true", "facts.dose": "?"}


def test_nothing_is_drawn_of_what_offers_no_drawing(bench: Bench) -> None:
    empty = ("robots", "cells", "parts", "targets", "zones")
    assert geometry.places(bench.plant.model) == {key: [] for key in empty}
    drawn = twin_view.positions(bench.plant)
    assert (drawn["parts"], drawn["books"]["bench"]) == ({"bench": None}, {"places": {}, "carriers": {}})


def test_what_a_cell_offers_is_a_form() -> None:
    (bench,) = forms.offers(model())
    bake, careless = bench["recipes"]
    assert (bake["form"], bake["example"], bake["default"]) == ("<cell> bake <dose>", "bench bake 10", False)
    assert (bake["about"], careless["about"]) == (
        "Look at the sample; bake a good one.",
        "Bake with the lid open.",
    )
    (dose,) = bake["parameters"]
    assert (str(dose["called"]), dose["type"], dose["choices"]) == ("dose", "choice", ["5", "10"])
    assert careless["parameters"] == []
    first = forms.offers(shipped())[0]["recipes"]
    assert [(each["name"], each["default"]) for each in first] == [("storage", True), ("palletizing", False)]


def test_a_number_has_its_limits_instead_of_choices() -> None:
    @recipe("heat")
    def heat(cell: Kit, degrees: Number[20, 90], hours: Number[0.5, 2.0]):  # type: ignore[no-untyped-def,valid-type]
        return work(cell.device("oven").close())

    (told,) = forms.offers(model(heat))[0]["recipes"]
    kinds = [{key: each[key] for key in ("type", "lower", "upper")} for each in told["parameters"]]
    assert kinds[0] == {"type": "integer", "lower": 20, "upper": 90}
    assert kinds[1] == {"type": "number", "lower": 0.5, "upper": 2.0}


def test_a_step_around_another_is_not_the_step_that_runs() -> None:
    patient = made("patient", lambda cell: cell.timeout(cell.device("oven").close(), seconds=9.0))
    here = Bench(model(patient))
    here.submit("bench patient")
    assert here.wait(30.0, lambda: here.told[-1:] == ["oven close"])
    assert str(cell_of(here)["step"]) == "oven close"
