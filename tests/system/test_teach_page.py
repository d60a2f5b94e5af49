"""A cell that is taught by hand on its page, in a real browser: by pointer, by keys, and let go of."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
import yaml

from arboleda.cli.new import write

from ..chromium import leave
from ..patience import PATIENCE_MS, PATIENCE_S
from .page import connected, running, until
from .test_accessible import Eye

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]

LAPTOP = {"viewport": {"width": 1366, "height": 900}, "locale": "en"}
PLUS = "#teach-devices [aria-label='brazo +']"
NOTE = "#teach-note"
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
    contexts: list[Any] = []
    troubles: list[str] = []

    def go(tab: str = "teach") -> Any:
        contexts.append(browser.new_context(**LAPTOP))
        page = contexts[-1].new_page()
        page.set_default_timeout(PATIENCE_MS)
        page.on("pageerror", lambda error: troubles.append(str(error)))
        page.goto(f"{address}/?tab={tab}")
        connected(page)
        return page

    yield go
    for each in contexts:
        leave(each)
    httpx.post(f"{address}/api/cells/cell/automatic", timeout=PATIENCE_S)
    assert troubles == []


def begin(page: Any, name: str = "Ana") -> None:
    page.wait_for_selector(PLUS)
    page.fill("#teach-name", name)
    page.click("#teach-begin")
    page.wait_for_selector(f"{PLUS}:not([disabled])")


def device(address: str, name: str = "loader") -> dict[str, Any]:
    found = httpx.get(f"{address}/api/teach/cell", timeout=PATIENCE_S).json()["devices"]
    return next(each for each in found if each["name"] == name)


def turned(address: str) -> float:
    at = device(address)["at"]
    return float(at[0])


def hold(page: Any, selector: str, done: Callable[[], bool]) -> None:
    """Hold a button until that is so. It is pressed again where a busy machine was late with it, and where
    the page has moved it away from under the pointer, which lets go of it."""
    button = page.locator(selector).first

    def is_done() -> bool:
        if cut_short(page) or not button.evaluate("each => each.matches(':hover')"):
            page.mouse.up()
            page.hover(selector)
            page.mouse.down()
        return done()

    page.hover(selector)
    page.mouse.down()
    until(is_done)


def stands(address: str) -> None:
    """The loader comes to rest, and stays where it is though nobody does anything."""
    until(lambda: not device(address)["moves"])
    there = turned(address)
    for _ in range(20):
        assert turned(address) == there


def test_a_button_moves_an_axis_as_long_as_it_is_held(screen: Open, address: str) -> None:
    page = screen("cells")
    page.click(".to-teach:visible")
    begin(page)
    before = turned(address)
    hold(page, PLUS, lambda: turned(address) > before + 2)
    page.mouse.up()
    stands(address)


def test_keys_do_the_same(screen: Open, address: str) -> None:
    page = screen()
    begin(page)
    before = turned(address)
    page.focus(PLUS)
    page.keyboard.down(" ")
    until(lambda: turned(address) > before + 1)
    page.keyboard.up(" ")
    stands(address)


def cut_short(page: Any) -> bool:
    """A machine so busy that the plant did not hear of the button for too long."""
    return "not held any more" in (page.text_content(NOTE) or "")


def test_a_step_is_as_far_as_it_says(screen: Open, address: str) -> None:
    page = screen()
    begin(page)
    before = turned(address)
    page.click("[data-step='1']")
    page.click(PLUS)
    until(lambda: abs(turned(address) - before - 1) < 0.05 or cut_short(page))
    stands(address)
    assert before < turned(address) < before + 1.05


@pytest.mark.parametrize("lost", ["page", "network"])
def test_whoever_is_gone_holds_nothing_any_more(screen: Open, address: str, lost: str) -> None:
    page = screen()
    begin(page)
    before = turned(address)
    hold(page, PLUS, lambda: turned(address) > before + 1)
    if lost == "page":
        page.close()
    else:
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
    hold(page, PLUS, lambda: turned(address) > here + 1)
    page.mouse.up()
    stands(address)
    page.select_option("[aria-label='Target']", "nest")
    hold(page, "button:text-is('Go there')", lambda: abs(turned(address) - here) < 0.05)
    page.mouse.up()
    page.fill("[aria-label='New target']", "tray")
    page.click("button:text-is('Here')")
    page.wait_for_function("document.querySelector('#teach-note').textContent.includes('tray is here now')")
    hold(page, PLUS, lambda: "is here now" not in page.text_content(NOTE))
    page.mouse.up()
    assert page.is_visible("#teach-recipe"), "what leads on from two targets stays"
    page.goto(f"{address}/?tab=make")  # who made it edits the draft, also there
    page.wait_for_function("document.querySelector('#make-who')?.textContent.includes('You edit the draft')")
    page.click("[data-make-panel=cells]")
    page.click(".make-teach")
    page.wait_for_selector("#teach-cell", state="visible")


def test_verbs_of_devices_and_what_cannot_be(screen: Open, address: str) -> None:
    page = screen()
    begin(page)
    page.click("[aria-label='Grip']")
    until(lambda: device(address)["facts"]["effector"] is True)
    page.click("[aria-label='Let go']")
    until(lambda: device(address)["facts"]["effector"] is False)
    page.hover(".teach-verbs[aria-label='press'] button")
    page.mouse.down()
    page.wait_for_function("document.querySelector('#teach-note').textContent.includes('needs door')")
    page.mouse.up()


def test_another_person_sees_who_teaches_and_cannot_move_anything(screen: Open, address: str) -> None:
    mine = screen()
    begin(mine)
    other = screen()
    other.wait_for_selector(PLUS)
    other.wait_for_function("document.body.textContent.includes('Ana teaches this cell')")
    assert other.is_disabled(PLUS) and other.is_disabled("#teach-begin")
    other.click("[data-tab=cells]")
    other.wait_for_selector(".pill[data-s=manual]")
    other.click(".to-teach:visible")
    other.click("#teach-end")
    mine.wait_for_selector(f"{PLUS}[disabled]")


@pytest.mark.requires("axe_playwright_python")
def test_axe_finds_nothing_while_a_cell_is_taught(screen: Open) -> None:
    page = screen()
    begin(page)
    eye = Eye(page)
    eye.look("teach")
    assert eye.violations == []


def test_who_gives_no_name_is_asked_for_one(screen: Open) -> None:
    page = screen()
    page.wait_for_selector(PLUS)
    page.fill("#teach-name", "")
    page.click("#teach-begin")
    assert re.match("Write your name", page.text_content(NOTE))
