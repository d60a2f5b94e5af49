"""What `check` says of a recipe without running it: what cannot be done, and what is forgotten at the end."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.plant_model import PlantModel
from arboleda.plant_check import advance_check
from arboleda.plant_file.loader import load

from ...plants import plant_text, read

PLANT = plant_text(__file__, "advance_check")
STORAGE = plant_text(__file__, "advance_check_storage")
INTO = 'take("rack"), reader.open(), put("drawer"), reader.close()'
OUT = 'reader.open(), take("drawer"), put("bin"), reader.close(), loader.home()'
BRING_BACK = 'loader.brings_back_to("bin") or cell.wait(1)'
LID_OPENS = "reader.becomes(lid='open', at_most_s=5)"
WAYS = 'cell.choose(seen, {"clear": [%s], "unclear": [%s]})'


def written(folder: Path, body: str, decorator: str) -> PlantModel:
    code = f"""
from arboleda.recipes import parallel, recipe, work

@recipe({decorator})
def attempt(cell):
    loader, jaw, reader = cell.devices("loader", "jaw", "reader")
    take = lambda at: loader.visit(at, jaw.close(width_mm=20, force_n=20))
    put = lambda at: loader.visit(at, jaw.open())
    seen = reader.read()
    return work({body})
"""
    return read(folder, PLANT, code)


def warned(folder: Path, body: str, decorator: str = '"try"') -> list[str]:
    """What is wrong; `advised` has what to write."""
    found = advance_check.warnings(written(folder, body, decorator))
    where = f"{folder / 'recipes.py'}:4:1: lab: try "
    assert all(each.startswith(where) for each in found)
    return [each.removeprefix(where).partition("; write ")[0] for each in found]


def advised(folder: Path, body: str, decorator: str = '"try"') -> list[str]:
    found = advance_check.warnings(written(folder, body, decorator))
    return [each.partition("; write ")[2] for each in found]


@pytest.mark.sampled(7)
@pytest.mark.parametrize(
    "body",
    [
        f"{INTO}, seen, {OUT}",
        f"{INTO}, cell.retry(seen), {WAYS % ('', '')}, {OUT}",
        f"{INTO}, seen, {WAYS % (OUT, OUT)}",
        f"{INTO}, seen, {WAYS % ('reader.open()', '')}, {WAYS % (OUT.partition(', ')[2], OUT)}",
        f"{INTO}, cell.fallback(cell.timeout(seen, 5), reader.read()), {OUT}",
        f"parallel(reader.open(), take('rack')), put('drawer'), {OUT}",
        f"parallel(work({INTO}), cell.wait(1)), {OUT}",
        f"take('rack'), parallel(work({LID_OPENS}, put('drawer')), reader.open()), {OUT}",
        "reader.close(), cell.fallback(work(reader.says(lid='open'), put('drawer')), cell.wait(1)), seen",
        "cell.timeout(cell.retry(seen, times=1000), 60)",
        f"cell.repeat(work({INTO}, {OUT}), 1)",
        f"cell.recover(work({INTO}, {OUT}), reader.open())",
        'take("nest"), put("nest"), put("nest")',
        f'{INTO}, reader.open(), take("drawer"), {BRING_BACK}, reader.close(), put("bin"), loader.home()',
    ],
)
def test_nothing_is_said_of_what_can_be_so(tmp_path: Path, body: str) -> None:
    assert warned(tmp_path, body) == []


@pytest.mark.sampled(9)
@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        (
            f"{INTO}, reader.open(), seen, {OUT}",
            "has reader read, which needs lid of reader to be closed, where it is open",
        ),
        (
            f'reader.close(), take("rack"), put("drawer"), {OUT}',
            "has loader go to drawer where lid of reader is closed; it has to be open",
        ),
        (
            'take("rack"), reader.open(), loader.visit("drawer", jaw.open(), reader.close()), ' + OUT,
            "has reader close while loader stands at drawer",
        ),
        (
            'take("rack"), put("bin"), take("rack"), put("bin"), loader.home()',
            "has jaw take hold of a part at rack, where nothing can be",
        ),
        (
            'take("rack"), put("nest"), take("bin"), put("nest")',
            "has jaw take hold of a part at bin, where nothing can be",
        ),
        (
            'take("rack"), put("rack"), take("nest"), put("rack")',
            "has jaw let go of a part at rack, which is full already",
        ),
        (
            f'{INTO}, reader.open(), take("drawer"), reader.close(), put("bin"), loader.home()',
            "has loader go to bin with a part that goes back to drawer after a failure, where lid of reader"
            " is closed; it has to be open, or brings_back_to another target",
        ),
        (
            'take("rack"), take("nest"), put("bin"), loader.home()',
            "has jaw take hold of a part at nest while it holds one from rack",
        ),
        ('take("rack"), loader.home(), jaw.open()', "has jaw let go of a part at home, where none lies"),
        (
            'loader.home(), jaw.close(width_mm=20, force_n=20), put("bin"), loader.home()',
            "has jaw take hold of a part at home, where none lies",
        ),
        ('take("rack"), loader.home()', "ends with a part that jaw still holds"),
        (f"{INTO}, loader.home()", "ends with 1 more at drawer of reader than it began with"),
        (
            f"{INTO}, seen, {WAYS % (OUT, OUT.replace('reader.close(), ', ''))}",
            "ends with reader lid closed and open, by which way it goes",
        ),
        (
            f"{INTO}, seen, {WAYS % (OUT, OUT.replace(', loader.home()', ''))}",
            "ends with loader at bin and home, by which way it goes",
        ),
        (
            "reader.open(), parallel(take('rack'), seen), put('bin'), loader.home()",
            "has reader read, which needs lid of reader to be closed, where it is open",
        ),
        (
            "parallel(take('rack'), reader.open()), seen, put('bin'), loader.home()",
            "has reader read, which needs lid of reader to be closed, where it is open",
        ),
        (f"parallel(work({INTO}), cell.wait(1))", "ends with 1 more at drawer of reader than it began with"),
        (
            "cell.recover(seen, work(reader.open(), reader.read()))",
            "has reader read, which needs lid of reader to be closed, where it is open",
        ),
        (
            "cell.retry(reader.open(), times=1000)",
            "tries reader open again 1,000 times, 1 s apart; a task that cannot be done never ends so",
        ),
        (
            "cell.retry(reader.open(), times=10, pause_s=600)",
            "tries reader open again 10 times, 600 s apart; a task that cannot be done never ends so",
        ),
    ],
)
def test_it_says_what_is_wrong_for_certain(tmp_path: Path, body: str, sentence: str) -> None:
    assert sentence in warned(tmp_path, body)


ARMS = "{loader: {kind: arm, model: scara}, jaw: {kind: gripper, tool_of: loader}}"
OTHER = """  other:
    devices: {loader: {shared: loader}, jaw: {shared: jaw}, eye: {kind: camera}}
    targets: {home: {loader: {deg: [0, 0], mm: 0}}}
