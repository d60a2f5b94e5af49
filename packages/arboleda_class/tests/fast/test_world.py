"""Plant in a notebook: its tree, its twin, its events, and mistakes as sentences."""

from __future__ import annotations

import sys
from pathlib import Path
from xml.etree import ElementTree as Xml

import pytest
from py_trees.behaviours import Success
from py_trees.composites import Sequence
from tests.unit.kinds.tending import plant

import arboleda_proofs.testing
from arboleda.recipes import Kit, recipe, work
from arboleda.testing import shipped
from arboleda_class.notebook import Drawing, World
from arboleda_class.notebook.drawn import Happening, Table
from arboleda_proofs.testing import Misuse


@recipe("there")
def there(cell: Kit):  # type: ignore[no-untyped-def]
    left = cell.device("left")
    return work(left.go("feed_2"), left.home())


@pytest.fixture
def world() -> World:
    """A world of one shipped cell."""
    return World(shipped("sis_a"))


def words(drawing: Drawing) -> list[str | None]:
    """The texts in a drawing; it is one SVG document that names no other."""
    root = Xml.fromstring(drawing._repr_svg_())
    assert root.tag == "{http://www.w3.org/2000/svg}svg" and "href" not in drawing.svg
    return [each.text for each in root.iter("{http://www.w3.org/2000/svg}text")]


def test_a_step_ends_with_the_next_news_and_returns_it(world: World) -> None:
    world.submit("sis_a 0B 7")
    (row,) = world.step("sis_a")
    assert (row.kind, row.subject, row.sentence, row.at) == ("step", "sis_a", "drive path 0B", world.now)
    assert world.step()[-1].sentence == "move to pick-up"
    assert world.step()[-1].at == world.now


def test_a_step_without_news_takes_its_time_and_returns_nothing(world: World) -> None:
    assert world.step(at_most=3.0) == []
    assert world.now == pytest.approx(3.0)
    assert repr(world.step(at_most=3.0)) == "Nothing new has happened."


def test_a_step_of_a_cell_goes_on_past_the_news_of_others() -> None:
    world = World(shipped("sis_a", "sis_b"))
    world.submit("sis_b 0B 7")
    assert world.step("sis_a", at_most=1.0)[-1].cell == "sis_b"
    assert world.now == pytest.approx(1.0)


def test_the_table_has_tasks_steps_cells_and_faults_in_their_order(world: World) -> None:
    task = world.submit("sis_a 0B 7")
    world.fault("mute", "ra1", at=0.1, seconds=3.0)
    world.run(until=lambda: task.ended)
    table = world.table()
    assert [row.at for row in table] == sorted(row.at for row in table)
    faults = [(row.what, row.sentence) for row in table if row.kind == "fault"]
    muted = "ra_1: Its board is not heard, for 3.000 s"
    assert faults == [("begins", muted), ("over", muted)]
    assert {"task", "step", "cell", "robot", "fault"} <= {row.kind for row in table}
    assert [row.what for row in table if row.kind == "task"] == ["running", task.state]


def test_the_tree_is_drawn_while_its_task_runs_and_as_it_was_when_it_has_ended(world: World) -> None:
    assert "No task has run in sis_a yet." in words(world.tree("sis_a"))
    task = world.submit("sis_a 0B 7")
    world.run(until=lambda: world.cell("sis_a").step == "move to station 7")
    assert "move to station 7" in words(world.tree("sis_a"))
    assert "--> move to station 7 [*]" in str(world.tree("sis_a"))
    world.run(until=lambda: task.ended)
    assert "--> move to station 7 [o]" in str(world.tree("sis_a"))


def test_the_twin_has_each_device_where_it_truly_is(world: World) -> None:
    before = world.twin("sis_a")
    assert {"ra1", "rm_sis_a: node: 0"} <= set(words(before))
    task = world.submit("sis_a 0B 7")
    world.run(until=lambda: task.ended)
    assert "rm_sis_a: node: 7" in words(world.twin("sis_a"))
    assert world.twin("sis_a").svg != before.svg


def test_devices_without_a_place_are_told_in_words() -> None:
    assert "heater: lid: open, clamped: false, celsius: 20" in words(World("lab_bench").twin("bench"))


