"""The border of the playground: requests and answers as JSON, in each language, for each plant."""

from __future__ import annotations

import json
from typing import Any

import pytest

from arboleda.web.languages import LANGUAGES, contents
from arboleda_class.playground import plants
from arboleda_class.playground.tab import Tab
from arboleda_proofs.campaigns.request import Request

OPENED = {"plant": None, "languages": ["en"], "seed": 0, "level": "none"}


def ask(tab: Tab, what: str, **request: Any) -> Any:
    return json.loads(tab.hear(json.dumps({"do": what, **request})))


def opened(**more: Any) -> tuple[Tab, Any]:
    tab = Tab()
    return tab, ask(tab, "open", **{**OPENED, **more})


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_page_is_in_the_language_that_was_asked_for(language: str) -> None:
    _, answer = opened(languages=[language])
    assert answer["page"]["language"] == language
    assert contents(language, "playground")["bar"] in answer["html"]
    assert answer["page"]["words"]["js_again"] == contents(language, "playground")["js_again"]


def test_every_language_has_all_words_and_every_plant_has_some() -> None:
    known = [contents(language, "playground").keys() for language in LANGUAGES]
    assert all(keys == known[0] for keys in known)
    assert {key for key in known[0] if key.startswith("plant_")} == {f"plant_{name}" for name in plants.FILES}


@pytest.mark.sampled(17)
@pytest.mark.parametrize("plant", plants.FILES)
def test_every_plant_opens(plant: str) -> None:
    tab, answer = opened(plant=plant)
    assert answer["frame"]["face"]["rows/counts"]
    assert ('id="twin"' in answer["html"]) is bool(ask(tab, "scene")["scene"])


def test_the_files_of_the_starter_are_those_of_a_plant_with_its_name() -> None:
    name, texts = plants.texts(plants.STARTER)
    assert f"name: {plants.STARTER}\n" in texts[name]


def test_a_plant_that_is_not_there_is_refused_with_those_that_are() -> None:
    _, answer = opened(plant="nowhere")
    assert "nowhere" in answer["sentence"] and "kitting" in answer["sentence"]


def test_faults_of_no_level_are_refused_with_those_that_are() -> None:
    _, answer = opened(level="storms")
    assert "storms" in answer["sentence"] and "normal" in answer["sentence"]


def test_one_request_moves_time_by_a_minute_at_most() -> None:
    tab, _ = opened(plant="own_board")
    assert ask(tab, "advance", ticks=10**9)["frame"]["clock"]["tick"] == 960


def test_a_frame_says_only_what_has_changed() -> None:
    tab, first = opened()
    assert len(ask(tab, "advance", ticks=4)["frame"]["face"]) < len(first["frame"]["face"]) / 2


def test_buttons_of_the_page_reach_the_plant() -> None:
    tab, _ = opened()
    ask(tab, "act", act="submit", of="sis_a 0A 8", more=None)
    ((_, good),) = ask(tab, "step")["frame"]["said"]
    assert good
    task = ask(tab, "task_face", id="t-1000-1")["face"]
    assert task["text/task.title"][0] == "sis_a 0A 8 #t-1000-1"
    assert ask(tab, "back")["frame"]["clock"]["tick"] == 0
    assert ask(tab, "look", on=True)["frame"]["twin"]
    assert ask(tab, "go", tick=0)["frame"]["clock"]["tick"] == 0
    assert ask(tab, "befall", name="reboot", target="ra_1", seconds=1)["frame"]["clock"]["marks"] == [
        [0, "0:00 ra1: Reboot its board"]
    ]
    digest = ask(tab, "digest")["digest"]
    other, answer = opened(past=ask(tab, "past")["past"])
    assert answer["frame"]["clock"]["marks"] and ask(other, "digest")["digest"] == digest


@pytest.mark.long
def test_a_seed_is_simulated_as_by_the_command() -> None:
    tab = Tab()
    assert ask(tab, "simulate", seed=1, cycles=1)["digest"] == Request(cycles=1).setting.run(1).digest
