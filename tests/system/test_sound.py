"""The sound of the page, heard in a real chromium: off at first, remembered, once for each cell."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from arboleda.cli.client import PlantClient
from arboleda.model.messages import Verb

from ..chromium import leave
from ..patience import PATIENCE_MS
from .page import connected, running

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]

# Whatever goes to the loudspeakers is heard here, too: `loudest` since the page came, and how often it began.
EAR = """
window.tones = 0;
window.ears = [];
window.loudest = 0;
const connect = AudioNode.prototype.connect;
AudioNode.prototype.connect = function (to, ...rest) {
  if (to === this.context.destination) {
    const ear = new AnalyserNode(this.context, { fftSize: 32768 });
    connect.call(this, ear);
    ears.push(ear);
  }
  return connect.call(this, to, ...rest);
};
const start = OscillatorNode.prototype.start;
OscillatorNode.prototype.start = function (...when) { tones += 1; return start.call(this, ...when); };
setInterval(() => {
  for (const ear of ears) {
    const heard = new Float32Array(ear.fftSize);
    ear.getFloatTimeDomainData(heard);
    loudest = Math.max(loudest, ...heard.map(Math.abs));
  }
}, 50);
"""


@pytest.fixture
def plant(tmp_path: Path) -> Iterator[tuple[str, PlantClient]]:
    with running(tmp_path / "state") as address:
        yield address, PlantClient(tmp_path / "state")


@pytest.fixture
def visit(browser: Any) -> Iterator[Callable[[str], Any]]:
    """A tab of one person's browser, in which nothing has been touched yet."""
    context = browser.new_context(locale="en", viewport={"width": 1366, "height": 768})
    context.add_init_script(EAR)

    def go(address: str) -> Any:
        page = context.new_page()
        page.set_default_timeout(PATIENCE_MS)
        page.goto(address)
        connected(page)
        return page

    yield go
    leave(context)


def in_trouble(page: Any) -> None:
    page.wait_for_selector("html[data-stands=trouble]")


def well(page: Any) -> None:
    page.wait_for_selector("html[data-stands=well]")


def test_who_has_turned_it_on_hears_it_once_for_a_cell_that_needs_somebody_also_the_next_time(
    plant: tuple[str, PlantClient], visit: Callable[[str], Any]
) -> None:
    address, client = plant
    page = visit(f"{address}/?tab=settings")
    well(page)
    button = page.get_by_role("button", name="Sound when a cell needs somebody")
    assert button.get_attribute("aria-pressed") == "false"
    assert button.get_attribute("title").startswith("The sound is off")
    button.focus()
    page.keyboard.press("Enter")
    page.wait_for_selector(".sound[data-sound=on][aria-pressed=true]")
    page.wait_for_function("tones === 3 && loudest > 0.1")  # the sound that says that it is on
    page.close()

    page = visit(f"{address}/?tab=settings")
    # Nothing was touched here yet: the browser lets nothing sound, and the page says so.
    well(page)
    page.wait_for_selector(".sound[data-sound=waits][aria-pressed=true]")
    assert "once you have clicked" in page.get_attribute(".sound", "title")
    page.click("h1")
    page.wait_for_selector(".sound[data-sound=on]")
    assert page.evaluate("tones") == 0
    client.operate(Verb.STOP, "sis_a")
    in_trouble(page)
    page.wait_for_function("tones === 3 && loudest > 0.1")
    page.wait_for_selector('[data-live="sis_a.state"][data-s=aborted]', state="attached")
    client.operate(Verb.CLEAR, "sis_a")
    page.wait_for_selector('[data-live="sis_a.state"][data-s=stopped]', state="attached")
    assert page.evaluate("tones") == 3  # it is the same cell that needs somebody
    client.operate(Verb.STOP, "sis_b")
    page.wait_for_function("tones === 6")
    page.click(".sound")
    page.wait_for_selector(".sound[data-sound=off][aria-pressed=false]")
    client.operate(Verb.STOP, "sis_c")
    page.wait_for_selector('[data-live="sis_c.state"][data-s=aborted]', state="attached")
    assert page.evaluate("tones") == 6
