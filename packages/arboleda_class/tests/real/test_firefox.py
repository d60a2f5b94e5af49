"""The playground in a Firefox: it starts, has the digests of here, and exercises work in it."""

from __future__ import annotations

import json
from collections.abc import Iterator

import pytest
from tests.firefox import Page, firefox
from tests.lengths import length
from tests.shared import need_tool

from arboleda.web.languages import contents
from arboleda_class.playground.tab import Tab

from ..exercises.works import samples

pytestmark = [
    pytest.mark.system,
    pytest.mark.requires("firefox-esr", "websockets"),
    pytest.mark.timeout(900),
]
SEEDS = range(1, length(2, whole=4))
PHONE = 390, 844


@pytest.fixture(scope="module")
def page(playground: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    """A tab for all tests of this file: a Firefox takes seconds to start."""
    with firefox(need_tool("firefox-esr"), tmp_path_factory.mktemp("firefox")) as tab:
        yield tab
        asked = [each for each in tab.asked if each.startswith("http")]
        assert [each for each in asked if not each.startswith(playground)] == []


def test_seeds_have_the_digests_of_here_and_a_person_gives_a_task_and_has_a_board_reboot(
    page: Page, playground: str
) -> None:
    page.goto(f"{playground}?plant=own_board&lang=en")
    page.wait_for("window.arboledaPlay?.ready()")
    here = Tab()
    for seed in SEEDS:
        asked = {"seed": seed, "cycles": 1}
        wanted = json.loads(here.hear(json.dumps({"do": "simulate", **asked})))
        assert page.evaluate("asked => arboledaPlay.ask('simulate', asked)", asked) == wanted

    page.goto(f"{playground}?lang=en")
    page.wait_for("window.arboledaPlay?.ready()")
    page.evaluate("arboledaPlay.pause()")
    page.click("[data-tab=tasks]")
    page.evaluate(
        """() => {
            const text = document.getElementById('task-text');
            text.value = 'sis_a 0A 8';
            text.dispatchEvent(new Event('input', { bubbles: true }));
        }""",
        None,
    )
    page.click("#task-send")
    page.wait_for("document.querySelector('#answer[data-s=good]')")
    page.evaluate("arboledaPlay.advance(80)")
    page.click("[data-tab=cells]")
    page.wait_for("document.querySelector('[data-tree=sis_a] g.node.current')")
    page.click("#play-mishaps summary")
    page.click("[data-fault=reboot]")
    page.evaluate("arboledaPlay.advance(160)")
    page.wait_for("document.querySelector('g.node.is-failure, g.node.is-halted')")
    page.click("[data-tab=cells]")
    page.wait_for("document.querySelector('#twin-robots li')?.textContent.startsWith('ra1')")
    page.view(*PHONE)
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


def test_an_exercise_is_judged_wrong_and_then_right(page: Page, playground: str) -> None:
    words = contents("en", "workbook")
    page.goto(f"{playground}workbook.html?exercise=retry&lang=en")
    page.wait_for("document.querySelector('#book-said [data-word=built]')")
    page.click("[data-does=judge]")
    page.wait_for("document.querySelector('#book-said [data-word=fails]')")
    [right] = [each for each in samples("retry") if each.right][:1]
    for name, content in right.files.items():
        page.click(f"[data-file='{name}']")
        page.wait_for(f"arboledaWork.shown() === {json.dumps(name)}")
        page.evaluate("text => arboledaWork.write(text)", content.decode())
    page.click("[data-does=judge]")
    page.wait_for("document.querySelector('#book-said [data-word=passes]')")
    assert page.evaluate("document.querySelector('[data-word=passes]').textContent") == words["passes"]
