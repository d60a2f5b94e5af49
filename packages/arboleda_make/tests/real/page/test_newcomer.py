"""The story of a newcomer, in a real browser: from an arm led by hand to a task, and no file edited."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from tests.patience import PATIENCE_MS, PATIENCE_S
from tests.system.page import running, until

from arboleda.cli.new import write
from arboleda.plant_file.loader import load
from arboleda.plant_file.versions import Versions

from .test_make import LONG_MS, Person
from .test_teach_page import NOTE, device, hold

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright"), pytest.mark.timeout(900)]

LAPTOP = {"viewport": {"width": 1280, "height": 800}, "locale": "en"}
ARM, DOWN = "#teach-devices [aria-label='brazo {sign}']", "#teach-devices [aria-label='efector +']"
MOST_PRESSES = 40
LAMP = """
  lamp:
    facts: {lit: bool}
    verbs: {shine: {effect: switch, sets: {lit: true}}}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A plant as `arboleda new` writes it, with a lamp, which somebody may switch off unnoticed."""
    plant = write(tmp_path / "lab")[0]
    text = plant.read_text().replace("kinds:\n", f"kinds:{LAMP}", 1)
    plant.write_text(text.replace("    devices:\n", "    devices:\n      lamp: {kind: lamp}\n", 1))
    return plant.parent


@pytest.fixture
def address(tmp_path: Path, folder: Path) -> Iterator[str]:
    """The plant on virtual boards that are as fast as real ones."""
    with running(tmp_path / "state", "--plant", str(folder / "plant.yaml"), "--rate", "1") as found:
        yield found.rstrip("/")


def test_a_newcomer_gets_from_an_arm_led_by_hand_to_a_task(browser: Any, address: str, folder: Path) -> None:
    me = Person(browser, address, tab="cells", **LAPTOP)
    teach_two_targets(me, address)
    draw_a_recipe(me)
    try_it(me)
    have_a_check_added(me)
    put_it_to_work(me)
    send_a_task(me, address)
    me.go()
    text = (folder / "plant.yaml").read_text()
    assert "# where parts lie: people fill the supply" in text and "approach_mm: 20" in text
    drawn = (folder / "to_tray.xml").read_text()
    assert 'num_attempts="2"' in drawn and 'lamp_becomes lit="true"' in drawn
    assert [each.name for each in load(folder / "plant.yaml").cells[0].recipes] == ["press", "to_tray"]
    assert [each.by for each in Versions(folder / "plant.yaml").all()] == ["", "Nora"]
    assert me.presses <= MOST_PRESSES


def teach_two_targets(me: Person, address: str) -> None:
    """The arm goes to a place, grips, goes elsewhere, lets go; both places are targets then."""
    me.press(".to-teach:visible")
    me.write("#teach-name", "Nora")
    me.press("#teach-begin")
    lead(me, address, ARM.format(sign="+"), 0, 4)
    lead(me, address, DOWN, 2, 20)
    me.write("[aria-label='Approach, mm']", "20")
    here(me, "rack")
    me.press("[aria-label='Grip']")
    me.page.wait_for_selector(".teach-device:has-text('effector: yes')")
    lead(me, address, ARM.format(sign="−"), 0, 4)
    here(me, "tray")
    me.press("[aria-label='Let go']")
    me.page.wait_for_selector(".teach-device:has-text('effector: no')")


def lead(me: Person, address: str, button: str, joint: int, far: float) -> None:
    """Hold a button until the joint is so far from where it was, in degrees or mm."""

    def at() -> float:
        return float(device(address)["at"][joint])

    me.page.wait_for_selector(f"{button}:not([disabled])")
    before = at()
    me.presses += 1
    hold(me.page, address, button, lambda: abs(at() - before) > far)
    me.page.mouse.up()
    until(lambda: not device(address)["moves"])


def here(me: Person, target: str) -> None:
    me.write("[aria-label='New target']", target)
    me.press("button:text-is('Here')")
    me.sees(NOTE, f"{target} is here now")
    assert is_in_sight(me.page, NOTE)


def is_in_sight(page: Any, selector: str) -> bool:
    """True where a person sees an element: on the screen, and below nothing else."""
    return bool(
        page.evaluate(
            """selector => {
              const at = document.querySelector(selector);
              const { left, top, width, height } = at.getBoundingClientRect();
              return at.contains(document.elementFromPoint(left + width / 2, top + height / 2));
            }""",
            selector,
        )
    )


def draw_a_recipe(me: Person) -> None:
    """The recipe that leads from the one target to the other, with a step by mouse and a retry by keys."""
    page, press = me.page, me.page.keyboard.press
    me.press("#teach-recipe")
    page.wait_for_function("document.getElementById('make-end').value === 'tray'", timeout=LONG_MS)
    assert page.input_value("#make-start") == "rack" and page.input_value("#make-name") == "Nora"
    me.write("#make-recipe", "to_tray")
    me.press("[data-make=carry]")
    page.wait_for_selector("#draw-rows [data-path='1.0'][aria-label*=loader_let_go]", timeout=LONG_MS)
    me.press("#draw-rows [data-path='0']")
    me.press("[data-how=before]")
    me.write("#draw-search", "lamp_shine")
    me.press("[data-kind=lamp_shine]:visible")
    page.wait_for_selector("#draw-rows [data-path='0'][aria-label*=lamp_shine]")
    page.focus("#draw-rows [data-path='0']")
    press("+")
    for key in ("Shift+Tab", "Shift+Tab", "Space", "Tab", "Tab", "Control+A"):  # around
        press(key)
    page.keyboard.type("RetryUntil")
    press("Enter")
    page.wait_for_selector("#draw-rows [data-path='0'][data-mark=mistake]")
    while not page.evaluate("document.activeElement.dataset.path === '0'"):
        press("Tab")
    press("Enter")
    page.keyboard.type("2")
    press("Tab")
    page.wait_for_selector("#draw-rows [data-path='0'][aria-label*='num_attempts=2']:not([data-mark])")


def try_it(me: Person) -> None:
    """It is simulated, and looked at in the twin; the way back leads to where it was tried."""
    me.press("#draw a.primary")
    me.page.wait_for_function(
        "document.getElementById('make-task').value.startsWith('cell to_tray')", timeout=LONG_MS
    )
    me.press("[data-make=try]")
    me.sees("#make-try-state", "to_tray: done")
    me.press("#make-tried a >> nth=0")
    me.page.wait_for_selector("#record-slider", timeout=LONG_MS)
    me.press(".record-leave")
    me.page.wait_for_selector("#make-try", timeout=LONG_MS)
    me.sees("#make-try-state", "to_tray: done")


def have_a_check_added(me: Person) -> None:
    """A failure that nobody notices is told, and a button adds the check; then it is proved."""
    page = me.page
    me.panel("prove")
    page.select_option("#make-prove_kind", "forgets")
    me.press("[data-make=prove]")
    unnoticed = "#make-proof li:has-text('lamp.lit is false') [data-find-check]"
    page.wait_for_selector(unnoticed, timeout=2 * LONG_MS)
    assert page.locator("#make-proof caption").all_inner_texts() == ["cell: to_tray"]
    me.press(f"{unnoticed} >> nth=0")
    me.sees("#make-proof .make-check", "lamp: lit becomes true would notice it")
    me.press("#make-proof .make-check button")
    me.sees("#make-proof .make-check", "The check is in the draft")
    me.press("[data-make=prove]")
    me.sees("#make-prove-state", "Held in")
    assert page.locator(unnoticed).count() == 0


def put_it_to_work(me: Person) -> None:
    me.panel("draft")
    me.sees("#make-changes", "to_tray.xml")
    me.press("[data-make=keep]")
    me.press("dialog button.primary")
    me.sees("#make-note", "version 2 of the plant. cell: when nobody teaches it any more")


def send_a_task(me: Person, address: str) -> None:
    """The cell is automatic again, and what is new is offered without the page being opened by hand."""
    me.part("cells")
    me.press(".to-teach:visible")
    me.press("#teach-end")
    me.part("cells")
    me.press("button:text-is('Make ready again')")
    me.press(".offer:visible")
    me.page.wait_for_selector("[data-choice=recipe][data-value=to_tray]", timeout=PATIENCE_MS)
    me.press("[data-choice=recipe][data-value=to_tray]")
    me.press("#task-send")
    me.page.wait_for_selector("#answer[data-s=good]")

    def is_done() -> bool:
        tasks = httpx.get(f"{address}/api/plant", timeout=PATIENCE_S).json()["tasks"]
        return [each["state"] for each in tasks] == ["done"]

    until(is_done)
