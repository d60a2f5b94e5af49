"""The form that is made of what cells offer, in a real browser."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from ..chromium import people
from .page import connected, running, show

BENCH = Path(__file__).parents[2] / "examples" / "lab_bench" / "plant.yaml"
pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]
ACCEPTED = """before => {
  const answer = document.getElementById("answer").innerText;
  return answer !== before && answer.startsWith("Aceptada");
}"""


@contextmanager
def opened(browser: Any, address: str) -> Iterator[Any]:
    """The form of tasks; a script that fails fails the test."""
    with people(browser) as new:
        page = new(viewport={"width": 360, "height": 740}, locale="es")
        page.goto(f"{address}/?tab=tasks")
        connected(page)
        yield page


def pressed(page: Any) -> list[str]:
    return page.eval_on_selector_all(
        "#task-form [aria-pressed=true]",
        "all => all.filter(each => each.checkVisibility()).map(each => each.innerText)",
    )


def sent(page: Any) -> str:
    """The id of the task that was sent; the answer to the one before stays until the next comes."""
    before = page.inner_text("#answer")
    page.click("#task-send")
    page.wait_for_function(ACCEPTED, arg=before)
    found = re.search(r"#([\w.-]+)\)", page.inner_text("#answer"))
    assert found is not None
    return found[1]


def test_a_person_gives_tasks_by_the_forms_of_their_recipes(browser: Any, tmp_path: Path) -> None:
    with running(tmp_path) as address, opened(browser, address) as page:
        page.click("#task-form [data-value=sis_a]")
        page.click("[data-fields=sis_a] [data-path='0B']")
        page.click("#task-form [data-value=sis_b]")
        assert page.input_value("#task-text") == "sis_b", "another cell forgets what was chosen"
        assert "0B" not in pressed(page)
        assert page.inner_text("legend:has-text('Estación')") == "Estación del almacén"
        page.click("[data-fields=sis_b] [data-parameter=station] [data-station='4']")
        page.click("[data-fields=sis_b] [data-parameter=path] [data-path='2A']")
        assert page.input_value("#task-text") == "sis_b 2A 4"
        assert pressed(page) == ["sis_b", "Almacenar una pieza", "2", "6 A", "4", "2A"]
        task = sent(page)
        page.wait_for_selector(f'[data-rows=tasks] [data-row="{task}"][data-s=done]', state="attached")
        page.click("#task-form :text('la que la termine antes')")
        page.click("#task-form [data-value=palletizing]")
        assert page.input_value("#task-text") == "sis_a,sis_b,sis_c palletizing"
        assert not page.is_visible("[data-fields=sis_b] [data-parameter]")
        task = sent(page)
        page.goto(f"{page.url.partition('?')[0]}?tab=tasks&task={task}")
        page.wait_for_selector("#task :text('Por qué allí: ')")


def test_a_bench_of_declared_devices_is_worked_by_its_form(browser: Any, tmp_path: Path) -> None:
    with running(tmp_path, "--rate", "4", "--plant", str(BENCH)) as address, opened(browser, address) as page:
        assert page.locator("#twin").count() == 0
        page.click("#task-form [data-value=incubate]")
        page.click("[data-recipe=incubate] [data-set='40']")
        page.click("[data-recipe=incubate] [data-set='5']")
        assert page.input_value("#task-text") == "bench incubate 5 40"
        assert "Fill what the reader knows" in page.inner_text("[data-recipe=incubate] .hint")
        task = sent(page)
        show(page, "cells")
        heater = '[data-rows="devices.bench"] [data-row=heater]'
        page.wait_for_selector(f"{heater}:has-text('clamped sí, celsius 40')")
        page.wait_for_selector(".cell.chosen g.node.current:has-text('heater heat 20')")
        show(page, "tasks")
        page.wait_for_selector(f'[data-rows=tasks] [data-row="{task}"][data-s=done]', state="attached")
        show(page, "links")
        page.wait_for_selector(
            "[data-rows=links] [data-row=heater]:has-text('lid open, clamped no, celsius 20')"
        )
