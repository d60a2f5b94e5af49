"""Views of an editor: the nodes of a file, the words of the check on each, a palette for each cell."""

from __future__ import annotations

from pathlib import Path

import pytest
from packages.arboleda_make.tests.fast.editing.corpus import HERE, texts
from packages.arboleda_trees.tests.fast.bt_xml.findings import mistakes, tree, warnings

from arboleda.plant_file import loader
from arboleda.web.languages import LANGUAGES, contents
from arboleda_make.editing import desk
from arboleda_make.editing.errors import EditError
from arboleda_make.editing.marks import marks
from arboleda_make.editing.picture import picture
from arboleda_make.editing.tree_text import TreeText
from arboleda_trees.bt_xml.nodes import BUILT_IN
from arboleda_trees.bt_xml.runnable import INSTEAD

OWN_TREE = HERE / "examples/own_tree/plant.yaml"


@pytest.mark.long
def test_every_node_is_shown_and_every_finding_of_the_check_has_its_sentence() -> None:
    for text in texts():
        there = TreeText(text)
        shown = picture(there, {})
        assert [each["name"] for each in shown] == list(there.trees)
        for each in marks(there, {}):
            assert each["sentence"]
            assert each["path"] is None or each["tree"] in there.trees


@pytest.mark.parametrize(
    ("body", "path", "attribute", "words"),
    [
        ('<Sequence><Sleep msec="soon"/></Sequence>', "0", "msec", "must be a whole number"),
        ("<Sequence><Inverter/></Sequence>", "0", None, "has no children"),
        ('<Sequence><Action ID="Run" at="1"/><Repeat num_cycles="2"/></Sequence>', "1", None, "needs 1"),
        ("<ManualSelector><AlwaysSuccess/></ManualSelector>", "root", None, "ask a person"),
        ('<Script code="x := "/>', "root", "code", "a value or a variable is expected"),
        ("", "", None, "has 0 nodes below it"),
        ('<Sequence><SubTree ID="Gone"/></Sequence>', "0", "ID", "is in none of these files"),
    ],
)  # fmt: skip
def test_a_finding_is_on_its_node(body: str, path: str, attribute: str | None, words: str) -> None:
    kinds = BUILT_IN if "Run" not in body else {**BUILT_IN, "Run": BUILT_IN["AlwaysSuccess"]}
    found = marks(TreeText(tree(body)), kinds)
    there = [each for each in found if (each["path"], each["attribute"]) == (path, attribute)]
    assert any(words in each["sentence"] for each in there), found


def test_marks_are_the_words_of_the_terminal() -> None:
    text = tree('<Sequence x="1"><AlwaysFailure/><Sleep msec="{never}"/></Sequence>')
    lines = {line.partition(": ")[2].removeprefix("warning: ") for line in [*mistakes(text), *warnings(text)]}
    assert {each["sentence"] for each in marks(TreeText(text), {}, "t.xml")} == lines


def test_a_node_says_what_may_stand_in_it_however_it_is_written() -> None:
    body = '<Control ID="Mine" x="1"><Decorator ID="Odd"><SubTreePlus ID="Two"/></Decorator><Foo/></Control>'
    (shown,) = picture(TreeText(tree(body)), {})
    rows = {row["path"]: (row["kind"], row["category"], row["most"], row["known"]) for row in shown["nodes"]}
    assert rows == {
        "root": ("Mine", "Control", 1000, False),
        "0": ("Odd", "Decorator", 1, False),
        "0.0": ("SubTree", "SubTree", 0, True),
        "1": ("Foo", "Action", 0, False),
    }
    assert shown["nodes"][0]["attributes"] == {"x": "1"} and shown["nodes"][2]["attributes"] == {"ID": "Two"}


def test_the_main_tree_and_the_parameters_of_each_are_shown() -> None:
    model = loader.load(OWN_TREE)
    (file,) = desk.tree_files(model)
    shown = desk.drawn(model, "cell", file["text"])
    assert [(each["name"], each["main"]) for each in shown["trees"]][:2] == [("Tend", True), ("Carry", False)]
    assert [each["name"] for each in shown["trees"][0]["parameters"]] == ["blank", "program"]
    with pytest.raises(EditError, match="is not a cell"):
        desk.drawn(model, "other", file["text"])


@pytest.mark.parametrize("language", LANGUAGES)
def test_each_kind_that_comes_with_arboleda_is_explained(language: str) -> None:
    words = contents(language, "nodes")
    assert {f"kind.{name}" for name in BUILT_IN if name not in INSTEAD} <= set(words)
    assert set(words) == set(contents("en", "nodes"))


def test_the_palette_has_all_that_the_devices_of_a_cell_make() -> None:
    plant = Path(HERE / "examples/own_tree/plant.yaml")
    groups = desk.palette(loader.load(plant), "cell", {"device.run": "It runs."})
    names = {each["name"]: [kind["name"] for kind in each["kinds"]] for each in groups if each["name"]}
    assert list(names) == ["loader", "jaw", "mill", "camera", "operator"]
    assert "mill_says" in names["mill"] and "operator_ask" in names["operator"]
    (run,) = [kind for each in groups for kind in each["kinds"] if kind["name"] == "mill_run"]
    assert run["about"] == "It runs." and run["ports"][0]["words"] == ["1001", "1002"]
    (usual,) = [each["kinds"] for each in groups if each["sort"] == "usual"]
    all_names = [kind["name"] for each in groups for kind in each["kinds"]]
    assert len(usual) == 12 and len(all_names) == len(set(all_names))
