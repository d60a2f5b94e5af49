"""A cell that is taught by hand on its page, in a real browser: by pointer, by keys, and let go of."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
import yaml
from tests.chromium import people
from tests.patience import PATIENCE_S
from tests.system.page import connected, running, until
from tests.system.test_accessible import Eye

from arboleda.cli.new import write

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]

LAPTOP = {"viewport": {"width": 1366, "height": 900}, "locale": "en"}
PLUS = "#teach-devices [aria-label='brazo +']"
NOTE = "#teach-note"
HEARD_S = 3.0  # a press that the plant has not heard of by then was given up by the page
RUN_OUT_DEG = 10.0
"""The loader moves less than this once nobody holds its button; to its end it has far more."""
Open = Callable[..., Any]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = tmp_path_factory.mktemp("plants") / "lab"
    write(found)
    return found


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory, folder: Path) -> Iterator[str]:
    """A plant of one's own, on virtual boards that are as fast as real ones."""
    plant = str(folder / "plant.yaml")
    with running(tmp_path_factory.mktemp("state"), "--plant", plant, "--rate", "1") as found:
        yield found.rstrip("/")


@pytest.fixture
def screen(browser: Any, address: str) -> Iterator[Open]:
    """`screen()`: the page of another person; a script that fails fails the test."""
    with people(browser) as new:

        def go(tab: str = "teach", language: str = "en") -> Any:
            page = new(**LAPTOP)
            page.goto(f"{address}/?tab={tab}&lang={language}")
            connected(page)
            return page

        yield go
    httpx.post(f"{address}/api/cells/cell/automatic", timeout=PATIENCE_S)


def begin(page: Any, name: str = "Ana") -> None:
    page.wait_for_selector(PLUS)
    page.fill("#teach-name", name)
    page.click("#teach-begin")
    page.wait_for_selector(f"{PLUS}:not([disabled])")


def state(address: str) -> dict[str, Any]:
    return dict(httpx.get(f"{address}/api/teach/cell", timeout=PATIENCE_S).json())


def is_held_now(address: str) -> bool:
    return state(address)["teaching"]["number"] is not None


def device(address: str, name: str = "loader") -> dict[str, Any]:
    return next(each for each in state(address)["devices"] if each["name"] == name)


def turned(address: str) -> float:
    at = device(address)["at"]
    return float(at[0])


def hold(page: Any, address: str, selector: str, done: Callable[[], bool], *, key: str = "") -> None:
    """Hold a button until that is so, by the pointer or by a key. It is pressed again where the plant has not
    heard of it or has let go of it: a busy machine is late with it, and the page may have moved it away from
    under the pointer."""

    def press() -> None:
        if key:
            page.keyboard.up(key)
            page.focus(selector)
            page.keyboard.down(key)
        else:
            page.mouse.up()
            page.hover(selector)
            page.mouse.down()

    until(lambda: pressed(press, address, done))


def pressed(press: Callable[[], None], address: str, done: Callable[[], bool]) -> bool:
    """Press a button and hold it as long as the plant knows of it; True once that is so."""
    press()
    began, was_held = time.monotonic(), False
    while not done():
        is_held = is_held_now(address)
        if not is_held and (was_held or time.monotonic() > began + HEARD_S):
            return False
        assert time.monotonic() < began + PATIENCE_S
        was_held = was_held or is_held
    return True


def stands(address: str) -> None:
    """Nobody holds a button any more; the loader comes to rest where it was let go of, and stays there.

    Between two short goals it rests for a moment too, and a goal that left before is on its way for a while.
    """
    until(lambda: not is_held_now(address))
    let_go_at = turned(address)
    until(lambda: not device(address)["moves"] and rests(address))
    assert abs(turned(address) - let_go_at) < RUN_OUT_DEG


def rests(address: str) -> bool:
    there = turned(address)
    return all(turned(address) == there for _ in range(20))


