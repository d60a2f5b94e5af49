"""Drawn plants with cells of devices: everything is drawn, the reader takes it, and recipes are right."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import get_args
from xml.etree import ElementTree

import pytest

from arboleda.dispatch.obstacles import Obstacles
from arboleda.plant_check import meeting_points
from arboleda.plant_file import loader
from arboleda.recipes.place_questions import PlaceHandle
from arboleda.trees.part_places import Places
from arboleda_drawn import devices
from arboleda_drawn.devices import DrawnDevices, Form, scales, sorters, steps
from arboleda_drawn.devices.kinds import NEEDY, SPARE, Span
from arboleda_drawn.devices.printers import BED, ROLE
from arboleda_drawn.plants import DrawnPlants, keep, loaded, of_devices
from arboleda_proofs.campaigns.plants import Plant, PlantRotation
from arboleda_proofs.campaigns.setting import Setting
from arboleda_proofs.simulator.invariants.part_places import done_tasks_leave_nothing_behind
from arboleda_proofs.simulator.truth.shared_devices import SharedDevicesTruth
from arboleda_trees.bt_xml.running import controls
from arboleda_trees.bt_xml.running.node import Node, Result

from ...mutants.mutant import Edit, edit

pytestmark = pytest.mark.long

SEEDS = range(150)
ONLY_IN_XML = (
    *("AsyncFallback", "AsyncSequence", "Delay", "ForEach", "ForceSuccess", "IfThenElse", "LoopInt"),
    *("ParallelAll", "Precondition", "ReactiveFallback", "ReactiveSequence", "RecoveryNode", "RunOnce"),
    *("Script", "ScriptCondition", "SequenceWithMemory", "SubTree", "Switch3", "TryCatch", "WhileDoElse"),
)
FAILS_ON_PURPOSE = 78  # has a rescue that fails, and a grip that is refused
ENDS_BY_ANSWER = 5  # says in its first recipe how each answer leaves its sorter
SCRIPTS = ("_failureIf", "_onFailure", "_onSuccess", "_post", "_skipIf", "_successIf", "_while")


@pytest.fixture(scope="module")
def drawn() -> list[DrawnDevices]:
    return [devices.draw(seed) for seed in SEEDS]


def test_a_seed_draws_the_same_and_another_something_else() -> None:
    assert devices.draw(7) == devices.draw(7) != devices.draw(8)
    assert devices.draw(7, 1) != devices.draw(7)


def test_half_of_the_plants_have_cells_of_devices() -> None:
    of_them = [bool(DrawnPlants().of(seed).drawn) for seed in range(1, 21)]
    assert 5 <= sum(of_them) <= 15


def test_every_step_is_drawn_and_nested(drawn: list[DrawnDevices]) -> None:
    found = {type(step) for each in drawn for recipe in each.recipes for step in steps.walk(recipe.step)}
    assert found == set(get_args(steps.Step))
    inside = {
        (type(outer), type(inner))
        for each in drawn
        for recipe in each.recipes
        for outer in steps.walk(recipe.step)
        for inner in steps.walk(outer)
    }
    assert (steps.Timeout, steps.Retry) in inside and (steps.Retry, steps.Parallel) in inside
    assert (steps.Parallel, steps.Choose) in inside


def test_recipes_end_with_checks_of_two_facts_and_tries_for_some_causes(drawn: list[DrawnDevices]) -> None:
    found = [step for each in drawn for recipe in each.recipes for step in steps.walk(recipe.step)]
    assert {steps.Says, steps.Becomes} <= {type(each) for each in found if getattr(each, "also", ())}
    causes = {each.causes for each in found if isinstance(each, steps.Retry)}
    assert {("rejected",), ("deadline",), ("deadline", "device_fault")} < causes


def test_recipes_end_with_verbs_of_two_facts_rescues_that_fail_and_grips_that_are_refused(
    drawn: list[DrawnDevices],
) -> None:
    found = [each for plant in drawn for recipe in plant.recipes for each in steps.walk(recipe.step)]
    tells = [each for each in found if isinstance(each, steps.Tell)]
    assert any(each.verb == SPARE for each in tells)
    assert any(plant.failing_rescues for plant in drawn)
    refused = {each.verb for each in tells if each.refused and each.role.endswith("_tool")}
    assert refused & {"close", "grip"} and refused & {"open", "let_go"}


def test_trees_have_the_nodes_and_scripts_that_only_xml_has(drawn: list[DrawnDevices]) -> None:
    trees = [text for each in drawn if each.form is Form.XML for text in each.beside.values()]
    nodes = [
        node for text in trees if text.startswith("<root") for node in ElementTree.fromstring(text).iter()
    ]
    assert set(ONLY_IN_XML) <= {node.tag for node in nodes}
    assert set(SCRIPTS) <= {name for node in nodes for name in node.attrib}


def test_the_words_of_no_failure_are_lost_between_two_inverters(drawn: list[DrawnDevices]) -> None:
    trees = [text for each in drawn if each.form is Form.XML for text in each.beside.values()]
    nodes = [
        node for text in trees if text.startswith("<root") for node in ElementTree.fromstring(text).iter()
    ]
    twice = [node for node in nodes if node.tag == "Inverter" and node[0].tag == "Inverter"]
    assert twice and not any("name" in each.attrib for node in twice for each in node.iter("AlwaysFailure"))


def test_a_rescue_fails_on_purpose_where_one_of_its_ways_does() -> None:
    ways = (("yes", steps.Work()), ("no", steps.Fail(sentence="it says no")))
    rescue = steps.Work(steps=(steps.Choose(answer="a1", ways=ways),))
    step = steps.Recover(work=steps.Fail(sentence="so"), rescue=rescue)
    one = steps.Recipe(name="do_1", parameters=(), step=step)
    assert DrawnDevices(section={}, recipes=(one,), form=Form.PYTHON).failing_rescues == ("it says no",)


@pytest.mark.parametrize(
    ("node", "work"),
    [
        (controls.Switch, lambda self: self.below[-2].execute()),
        (controls.WhileDoElse, lambda self: self.below[1].execute()),
    ],
    ids=["switch", "while_do_else"],
)
def test_a_node_of_xml_that_goes_the_wrong_way_is_found(
    monkeypatch: pytest.MonkeyPatch, node: type[Node], work: Callable[[Node], Result]
) -> None:
    monkeypatch.setattr(node, "work", work)
    trees = (seed for seed in SEEDS if devices.draw(seed).form is Form.XML)
    results = (Setting(plants=OfDevices(), cycles=12, level="none").run(seed) for seed in trees)
    assert any(each.broken or each.findings for each in islice(results, 8))


def test_kinds_have_every_effect_and_type_of_fact(drawn: list[DrawnDevices]) -> None:
    kinds = [kind for each in drawn for kind in each.section.get("kinds", {}).values()]
    verbs = [verb for kind in kinds for verb in kind["verbs"].values()]
    assert {verb["effect"] for verb in verbs} == {"motion", "process", "switch", "query"}
    types = [type for kind in kinds for type in kind.get("facts", {}).values()]
    assert {type for type in types if isinstance(type, str)} == {"bool", "int", "number", "text"}
    assert {"needs", "on_stop", "holds", "with", "answers"} <= {key for verb in verbs for key in verb}
    assert any(verb.get("needs") == {} for verb in verbs) and any("needs" not in verb for verb in verbs)
    assert any("takes_s" not in verb for verb in verbs) and any(verb.get("takes_s", 0) > 20 for verb in verbs)


def test_kinds_are_written_in_python_too_with_numbers_within_limits(drawn: list[DrawnDevices]) -> None:
    written = [each for each in drawn if each.kinds is not None]
    assert 0.2 < len(written) / len(drawn) < 0.5
    types = [type for each in written for kind in each.kinds or () for _, type in kind.facts]
    given = [
        type
        for each in written
        for kind in each.kinds or ()
        for verb in kind.verbs
        for _, type in verb.parameters
    ]
    assert any(isinstance(type, Span) for type in types) and any(isinstance(type, Span) for type in given)
    texts = "".join(each.beside["kinds.py"] for each in written)
    assert all(
        word in texts for word in ("takes_s=lambda", "virtual=lambda", "finishes=True", "holds_part=True")
    )


def test_numbers_and_paths_are_parameters_of_recipes(drawn: list[DrawnDevices]) -> None:
    found = {type(each) for one in drawn for recipe in one.recipes for each in recipe.parameters}
    assert found == set(get_args(steps.Parameter))


def test_a_machine_may_work_on_what_lies_in_it(drawn: list[DrawnDevices]) -> None:
    texts = [str(each.section) + each.beside.get("kinds.py", "") for each in drawn]
    assert any("'works_on': 'part'" in text for text in texts)
    assert any("works_on_part=True" in text for text in texts)


def test_two_or_three_cells_share_devices(drawn: list[DrawnDevices]) -> None:
    sharing = [len(each.section["cells"]) for each in drawn if "shared" in each.section]
    assert set(sharing) == {2, 3}
    for plant in drawn:
        cells = plant.section["cells"].values()
        own = [device["name"] for cell in cells for device in cell["devices"].values() if "name" in device]
        assert len(set(own)) == len(own)


def test_cells_have_what_a_cell_can_have(drawn: list[DrawnDevices]) -> None:
    cells = [cell for each in drawn for cell in each.section["cells"].values()]
    rows = [device for cell in cells for device in cell["devices"].values()]
    assert {"needs", "places", "groups", "targets", "paths"} <= {key for cell in cells for key in cell}
    assert {device.get("kind") for device in rows} >= {
        "arm",
        "mobile",
        "person",
        "camera",
        "gripper",
        "conveyor",
        "turntable",
    }
    assert {device.get("evidence") for device in rows} >= {"ids", "facts", "joints", "state"}
    shared = [device for each in drawn for device in each.section.get("shared", {}).values()]
    assert {"arm", "gripper", "kind_1", "person"} <= {device["kind"] for device in shared}
    zones = [zone for each in drawn for zone in each.section.get("zones", {}).values()]
    assert {"poses", "free_while", "held_while"} <= {key for zone in zones for key in zone}
    assert any(each.section.get("timing", {}).get("dwell_s") == 0 for each in drawn)
    assert {"times": 10, "backoff_s": 0} in [cell.get("retry") for cell in cells]


def test_carts_that_tell_nodes_without_the_command_drive_through_zones(drawn: list[DrawnDevices]) -> None:
    found = []
    for each in drawn:
        cell = each.section["cells"]["cell"]
        carts = {role for role, row in cell["devices"].items() if row.get("kind") == "mobile"}
        by_joints = {role for role in carts if cell["devices"][role].get("evidence") == "joints"}
        inside = [pose for zone in each.section.get("zones", {}).values() for pose in zone.get("poses", ())]
        targets = [cell["targets"].get(pose.removeprefix("cell "), {}) for pose in inside]
        found += [target for target in targets if by_joints & target.keys()]
    assert found


def test_cells_share_a_hand_that_moves_parts_beside_a_recipe_that_does_not_touch_it(
    drawn: list[DrawnDevices],
) -> None:
    found = []
    for plant in drawn:
        cell = plant.section["cells"]["cell"]
        arm = next((name.removesuffix("_racks") for name in cell.get("places", {})), "")
        if "shared" in cell["devices"].get(arm, {}):
            roles = [{getattr(each, "role", "") for each in steps.walk(one.step)} for one in plant.recipes]
            found.append({arm in each for each in roles})
    assert {True, False} in found


def test_a_recipe_says_how_it_leaves_a_device_that_cells_share_and_keeps_that_while_it_shrinks(
    drawn: list[DrawnDevices],
) -> None:
    plant = next(each for each in drawn if each.recipes[0].ends and each.form is Form.XML)
    python = replace(plant, form=Form.PYTHON).beside["recipes.py"]
    assert all("ends_with=" in text for text in (plant.beside["do_1.xml"], python))
    less = [each.recipes[0] for each in devices.smaller(plant)]
    assert any(each.ends and each.step != plant.recipes[0].step for each in less)
    assert any(not each.ends and each.step == plant.recipes[0].step for each in less)
    assert any(not each.ends and each.step != plant.recipes[0].step for each in less)


def test_recipes_wait_for_a_part_and_for_room_in_both_forms(drawn: list[DrawnDevices]) -> None:
    texts = {form: "".join(t for p in drawn if p.form is form for t in p.beside.values()) for form in Form}
    assert ").gets_part(" in texts[Form.PYTHON] and ").gets_room(" in texts[Form.PYTHON]
    assert "<place_gets_part " in texts[Form.XML] and "<place_gets_room " in texts[Form.XML]


def test_a_switch_that_needs_what_is_not_so_stands_after_work_that_may_be_late(
    drawn: list[DrawnDevices],
) -> None:
    found = [each for plant in drawn for recipe in plant.recipes for each in steps.walk(recipe.step)]
    ends = [each.steps[-1] for each in found if isinstance(each, steps.Fallback)]
    assert NEEDY in {each.verb for each in ends if isinstance(each, steps.Tell) and each.refused}


def test_check_says_that_arms_on_one_base_stand_in_each_other(drawn: list[DrawnDevices]) -> None:
    def bases(plant: DrawnDevices) -> list[str]:
        cells = plant.section["cells"].values()
        return [str(row["base"]) for cell in cells for row in cell["devices"].values() if "base" in row]

    plant = next(each for each in drawn if len(bases(each)) > len(set(bases(each))))
    assert any(" stand in each other" in each for each in meeting_points.warnings(loaded(plant).model))


def test_a_printer_makes_a_part_that_a_hand_takes_away_and_check_takes_the_plant(
    drawn: list[DrawnDevices],
) -> None:
    printing = [each for each in drawn if BED in each.section["cells"]["cell"].get("places", {})]
    assert {Form.PYTHON, Form.XML} <= {each.form for each in printing}
    assert {True, False} == {each.kinds is None for each in printing}
    assert all(_takes_away(each) for each in printing if ROLE in _roles(each))
    assert all(loaded(each) for each in printing[:4])


def _roles(plant: DrawnDevices) -> set[str]:
    return {getattr(each, "role", "") for recipe in plant.recipes for each in steps.walk(recipe.step)}


def _takes_away(plant: DrawnDevices) -> bool:
    recipes = [list(steps.walk(recipe.step)) for recipe in plant.recipes]
    made = [each for each in recipes if any(getattr(step, "role", "") == ROLE for step in each)]
    return all(any(isinstance(s, steps.Visit) and s.target == BED for s in each) for each in made)


def test_recipes_go_on_by_a_number_in_both_forms_and_compare_one_and_check_takes_the_plants(
    drawn: list[DrawnDevices],
) -> None:
    asking = [each for each in drawn if scales.ROLE in _roles(each)]
    assert {Form.PYTHON, Form.XML} == {each.form for each in asking}
    texts = "".join(text for each in asking for text in each.beside.values())
    assert "'otherwise': " in texts and ".says(celsius='<" in texts and 'celsius="&gt;' in texts
    answers = [verb.numbers for each in asking for kind in each.kinds or () for verb in kind.verbs]
    assert any(isinstance(each, Span) for each in answers)
    assert all(loaded(each) for each in asking[1:5])


def test_each_number_has_one_of_the_drawn_ways(drawn: list[DrawnDevices]) -> None:
    found = [each for plant in drawn for recipe in plant.recipes for each in steps.walk(recipe.step)]
    chosen = [each for each in found if isinstance(each, steps.Choose) and each.answer == scales.ANSWER]
    assert chosen
    for each in chosen:
        ranges = [way for way, _ in each.ways if isinstance(way, steps.Range)]
        for number in (-50, -3, 0.75, 2, 7, 20, 80.1, 200):
            assert sum(way.has(number) for way in ranges if way.comparisons) <= 1
            assert any(way.has(number) for way in ranges)


def test_recipes_have_an_end_for_each_answer_in_both_forms_and_check_takes_the_plants(
    drawn: list[DrawnDevices],
) -> None:
    ending = [each for each in drawn if any(recipe.ends_by_answer for recipe in each.recipes)]
    texts = {form: "".join(t for p in ending if p.form is form for t in p.beside.values()) for form in Form}
    assert "ends_with=[{'sorter.inspect': " in texts[Form.PYTHON]
    assert 'ends_with="sorter.inspect: ' in texts[Form.XML] and " | sorter.inspect: " in texts[Form.XML]
    assert all(loaded(each) for each in ending[:4])


def test_an_end_for_an_answer_that_is_not_so_is_found() -> None:
    plant = of_devices(ENDS_BY_ANSWER).drawn
    assert plant is not None
    first = plant.recipes[0]
    (answer, (fact, side)), *others = first.ends_by_answer
    wrong = next(each for each in sorters.SIDES[isinstance(side, int)] if each != side)
    made = replace(first, ends_by_answer=((answer, (fact, wrong)), *others))
    plants = PlantRotation(plants=(loaded(replace(plant, recipes=(made,))),))
    result = Setting(plants=plants, cycles=12, level="none").run(1)
    assert "recipes_end_as_they_say" in str(result.broken)


BUGS = {
    "a command passes over a need of late work": (
        26,
        edit(Obstacles.to, 'obstacle = None  # "moving"', 'return None  # "moving"'),
    ),
    "a task answers for the part in a hand that another cell has": (
        16,
        edit(
            done_tasks_leave_nothing_behind.rule,
            "name in model.shared and not _was_commanded(look, name, cell, since=began)",
            "False",
        ),
    ),
    "a task ends with a shared device as that is at last": (
        16,
        edit(SharedDevicesTruth.as_left_by, "return own.facts", "return self._facts_of(device)"),
    ),
    "a device makes a second part where one lies": (
        22,
        edit(Places._to_work, "if not full or len(full)", "if full or len(full)"),
    ),
    "a wait for a part is over at once": (
        49,
        edit(PlaceHandle._is_filled, "self._context.places.is_filled(self._target)", "True"),
    ),
    "a tree's wait for a part is over at once": (
        60,
        edit(PlaceHandle._is_filled, "self._context.places.is_filled(self._target)", "True"),
    ),
    "a wait for room is over at once": (
        55,
        edit(PlaceHandle._is_free, "self._context.places.is_free(self._target)", "True"),
    ),
}


@pytest.mark.parametrize(("seed", "bug"), BUGS.values(), ids=BUGS)
def test_a_bug_is_found_by_what_is_drawn_for_it(
    monkeypatch: pytest.MonkeyPatch, seed: int, bug: Edit
) -> None:
    rates = {"rates": {"ends_late": 12.0}} if bug.function is Obstacles.to else None
    setting = Setting(plants=OfDevices(), cycles=12, level="none", faults_data=rates)
    bug.make(monkeypatch)
    result = setting.run(seed)
    assert result.broken or (result.findings and not rates)


def test_both_forms_of_recipes_are_drawn_and_read_by_the_ordinary_reader(tmp_path: Path) -> None:
    plants = [of_devices(seed) for seed in range(1, 5)]
    assert {plant.drawn.form for plant in plants if plant.drawn is not None} == {Form.PYTHON, Form.XML}
    for number, plant in enumerate(plants):
        read = loader.load(keep(plant, tmp_path / str(number)))
        assert [recipe.name for recipe in read.cells[0].recipes] == [
            recipe.name for recipe in plant.declared.cells[0].recipes
        ]


def test_a_plant_is_read_again_from_what_json_has_of_it() -> None:
    plain = of_devices(5).plain
    again = loaded(plain["plant_file"], plain["plant_files"])
    assert again.declared.name == "drawn_5" and again.files.contents.keys() == {"drawn_5.yaml", "recipes.py"}


def test_smaller_plants_have_a_recipe_a_step_or_a_key_less() -> None:
    drawn = next(
        each for each in map(devices.draw, SEEDS) if len(each.recipes) > 1 and each.form is Form.PYTHON
    )
    less = list(devices.smaller(drawn))
    assert len(less) > 20 and all(len(str(each)) < len(str(drawn)) for each in less)
    assert {len(each.recipes) for each in less} == {len(drawn.recipes), len(drawn.recipes) - 1}
    assert any(each.section != drawn.section for each in less)


@pytest.mark.parametrize("seed", [1, 2])
def test_without_faults_nothing_fails(seed: int) -> None:
    result = Setting(plants=OfDevices(), cycles=2, level="none").run(seed)
    assert result.broken is None, str(result.broken)
    assert not result.findings and result.outcomes["done"] > 0


class OfDevices:
    """Plants with cells of devices only."""

    def of(self, seed: int) -> Plant:
        return of_devices(seed)


def test_what_a_drawn_recipe_has_fail_on_purpose_is_no_finding() -> None:
    result = Setting(plants=OfDevices(), cycles=12, level="none").run(FAILS_ON_PURPOSE)
    assert result.outcomes["rejected"] and result.broken is None
    assert not result.findings
