"""Workbooks of the playground: lessons and exercises beside their code, in a real browser."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.chromium import leave
from tests.lengths import sample
from tests.patience import LONG_MS
from tests.system.test_accessible import SCREENS, VIEWS, Eye

from arboleda.web.languages import contents
from arboleda_class.exercises.exercise import exercise
from arboleda_class.exercises.judge import Judge
from arboleda_class.exercises.judge_process import judged
from arboleda_class.exercises.work import packed, works

from ..exercises.works import Sample, samples

pytestmark = [
    pytest.mark.system,
    pytest.mark.requires("chromium", "playwright"),
    pytest.mark.timeout(900),
]
WORDS = {language: contents(language, "workbook") for language in ("en", "es")}
LOOP = "while True:\n    pass\n"
LESSONS = [
    "01_paths",
    "03_fsm_vs_tree",
    "04_recovery",
    "05_retry_and_conditions",
    "11_first_recipe",
    "12_own_arm",
    "13_declared_device",
    "16_drawn_tree",
]
WORKS_JUDGED = sample(["query_first", "night", "tree_xml", "two_arms"], every=2)
Open = Callable[..., Any]


@pytest.fixture
def opened(playground: str, browser: Any) -> Iterator[Open]:
    """`opened(query, **context)`: a workbook; what it asks elsewhere or what breaks in it fails the test."""
    contexts: list[Any] = []
    troubles: list[str] = []

    def go(query: str, **options: Any) -> Any:
        context = browser.new_context(**{"locale": "en", "color_scheme": "light", **options})
        contexts.append(context)
        page = context.new_page()
        page.set_default_timeout(LONG_MS)
        local = (playground, "data:")
        page.on("request", lambda each: each.url.startswith(local) or troubles.append(each.url))
        page.on("response", lambda each: troubles.append(each.url) if each.status >= 400 else None)
        page.on("pageerror", lambda error: troubles.append(str(error)))
        page.goto(f"{playground}workbook.html?{query}")
        page.wait_for_function(
            "window.arboledaWork?.shown() || document.querySelector('[data-word=nowhere]')"
        )
        return page

    yield go
    for context in contexts:
        leave(context)
    assert not troubles


REACHED = """() => {
  const code = [...document.querySelectorAll("#book-text pre")];
  const wide = code.filter((each) => each.scrollWidth > each.clientWidth);
  return wide.length > 0 && code.every((each) => wide.includes(each) === (each.tabIndex === 0));
}"""


def test_code_that_is_wider_than_its_box_is_reached_by_keys(opened: Open) -> None:
    page = opened("lesson=11_first_recipe", viewport={"width": 390, "height": 844})
    page.wait_for_function(REACHED)


def write(page: Any, text: str) -> None:
    page.evaluate("text => arboledaWork.write(text)", text)


def text_of(page: Any) -> str:
    return str(page.evaluate("arboledaWork.text()"))


def turn(page: Any, name: str) -> None:
    """Have a file in the editor."""
    page.click(f"[data-file='{name}']")
    page.wait_for_function("name => arboledaWork.shown() === name", arg=name)


def said(page: Any, word: str, language: str = "en") -> None:
    """Wait until the page says this."""
    page.wait_for_selector(f"#book-said [data-word={word}]", state="attached")
    assert page.text_content(f"#book-said [data-word={word}]") == WORDS[language][word]


def plant(page: Any) -> Any:
    """The page of the plant that was built last, once it is there."""
    said(page, "built")
    frame = page.frame_locator("#book-frame")
    frame.locator("#play-slider").wait_for()
    return frame


@pytest.mark.parametrize("name", sample(LESSONS, every=len(LESSONS)))
def test_keys_alone_reach_the_editor_of_a_lesson_and_it_prints_what_its_page_says(
    opened: Open, name: str
) -> None:
    page = opened(f"lesson={name}")
    page.wait_for_selector(".cm-content")
    page.focus("#book-files button")
    for stop in ("cm-scroller", "cm-content"):  # what scrolls is a stop of its own
        page.keyboard.press("Tab")
        assert page.evaluate("document.activeElement.className").startswith(stop)
    page.keyboard.press("Escape")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.id") == "book-arguments"
    wanted = page.inner_text("#book-text pre:has-text('$') >> nth=0").splitlines()[1:]
    page.click("[data-does=run]")
    page.wait_for_selector("#book-output:not([hidden])")
    printed = [line.rstrip() for line in page.inner_text("#book-output").splitlines() if line.strip()]
    assert printed == [line.rstrip() for line in wanted if line.strip()]
    page = opened("lesson=07_ros2_cell")
    said(page, "needs_ros")
    assert page.is_disabled("[data-does=run]") and "rclpy" not in page.inner_text("#book-said")
    said(opened("lesson=99_nothing"), "nowhere")


def test_a_program_is_changed_breaks_is_interrupted_survives_a_reload_and_is_reset(opened: Open) -> None:
    page = opened("lesson=06_blackboard")
    begun = text_of(page)
    write(page, "print('mine')\nraise ValueError('no such thing')\n")
    page.click("[data-does=run]")
    page.wait_for_selector(".book-problem")
    assert page.inner_text(".book-problem") == "ValueError: no such thing"
    assert page.inner_text("#book-output") == "mine\n"
    page.reload()
    page.wait_for_selector(".cm-line:has-text('no such thing')")
    write(page, LOOP)
    page.click("[data-does=run]")
    page.click("[data-does=interrupt]")  # waits until it can be pressed
    said(page, "stopped")
    page.on("dialog", lambda each: each.accept())
    page.click("[data-does=reset]")
    assert text_of(page) == begun
    page.click("[data-does=run]")
    page.wait_for_function("document.getElementById('book-output').textContent.includes('walk')")


def test_an_exercise_is_judged_played_mended_and_handed_in_as_by_the_command(
    opened: Open, tmp_path: Path
) -> None:
    page = opened("exercise=query_first", viewport={"width": 1366, "height": 768})
    plant(page)
    assert page.evaluate("document.getElementById('book-editor').offsetHeight") > 400
    page.click("[data-does=hint]")
    page.click("[data-does=judge]")
    said(page, "fails")
    page.click("[data-does=hint]")
    said(page, "fails")
    assert exercise("query_first").hints[1]["en"].split("`")[0].strip()[:20] in page.inner_text("#book-hint")
    assert page.evaluate("document.getElementById('book-results').offsetHeight") > 150
    page.click("[data-does=play]")
    frame = page.frame_locator("#book-frame")
    frame.locator("#play:not(:has(#play-mishaps)) #play-slider").wait_for()  # nothing can be begun in it
    frame.locator("#play-slider").focus()
    page.keyboard.press("End")
    frame.locator("[data-tree] g.node.is-failure, [data-tree] g.node.is-success").first.wait_for()
    frame.locator("[data-play=begin]").click()
    frame.locator("#play-clock:has-text('0:00')").wait_for()
    [right] = [each for each in samples("query_first") if each.right][:1]
    for name, content in right.files.items():
        turn(page, name)
        write(page, content.decode())
    page.click("[data-does=judge]")
    said(page, "passes")
    page.click("[data-does=download]")
    said(page, "name_first")
    page.fill("#book-student", "Ana")
    with page.expect_download() as download:
        page.click("[data-does=download]")
    handed = tmp_path / download.value.suggested_filename
    download.value.save_as(handed)
    [work] = works([handed])
    assert (work.student, handed.name) == ("Ana", "query_first-Ana.zip")
    packed(work, tmp_path / "packed.zip")
    assert _members(handed.read_bytes()) == _members((tmp_path / "packed.zip").read_bytes())
    assert judged(work).passes
    page.on("dialog", lambda each: each.accept())
    page.click("[data-does=reset]")
    said(page, "built")
    page.set_input_files("#book-load", str(handed))
    said(page, "built")
    page.wait_for_function("text => arboledaWork.text() === text", arg=right.files[name].decode())


def test_another_language_of_a_workbook_tells_of_the_same_run(opened: Open) -> None:
    page = opened("exercise=query_first")
    frame = plant(page)
    frame.locator("#play-mishaps summary").click()
    frame.locator("[data-fault=reboot]").click()
    frame.locator("#play-marks i").wait_for(state="attached")
    page.click("#book-language")
    page.wait_for_selector("html[lang=es]")
    again = page.frame_locator("#book-frame")
    again.locator("[data-rows=happened] :text('Reiniciar')").first.wait_for()
    assert again.locator("#play-marks i").count() == 1


def _members(content: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(content)) as pack:
        return {each: pack.read(each) for each in pack.namelist()}


def test_the_judge_says_the_same_in_a_browser_as_here(opened: Open) -> None:
    page = opened("exercise=night")
    plant(page)
    for work in _few():
        files = {name: content.decode() for name, content in work.files.items()}
        request = {"exercise": work.exercise, "files": files}
        found = page.evaluate("request => arboledaPython.ask('judge', request)", request)
        assert found.pop("film") is bool(found["findings"] and found["runs"]), work
        assert found == Judge(exercise(work.exercise), work.files).judge().plain, work


def _few() -> Iterator[Sample]:
    """A right work and two wrong ones of some exercises."""
    for name in WORKS_JUDGED:
        every = list(samples(name))
        yield from [each for each in every if each.right][:1]
        yield from [each for each in every if not each.right][:2]


@pytest.mark.requires("axe_playwright_python")
@pytest.mark.parametrize(("language", "screen"), sample(VIEWS, every=2))
def test_axe_finds_nothing_in_a_workbook_and_nobody_scrolls_sideways(
    opened: Open, language: str, screen: str
) -> None:
    page = opened("exercise=retry", locale=language, **SCREENS[screen])
    said(page, "built", language)
    eyes = Eye(page)
    for part in ("text", "code", "plant"):
        if page.is_visible(f"[data-show={part}]"):
            page.click(f"[data-show={part}]")
        eyes.look(part)
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), part
    assert not eyes.violations, "\n".join(eyes.violations)