"""
SHARED = (
    PLANT.replace("{kind: arm, model: scara}", "{shared: loader}")
    .replace("{kind: gripper, tool_of: loader}", "{shared: jaw}")
    .replace("cells:\n", f"shared: {ARMS}\ncells:\n")
    .replace("zones:\n", f"{OTHER}zones:\n")
)
LOOKS = """
@recipe("look")
def look(cell):
    return cell.device("eye").look()
"""


@pytest.mark.parametrize(
    ("body", "wrong"),
    [
        (f"{INTO}, seen, {WAYS % (OUT, OUT)}", []),
        (f"{INTO}, seen, {OUT}", []),
        (f"{INTO}, seen, {WAYS % (OUT, '')}", ["ends with drawer 1, and says that it ends with 0"]),
        (
            f"cell.recover(work({INTO}, reader.open(), seen), cell.wait(1)), {OUT}",
            ["has reader read, which needs lid of reader to be closed, where it is open"],
        ),
        (
            'take("rack"), take("nest"), put("bin"), loader.home()',
            ["has jaw take hold of a part at nest while it holds one from rack"],
        ),
    ],
)
def test_an_arm_that_cells_share_does_not_silence_it(tmp_path: Path, body: str, wrong: list[str]) -> None:
    decorator = '"try", ends_with={"drawer": 0}'
    assert warned(tmp_path, body, decorator) == wrong
    with (tmp_path / "recipes.py").open("a", encoding="utf-8") as file:
        file.write(LOOKS)
    (tmp_path / "plant.yaml").write_text(SHARED, "utf-8")
    where = f"{tmp_path / 'recipes.py'}:4:1: lab: try "
    shared = advance_check.warnings(load(tmp_path / "plant.yaml"))
    assert [each.partition("; write ")[0] for each in shared] == [where + each for each in wrong]


PROBE = """
  probe:
    facts: {out: bool}
    verbs: {stab: {effect: motion, sets: {out: true}}, draw: {effect: motion, sets: {out: false}}}