def test_a_button_and_a_key_move_an_axis_as_long_as_they_are_held_on_a_page_that_is_there(
    screen: Open, address: str
) -> None:
    page = screen("cells")
    page.click(".to-teach:visible")
    page.wait_for_selector(PLUS)
    page.fill("#teach-name", "")
    page.click("#teach-begin")
    assert re.match("Write your name", page.text_content(NOTE))
    begin(page)
    before = turned(address)
    hold(page, address, PLUS, lambda: turned(address) > before + 2)
    page.mouse.up()
    stands(address)
    before = turned(address)
    hold(page, address, PLUS, lambda: turned(address) > before + 1, key=" ")
    page.keyboard.up(" ")
    stands(address)
    page.click("[aria-label='Grip']")
    until(lambda: device(address)["facts"]["effector"] is True)
    page.click("[aria-label='Let go']")
    until(lambda: device(address)["facts"]["effector"] is False)
    page.hover(".teach-verbs[aria-label='press'] button")
    page.mouse.down()
    page.wait_for_function("document.querySelector('#teach-note').textContent.includes('needs door')")
    page.mouse.up()
    before = turned(address)
    hold(page, address, PLUS, lambda: turned(address) > before + 1)
    page.context.set_offline(True)
    stands(address)


def test_a_target_is_made_here_and_gone_to(screen: Open, address: str, folder: Path) -> None:
    page = screen()
    begin(page)
    page.fill("[aria-label='New target']", "nest")
    page.select_option("[aria-label='Zone of the target']", "inside")
    page.click("button:text-is('Here')")
    page.wait_for_function("document.querySelector('#teach-note').textContent.includes('nest is here now')")
    draft = httpx.get(f"{address}/api/draft", timeout=PATIENCE_S).json()
    here = turned(address)
    assert draft["values"]["cells"]["cell"]["targets"]["nest"]["loader"]["deg"][0] == here
    assert draft["values"]["zones"]["inside"]["poses"] == ["cell press", "cell nest"]
    assert "nest" not in yaml.safe_load((folder / "plant.yaml").read_text())["cells"]["cell"]["targets"]
    hold(page, address, PLUS, lambda: turned(address) > here + 1)
    page.mouse.up()
    stands(address)
    page.select_option("[aria-label='Target']", "nest")
    hold(page, address, "button:text-is('Go there')", lambda: abs(turned(address) - here) < 0.05)
    page.mouse.up()
    page.fill("[aria-label='New target']", "tray")
    page.click("button:text-is('Here')")
    page.wait_for_function("document.querySelector('#teach-note').textContent.includes('tray is here now')")
    hold(page, address, PLUS, lambda: "is here now" not in page.text_content(NOTE))
    page.mouse.up()
    assert page.is_visible("#teach-recipe"), "what leads on from two targets stays"
    page.goto(f"{address}/?tab=make")  # who made it edits the draft, also there
    page.wait_for_function("document.querySelector('#make-who')?.textContent.includes('You edit the draft')")
    page.click("[data-make-panel=cells]")
    page.click(".make-teach")
    page.wait_for_selector("#teach-cell", state="visible")


@pytest.mark.requires("axe_playwright_python")
def test_another_person_sees_who_teaches_and_cannot_move_anything(screen: Open, address: str) -> None:
    mine = screen()
    begin(mine)
    other = screen()
    other.wait_for_selector(PLUS)
    other.wait_for_function("document.body.textContent.includes('Ana teaches this cell')")
    assert other.is_disabled(PLUS) and other.is_disabled("#teach-begin")
    eye = Eye(mine)
    eye.look("teach")
    assert eye.violations == []
    other.click("[data-tab=cells]")
    other.wait_for_selector(".pill[data-s=manual]")
    other.click(".to-teach:visible")
    other.click("#teach-end")
    mine.wait_for_selector(f"{PLUS}[disabled]")
