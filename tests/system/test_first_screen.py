"""What a stranger sees first: on a laptop all of a plant on one screen, on a phone the stop and trouble."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from arboleda.cli.client import PlantClient
from arboleda.model.messages import Verb

from ..chromium import people
from .page import connected, ended, lead_out, operate, running, until

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]

LAPTOP = {"viewport": {"width": 1366, "height": 768}}
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True}
CELLS = ("sis_a", "sis_b", "sis_c")
TASKS = {"sis_a 0B 7": "one", "sis_b 1C 3": "two", "sis_c 2A 5": "three"}
PLACES = {
    "en": ["Cells", "Tasks", "Make", "Log", "Settings"],
    "es": ["Celdas", "Tareas", "Hacer", "Bitácora", "Ajustes"],
}
OF_BEFORE = {
    "twin": ("cells", "cells"),
    "panel": ("cells", "cells"),
    "links": ("links", "log"),
    "draw": ("draw", "make"),
}
OUT = "[data-cell=sis_c] :is([data-rows='ready.sis_c'], [data-rows='ways.sis_c']) button:enabled"
IN_SIGHT = """selector => {
  const at = document.querySelector(selector);
  const { left, right, top, bottom } = at.getBoundingClientRect();
  const seen = document.elementFromPoint((left + right) / 2, (top + bottom) / 2);
  const within = left >= 0 && top >= 0 && right <= innerWidth && bottom <= innerHeight;
  return bottom > top && within && at.contains(seen);
}"""
Open = Callable[..., Any]


@pytest.fixture(scope="module")
def plant(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, PlantClient]]:
    """A plant where each cell has done a task, so that parts lie in its rack."""
    state = tmp_path_factory.mktemp("first")
    tasks = [f"{text} #{id}" for text, id in TASKS.items()]
    with running(state, *tasks) as address:
        ended(address, *TASKS.values())
        yield address, PlantClient(state)


@pytest.fixture
def look(browser: Any, plant: tuple[str, PlantClient]) -> Iterator[Open]:
    """`look(**screen)`: the page as somebody sees it there; a script that fails fails the test."""
    address, _ = plant
    until(lambda: lead_out(address))
    with people(browser) as new:

        def go(query: str = "", locale: str = "en", **screen: Any) -> Any:
            page = new(locale=locale, **screen)
            page.goto(f"{address}/{query}")
            connected(page)
            return page

        yield go


def wait_for_sight(page: Any, selector: str) -> None:
    """Wait until a person sees all of it: on the screen, and below nothing else."""
    page.wait_for_selector(selector)
    page.wait_for_function(IN_SIGHT, arg=selector)


def test_on_a_laptop_cells_twin_and_tree_are_on_one_screen(look: Open) -> None:
    page = look(**LAPTOP)
    for cell in CELLS:
        wait_for_sight(page, f"[data-choose={cell}]")
        wait_for_sight(page, f"[data-menu={cell}]")
    root = "g.node[data-cell=sis_a][data-path=root]"
    for name in ("#stop", "#twin", "[data-cell=sis_a] > .tree-box", root):
        wait_for_sight(page, name)
    assert page.inner_text("#twin-title") == "Twin of sis_a"
    assert page.inner_text("[data-cell=sis_a] .tree-box h2") == "Tree of sis_a"
    page.click("[data-choose=sis_b]")
    wait_for_sight(page, "g.node[data-cell=sis_b][data-path=root]")
    page.wait_for_function("document.getElementById('twin-title').textContent === 'Twin of sis_b'")
    assert page.evaluate("document.documentElement.scrollHeight <= innerHeight")


def test_on_a_phone_the_stop_and_the_cell_in_trouble_come_first(
    look: Open, plant: tuple[str, PlantClient]
) -> None:
    plant[1].operate(Verb.STOP, "sis_c")
    page = look(**PHONE)
    page.wait_for_selector("html[data-stands=trouble]")
    assert page.evaluate("document.querySelector('.cells').firstElementChild.dataset.cell") == "sis_c"
    for name in ("#stop", "[data-choose=sis_c]", OUT):
        wait_for_sight(page, name)


def test_a_dot_is_pressed_for_a_part_that_was_taken_out(look: Open) -> None:
    page = look(**LAPTOP)
    dot = "[data-rows='places.sis_a'] button:text-is('7')"
    page.wait_for_selector(f"{dot}[data-s=taken]")
    page.click(dot)
    page.wait_for_selector(f"{dot}[data-s=free]")


@pytest.mark.parametrize("locale", PLACES)
def test_the_page_has_five_places(look: Open, locale: str) -> None:
    page = look(locale=locale, **LAPTOP)
    assert page.locator(".tabs a").all_inner_texts() == PLACES[locale]
    assert page.get_attribute("[aria-current=page]", "data-tab") == "cells"


def test_an_address_of_before_leads_to_what_it_named(look: Open) -> None:
    page = look(**LAPTOP)
    for tab, (part, place) in OF_BEFORE.items():
        page.goto(f"{page.url.partition('?')[0]}?tab={tab}")
        connected(page)
        page.wait_for_selector(f"#part-{part}")
        assert page.get_attribute(".tabs [aria-current=page]", "data-tab") == place
        assert page.is_visible("#menu") is (tab == "panel")


def test_the_menu_is_of_the_cell_whose_button_was_pressed_and_escape_closes_it(look: Open) -> None:
    page = look(**PHONE)
    operate(page, "sis_b")
    assert page.locator("#menu [data-scope]:visible").all_inner_texts()[0].startswith("sis_b")
    assert page.locator("#fault-target option:not([hidden])").all_text_contents() == ["ra2", "rm_sis_b"]
    assert page.evaluate(IN_SIGHT, "#stop")
    page.keyboard.press("Escape")
    page.wait_for_selector("#menu", state="hidden")
    assert page.evaluate("document.activeElement.dataset.menu") == "sis_b"