cells:"""


def shut_out(folder: Path, zone: str) -> list[str]:
    """What is said of a reader that closes before a probe comes out where the reader's zone is."""
    written(folder, "", '"try"')
    device = "reader: {kind: reader}"
    plant = PLANT.replace("\ncells:", PROBE).replace(device, f"{device}\n      probe: {{kind: probe}}")
    (folder / "plant.yaml").write_text(plant.replace("free_while: {reader: {lid: open}}}", zone), "utf-8")
    code = (folder / "recipes.py").read_text("utf-8")
    doing = 'reader.close(), cell.device("probe").stab(), cell.device("probe").draw(), reader.open()'
    (folder / "recipes.py").write_text(code.replace("work()", f"work({doing})"), "utf-8")
    return list(advance_check.warnings(load(folder / "plant.yaml")))


def test_two_devices_that_shut_each_other_out_of_one_zone_are_told(tmp_path: Path) -> None:
    (found,) = shut_out(tmp_path, "free_while: {reader: {lid: open}, probe: {out: false}}}")
    assert found.endswith(
        "has probe stab in the zone in_the_reader, which reader keeps while lid of reader is closed; "
        "it has to be open, or each has a zone of its own"
    )


def test_two_devices_with_a_zone_each_are_not_in_each_others_way(tmp_path: Path) -> None:
    second = "  beside: {poses: [lab drawer], free_while: {probe: {out: false}}}"
    assert shut_out(tmp_path, f"free_while: {{reader: {{lid: open}}}}}}\n{second}") == []


def test_what_a_recipe_says_of_its_end_counts(tmp_path: Path) -> None:
    left = '"try", ends_with={"drawer": 1, "reader.lid": "open"}'
    assert warned(tmp_path, f"{INTO}, reader.open(), loader.home()", left) == []
    assert warned(tmp_path, f"{INTO}, loader.home()", left) == [
        "ends with reader.lid closed, and says that it ends with open"
    ]


@pytest.mark.parametrize(
    ("body", "decorator", "told"),
    [
        (
            'take("rack"), loader.visit("nest", jaw.open()), loader.home()',
            '"try"',
            "jaw.gripped false, 1 fewer at rack, 1 more at nest, loader at home",
        ),
        (f"seen, {WAYS % ('reader.close()', 'reader.open()')}", '"try"', "nothing that is certain"),
        ("reader.open()", '"try", ends_with={"reader.lid": "open"}', "reader.lid open (it says so)"),
    ],
    ids=["parts and robots", "ways that differ", "what the recipe says"],
)
def test_the_end_of_a_recipe_is_what_all_its_ways_leave(
    tmp_path: Path, body: str, decorator: str, told: str
) -> None:
    (found,) = advance_check.ends(written(tmp_path, body, decorator))
    assert found == f"lab: try ends with {told}"


def test_a_number_of_parts_that_people_begin_with_is_compared_with_what_the_recipe_says(
    tmp_path: Path,
) -> None:
    body = 'take("rack"), loader.visit("bin", jaw.open()), loader.home()'
    assert warned(tmp_path, body, '"try", ends_with={"bin": 1, "rack": 0}') == []
    assert warned(tmp_path, body, '"try", ends_with={"bin": 0}') == [
        "ends with bin 1, and says that it ends with 0"
    ]


def test_a_part_that_stays_is_compared_with_what_the_recipe_says_however_many_were_there(
    tmp_path: Path,
) -> None:
    assert warned(tmp_path, f"{INTO}, loader.home()", '"try", ends_with={"drawer": 0}') == [
        "ends with drawer 1, and says that it ends with 0"
    ]
    assert warned(tmp_path, f"{INTO}, {OUT}", '"try", ends_with={"drawer": 0}') == []


