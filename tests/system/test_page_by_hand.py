"""Where the keyboard stays on the page."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from arboleda.cli.client import PlantClient
from arboleda.model.messages import Verb

from ..patience import PATIENCE_MS
from .page import connected, running

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
    page.eval_on_selector("article[data-cell=sis_b] details.more", "more => (more.open = true)")
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
