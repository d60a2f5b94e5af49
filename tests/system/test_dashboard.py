"""The page in a real browser, on a plant with virtual robots."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from arboleda.model.messages import ENDED, Fact, Remember, TaskState
from arboleda.store.sqlite import Store

from ..patience import PATIENCE_MS
from .conftest import SHIPPED
from .page import PARTS, connected, ended, lead_out, operate, running, show, until

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]

LAPTOP = {"viewport": {"width": 1366, "height": 768}, "locale": "en"}
PHONE = {"viewport": {"width": 360, "height": 740}, "has_touch": True}
EVERY_CELL = (
    "state => [...document.querySelectorAll('.scopes .pill')].every(pill => pill.dataset.s === state)"
)
STOPS = "document.querySelector('[data-rows=events]').textContent.split('stop plant').length - 1"
Open = Callable[..., Any]


@pytest.fixture(scope="module")
def quick_plant(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with running(tmp_path_factory.mktemp("state")) as found:
        yield found


@pytest.fixture(scope="module")
def slow_plant(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with running(tmp_path_factory.mktemp("slow"), "--rate", "1") as found:
        yield found


@pytest.fixture
def address(quick_plant: str) -> str:
    """A plant that is ready, however the test before has left it."""
    until(lambda: lead_out(quick_plant))
    return quick_plant


@pytest.fixture
def slow(slow_plant: str) -> str:
    """A plant whose tasks take as long as real ones, so that there is time to do something meanwhile."""
    until(lambda: lead_out(slow_plant))
    return slow_plant


@pytest.fixture(scope="module")
def half_idle(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A plant where the task lot42 of sis_c fails in its first step; nobody gave sis_b one."""
    folder = tmp_path_factory.mktemp("half-idle")
    plant = yaml.safe_load(SHIPPED.read_text())
    plant["cells"]["sis_c"]["drive_to_start"] = False
    # A page knows the trees that it was shown, and a busy machine may show none for a second or two.
    plant["timing"] = {"dwell_s": 4}
    file = folder / "plant.yaml"
    file.write_text(yaml.safe_dump(plant))
    with running(folder, "--plant", str(file), "sis_c 2A 5 #lot42") as found:
        yield found


