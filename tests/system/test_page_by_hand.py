"""Small things that somebody with a keyboard, a laptop or a phone meets on the page."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from arboleda.cli.client import PlantClient
from arboleda.model.messages import Verb

from ..patience import PATIENCE_MS
from .page import PARTS, connected, ended, running, show

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]
WITHIN = "document.activeElement.closest('article.cell')?.dataset.cell"


@pytest.fixture(scope="module")
def plant(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, PlantClient]]:
    state = tmp_path_factory.mktemp("by-hand")
    with running(state) as address:
        yield address, PlantClient(state)


def opened(browser: Any, address: str, **how: Any) -> Any:
    page = browser.new_context(**how).new_page()
    page.set_default_timeout(PATIENCE_MS)
    page.goto(address)
    connected(page)
    return page


def test_the_keyboard_stays_at_the_card_of_an_advice_that_was_pressed(
    browser: Any, plant: tuple[str, PlantClient]
) -> None:
    address, client = plant
    page = opened(browser, address)
    client.operate(Verb.STOP, "sis_b")
    clear = "article[data-cell=sis_b] [data-act=clear]:enabled"
    page.focus(clear)
    page.keyboard.press("Enter")
    page.wait_for_selector("article[data-cell=sis_b] [data-act=reset]:enabled")
    page.wait_for_selector(clear, state="detached")
    assert page.evaluate(WITHIN) == "sis_b"
    page.focus("article[data-cell=sis_b] [data-act=reset]:enabled")
    page.keyboard.press("Enter")
    page.wait_for_selector("article[data-cell=sis_b] [data-act=reset]", state="detached")
    assert page.evaluate(WITHIN) == "sis_b"


@pytest.mark.parametrize("language", ["en", "es"])
def test_no_part_of_the_page_scrolls_sideways_on_a_laptop(
    browser: Any, plant: tuple[str, PlantClient], language: str
) -> None:
    address, client = plant
    ended(address, client.submit("sis_a 0B 7")["id"])
    page = opened(browser, f"{address}/?lang={language}", viewport={"width": 1280, "height": 800})
    for part in PARTS:
        show(page, part)
        if part == "tasks":
            page.wait_for_selector("#part-tasks .kept .column-6")
            page.wait_for_selector("#part-tasks .oee .column-6")
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), part


@pytest.mark.parametrize("phone", [{"has_touch": True, "is_mobile": True}, {}], ids=["touch", "narrow"])
def test_a_phone_does_not_read_of_a_key(
    browser: Any, plant: tuple[str, PlantClient], phone: dict[str, bool]
) -> None:
    page = opened(browser, plant[0], viewport={"width": 390, "height": 844}, **phone)
    assert not page.is_visible(".stop-key")
    assert opened(browser, plant[0], viewport={"width": 1280, "height": 800}).is_visible(".stop-key")


def test_there_is_no_last_failure_where_none_was(browser: Any, plant: tuple[str, PlantClient]) -> None:
    page = opened(browser, plant[0])
    page.wait_for_selector("article.cell.chosen .changes")
    assert not page.is_visible("article[data-cell=sis_c] .to-record")