def test_who_goes_into_a_zone_has_seen_what_lets_it_in(tmp_path: Path) -> None:
    wrong = warned(tmp_path, 'take("rack"), put("drawer"), seen, take("drawer"), put("bin"), loader.home()')
    assert wrong == ["has reader read, which needs lid of reader to be closed, where it is open"]


def test_who_goes_into_a_zone_knows_nothing_of_what_no_verb_tells(tmp_path: Path) -> None:
    model = written(tmp_path, 'take("rack"), put("drawer"), seen, take("drawer"), put("bin")', '"try"')
    told = PLANT.replace("sets: {lid: open}", "takes_s: 1").replace("sets: {lid: closed}", "takes_s: 1")
    (tmp_path / "plant.yaml").write_text(told, "utf-8")
    assert any("which needs" in each for each in advance_check.warnings(model))
    assert not any("which needs" in each for each in advance_check.warnings(load(tmp_path / "plant.yaml")))


def test_a_part_goes_back_to_a_target_whose_pose_has_another_name(tmp_path: Path) -> None:
    """In a cell of an arm and a mobile robot the target `pickup_a` is the pose `pick-up A`."""
    code = """
from arboleda.recipes import Path, Pick, Place, Slot, recipe, work

@recipe("try")
def attempt(cell, path=Path(), station=Slot("stations")):
    arm, mobile = cell.devices("arm", "mobile")
    pickup = cell.handover(path)
    arm.brings_back_to(pickup)
    return work(mobile.follow(path), arm.tour(Pick(pickup), Place(station), "home"))
"""
    assert advance_check.warnings(read(tmp_path, STORAGE, code)) == ()


ADVICE = {
    "a need": (f"{INTO}, reader.open(), seen, {OUT}", "reader.close() before"),
    "a door": (f'reader.close(), take("rack"), put("drawer"), {OUT}', ""),
    "a robot in the way": (
        'take("rack"), reader.open(), loader.visit("drawer", jaw.open(), reader.close()), ' + OUT,
        "loader.home() before",
    ),
    "a part left": ('take("rack"), loader.home()', 'ends_with={"jaw.gripped": True} if that is meant'),
    "a part more": (f"{INTO}, loader.home()", 'ends_with={"drawer": 1} if that is meant'),
    "two ends": (f"seen, {WAYS % ('reader.close()', 'reader.open()')}", "reader.close() on each way"),
    "a retry": ("cell.retry(reader.open(), times=1000)", "cell.timeout(step, seconds) around it"),
}


@pytest.mark.parametrize(("body", "advice"), ADVICE.values(), ids=ADVICE)
def test_a_warning_ends_with_what_to_write_in_python(tmp_path: Path, body: str, advice: str) -> None:
    assert advice in advised(tmp_path, body)


def test_what_an_advice_says_can_be_written(tmp_path: Path) -> None:
    decorator = '"try", ends_with={"drawer": 1}'
    assert warned(tmp_path, f"{INTO}, loader.home()", decorator) == []


NUMBERS = plant_text(__file__, "advance_check_numbers")
CHOICES = """
from arboleda.recipes import recipe, work

@recipe("try")
def attempt(cell):
    scale, gate = cell.devices("scale", "gate")
    asked, left, right, pin = scale.%s(), gate.turn(to="left"), gate.turn(to="right"), gate.pin()
    return work(asked, cell.choose(asked, %s), cell.choose(asked, %s))
"""
BY_120 = '{"> 120": left, "otherwise": right}'
BY_150 = '{"> 150": [], "> 120 and <= 150": %s, "otherwise": %s}'


@pytest.mark.parametrize(
    ("verb", "first", "then", "is_sound"),
    [
        ("weigh", BY_120, BY_150 % ("pin", "[]"), True),
        ("weigh", BY_120, BY_150 % ("[]", "pin"), False),
        ("look", '{"good": left, "bad": right}', '{"bad": [], "good": pin}', True),
        ("look", '{"good": left, "bad": right}', '{"bad": pin, "good": []}', False),
    ],
)
def test_two_choices_by_one_question_go_by_the_same_answer(
    tmp_path: Path, verb: str, first: str, then: str, *, is_sound: bool
) -> None:
    found = advance_check.warnings(read(tmp_path, NUMBERS, CHOICES % (verb, first, then)))
    assert ["which needs at of gate to be left" in each for each in found] == [True] * (not is_sound)
