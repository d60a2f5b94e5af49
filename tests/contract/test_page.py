"""The page before a plant whose every text is an attack."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from ..chromium import browsers
from ..patience import PATIENCE_MS, PATIENCE_S
from ..system.page import operate, show

pytestmark = pytest.mark.requires("chromium", "playwright")

EVIL = "<img src=x onerror=window.broken=1>`${window.broken=2}`</script>\"' {{1+1}}"


@pytest.fixture(scope="module")
def hostile() -> Iterator[list[str]]:
    """What the process with the page printed; its address is the last line."""
    script = str(Path(__file__).with_name("hostile_page.py"))
    environ = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    with subprocess.Popen([sys.executable, script, EVIL], env=environ, **pipes) as child:
        assert child.stdin is not None and child.stdout is not None
        yield [child.stdout.readline().strip() for _ in range(2)]
        child.stdin.close()
        assert child.wait(PATIENCE_S) == 0


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with browsers() as launch:
        yield launch().new_context()


@pytest.fixture
def tab(browser: Any, hostile: list[str]) -> Iterator[Any]:
    made = browser.new_page()
    made.set_default_timeout(PATIENCE_MS)
    made.goto(hostile[-1])
    made.wait_for_selector("#connection", state="hidden")
    yield made
    made.close()


def test_a_second_page_in_one_process_is_refused(hostile: list[str]) -> None:
    assert "This process shows the page of another plant already" in hostile[0]


def test_an_address_without_a_page_and_another_method_are_one_sentence(hostile: list[str]) -> None:
    with httpx.Client(
        base_url=hostile[-1], trust_env=False, headers={"origin": hostile[-1]}, timeout=PATIENCE_S
    ) as client:
        absent, other = client.get("/nothing"), client.post("/")
    assert (absent.status_code, absent.json()) == (404, {"sentence": "Not Found"})
    assert (other.status_code, other.headers["allow"]) == (405, "GET")


def test_nothing_that_anybody_wrote_is_rendered_as_html(tab: Any) -> None:
    for part in ("tasks", "links", "events", "cells"):
        show(tab, part)
        tab.wait_for_selector(f"#part-{part}:has-text('<img src=x')")
    tab.click("[data-choose=sis_a]")
    tab.click(".cell.chosen g.node.current")
    tab.wait_for_selector("#node:has-text('<img src=x')")
    operate(tab, "sis_a")
    tab.click(".verb[data-verb=hold] button")
    tab.wait_for_selector("#answer:has-text('<img src=x')")
    show(tab, "tasks")
    tab.fill("#task-text", EVIL)
    tab.click("#task-send")
    tab.wait_for_selector("#answer:has-text('{{1+1}}')")
    assert tab.inner_text("h1") == EVIL
    assert tab.evaluate("[window.broken ?? null, document.images.length]") == [None, 0]
