"""Mends: edits as data, looked for by trying; nothing is proposed that makes a plant no better."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.plant_check.check_answer import check_answer
from arboleda.plant_check.findings import Source, checked
from arboleda.plant_check.mend import Cut, Edit, MendRefused, cut_between, edit_of, edited
from arboleda_make.mending.clues import clues_of
from arboleda_make.mending.plant_edits import plant_candidates
from arboleda_make.mending.python_source import PythonSource
from arboleda_make.mending.search import mend_of, texts_of

BENCH = Path(__file__).parents[5] / "examples" / "lab_bench"
TEXTS = {"a.py": "one\ntwo\n"}
RECIPE = """
def told(cell, number):
    heater, cart = cell.devices("heater", f"cart_{number}")
    return work(parallel(heater.open(), cart.home()), cart.visit("nest", heater.close()))
"""


def planted(folder: Path, *edits: tuple[str, str, str]) -> Path:
    """The plant file of the bench in a folder, with mistakes in its files."""
    shutil.copytree(BENCH, folder, dirs_exist_ok=True)
    for name, old, new in edits:
        text = (folder / name).read_text()
        assert text.count(old) == 1
        (folder / name).write_text(text.replace(old, new))
    return folder / "plant.yaml"


def test_an_edit_says_where_it_goes_and_fits_no_other_text() -> None:
    edit = edit_of(TEXTS, Cut(file="a.py", start=5, end=6, new="W"))
    assert edit == Edit(file="a.py", line=2, column=2, old="w", new="W")
    assert edited(TEXTS, [edit]) == {"a.py": "one\ntWo\n"}
    for other in ({"a.py": "one\nten\n"}, {"b.py": "one\ntwo\n"}):
        with pytest.raises(MendRefused, match="there is no 'w' any more"):
            edited(other, [edit])


def test_edits_of_one_text_count_their_places_before_any_of_them() -> None:
    cuts = [Cut(file="a.py", start=start, end=start, new="-") for start in (0, 4)]
    assert edited(TEXTS, [edit_of(TEXTS, each) for each in cuts]) == {"a.py": "-one\n-two\n"}


@pytest.mark.parametrize(("old", "new"), [("abc", "abxc"), ("abab", "ab"), ("a", "b"), ("", "x"), ("x", "x")])
def test_the_shortest_cut_between_two_texts_makes_one_the_other(old: str, new: str) -> None:
    cut = cut_between("a", old, new)
    assert old[: cut.start] + cut.new + old[cut.end :] == new


def test_a_step_is_put_where_there_is_room_for_steps_and_a_device_has_its_name_there() -> None:
    source = PythonSource("a.py", RECIPE)
    by_text = {source.source(each.node): each for each in source.elements}
    alone, visit = by_text["heater.open()"], by_text['cart.visit("nest", heater.close())']

    def changed(cuts: tuple[Cut, ...]) -> str:
        return edited({"a.py": RECIPE}, [edit_of({"a.py": RECIPE}, each) for each in cuts])["a.py"]

    assert "parallel(work(x(), heater.open()), cart" in changed(source.before(alone, "x()"))
    assert 'cart.home()), x(), cart.visit("nest"' in changed(source.before(visit, "x()"))
    assert 'cart.visit("nest"))' in changed(source.without(by_text["heater.close()"]))
    names = [source.handle_of(role, alone.function) for role in ("heater", "cart_2", "pump")]
    assert names == ["heater", "cart", 'cell.device("pump")']


def test_a_plant_with_nothing_wrong_has_no_mend() -> None:
    answer = check_answer(BENCH / "plant.yaml", mending=mend_of, apart=False)
    assert answer.findings == () and answer.mend is None


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("name", "old", "new", "source"),
    [
        ("recipes.py", "heater.open(), heater", "heater", Source.WARNING),
        ("recipes.py", '"blank": pump', '"blanc": pump', Source.PROBLEM),
        ("plant.yaml", "sets: {lid: closed}, takes_s", "sets: {lid: open}, takes_s", Source.WARNING),
    ],
)
def test_what_mends_a_mistake_is_an_edit_after_which_nothing_is_found(
    tmp_path: Path, name: str, old: str, new: str, source: Source
) -> None:
    file = planted(tmp_path, (name, old, new))
    answer = check_answer(file, mending=mend_of, apart=False)
    assert {each.source for each in answer.findings} == {source} and answer.mend is not None
    assert answer.mend.left == 0 and {each.file for each in answer.mend.edits} == {name}
    (tmp_path / name).write_text(edited(texts_of(file), answer.mend.edits)[name])
    assert check_answer(file, mending=mend_of, apart=False).findings == ()


def test_a_rule_of_the_plant_is_never_changed_for_a_recipe_that_breaks_it(tmp_path: Path) -> None:
    file = planted(tmp_path, ("plant.yaml", "needs: {lid: closed,", "needs: {lid: open,"))
    look = checked(file, apart=False)
    text = file.read_text()
    found = [*plant_candidates(file.name, text, look.model, clues_of(look.findings, look.model))]
    assert look.findings and found == []


def test_what_cannot_be_mended_has_no_mend(tmp_path: Path) -> None:
    answer = check_answer(
        planted(tmp_path, ("plant.yaml", "uses: [recipes.py]", "uses: []")), mending=mend_of, apart=False
    )
    assert answer.findings and answer.mend is None


def test_check_answers_as_data_and_in_words(tmp_path: Path) -> None:
    file = planted(tmp_path / "bench", ("recipes.py", "heater.open(), heater", "heater"))
    out = tmp_path / "out.json"
    shown = CliRunner().invoke(cli, ["check", str(file), "--mend", "--json", str(out)])
    data = json.loads(out.read_text())
    assert shown.exit_code == 0 and f"mend: {data['mend']['sentence']}" in shown.stdout
    assert data["findings"][0]["file"] == "recipes.py" and data["mend"]["edits"][0]["old"] == ""
    alone = CliRunner().invoke(cli, ["check", str(file), "--json", "-"])
    assert json.loads(alone.stdout) == {**data, "mend": None}


TREE = """<root BTCPP_format="4" main_tree_to_execute="Warm">
  <BehaviorTree ID="Warm">
    <Sequence>
      <heater_open/>
      <heater_clamp on="true"/>
      <heater_heat celsius="40"/>
      <heater_heat celsius="20"/>
      <heater_open/>
      <heater_clamp on="false"/>
    </Sequence>
  </BehaviorTree>
  <TreeNodesModel>
    <SubTree ID="Warm"><MetadataFields><Metadata ends_with="heater.lid: open"/></MetadataFields></SubTree>
  </TreeNodesModel>
</root>
"""


@pytest.mark.long
def test_a_tree_gets_the_step_that_it_lacks(tmp_path: Path) -> None:
    file = planted(tmp_path, ("plant.yaml", "uses: [recipes.py]", "uses: [recipes.py, warm.xml]"))
    (tmp_path / "warm.xml").write_text(TREE)
    mend = check_answer(file, mending=mend_of, apart=False).mend
    assert mend is not None and mend.left == 0
    assert [each.new.strip() for each in mend.edits] == ["<heater_close/>"]
