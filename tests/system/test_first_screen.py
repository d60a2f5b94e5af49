"""The first screen: from a laptop up all of a plant is on it, on a phone the stop and the trouble."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from arboleda.cli.client import PlantClient
from arboleda.model.messages import Verb

from ..chromium import people
from .conftest import SHIPPED
from .page import connected, ended, lead_out, operate, running, show, until

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]

LAPTOP = {"viewport": {"width": 1366, "height": 768}}
SCREENS = ((1280, 800), (1366, 768), (1920, 1080), (2560, 1440))
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
OVERFLOWING = """() => {
  const inside = (each) => {
    const text = document.createRange();
    text.selectNodeContents(each);
    const [letters, circle] = [text.getBoundingClientRect(), each.getBoundingClientRect()];
    return letters.width < circle.width && letters.top >= circle.top && letters.bottom <= circle.bottom;
  };
  const circles = [...document.querySelectorAll(".place, .places .act")];
  return circles.filter((each) => each.checkVisibility() && !inside(each)).map((each) => each.textContent);
}"""
BELOW_THE_HEADER = """() => {
  const [top, parts] = [".top", "#parts"].map((each) => document.querySelector(each).getBoundingClientRect());
  return parts.top >= top.bottom;
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


@pytest.mark.parametrize(("width", "height"), SCREENS)
def test_from_a_laptop_up_cells_twin_and_tree_are_on_one_screen(look: Open, width: int, height: int) -> None:
    page = look(viewport={"width": width, "height": height})
    for cell in CELLS:
        wait_for_sight(page, f"[data-choose={cell}]")
        wait_for_sight(page, f"[data-menu={cell}]")
    root = "g.node[data-cell=sis_a][data-path=root]"
    for name in ("#stop", "#twin", "[data-cell=sis_a] > .tree-box", root):
        wait_for_sight(page, name)
    page.wait_for_function("document.getElementById('twin-title').textContent === 'Twin of sis_a'")
    assert page.inner_text("[data-cell=sis_a] .tree-box h2") == "Tree of sis_a"
    page.click("[data-choose=sis_b]")
    wait_for_sight(page, "g.node[data-cell=sis_b][data-path=root]")
    page.wait_for_function("document.getElementById('twin-title').textContent === 'Twin of sis_b'")
    assert page.evaluate("document.documentElement.scrollHeight <= innerHeight")


def of_eight_cells(folder: Path) -> Path:
    """The shipped plant, its cells again and again, beside each other."""
    plant = yaml.safe_load(SHIPPED.read_text())
    shipped, plant["cells"] = [*plant["cells"].values()], {}
    for number in range(8):
        cell = copy.deepcopy(shipped[number % 3])
        cell["arm"] |= {"name": f"arm_{number}", "mqtt": f"arm_{number}", "twin": f"t{number}"}
        cell["mobile"]["name"] = f"mobile_{number}"
        for place in (cell["arm"]["base"], cell["mobile"]["grid"]):
            place["origin_m"][0] += 4 * (number // 3)
        plant["cells"][f"cell_{number}"] = cell
    file = folder / "plant.yaml"
    file.write_text(yaml.safe_dump(plant))
    return file


def test_of_a_crowd_of_cells_the_twin_is_on_the_first_screen_too(browser: Any, tmp_path: Path) -> None:
    plant = of_eight_cells(tmp_path)
    with running(tmp_path / "state", "--plant", str(plant)) as address, people(browser) as new:
        for width, height in SCREENS:
            page = new(locale="en", viewport={"width": width, "height": height})
            page.goto(address)
            connected(page)
            for name in ("#twin", *(f"[data-choose=cell_{number}]" for number in range(8))):
                wait_for_sight(page, name)
            page.close()


def test_on_a_phone_the_stop_and_the_cell_in_trouble_come_first(
    look: Open, plant: tuple[str, PlantClient]
) -> None:
    plant[1].operate(Verb.STOP, "sis_c")
    page = look(**PHONE)
    page.wait_for_selector("html[data-stands=trouble]")
    assert page.evaluate("document.querySelector('.cells').firstElementChild.dataset.cell") == "sis_c"
    for name in ("#stop", "[data-choose=sis_c]", OUT):
        wait_for_sight(page, name)


def test_on_a_phone_a_place_opens_at_its_top_and_the_stop_alone_stays_when_it_is_scrolled(look: Open) -> None:
    page = look(**PHONE)
    at_top = page.evaluate("document.getElementById('stop').getBoundingClientRect().top")
    for part in ("tasks", "cells"):
        show(page, part)
        assert page.evaluate("scrollY") == 0
        page.wait_for_function(BELOW_THE_HEADER)
        page.evaluate("scrollTo(0, 400)")
        page.wait_for_function("document.querySelector('.top').getBoundingClientRect().bottom <= 120")
        assert page.evaluate("document.getElementById('stop').getBoundingClientRect().top") == at_top
        wait_for_sight(page, "#stop")


def test_on_a_phone_letters_are_in_their_circles_and_a_task_is_sent_once_all_is_chosen(look: Open) -> None:
    page = look("?tab=tasks&cell=sis_a", **PHONE)
    page.wait_for_selector("[data-maps=sis_a] .place")
    assert page.evaluate(OVERFLOWING) == []
    page.click("[data-maps=sis_a] [data-path='0B']")
    assert page.is_disabled("#task-send")
    assert page.inner_text("#task-missing") == "Still to choose: Station of the rack."
    page.click("[data-maps=sis_a] [data-station='7']")
    assert page.is_enabled("#task-send") and not page.is_visible("#task-missing")
    page.fill("#task-text", "")
    assert page.is_disabled("#task-send")
    page.fill("#task-text", "whatever")
    assert page.is_enabled("#task-send")


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