def test_the_world_shows_each_cell_with_its_tree_and_twin(world: World) -> None:
    world.submit("sis_a 0B 7")
    shown = world._repr_html_()
    assert world.tree("sis_a").svg in shown and world.twin("sis_a").svg in shown
    assert "sis_a" in shown and "execute" in repr(world)


def test_what_is_written_in_a_plant_cannot_be_markup() -> None:
    row = Happening(at=0.0, cell="<b>", kind="step", subject="", what="", sentence="<script>")
    shown = Table([row])._repr_html_()
    assert "<b>" not in shown and "<script>" not in shown
    assert words(Drawing.of_words("<script>")) == ["<script>"]


def test_in_spanish_the_table_and_the_tree_are_in_spanish() -> None:
    world = World("lab_bench", language="es")
    world.submit("bench weigh 5")
    assert "paso" in repr(world.table()) and "arranque del sistema" in str(world.tree("bench"))


def test_a_tree_of_ones_own_is_drawn_too() -> None:
    tree = Sequence("all", memory=True, children=[Success("one")])
    tree.tick_once()
    assert words(Drawing.of_tree(tree)) == ["all", "one"]
    assert str(Drawing.of_tree(tree)) == "{-} all [o]\n    --> one [o] -- success\n"


def test_a_mistake_is_shown_as_a_sentence_without_a_traceback(world: World) -> None:
    with pytest.raises(Misuse, match="did you mean 'lab_bench'") as missing:
        World("lab_bnch")
    assert missing.value._render_traceback_() == [str(missing.value)]
    with pytest.raises(AssertionError, match="did not come true in 1 s") as never:
        world.run(until=lambda: False, at_most=1.0)
    assert never.value._render_traceback_() == [str(never.value)]  # type: ignore[attr-defined]
    with pytest.raises(Misuse, match="a cell of this plant"):
        world.tree("sis_x")
    with pytest.raises(Misuse, match="a language"):
        World(language="xx")


def test_an_error_in_a_recipe_of_ones_own_is_a_sentence_with_its_kind() -> None:
    def broken(order: object, context: object) -> None:
        raise ZeroDivisionError("here")

    world = World(plant(there))
    world.recipe("there", broken)  # type: ignore[arg-type]
    with pytest.raises(AssertionError) as error:
        world.submit("tending there")
    (sentence,) = error.value._render_traceback_()  # type: ignore[attr-defined]
    assert "ZeroDivisionError in the tree: here" in sentence


def test_a_plant_that_dies_and_begins_anew_is_followed(world: World) -> None:
    task = world.submit("sis_a 0B 7")
    world.run(2.0)
    world.fault("plant_crash", seconds=1.0)
    world.run(10.0)
    assert [row.at for row in world.table() if row.what == "held"] == [pytest.approx(2.0)]
    assert world.operate("resume", "sis_a") is None
    world.run(20.0)
    last = world.table()[-1]
    assert (last.kind, last.what) == ("task", "done") and f"#{task.id}" in last.sentence


def test_names_of_before_are_there_with_a_warning_that_says_the_new_ones() -> None:
    with pytest.warns(DeprecationWarning, match="use `from arboleda_class.notebook import World`"):
        assert arboleda_proofs.testing.World is World


def test_without_this_package_they_are_refused_with_the_line_that_installs_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name in ("arboleda_class.notebook", "arboleda_class"):
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(sys, "path", [each for each in sys.path if not Path(each, "arboleda_class").is_dir()])
    refused = pytest.raises(ImportError, match=r"World needs .* type pip install 'arboleda\[class\]'")
    with pytest.warns(DeprecationWarning, match="World"), refused:
        arboleda_proofs.testing.World  # noqa: B018 - the name is looked up, as by `from ... import`


def test_in_spanish_nodes_of_lessons_and_faults_have_spanish_names() -> None:
    tree = Sequence("walk path", memory=True, children=[Success("move to station"), Success("polish")])
    drawn = str(Drawing.of_tree(tree, language="es"))
    assert "recorrer el camino" in drawn and "ir a la estación" in drawn and "polish" in drawn
    world = World(shipped("sis_a"), language="es")
    world.fault("reboot", "ra1", at=0.1)
    world.run(0.5)
    assert "ra_1: Reiniciar su placa" in str(world.table())
