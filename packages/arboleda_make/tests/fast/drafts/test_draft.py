"""Drafts of a plant's files: edits, undo and redo, what changed in words, and the check of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.plant_files import PlantFiles
from arboleda.plant_check import draft_check
from arboleda.plant_file.draft import Shade
from arboleda.plant_file.loader import load_with_files
from arboleda.plant_file.yaml_edit import EditRefused
from arboleda_make.drafts.draft import MOST_BYTES, MOST_STEPS, Draft, draft_of
from arboleda_make.versions.changes import changes

FOLDER = Path(__file__).parents[5] / "examples/own_tree"
VISE = ("cells", "cell", "targets", "vise", "loader")
POSE = {"deg": [-75.5, -60.58], "mm": 80, "approach_mm": 40}


@pytest.fixture(scope="module")
def empty() -> Draft:
    names = ("plant.yaml", "tend.xml")
    contents = {name: (FOLDER / name).read_bytes() for name in names}
    return draft_of(PlantFiles(plant="plant.yaml", contents=contents))


def words(draft: Draft) -> list[str]:
    return [each.words for each in draft.changes]


def test_a_target_is_changed_with_its_line_alone_and_said_with_both_poses(empty: Draft) -> None:
    draft = empty.with_value(VISE, POSE)
    assert words(draft) == [
        "cell cell, target vise of loader: from deg (-75.52, -60.58), mm 80, approach_mm 40"
        " to deg (-75.5, -60.58), mm 80, approach_mm 40"
    ]
    rows = zip(
        *(each.contents["plant.yaml"].splitlines() for each in (empty.files, draft.files)), strict=True
    )
    assert sum(before != after for before, after in rows) == 1


def test_a_target_is_new_and_another_gone(empty: Draft) -> None:
    draft = empty.with_value((*VISE[:3], "tray"), {"loader": {"deg": [1, 2]}}).without((*VISE[:3], "done"))
    assert words(draft) == [
        "cell cell, target done of loader: gone, it was deg (-21.31, 107.91), mm 80, approach_mm 40",
        "cell cell, target tray of loader: new, deg (1, 2)",
    ]


LAMP = {"facts": {"lit": "bool"}, "verbs": {"shine": {"effect": "switch", "sets": {"lit": True}}}}


def test_a_device_its_kind_and_a_cell_are_said_without_their_text(empty: Draft) -> None:
    place = ("cells", "cell", "devices", "lamp")
    draft = empty.with_values(
        [(("kinds", "lamp"), LAMP), (place, {"kind": "lamp", "driver": {"modbus": {}}})]
    )
    new = [
        "new kind lamp: says lit; does shine",
        "new device lamp of cell: lamp with shine, reached by modbus",
    ]
    assert words(draft) == new
    more = draft_of(draft.files).with_value(("kinds", "lamp", "verbs", "shine", "takes_s"), 2)
    assert words(more.with_value((*place, "evidence"), "state").without((*place, "driver"))) == [
        "kind lamp, shine.takes_s: new, 2",
        "cell cell, driver of lamp: gone, it was modbus",
        "cell cell, evidence of lamp: new, state",
    ]
    gone = draft_of(draft.files).without(place).without(("kinds", "lamp"))
    assert words(gone) == ["kind lamp is gone", "device lamp of cell is gone"]
    other = empty.with_value(("cells", "dark"), {"devices": {"arm": {"kind": "arm"}}})
    assert words(other) == ["new cell dark with arm"]
    assert words(draft_of(other.files).without(("cells", "dark"))) == ["cell dark is gone"]


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        (b"a: 1\nb: {c: 2}\n", b"# why\na: 1\nb:\n  c: 2\n", []),
        (b"a: 1\n", b"a: 2\n", ["a: from 1 to 2"]),
        (b"a: [1]\n", b"b: x y\n", ["a: gone, it was 1", "b: new, x y"]),
        (b"a: [b, c]\n", b"a: [c]\n", ["a: gone, b"]),
        (b"a: [b, c]\n", b"a: [c, d]\n", ["a: from b, c to c, d"]),
        (b"a: [b, c]\n", b"a: [c, b]\n", ["a: from b, c to c, b"]),
        (b"a: [b, c]\n", b"a: [c, b, d]\n", ["a: from b, c to c, b, d"]),
        (b"a: [b, c]\n", b"a: [b, c, c, d]\n", ["a: from b, c to b, c, c, d"]),
        (b"a: [b]\n", b"a: []\n", ["a: gone, b"]),
        (
            b"zones: {a: {}}",
            b"zones: {a: {poses: [], b: {m: {d: o}}}}",
            ["zone a, poses: new, nothing", "zone a, b: new, m (d o)"],
        ),
        (
            b"cells: {a: {}}",
            b"cells: {a: {places: {b: {supply: true, holds: 2}}}}",
            ["cell a, places: new, b (supply, holds 2)"],
        ),
        (b"a: 1\n", b"a: [\n", ["p.yaml: changed"]),
        (b"a: 1\n", b"a: " + b"x" * 500, ["a: from 1 to " + "x" * 37 + "... (500 characters)"]),
    ],
)
def test_values_are_compared_and_layout_is_not(before: bytes, after: bytes, said: list[str]) -> None:
    files = [PlantFiles(plant="p.yaml", contents={"p.yaml": each}) for each in (before, after)]
    assert [each.words for each in changes(*files)] == said


def test_trees_are_compared_by_name_and_other_files_as_a_whole() -> None:
    def tree(name: str, node: str) -> bytes:
        return b'<root BTCPP_format="4"><BehaviorTree ID="%s"><%s/></BehaviorTree></root>' % (
            name.encode(),
            node.encode(),
        )

    before = {"p": b"a: 1", "t.xml": tree("A", "Load"), "u.xml": tree("B", "Load"), "r.py": b"1", "o": b""}
    after = {"p": b"a: 1", "t.xml": tree("A", "Look"), "u.xml": tree("C", "Load"), "r.py": b"2", "n": b""}
    files = [PlantFiles(plant="p", contents=each) for each in (before, after)]
    assert [each.words for each in changes(*files)] == [
        "n: new",
        "o: gone",
        "r.py: changed",
        "t.xml, tree A: changed",
        "u.xml, tree C: new",
        "u.xml, tree B: gone",
    ]


def test_undo_and_redo_lead_through_all_steps(empty: Draft) -> None:
    first = empty.with_value(VISE, POSE)
    second = first.with_trees("more.xml", b"<root/>")
    assert second.undo().files == first.files and second.undo().undo().files == empty.files
    assert second.undo().undo().redo().redo().files == second.files
    assert second.undo().undo().changes == ()
    for refused in (empty.undo, second.redo):
        with pytest.raises(EditRefused, match="nothing to"):
            refused()


def test_a_step_after_an_undo_forgets_what_was_undone(empty: Draft) -> None:
    other = empty.with_value(VISE, POSE).undo().with_value(("timing", "dwell_s"), 1)
    assert words(other) == ["timing: new, dwell_s 1"]
    with pytest.raises(EditRefused, match="nothing to redo"):
        other.redo()


def test_a_step_that_changes_nothing_is_none(empty: Draft) -> None:
    assert empty.with_value(("name",), "own_tree") == empty


def test_old_steps_are_forgotten(empty: Draft) -> None:
    draft = empty
    for number in range(MOST_STEPS + 5):
        draft = draft.with_trees("t.xml", b"%d" % number)
    assert len(draft.past) == MOST_STEPS


def test_steps_are_kept_as_long_as_all_of_them_fit(empty: Draft) -> None:
    draft, large = empty, 1024 * 1024
    for number in range(80):
        draft = draft.with_trees("t.xml", bytes([number]) * large)
    assert 60 <= len(draft.past) <= MOST_BYTES // large
    assert draft.undo().files.contents["t.xml"][0] == 78


@pytest.mark.parametrize(
    "name",
    ["recipes.py", "../t.xml", "/etc/t.xml", "t.xml/..", "a\\t.xml", ".xml", "t\n.xml", "-t.xml", ".t.xml"],
)
def test_only_trees_within_the_folder_are_written(empty: Draft, name: str) -> None:
    with pytest.raises(EditRefused, match="no file of trees"):
        empty.with_trees(name, b"<root/>")


@pytest.mark.parametrize("name", ["plant.yaml", ".arboleda/t.xml"])
def test_neither_the_plant_file_nor_a_version_is_a_file_of_trees(empty: Draft, name: str) -> None:
    with pytest.raises(EditRefused, match="no file of trees"):
        empty.with_trees(name, b"<root/>")


@pytest.mark.parametrize("word", ["mine.py", "os", "my_lab.recipes", "../x.xml", "/tmp/x.xml"])
def test_no_draft_has_a_plant_use_python_that_it_did_not_use(empty: Draft, word: str) -> None:
    for place, value in ((("uses", 1), word), (("uses",), [word])):
        with pytest.raises(EditRefused, match="no file of trees"):
            empty.with_value(place, value)


def test_python_that_is_used_stays_used(empty: Draft) -> None:
    text = empty.files.contents["plant.yaml"].replace(b"[tend.xml]", b"[recipes.py, tend.xml]")
    contents = {**empty.files.contents, "plant.yaml": text}
    draft = draft_of(PlantFiles(plant="plant.yaml", contents=contents)).with_value(("uses", 2), "more.xml")
    assert words(draft) == ["uses: new, more.xml"]


def test_a_file_of_trees_is_not_too_large_and_a_gone_one_was_there(empty: Draft) -> None:
    with pytest.raises(EditRefused, match="larger than"):
        empty.with_trees("t.xml", b" " * 10_000_000)
    with pytest.raises(EditRefused, match="no file of this plant"):
        empty.without_trees("t.xml")
    assert words(empty.without_trees("tend.xml")) == ["tend.xml: gone"]


def test_a_draft_is_checked_beside_the_other_files_and_nothing_is_written(empty: Draft) -> None:
    before = {each: each.read_bytes() for each in FOLDER.iterdir() if each.is_file()}
    found = draft_check.check(empty.with_value(VISE, POSE).files, FOLDER / "plant.yaml")
    assert found.problems == () and found.plant is not None
    assert found.plant.name == "own_tree"
    assert {each: each.read_bytes() for each in FOLDER.iterdir() if each.is_file()} == before


def test_what_check_refuses_is_named_by_the_real_file_with_its_line(empty: Draft) -> None:
    plant = FOLDER / "plant.yaml"
    found = draft_check.check(empty.with_value((*VISE, "deg", 0), 500).files, plant)
    line = 1 + [each.strip()[:4] for each in plant.read_bytes().decode().splitlines()].index("vise")
    assert found.plant is None
    assert found.problems[0].startswith(f"{plant}:{line}:") and "500" in found.problems[0]


def test_what_check_refuses_can_be_named_as_the_draft_names_it(tmp_path: Path) -> None:
    (tmp_path / "cells").mkdir()
    plant = tmp_path / "cells/plant.yaml"
    plant.write_text("cells: {a: {devices: {b: c}}}\n")
    files = PlantFiles(plant="cells/plant.yaml", contents={"cells/plant.yaml": plant.read_bytes()})
    (problem, *_) = draft_check.check(files, plant, Shade.shortened).problems
    assert problem.startswith("cells/plant.yaml:1:")


def test_a_mistake_in_a_tree_is_named_by_the_real_file(empty: Draft) -> None:
    draft = empty.with_trees("tend.xml", empty.files.contents["tend.xml"].replace(b"<Retry", b"<Rety"))
    found = draft_check.check(draft.files, FOLDER / "plant.yaml")
    assert found.plant is None and found.problems[0].startswith(f"{FOLDER / 'tend.xml'}:")


def test_files_above_the_plant_file_keep_their_places(tmp_path: Path) -> None:
    (tmp_path / "cells").mkdir()
    text = (FOLDER / "plant.yaml").read_text().replace("[tend.xml]", "[../tend.xml]")
    (tmp_path / "cells/plant.yaml").write_text(text)
    (tmp_path / "tend.xml").write_bytes((FOLDER / "tend.xml").read_bytes())
    _, files = load_with_files(tmp_path / "cells/plant.yaml")
    draft = draft_of(files).with_value(VISE, POSE)
    assert draft_check.check(draft.files, tmp_path / "cells/plant.yaml").problems == ()
    assert sorted(files.contents) == ["cells/plant.yaml", "tend.xml"]


def test_a_new_file_of_trees_is_used_by_the_plant_and_undone_in_one_step(empty: Draft) -> None:
    drawn = empty.with_recipe("pick.xml", b"<root/>")
    assert drawn.files.contents["plant.yaml"].count(b"uses: [tend.xml, pick.xml]") == 1
    assert drawn.undo().files == empty.files
    assert drawn.with_recipe("pick.xml", b"<root />").files.contents["plant.yaml"].count(b"pick.xml") == 1
    gone = drawn.without_recipe("pick.xml")
    assert gone.files == empty.files and len(gone.past) == 2
    assert b"uses" not in empty.without_recipe("tend.xml").files.contents["plant.yaml"]
