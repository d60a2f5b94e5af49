"""*Make ready again*, in a real browser: it asks before robots move, and a stop ends it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from arboleda.cli.client import PlantClient
from arboleda.model.messages import Verb

from ..patience import PATIENCE_MS
from .page import connected, operate, running, until

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright"), pytest.mark.timeout(300)]

SIZES = [{"width": 1366, "height": 768}, {"width": 390, "height": 844}]
DARK = """() => {
  const ink = getComputedStyle(document.body).color;
  const dark = (button) => button.checkVisibility() && getComputedStyle(button).backgroundColor === ink;
  const buttons = [...document.querySelectorAll("[data-cell=sis_a] button")];
  return buttons.filter(dark).map((button) => button.textContent);
}"""
BUTTON = '[data-rows="ready.sis_a"] button'


@pytest.fixture(scope="module")
def plant(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, PlantClient]]:
    state = tmp_path_factory.mktemp("ready")
    with running(state) as address:
        yield address, PlantClient(state)


@pytest.mark.parametrize("size", SIZES, ids=lambda size: str(size["width"]))
def test_two_presses_lead_from_a_stop_to_work_and_a_stop_ends_what_is_under_way(
    browser: Any, plant: tuple[str, PlantClient], size: dict[str, int]
) -> None:
    address, client = plant
    page = browser.new_context(viewport=size, locale="en").new_page()
    page.set_default_timeout(PATIENCE_MS)
    page.goto(address)
    connected(page)
    client.operate(Verb.STOP, "sis_a")
    task = client.submit("sis_a 0B 7")["id"]
    page.wait_for_selector(BUTTON)
    page.click("[data-cell=sis_a] .more > summary")
    page.wait_for_selector('[data-rows="ways.sis_a"] button')
    assert page.evaluate(DARK) == ["Make ready again"]
    page.click(BUTTON)
    page.wait_for_selector("dialog:has-text('sets ra1, rm_sis_a in motion')")
    page.click("#stop")
    page.wait_for_selector("#answer:has-text('The plant took the stop')")
    page.wait_for_selector('[data-live="sis_a.state"][data-s=aborted]')
    assert page.locator("dialog").count() == 0
    page.click(BUTTON)
    page.wait_for_selector("dialog:has-text('sets ra1, rm_sis_a in motion')")
    client.operate(Verb.STOP, "sis_a")
    page.wait_for_selector("#answer:has-text('A stop ended Make ready again')")
    assert page.locator("dialog").count() == 0
    page.click(BUTTON)
    page.click("dialog .primary")
    page.wait_for_selector("#answer:has-text('sis_a: ready again.')")
    until(lambda: client.task(task)["state"] == "done")
    page.evaluate("scrollTo(0, 0)")  # a phone shows what is for the whole plant only there
    page.click('[data-rows="for_all"] button')
    page.wait_for_selector("#answer:has-text('Whole plant: ready again.')")


REDRAWN = """selector => {
  const drawn = document.querySelector(selector).closest("span");
  drawn.replaceWith(drawn.cloneNode(true));
}"""


def test_the_keyboard_is_after_an_answer_where_it_was_before_the_question(
    browser: Any, plant: tuple[str, PlantClient]
) -> None:
    address, client = plant
    page = browser.new_context(viewport=SIZES[0], locale="en").new_page()
    page.set_default_timeout(PATIENCE_MS)
    page.goto(address)
    connected(page)
    client.operate(Verb.STOP, "sis_a")
    client.submit("sis_a 0B 7")
    page.wait_for_selector('[data-live="sis_a.state"][data-s=aborted]')
    operate(page, "sis_a")
    page.focus(".verb[data-verb=clear] button")
    page.keyboard.press("Enter")
    page.wait_for_selector(".verb[data-verb=clear] button:disabled")
    assert page.evaluate("document.getElementById('menu').contains(document.activeElement)")
    page.click("#menu-close")
    page.focus(BUTTON)
    page.keyboard.press("Enter")
    page.wait_for_selector("dialog:has-text('sets ra1, rm_sis_a in motion')")
    page.evaluate(REDRAWN, BUTTON)
    page.keyboard.press("Enter")  # on "No"
    page.wait_for_selector("dialog", state="detached")
    assert page.evaluate("selector => document.activeElement.matches(selector)", BUTTON)