@pytest.fixture(scope="module")
def silent(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A plant with shared zones, one of them in quarantine, whose boards never come."""
    folder = tmp_path_factory.mktemp("silent")
    with Store(folder / "plant.sqlite") as store:
        store.keep(Remember(fact=Fact.QUARANTINE, name="table", value="arm_left"))
    shared = str(SHIPPED.with_name("shared.yaml"))
    with running(folder, "--plant", shared, "--boards", "real", "--rate", "1") as found:
        yield found


@pytest.fixture(scope="module")
def household(browser: Any) -> Any:
    """One person's browser: what it remembers is remembered in all its tabs."""
    return browser.new_context(**LAPTOP)


@pytest.fixture
def open_page(browser: Any, household: Any, address: str) -> Iterator[Open]:
    """`open_page("tasks")`: a tab that shows that part, with options one of a browser of its own.

    A script that fails fails the test.
    """
    opened: list[Any] = []
    troubles: list[str] = []

    def go(part: str = "cells", *, at: str = address, token: str = "", **options: Any) -> Any:
        context = browser.new_context(**(LAPTOP | options)) if options else household
        page = context.new_page()
        opened.append(page)
        page.set_default_timeout(PATIENCE_MS)
        page.on("pageerror", lambda error: troubles.append(str(error)))
        page.goto(f"{at}/?tab={part}")
        if token:
            page.fill("input", token)
            page.press("input", "Enter")
        connected(page)
        return page

    yield go
    for each in opened:
        each.close()
    assert troubles == []


def send(page: Any, text: str) -> str:
    """Type a task and send it; its id."""
    show(page, "tasks")
    page.fill("#task-text", text)
    page.click("#task-send")
    return taken(page, text)


def taken(page: Any, text: str) -> str:
    page.wait_for_function("text => answer.textContent.startsWith(`Taken: ${text}`)", arg=text)
    found = re.search(r"#([\w.-]+)\)", page.inner_text("#answer"))
    assert found is not None
    return found[1]


def wait_for_task(page: Any, task: str, state: str) -> None:
    """Wait until the page shows it so; a task that is to end is led there where the machine held its cell."""
    if TaskState(state) in ENDED:
        ended(page.evaluate("location.origin"), task)
    page.wait_for_selector(f'[data-rows=tasks] [data-row="{task}"][data-s="{state}"]', state="attached")


def wait_for_answer(page: Any, words: str, state: str) -> None:
    page.wait_for_function(
        "([words, state]) => answer.textContent.includes(words) && answer.dataset.s === state",
        arg=[words, state],
    )


def wait_for_stop(page: Any, state: str) -> None:
    page.wait_for_selector(f'.stop-state[data-s="{state}"]')


def get_ready(page: Any) -> None:
    """Lead every cell out, as the plant advises: a stop finds an arm now with a part, now without."""
    address = page.evaluate("location.origin")
    until(lambda: lead_out(address))
    page.wait_for_function(EVERY_CELL, arg="idle")
    wait_for_stop(page, "ready")


def more(page: Any, cell: str, act: str) -> None:
    """Press a single act of a cell's card, which is the next one."""
    page.eval_on_selector_all("details.more", "all => all.forEach((each) => (each.open = true))")
    page.click(f'[data-rows="ways.{cell}"] [data-s=next] button[data-act={act}]:enabled')


def by_panel(page: Any) -> None:
    """Clear, reset and resume the whole plant."""
    operate(page)
    for verb, after in (("clear", "stopped"), ("reset", "paused"), ("resume", "idle")):
        page.click(f".verb[data-verb={verb}] button")
        if verb == "resume":
            page.click("dialog:has-text('Whole plant: robots may move') .primary")
        wait_for_answer(page, "Done", "good")
        page.wait_for_function(EVERY_CELL, arg=after)
    wait_for_stop(page, "ready")


@pytest.mark.smoke
def test_a_task_is_sent_by_clicking_moves_the_tree_and_ends_done(open_page: Open) -> None:
    page = open_page("tasks")
    for choice in ("[data-value=sis_a]", "[data-value=storage]"):
        page.click(f"#task-form {choice}")
    for place in ("[data-node='0']", "[data-node='7']", "[data-station='7']"):
        page.click(f"[data-maps=sis_a] {place}")
    assert page.input_value("#task-text") == "sis_a 0B 7"
    page.click("#task-send")
    task = taken(page, "sis_a 0B 7")
    show(page, "cells")
    page.wait_for_selector(".cell.chosen g.node.current")
    page.wait_for_selector(".cell.chosen g.node.is-success[data-path='0']")
    show(page, "tasks")
    wait_for_task(page, task, "done")


@pytest.mark.smoke
def test_stop_is_confirmed_by_the_robots_and_cleared_and_reset(open_page: Open) -> None:
    page = open_page("tasks")
    task = send(page, "sis_c 0C 8")
    wait_for_task(page, task, "running")
    page.click("#stop")
    wait_for_stop(page, "stopped")
    assert "All 6 robots latched and still" in page.inner_text(".stop-state")
    wait_for_task(page, task, "failed")
    assert "stopped by the operator" in page.inner_text(f'[data-row="{task}"]')
    get_ready(page)


def test_a_stop_needs_neither_socket_nor_http_and_is_one_act_where_both_are_there(open_page: Open) -> None:
    page = open_page("events")
    before = page.evaluate(STOPS)
    page.click("#stop")
    wait_for_stop(page, "stopped")
    get_ready(page)
    assert page.evaluate(STOPS) == before + 1
    page.evaluate("window.socket.disconnect()")
    page.click("#stop")
    wait_for_answer(page, "The plant took the stop", "good")
    page.reload()
    connected(page)
    wait_for_stop(page, "stopped")
    by_panel(page)
    page.route("**/api/**", lambda route: route.abort())
    page.click("#stop")
    wait_for_stop(page, "stopped")
    get_ready(page)


def test_the_advice_on_the_card_leads_out_and_the_tab_shows_trouble(open_page: Open) -> None:
    page = open_page()
    page.wait_for_function("document.title === 'arboleda'")
    page.click("#stop")
    wait_for_stop(page, "stopped")
    page.wait_for_function("document.title.startsWith('⚠ sis_a')")
    assert page.get_attribute("link[rel~=icon]", "href").endswith("/tree_trouble.svg")
    for act in ("clear", "reset", "resume"):
        more(page, "sis_a", act)
    page.wait_for_selector('[data-live="sis_a.state"][data-s=idle]')
    page.click('[data-rows="ready.sis_b"] button')
    page.wait_for_selector('[data-live="sis_b.state"][data-s=idle]')
    wait_for_answer(page, "sis_b: ready again.", "good")
    page.click("[data-rows=for_all] button")
    wait_for_answer(page, "Whole plant: ready again.", "good")
    page.wait_for_function("document.title === 'arboleda'")
    assert page.get_attribute("link[rel~=icon]", "href").endswith("/tree.svg")


def test_a_button_stays_while_its_row_changes_and_what_moves_a_robot_is_asked_once(
    open_page: Open, slow: str
) -> None:
    page = open_page("tasks", at=slow)
    task = send(page, "sis_b 0B 7")
    wait_for_task(page, task, "running")
    button = page.query_selector(f"[data-row='{task}'] button[data-act=cancel]")
    button.focus()
    time = f"""document.querySelector("[data-row='{task}'] .column-4").innerText"""
    for _ in range(2):
        page.wait_for_function(f"before => {time} !== before", arg=page.evaluate(time))
    assert button.evaluate("button => document.activeElement === button")
    operate(page, "sis_b")
    page.click(".verb[data-verb=hold] button")
    page.click("#menu-close")
    page.click('[data-rows="ready.sis_b"] button')
    page.wait_for_selector("dialog[open]")
    assert "this sets ra2, rm_sis_b in motion" in page.inner_text("#question")
    page.click("dialog .primary")
    show(page, "tasks")
    wait_for_task(page, task, "done")


def test_what_is_wrong_is_said_as_text_and_what_cannot_be_sent_is_not_kept(open_page: Open) -> None:
    page = open_page("tasks")
    page.fill("#task-text", "sis_a 0D 7")
    page.press("#task-text", "Enter")
    wait_for_answer(page, "'0D' is not a path of sis_a", "bad")
    page.fill("#task-text", "<img/src=x/onerror=window.broken=1> 0B 7")
    page.click("#task-send")
    wait_for_answer(page, "'<img/src=x/onerror=window.broken=1>' is not a cell", "bad")
    assert page.evaluate("[window.broken, document.images.length]") == [None, 0]
    show(page, "cells")
    assert page.inner_text("#answer") == "", "it was said of another part of the page"
    show(page, "tasks")
    page.evaluate("window.socket.disconnect()")
    page.fill("#task-text", "sis_a 0B 7")
    page.click("#task-send")
    wait_for_answer(page, "Not sent", "bad")
    page.wait_for_selector("#connection:not([hidden])")
    assert "what you see is old" in page.inner_text("#connection")


def test_a_plant_whose_boards_never_come_is_not_called_silent_and_an_override_is_asked_twice(
    open_page: Open, silent: str
) -> None:
    page = open_page("panel", at=silent, locale="en")  # an address of before, which opens the menu
    page.evaluate("""() => {
        const live = arboleda.live;
        window.empty = 0;
        arboleda.live = (number, patch) => {
            live(number, patch);
            empty += Object.keys(patch).length === 0;
        };
    }""")
    page.wait_for_function("empty > 5")
    assert page.is_hidden("#connection") and page.locator(".silent").count() == 0
    row = '[data-row=table][data-s="quarantined"]'
    page.click(f"{row} [data-act=override]")
    page.click("dialog button:has-text('No')")
    page.click(f"{row} [data-act=override]")
    page.click("dialog:has-text('with your own eyes') .primary")
    assert page.is_visible(row)
    page.click("dialog:has-text('journal') .primary")
    page.wait_for_selector('[data-row=table][data-s="free"]')
    show(page, "events")
    page.wait_for_selector("[data-rows=events] .row:has-text('override table')")


def test_language_part_and_cell_are_in_the_address_and_going_back_leads_through_them(open_page: Open) -> None:
    page = open_page("tasks&cell=sis_b&lang=es", locale="en")
    assert page.is_visible("[data-maps=sis_b]") and "Tarea nueva" in page.inner_text("#task-form")
    assert page.get_attribute("html", "lang") == "es" and "Paro (software)" in page.inner_text("#stop")
    page.fill("#task-text", "sis_a 0D 7")
    page.click("#task-send")
    wait_for_answer(page, "'0D' no es un camino de sis_a", "bad")
    show(page, "settings")
    page.click("[data-language=en]")
    page.wait_for_selector("#part-settings h2:text('This browser')")
    assert "cell=sis_b" in page.url and "lang=en" in page.url
    page.reload()
    connected(page)
    page.wait_for_selector("html[lang=en]")
    with page.context.expect_page() as opened:
        page.click("[data-tab=log]", modifiers=["ControlOrMeta"])
    other = opened.value
    connected(other)
    assert other.is_visible("#part-events") and "cell=sis_b" in other.url
    assert page.is_visible("#part-settings")
    other.close()
    assert "Paro (software)" in open_page(locale="es-MX").inner_text("#stop")
    page = open_page("cells&cell=%3Cimg src=x%3E")
    wait_for_answer(page, "There is no cell <img src=x> in this plant", "bad")
    assert "cell=" not in page.url

    page.click("[data-choose=sis_c]")
    show(page, "tasks")
    page.wait_for_selector("#part-tasks:not([hidden])")
    operate(page, "sis_b")
    assert "tab=cells" in page.url and "cell=sis_b" in page.url
    page.go_back()
    page.wait_for_selector("#menu", state="hidden")
    page.wait_for_selector(".cell.chosen[data-cell=sis_c]")
    page.go_back()
    assert page.is_visible("#part-tasks")
    page.go_back()
    page.wait_for_selector(".cell.chosen[data-cell=sis_c]", state="attached")
    page.go_back()
    page.wait_for_selector(".cell.chosen[data-cell=sis_a]", state="attached")
    page.go_forward()
    page.wait_for_selector(".cell.chosen[data-cell=sis_c]", state="attached")


def test_a_link_to_a_task_shows_the_leaf_that_failed_and_an_idle_cell_offers_to_send_one(
    open_page: Open, half_idle: str
) -> None:
    page = open_page("tasks", at=half_idle, locale="en")
    wait_for_task(page, "lot42", "failed")
    page.goto(f"{half_idle}/?task=lot42")
    page.wait_for_selector("#task g.node.is-failure:has-text('at start')")
    assert 'Failed in step "at start": rm_sis_c stands on node 0' in page.inner_text("#task .trouble")
    page.goto(f"{half_idle}/?task=lot43")
    page.wait_for_selector("#task:has-text('knows no such task')")
    page.goto(half_idle)
    connected(page)
    page.click("[data-choose=sis_b]")
    page.click(".cell.chosen a:has-text('Send a task to sis_b'):visible")
    page.wait_for_selector("[data-maps=sis_b]:visible")
    page.click("[data-maps=sis_b] [data-path='2A']")
    page.click("[data-maps=sis_b] [data-station='4']")
    page.click("#task-send")
    task = taken(page, "sis_b 2A 4")
    wait_for_task(page, task, "done")
    show(page, "cells")
    page.click("[data-choose=sis_b]")
    page.focus(".cell.chosen g.node[data-path=root]")
    page.keyboard.press("Enter")
    assert page.inner_text("#node-name") == "sis_b · storage"
    about = page.text_content(".cell.chosen g.node[data-path=root] title")
    assert about == "A choice: tries its branches one after the other until one succeeds."
    assert page.locator(".cell.chosen g.node text:text-is('dwell')").count() == 0
    page.click(".cell.chosen g.node:has-text('move to station 4')")
    given = page.inner_text("#node-given")
    assert "ra2" in given and "joints" in given
    page.keyboard.press("Escape")
    assert not page.is_visible("#node")


def test_the_systems_dark_is_followed_until_something_is_chosen_which_is_remembered(open_page: Open) -> None:
    background = "getComputedStyle(document.body).backgroundColor"
    page = open_page("settings", color_scheme="light")
    light = page.evaluate(background)
    assert open_page(color_scheme="dark").evaluate(background) != light
    while page.get_attribute("html", "data-look") != "dark":
        page.click(".look")
    assert page.evaluate(background) != light
    page.reload()
    connected(page)
    assert page.get_attribute("html", "data-look") == "dark"


def test_a_phone_sees_the_same_needs_no_sideways_scroll_and_does_not_read_of_a_key(open_page: Open) -> None:
    laptop, page = open_page("tasks", viewport={"width": 1280, "height": 800}), open_page("tasks", **PHONE)
    task = send(laptop, "sis_a 1A 3")
    for each in (laptop, page):
        wait_for_task(each, task, "done")
    rows = "[...document.querySelectorAll('[data-rows=tasks] .row')].map(row => row.textContent)"
    assert laptop.evaluate(rows) == page.evaluate(rows)
    assert laptop.is_visible(".stop-key") and not page.is_visible(".stop-key")
    for screen, shown in (("laptop", laptop), ("phone", page)):
        for part in PARTS:
            show(shown, part)
            there, room = shown.evaluate(
                "[document.documentElement.scrollWidth, document.documentElement.clientWidth]"
            )
            assert (screen, part, there) == (screen, part, room)
            assert shown.is_visible("#stop")


def focus(page: Any, selector: str) -> None:
    """Press Tab until this element has the focus."""
    for _ in range(80):
        if page.evaluate("selector => document.activeElement.matches(selector)", selector):
            return
        page.keyboard.press("Tab")
    pytest.fail(f"the keyboard does not reach {selector}")


def test_the_keyboard_is_enough(open_page: Open) -> None:
    page = open_page("links")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.id") == "stop"
    focus(page, "[data-tab=tasks]")
    page.keyboard.press("Enter")
    focus(page, "#task-text")
    page.keyboard.type("sis_b 2A 2")
    page.keyboard.press("Enter")
    wait_for_task(page, taken(page, "sis_b 2A 2"), "done")
    page.keyboard.press("Shift+Tab")
    focus(page, "[data-act=submit]")


def test_the_links_say_who_is_heard_and_the_time_line_is_filtered_and_downloaded(open_page: Open) -> None:
    page = open_page("links")
    page.wait_for_selector('[data-row=ra1][data-s="online"]:has-text("ready")')
    page.wait_for_function(r"/\d+\.\d Hz/.test(document.querySelector('[data-row=ra1]').textContent)")
    assert "connected" in page.inner_text("[data-live=broker]")
    show(page, "tasks")
    wait_for_task(page, send(page, "sis_b 0B 8"), "done")
    show(page, "events")
    page.click("[data-filter=events][data-value=sis_b]")
    cells = page.evaluate(
        "[...document.querySelectorAll('[data-rows=events] .column-1')].map(c => c.innerText)"
    )
    assert set(cells) == {"sis_b"}
    with page.expect_download() as download:
        page.click("[data-act=download]")
    events = json.loads(Path(download.value.path()).read_text())
    assert {"at", "cell", "kind", "what", "sentence"} <= events[-1].keys()
    assert any(event["sentence"].startswith("sis_b 0B 8") for event in events)


def test_a_viewer_may_stop_and_nothing_else(open_page: Open, tmp_path: Path) -> None:
    with running(tmp_path, "--host", "0.0.0.0") as address:
        token = json.loads((tmp_path / "tokens.json").read_text())["viewer"]
        page = open_page("links&cell=sis_b", at=address, token=token)
        assert page.is_visible("#part-links") and "cell=sis_b" in page.url
        assert page.locator("#make, #teach").count() == 0
        show(page, "cells")
        assert page.is_visible("[data-choose=sis_b]") and not page.is_visible(".to-teach")
        page.click("#stop")
        wait_for_stop(page, "stopped")
        operate(page)
        page.click(".verb[data-verb=clear] button")
        wait_for_answer(page, "You are logged in as a viewer", "bad")
        show(page, "tasks")
        page.fill("#task-text", "sis_a 0B 7")
        page.click("#task-send")
        wait_for_answer(page, "Sending tasks needs an operator", "bad")
        wait_for_stop(page, "stopped")


def by_touch(page: Any) -> None:
    page.tap("#stop")


def by_keyboard(page: Any) -> None:
    focus(page, "#stop")
    page.keyboard.press("Enter")


def by_held_key(page: Any) -> None:
    page.keyboard.down("Escape")
    wait_for_stop(page, "stopped")
    page.keyboard.up("Escape")


def test_stop_works_over_every_open_question(open_page: Open) -> None:
    page = open_page(**PHONE)
    ways = ((by_touch, "sis_a", "release"), (by_keyboard, "sis_a", "home"), (by_held_key, "ra1", "home"))
    for press, scope, verb in ways:
        operate(page, "sis_a")
        page.click(f"[data-scope={scope}]")
        page.click(f".verb[data-verb={verb}] button")
        page.wait_for_selector("dialog button:focus")
        press(page)
        wait_for_stop(page, "stopped")
        assert page.locator("dialog").count() == 0, f"{verb} {scope} is still asked after {press.__name__}"
        page.click("#menu-close")
        get_ready(page)


def test_beside_a_question_only_the_stop_is_reached_and_escape_or_going_back_say_no(open_page: Open) -> None:
    page = open_page("tasks")
    operate(page, "sis_a")
    page.click(".verb[data-verb=home] button")
    page.wait_for_selector("dialog button:focus")
    reached = set()
    for _ in range(8):
        page.keyboard.press("Tab")
        reached.add(page.evaluate("document.activeElement.closest('#stop, dialog, body')?.localName"))
    assert reached <= {"button", "dialog", "body"} and "button" in reached
    page.keyboard.press("Escape")
    page.wait_for_selector("dialog", state="detached")
    assert page.evaluate("document.activeElement.closest('.verb').dataset.verb") == "home"
    page.click(".verb[data-verb=home] button")
    page.wait_for_selector("dialog button:focus")
    page.go_back()
    page.wait_for_selector("dialog", state="detached")
    page.wait_for_selector("#menu", state="hidden")
    show(page, "tasks")
    assert page.inner_text(".stop-state") == "Stops every robot of the plant"
