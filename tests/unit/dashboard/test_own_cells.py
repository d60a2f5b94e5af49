"""What the page shows of a cell of any devices."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import partial

from arboleda.dashboard import trees
from arboleda.dashboard.faces import Face
from arboleda.dashboard.faces.links import says
from arboleda.dashboard.page_state import PageState
from arboleda.dashboard.tags import markup
from arboleda.dashboard.wording import words
from arboleda.model.messages import Event
from arboleda.model.plant_model import PlantModel
from arboleda.testing import shipped
from arboleda.views import view

from ..kinds.lab import Bench, model
from .conftest import LINKS
from .test_history import CUT


class Told(Bench):
    """A bench whose story is told at every step, as the page's feed does."""

    def __init__(self, plant: PlantModel) -> None:
        self.story = PageState(view.layout(plant), [])
        super().__init__(plant)

    def _pass(self, *events: Event) -> None:
        super()._pass(*events)
        self.story.see(view.snapshot(self.plant), 1000.0 + self.now)

    def face(self, language: str = "en") -> Face:
        face = self.story.face(language, LINKS)
        assert json.loads(json.dumps(face)) == face
        return face


def baking() -> Told:
    here = Told(model())
    here.submit("bench bake 10")
    assert here.wait(30.0, lambda: here.told[-1:] == ["oven bake"])
    here.wait(1.0)
    return here


def test_the_links_show_each_device_with_its_kind_and_its_facts() -> None:
    here = baking()
    here.plant.dispatcher.beliefs["oven"].facts.pop("dose")
    here.wait(0.1)
    texts = here.face()["row/links/oven"]["texts"]
    assert texts[:2] == ["oven", "oven"]
    assert "at work" in texts
    assert "lid closed, clamped yes, dose not told, holds a part" in texts
    assert here.face()["row/links/eye"]["cell"] == "bench"


def test_the_card_of_a_cell_shows_the_devices_that_no_drawing_shows() -> None:
    face = baking().face("es")
    assert face["rows/devices.bench"] == ["oven", "eye"]
    name, said, command = face["row/devices.bench/oven"]["texts"]
    assert (name, said) == ("oven", "lid closed, clamped sí, dose 5, sujeta una pieza")
    assert "bake 10" in command
    assert "(good)" in face["row/devices.bench/eye"]["texts"][2]


def test_the_card_and_the_task_show_what_was_answered() -> None:
    here = baking()
    face = here.face("es")
    (row,) = face["rows/heard.bench"]
    assert face[f"row/heard.bench/{row}"]["texts"] == ["eye", "look", "good"]
    here.outcome()
    after = here.face()
    assert (after["rows/heard.bench"], after["row/tasks/t-1000-1"]["heard"]) == ([], 1)
    task = here.story.task_face("t-1000-1", "en")
    assert task["row/task.heard/0"]["texts"] == ["eye", "look", "good"]


def test_a_task_that_only_the_history_knows_is_shown_as_it_was_kept() -> None:
    here = baking()
    heard = json.dumps([{"by": "eye", "asked": "look", "answer": True}])
    kept = replace(CUT, text="bench bake 5", cell="bench", answers=heard)
    face = here.story.task_face("lot1", "es", kept)
    assert face["text/task.title"][0] == "bench bake 5 #lot1"
    assert face["text/task.state"] == ["fallida", "failed"]
    assert "la planta terminó mientras esta estaba en marcha" in face["text/task.cause"][0]
    assert face["row/task.heard/0"]["texts"] == ["eye", "look", "sí"]
    assert "su árbol ya no está" in face["text/task.note"][0]
    assert "10 s" in face["text/task.when"][0]


def test_a_storage_cell_has_no_list_of_answers() -> None:
    here = Told(shipped("sis_a"))
    here.wait(1.0)
    assert not [key for key in here.face() if "heard." in key]


def test_an_effector_is_on_or_off_where_other_facts_are_so_or_not() -> None:
    row = {"facts": {"effector": False, "piece": True, "lid": "open"}, "holding": False, "holder": None}
    assert says(words("en"), row) == "effector off, piece yes, lid open"
    assert says(words("es"), row) == "efector apagado, pieza sí, lid open"


def test_the_bar_of_a_recipe_of_ones_own_grows_with_its_steps() -> None:
    here = Told(model())
    here.submit("bench bake 10")
    bars: list[float] = []
    while here.changes[-1].state.value != "done":
        here.wait(0.2)
        bars += [bar] if (bar := here.face()["bar/bench.progress"]) not in (None, *bars) else []
    assert bars == sorted(bars) and len(bars) >= 4
    snapshot = view.snapshot(baking().plant)["cells"][0]
    assert baking().face()["bar/bench.progress"] == round(snapshot["progress"], 3)


def test_the_failed_step_of_a_recipe_of_ones_own_is_named() -> None:
    here = Told(model())
    here.submit("bench careless")
    here.outcome()
    cause, state = here.face()["text/bench.cause"]
    assert state == "failed"
    assert cause.startswith('Failed in step "oven bake 5": oven needs lid to be closed')
    task = here.story.task_face("t-1000-1", "en")
    failed = [key for key, node in task.items() if key.startswith("node/#task") and node["failed"]]
    assert "node/#task/0.2" in failed


def test_there_is_no_twin_where_nothing_is_drawn() -> None:
    drawn = [markup(partial(trees.build, view.layout(each), words("en"))) for each in (model(), shipped())]
    assert ['id="twin"' in each for each in drawn] == [False, True]


def test_the_time_line_tells_of_every_device() -> None:
    here = baking()
    online = [event for event in here.story.chronicle.events if event["kind"] == "robot"]
    assert {event["subject"] for event in online} == {"oven", "eye"}
