"""The playground as it is served: files alone, in a real browser, below any address."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from tests.chromium import FEW_FRAMES, leave
from tests.lengths import length, sample
from tests.patience import LONG_MS
from tests.system.page import show
from tests.system.test_accessible import SCREENS, VIEWS, Eye

from arboleda.dashboard.lone_page import PARTS
from arboleda.web.languages import contents
from arboleda_class.playground.tab import Tab

pytestmark = [
    pytest.mark.system,
    pytest.mark.requires("chromium", "playwright"),
    pytest.mark.timeout(900),
]
SEEDS, CYCLES = range(1, length(4, whole=11)), 1
Open = Callable[..., Any]


@pytest.fixture
def opened(playground: str, browser: Any) -> Iterator[Open]:
    """`opened(query, **context)`: a plant in a tab whose time stands still; what it asks elsewhere, or what
    breaks in it, fails the test."""
    contexts: list[Any] = []
    troubles: list[str] = []

    def go(query: str = "", **options: Any) -> Any:
        context = browser.new_context(**{"locale": "en", "color_scheme": "light", **options})
        contexts.append(context)
        page = context.new_page()
        page.set_default_timeout(LONG_MS)
        page.add_init_script(FEW_FRAMES)
        page.on("request", lambda each: each.url.startswith(playground) or troubles.append(each.url))
        page.on("response", lambda each: troubles.append(each.url) if each.status >= 400 else None)
        page.on("pageerror", lambda error: troubles.append(str(error)))
        page.goto(f"{playground}?{query}")
        page.wait_for_function("window.arboledaPlay?.ready()")
        page.evaluate("arboledaPlay.pause()")
        return page

    yield go
    for context in contexts:
        leave(context)
    assert not troubles


def ask(page: Any, what: str, **request: Any) -> Any:
    return page.evaluate("([what, request]) => arboledaPlay.ask(what, request)", [what, request])


def pressed(page: Any, selector: str) -> None:
    """Press what is for keys and fingers, too."""
    page.focus(selector)
    page.keyboard.press("Enter")


def test_seeds_and_a_session_have_the_digests_that_they_have_here(opened: Open) -> None:
    page, here = opened("plant=own_board"), Tab()

    def both(what: str, **request: Any) -> Any:
        found = ask(page, what, **request)
        assert json.loads(here.hear(json.dumps({"do": what, **request}))).keys() == found.keys()
        return found

    for seed in SEEDS:
        request = {"do": "simulate", "seed": seed, "cycles": CYCLES}
        assert ask(page, "simulate", seed=seed, cycles=CYCLES) == json.loads(here.hear(json.dumps(request)))
    both("open", plant="machine_tending", languages=["en"], seed=7, level="normal")
    both("act", act="submit", of="tending mill slot_1 1002", more=None)
    both("advance", ticks=400)
    both("befall", name="reboot", target="loader", seconds=0)
    both("advance", ticks=400)
    digest = both("digest")["digest"]
    assert digest == json.loads(here.hear('{"do": "digest"}'))["digest"]
    both("go", tick=100)
    both("go", tick=10**6)
    assert both("digest")["digest"] == digest


def test_a_person_gives_a_task_has_a_board_reboot_goes_back_stops_and_opens_another_plant(
    opened: Open,
) -> None:
    page = opened()
    show(page, "tasks")
    page.fill("#task-text", "sis_a 0A 8")
    page.click("#task-send")
    page.wait_for_selector("#answer[data-s=good]")
    page.evaluate("arboledaPlay.advance(80)")
    show(page, "cells")
    page.wait_for_selector("[data-tree=sis_a] g.node.current")
    page.click("#play-mishaps summary")
    page.click("[data-fault=reboot]")
    page.evaluate("arboledaPlay.advance(160)")
    page.wait_for_selector("g.node.is-failure, g.node.is-halted")
    page.wait_for_selector("#play-marks i", state="attached")
    pressed(page, "[data-play=begin]")
    page.wait_for_function("arboledaPlay.clock().tick === 0")
    page.focus("#play-slider")
    page.keyboard.press("End")
    page.wait_for_function("arboledaPlay.clock().tick === arboledaPlay.clock().latest")
    page.wait_for_selector("g.node.is-failure, g.node.is-halted")
    show(page, "cells")
    page.wait_for_function("Object.keys(window.arboledaTwin?.drawn() ?? {}).includes('robot/ra1')")
    assert page.inner_text("#twin-robots li:first-child").startswith("ra1")
    page.click("#stop")
    page.wait_for_selector(".stop-state[data-s=stopped]")
    page.select_option("#play-speed", "16")
    pressed(page, "[data-play=play]")
    page.wait_for_function("arboledaPlay.clock().tick > 160")
    pressed(page, "[data-play=play]")
    assert page.get_attribute("[data-play=play]", "title") == contents("en", "playground")["js_play"]
    page.select_option("#play-plant", "agv")
    page.wait_for_function("document.querySelector('#play-slider') && document.title.includes('agv')")
    show(page, "links")
    assert "plant=agv" in page.url and "tab=links" in page.url


def test_on_a_laptop_faults_take_one_row_and_another_language_tells_of_the_same_run(opened: Open) -> None:
    page = opened("plant=machine_tending", viewport={"width": 1366, "height": 768})
    before = page.evaluate("document.getElementById('play').offsetHeight")
    page.click("#play-mishaps summary")
    buttons = page.evaluate(
        "[...document.querySelectorAll('[data-fault]:not([hidden])')].map(b => b.offsetTop)"
    )
    assert len(buttons) > 5 and len(set(buttons)) == 1
    assert page.evaluate("document.getElementById('play').offsetHeight") < before + 60
    page.click("[data-fault=lost_part]")
    page.wait_for_selector("[data-rows=happened] :text('Nothing to lose now')")
    assert page.get_attribute("#play-marks i", "title").endswith("loader: Lose the part")
    show(page, "events")
    page.wait_for_selector("[data-rows=events] :text('fault by hand')")
    show(page, "settings")
    page.click("[data-language=es]")
    page.wait_for_selector("html[lang=es] [data-rows=happened] :text('Ahora no hay nada que perder')")
    assert "plant=machine_tending" in page.url and "tab=settings" in page.url


@pytest.mark.requires("axe_playwright_python")
@pytest.mark.parametrize(("language", "screen"), sample(VIEWS[::-1], every=2))
def test_axe_finds_nothing_and_nobody_scrolls_sideways(opened: Open, language: str, screen: str) -> None:
    page = opened(locale=language, **SCREENS[screen])
    assert page.get_attribute("html", "lang") == language
    eyes = Eye(page)
    for part in PARTS:
        show(page, part)
        eyes.look(part)
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), part
    show(page, "cells")
    page.click("#play-mishaps summary")
    page.select_option("#fault-seconds", "60")
    page.click("[data-fault=no_power]")
    page.evaluate("arboledaPlay.advance(160)")
    page.wait_for_selector("[data-rows=happened] button")
    eyes.look("a board without power")
    assert not eyes.violations, "\n".join(eyes.violations)
