"""A person is asked on the page, in a real browser, and answers there."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from ..chromium import people
from .page import connected, running
from .test_accessible import Eye

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]

QUESTION = "Is the pallet <b>full</b> again?"
PLANT = """\
name: shop
uses: [recipes.py]
cells:
  tending:
    devices:
      ana: {kind: person}
    queue_limit: 5
    on_absence: go_on
"""
RECIPES = f'''\
from arboleda.recipes import recipe, work


@recipe("refill")
def refill(cell):
    """Ask whether there are parts again."""
    asked = cell.device("ana").ask("{QUESTION}", ["yes", "no parts left"])
    ways = {{"yes": [], "no parts left": cell.fail("there are no parts left")}}
    return work(asked, cell.choose(asked, ways))
'''


@contextmanager
def asking(folder: Path) -> Iterator[str]:
    """A plant whose only task asks ana."""
    (folder / "plant.yaml").write_text(PLANT)
    (folder / "recipes.py").write_text(RECIPES)
    with running(folder / "state", "--plant", str(folder / "plant.yaml"), "tending refill #asks") as address:
        yield address


@pytest.fixture
def page(browser: Any, tmp_path: Path) -> Iterator[Any]:
    """The cells on a phone, where ana is being asked; a script that fails fails the test."""
    with asking(tmp_path) as address, people(browser) as new:
        made = new(viewport={"width": 360, "height": 740}, locale="en")
        made.goto(address)
        connected(made)
        made.wait_for_selector("[data-act=answer]")
        yield made


def announced(page: Any) -> str:
    return page.inner_text(".asked [aria-live=polite]")


@pytest.mark.requires("axe_playwright_python")
def test_a_wrong_answer_is_refused_with_its_reason_and_a_press_lets_the_task_go_on(page: Any) -> None:
    assert announced(page) == f"ana is asked\n\n{QUESTION}"
    assert page.locator(".asked b").count() == 0
    buttons = page.get_by_role("button", description=QUESTION)
    assert buttons.all_inner_texts() == ["yes", "no parts left"]
    assert page.title() == "? tending: waits for ana - shop"
    assert page.get_attribute("link[rel~=icon]", "href").endswith("/tree_waits.svg")
    assert page.evaluate("document.documentElement.scrollWidth") == 360
    eye = Eye(page)
    eye.look("a question")
    assert not eye.violations, "\n".join(eye.violations)

    change = "(button, more) => { const before = button.dataset.arguments; button.dataset.arguments = more;"
    button = page.locator("[data-act=answer]").first
    before = button.evaluate(f"{change} return before; }}", '{"answer": "maybe"}')
    button.click()
    page.wait_for_selector("#answer[data-s=bad]:has-text('answers: yes, no parts left')")
    assert page.locator("[data-act=answer]").count() == 2, "the question stays"
    button.evaluate(f"{change} }}", before)

    page.get_by_role("button", name="yes", exact=True).click()
    page.wait_for_selector("[data-act=answer]", state="detached")
    page.wait_for_selector('[data-rows=tasks] [data-row=asks][data-s="done"]', state="attached")
    page.wait_for_selector("#answer:text-is('Done: Answer, ana yes.')")
    page.wait_for_function("!document.querySelector('.asked [aria-live=polite]').innerText.trim()")
    page.click("nav a[data-go*=tasks]")
    page.click("[data-rows=history] [data-row] a")
    page.wait_for_selector("#task [data-rows='task.heard'] .row")
    assert page.inner_text("#task [data-rows='task.heard'] .column-1") == QUESTION
    page.wait_for_function("document.title === 'shop'")
    assert page.get_attribute("link[rel~=icon]", "href").endswith("/tree.svg")
