"""A cell made on the page of its plant, in a real browser: drawn, tried, proved, mended, and put to work."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from packages.arboleda_drivers.tests.real.modbus.bench import PlayedModbus
from tests.chromium import leave
from tests.lengths import sample
from tests.patience import PATIENCE_MS, PATIENCE_S
from tests.ports import unused_port
from tests.system.page import PLACES, connected, running
from tests.system.test_accessible import Eye

from arboleda.cli.new import write
from arboleda.plant_file.loader import load
from arboleda.plant_file.versions import Versions

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]

PLANT = """# A cell for tests of the page.
name: lab
uses: [rest.xml]
kinds:
  lamp: # shines while the arm works
    facts: {lit: bool}
    verbs:
      shine: {effect: switch, sets: {lit: true}}
      dark:  {effect: switch, sets: {lit: false}}
cells:
  cell:
    devices:
      loader: {kind: arm, model: scara}
      lamp:   {kind: lamp}
    targets:
      home: {loader: {deg: [0, 0], mm: 0}}
      feed: {loader: {deg: [60, 20], mm: 80, approach_mm: 40}}
"""
DOOR = """      door:
        kind: gate
        driver:
          modbus:
            host: 127.0.0.1
            port: %d
            facts: {guard: {discrete: 0, words: {open: 0, closed: 1}}}
            verbs: {open: {write: [{holding: 0, value: 1}]}}
            sequence: {write: {holding: 2}, accepted: {input: 2}, done: {input: 3}}
    targets:
"""
REST = '<root BTCPP_format="4"><BehaviorTree ID="Rest"><loader_home/></BehaviorTree></root>\n'
TAKES = '<loader_visit target="feed"><jaw_close width_mm="30" force_n="20"/></loader_visit>'
LAPTOP = {"viewport": {"width": 1366, "height": 900}, "locale": "en"}
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "locale": "es"}
RED = "rgb(179, 36, 28)"
COLOUR = "selector => getComputedStyle(document.querySelector(selector)).color"
PANELS = ("draft", "cells", "try", "prove", "device")
PANEL_NAMES = ("Changes", "Cells and recipes", "Try", "Prove", "Devices", "Proposals")
LONG_MS = 4 * PATIENCE_MS  # of what takes another process
OFFER = "#make-offers button:text-is('cells.cell.places: {feed: {supply: true}}')"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "plant.yaml").write_text(PLANT)
    (tmp_path / "rest.xml").write_text(REST)
    return tmp_path


@pytest.fixture
def unsaid(folder: Path) -> Path:
    """The plant, whose recipe takes a part of which nobody says where it lies."""
    jaw = "      jaw: {kind: gripper, tool_of: loader}\n    targets:\n"
    (folder / "plant.yaml").write_text(PLANT.replace("    targets:\n", jaw))
    (folder / "rest.xml").write_text(REST.replace("<loader_home/>", TAKES))
    return folder


@pytest.fixture
def address(folder: Path) -> Iterator[str]:
    """A plant that comes back to its port after a restart, whatever other tests start meanwhile."""
    port = str(unused_port())
    with running(folder / "state", "--plant", str(folder / "plant.yaml"), "--port", port) as found:
        yield found


class Person:
    """Person at a page: what is pressed is counted; a script that fails fails the test."""

    def __init__(self, browser: Any, address: str, tab: str = "make", **screen: Any) -> None:
        self.presses = 0
        self.troubles: list[str] = []
        self.context = browser.new_context(**screen)
        self.page = self.context.new_page()
        self.page.set_default_timeout(PATIENCE_MS)
        self.page.on("pageerror", lambda error: self.troubles.append(f"{error} {error.stack}"))
        self.page.goto(f"{address}/?tab={tab}")
        connected(self.page)
        if tab == "make":
            self.page.wait_for_selector(".make-cell", state="attached", timeout=LONG_MS)

    def press(self, selector: str) -> None:
        self.presses += 1
        self.page.click(selector)

    def write(self, selector: str, text: str) -> None:
        self.presses += 1
        self.page.fill(selector, text)

    def sees(self, selector: str, text: str) -> None:
        self.page.wait_for_function(
            "([at, words]) => document.querySelector(at)?.textContent.includes(words)",
            arg=[selector, text],
            timeout=LONG_MS,
        )

    def part(self, name: str) -> None:
        if name in PLACES and not self.page.is_visible(f".within [data-tab={name}]"):
            self.press(f".tabs [data-tab={PLACES[name]}]")
        self.press(f"[data-tab={name}]:visible")

    def panel(self, name: str) -> None:
        self.press(f"[data-make-panel={name}]")

    def go(self) -> None:
        leave(self.context)
        assert self.troubles == []


@pytest.mark.smoke
def test_a_recipe_is_made_tried_proved_mended_and_put_to_work(
    browser: Any, address: str, folder: Path
) -> None:
    me = Person(browser, address, **LAPTOP)
    page = me.page
    # a target, as a copy of another one that is turned away from it
    me.panel("cells")
    me.write(".make-target-name", "tray")
    page.select_option(".make-target-like", "feed")
    me.press("[data-new-target=cell]")
    page.wait_for_selector("[aria-label='tray loader']")
    me.write("[aria-label='tray loader'] input >> nth=0", "-45")
    page.press("[aria-label='tray loader'] input >> nth=0", "Tab")
    # a recipe of it, drawn further: a lamp before, a retry around
    me.write("#make-recipe", "to_tray")
    page.wait_for_selector("#make-end option[value=tray]", state="attached")
    page.select_option("#make-end", "tray")
    me.press("[data-make=carry]")
    page.wait_for_selector("#draw-rows [data-path='1.0'][aria-label*=loader_let_go]", timeout=LONG_MS)
    me.press("#draw-rows [data-path='0']")
    me.press("[data-how=before]")
    me.write("#draw-search", "lamp_shine")
    me.press("[data-kind=lamp_shine]:visible")
    page.wait_for_selector("#draw-rows [data-path='0'][aria-label*=lamp_shine]")
    me.press("[data-how=around]")
    me.write("#draw-search", "RetryUntil")
    me.press("[data-kind=RetryUntilSuccessful]:visible")
    page.wait_for_selector("#draw-rows [data-path='0'][data-mark=mistake]")
    me.write("[data-port=num_attempts]", "2")
    page.press("[data-port=num_attempts]", "Tab")
    page.wait_for_selector("#draw-rows [data-path='0'][aria-label*='num_attempts=2']:not([data-mark])")
    # simulated, and looked at
    me.part("make")
    me.panel("try")
    page.wait_for_selector("#make-try_recipe option[value='cell to_tray']", state="attached", timeout=LONG_MS)
    page.select_option("#make-try_recipe", "cell to_tray")
    me.press("[data-make=try]")
    me.sees("#make-try-state", ": done")
    # what nobody notices, and the check that would
    me.panel("prove")
    page.select_option("#make-prove_recipe", "to_tray")
    page.select_option("#make-prove_kind", "forgets")
    page.select_option("#make-budget", "600")
    me.press("[data-make=prove]")
    page.wait_for_selector("#make-proof [data-find-check]", timeout=2 * LONG_MS)
    me.press("#make-proof li:has-text('lamp.lit is false') [data-find-check] >> nth=0")
    me.sees("#make-proof .make-check", "lamp: lit becomes true would notice it")
    me.press("#make-proof .make-check button")
    me.sees("#make-proof .make-check", "The check is in the draft")
    # put to work
    me.panel("draft")
    me.sees("#make-changes", "to_tray.xml")
    me.press("[data-make=keep]")
    me.press("dialog button.primary")
    me.sees("#make-note", "version")
    me.go()
    kept = load(folder / "plant.yaml")
    assert [each.name for each in kept.cells[0].recipes] == ["rest", "to_tray"]
    assert 'lamp_becomes lit="true"' in (folder / "to_tray.xml").read_text()
    assert "# shines while the arm works" in (folder / "plant.yaml").read_text()
    assert [each.by for each in Versions(folder / "plant.yaml").all()][-1] == "somebody"
    assert me.presses <= 40


@pytest.mark.parametrize("act", ["discard", "keep"])
def test_the_keyboard_stays_beside_a_button_that_takes_no_press_any_more(
    browser: Any, address: str, act: str
) -> None:
    me = Person(browser, address, **LAPTOP)
    page = me.page
    me.panel("cells")
    me.write(".make-target-name", "tray")
    page.select_option(".make-target-like", "feed")
    me.press("[data-new-target=cell]")
    button = f"[data-make={act}]"
    page.wait_for_selector(f"{button}:enabled")
    page.focus(button)
    page.keyboard.press("Enter")
    page.wait_for_selector("dialog button.primary", timeout=LONG_MS)
    page.focus("dialog button.primary")
    page.keyboard.press("Enter")
    page.wait_for_selector(f"{button}:disabled", timeout=LONG_MS)
    assert page.evaluate("document.activeElement.matches('.make-bar fieldset button:enabled')")
    me.go()


def test_a_tryout_is_looked_at_as_a_record_and_the_way_leads_back(browser: Any, address: str) -> None:
    me = Person(browser, address, **LAPTOP)
    me.panel("try")
    me.press("[data-make=try]")
    me.sees("#make-try-state", ": done")
    me.page.select_option("#make-fault", label="loader: Reboot its board")
    me.press("[data-make=try_fault]")
    me.sees("#make-try-state", "loader: Reboot its board: ")
    me.press("#make-tried a >> nth=1")
    me.page.wait_for_selector("#record-slider", timeout=LONG_MS)
    me.sees("h1", "the draft, simulated")
    assert not me.page.is_visible(".to-teach")
    me.press("[data-past=failure_after]")
    me.page.wait_for_selector("[data-cell=cell] g.node", timeout=LONG_MS)
    me.press(".record-leave")
    me.page.wait_for_selector("#make-who", timeout=LONG_MS)
    me.go()


def test_a_new_device_with_a_driver_is_reached_before_it_is_added(
    browser: Any, address: str, folder: Path
) -> None:
    wire = PlayedModbus()
    me = Person(browser, address, **LAPTOP)
    me.panel("device")
    me.write("#make-role", "door")
    me.write("#make-new_kind", "gate")
    fact, verb = "#make-facts .make-form >> nth=0 >> ", "#make-verbs .make-form >> nth=0 >> "
    me.write(f"{fact}[data-key=fact]", "guard")
    me.write(f"{fact}[data-key=type]", "open, closed")
    me.write(f"{verb}[data-key=verb]", "open")
    me.page.select_option(f"{verb}[data-key=effect]", "switch")
    me.write(f"{verb}[data-key=sets]", "guard: open")
    me.page.wait_for_selector("#make-driver option[value=modbus]", state="attached", timeout=LONG_MS)
    me.page.select_option("#make-driver", "modbus")
    me.sees("#make-setting-poll_s-about", "between two polls, 0.005 to 0.5 s. Without it: 0.05")
    me.write("[data-setting=host]", "127.0.0.1")
    me.write("[data-setting=port]", "far")
    me.press("[data-make=reach]")
    me.sees("#make-reach-state", "port must be a whole number, is 'far'")
    me.write("[data-setting=port]", str(wire.port))
    me.press("[data-make=reach]")
    me.sees("label:has(> [data-setting=facts]) .make-wrong", "guard of a gate is missing")
    me.write("[data-setting=facts]", "guard: {discrete: 0, words: {open: 0, closed: 1}}")
    me.write("[data-setting=verbs]", "open: {write: [{holding: 0, value: 1}]}")
    me.write("[data-setting=sequence]", "write: {holding: 2}\naccepted: {input: 2}\ndone: {input: 3}")
    try:
        me.press("[data-make=reach]")
        me.sees("#make-reach-state", "door is there, stopped. guard: ")
    finally:
        wire.close()
    me.press("[data-make=reach]")
    me.sees("#make-reach-state", f"door was not reached: 127.0.0.1:{wire.port} is not there")
    assert "door" not in (folder / "plant.yaml").read_text()
    me.press("[data-make=add_device]")
    me.sees("#make-note", "door is in the draft, of the kind gate")
    me.panel("draft")
    me.sees("#make-problems", "Nothing to object to")
    me.press("[data-make=keep]")
    me.press("dialog button.primary")
    me.sees("#make-note", "version")
    me.press("dialog button.primary")  # the plant restarts: a device joins its cell at a start
    me.page.wait_for_selector("[data-robots=cell] :text('door')", state="attached", timeout=LONG_MS)
    me.go()
    assert "# shines while the arm works" in (folder / "plant.yaml").read_text()
    assert DOOR % wire.port in (folder / "plant.yaml").read_text()


def enabled(me: Person) -> list[str]:
    """The names of the buttons of *Make* that can be pressed, in the order of the page."""
    named = "each => each.ariaLabel ?? each.textContent"
    return list(me.page.evaluate(f"[...document.querySelectorAll('#make button:enabled')].map({named})"))


def test_the_second_person_sees_who_edits_and_takes_over_and_takes_an_offer_and_asks_for_a_restart(
    browser: Any, unsaid: Path, address: str
) -> None:
    ana = {"editor": "test-of-ana", "name": "Ana"}
    httpx.post(f"{address}/api/draft/take", json=ana, timeout=PATIENCE_S).raise_for_status()
    me = Person(browser, address, **LAPTOP)
    me.sees("#make-who", "Ana edits the draft since")
    me.page.wait_for_selector(f"{OFFER}:disabled", timeout=LONG_MS)
    me.sees("#make-offers", "cell: nothing is known of where parts lie")
    assert enabled(me) == ["Take over", *PANEL_NAMES]
    me.panel("cells")
    me.press("[data-make=take]")
    me.sees("#make-who", "You edit the draft")
    me.write(".make-target-name", "tray")
    me.press("[data-new-target=cell]")
    me.page.wait_for_selector("[aria-label='tray loader']")
    me.press("[data-make=undo]")
    me.page.wait_for_selector("[aria-label='tray loader']", state="detached")
    me.panel("draft")
    me.press(OFFER)
    me.sees("#make-changes", "cell cell, places: new, feed (supply)")
    me.sees("#make-problems", "rest ends with a part that jaw still holds")
    assert "nothing is known" not in me.page.text_content("#make-offers")
    made = httpx.get(f"{address}/api/draft", timeout=PATIENCE_S).json()["values"]
    assert made["cells"]["cell"]["places"] == {"feed": {"supply": True}}
    httpx.post(
        f"{address}/api/cells/cell/teach", json={"teacher": "Ana"}, timeout=PATIENCE_S
    ).raise_for_status()  # a restart waits for her
    me.part("settings")
    me.sees("#versions-restart button", "Restart once all cells rest")
    me.press("#versions-restart button")
    me.sees("#versions-restart", "The plant restarts once all its cells rest, as the page wants.")
    me.sees("#versions-restart button", "Do not restart")
    me.press("#versions-restart button")
    me.sees("#versions-restart button", "Restart once all cells rest")
    restart = httpx.get(f"{address}/api/versions", timeout=PATIENCE_S).json()["restart"]
    assert restart == {"by": "", "can": True}
    me.go()


def test_an_offer_that_is_pressed_just_as_the_draft_changes_counts(
    browser: Any, unsaid: Path, address: str
) -> None:
    me = Person(browser, address, **LAPTOP)
    me.press("[data-make=take]")
    me.page.wait_for_selector(f"{OFFER}:enabled", timeout=LONG_MS)
    place = ["cells", "cell", "targets", "feed", "loader", "mm"]
    step = {
        "editor": me.page.evaluate("sessionStorage.getItem('arboleda_editor')"),
        "place": place,
        "value": 79,
    }
    httpx.post(f"{address}/api/draft/set", json=step, timeout=PATIENCE_S).raise_for_status()
    me.press(OFFER)
    me.sees("#make-changes", "cell cell, places: new, feed (supply)")
    me.sees("#make-changes", "target feed of loader: from")
    me.go()


def test_a_device_that_the_draft_is_wrong_about_is_marked_and_its_form_refuses_what_check_does(
    browser: Any, address: str
) -> None:
    ana = {"editor": "ana-12345", "name": "Ana"}
    wrong = {"effect": "switch", "sets": {"lit": True}}
    post = httpx.Client(base_url=address, timeout=PATIENCE_S).post
    post("/api/draft/take", json=ana).raise_for_status()
    step = {"editor": "ana-12345", "place": ["kinds", "lamp", "verbs", "raise"], "value": wrong}
    post("/api/draft/set", json=step).raise_for_status()
    step |= {"place": ["cells", "cell", "devices", "lift"], "value": {"kind": "lamp"}}
    post("/api/draft/set", json=step).raise_for_status()
    me = Person(browser, address, "draw", **LAPTOP)
    me.sees("#draw-who", "Ana edits the draft since")
    me.press("#draw [data-make=take]")
    me.sees("#draw-who", "You edit the draft.")
    me.part("make")
    me.panel("cells")
    for role in ("lamp", "lift"):
        me.page.wait_for_selector(f"[data-mark=mistake] [data-remove-device={role}]", timeout=LONG_MS)
    assert me.page.evaluate(COLOUR, ".make-lines [data-mark=mistake] strong") == RED
    me.press("[data-remove-device=lift]")
    me.page.wait_for_selector("[data-remove-device=lift]", state="detached")
    me.press("[data-change-device=lamp]")
    me.write("#make-verbs .make-form >> nth=2 >> [data-key=verb]", "lift")
    me.write("#make-verbs .make-form >> nth=0 >> [data-key=verb]", "raise")
    me.press("[data-make=add_device]")
    me.sees("#make-verbs .make-wrong", 'the name "raise" is a word of Python')
    me.page.wait_for_function("document.activeElement.value === 'raise'")
    me.write("#make-verbs .make-form >> nth=0 >> [data-key=verb]", "shine")
    me.press("[data-make=add_device]")
    me.sees("#make-note", "lamp is changed in the draft")
    me.panel("draft")
    me.sees("#make-problems", "Nothing to object to")
    me.go()


def test_a_device_is_changed_and_taken_away_and_a_cell_made_and_the_form_says_what_is_wrong(
    browser: Any, address: str
) -> None:
    me = Person(browser, address, **LAPTOP)
    me.panel("cells")
    me.press("[data-change-device=lamp]")
    shine = "#make-verbs .make-form >> nth=0 >> "
    me.write(f"{shine}[data-key=with]", "on: boolean")
    me.write(f"{shine}[data-key=sets]", "light: $on")
    me.page.press(f"{shine}[data-key=sets]", "Tab")
    me.sees("#make-verbs .make-wrong", 'there is no fact "light"; did you mean "lit"?')
    assert me.page.evaluate(COLOUR, "#make-verbs .make-wrong") == RED
    me.press("[data-make=add_device]")
    me.page.wait_for_function("document.activeElement.dataset.key === 'sets'")
    me.write(f"{shine}[data-key=sets]", "lit: $on")
    me.press("[data-make=add_device]")
    me.sees("#make-note", "lamp is changed in the draft")
    me.panel("draft")
    me.sees("#make-changes", "kind lamp, shine.with: new, on bool")
    me.sees("#make-changes", "kind lamp, shine.sets.lit: from true to $on")
    me.panel("device")
    fact = "#make-facts .make-form >> nth=0 >> [data-key=type]"
    me.page.select_option("#make-kind", "")
    me.write(fact, "boolean")
    me.page.press(fact, "Tab")
    assert me.page.input_value(fact) == "bool"
    me.page.select_option("#make-device_cell", "")
    me.write("#make-new_cell", "yard")
    me.page.select_option("#make-kind", "arm")
    me.write("#make-role", "Loader")
    me.page.press("#make-role", "Tab")
    me.sees("#make-device .make-wrong", "a role must be a name of at most 64 small letters")
    me.write("#make-role", "loader")
    me.write("#make-x_m", "3")
    me.press("[data-make=add_device]")
    me.sees("#make-note", "loader is in the draft, of the kind arm")
    me.panel("cells")
    me.press("[data-remove-device=lamp]")
    me.page.wait_for_selector("[data-remove-device=lamp]", state="detached")
    me.panel("draft")
    for line in ("new cell yard with loader", "device lamp of cell is gone", "kind lamp is gone"):
        me.sees("#make-changes", line)
    me.sees("#make-problems", "Nothing to object to")
    me.panel("cells")
    me.press("[data-remove-cell=yard]")
    me.page.wait_for_selector("[data-remove-cell]", state="detached")
    made = httpx.get(f"{address}/api/draft", timeout=PATIENCE_S).json()["values"]
    assert list(made["cells"]) == ["cell"] and "kinds" not in made
    me.go()


def test_the_devices_and_recipes_of_a_new_plant_go_for_others(browser: Any, tmp_path: Path) -> None:
    plant = write(tmp_path / "lab")[0]
    with running(tmp_path / "state", "--plant", str(plant), "--port", str(unused_port())) as address:
        me = Person(browser, address, tab="draw", **LAPTOP)
        me.sees("#draw-empty", "The draft has no tree yet")
        me.part("make")
        me.panel("cells")
        me.page.wait_for_selector("#make-end option[value=press]", state="attached", timeout=LONG_MS)
        assert me.page.locator("#make-end option").all_inner_texts() == [
            "press"
        ]  # people keep the others full
        me.press("[data-remove-python='recipes.py']")
        me.page.wait_for_selector("[data-remove-python]", state="detached")
        me.press("[data-remove-device=press]")
        me.page.wait_for_selector("[data-remove-device=press]", state="detached")
        me.write("#make-recipe", "rest")
        me.press("[data-make=empty]")
        me.page.wait_for_selector("#draw-rows [data-path='0']", timeout=LONG_MS)
        assert me.page.evaluate("document.querySelector('.draw-bar').offsetHeight") < 90  # one line
        me.part("make")
        me.panel("draft")
        for line in ("device press of cell is gone", "kind press is gone", "rest.xml: new"):
            me.sees("#make-changes", line)
        me.sees("#make-problems", "Nothing to object to")
        me.go()


def test_what_a_try_found_broken_is_put_to_work_only_when_it_is_said_twice(
    browser: Any, folder: Path, address: str
) -> None:
    me = Person(browser, address, **LAPTOP)
    me.press("[data-make=take]")
    editor = me.page.evaluate("sessionStorage.getItem('arboleda_editor')")
    broken = {"editor": editor, "file": "rest.xml", "text": REST.replace("loader_home", "AlwaysFailure")}
    httpx.post(f"{address}/api/draft/set_trees", json=broken, timeout=PATIENCE_S).raise_for_status()
    me.panel("try")
    me.press("[data-make=try]")
    me.sees("#make-try-state", ": failed")
    me.sees("#make-changes", "rest.xml")
    me.press("[data-make=keep]")
    me.sees("dialog", "Not proved since the last change.")
    me.press("dialog button.primary")
    me.sees("dialog", "It is broken. Put it to work all the same?")
    me.press("dialog button:not(.primary)")
    me.go()
    assert "loader_home" in (folder / "rest.xml").read_text()


@pytest.mark.requires("axe_playwright_python")
@pytest.mark.parametrize("screen", sample([PHONE, LAPTOP], every=2), ids=lambda each: each["locale"])
def test_axe_finds_nothing_in_any_panel(browser: Any, address: str, screen: dict[str, Any]) -> None:
    me = Person(browser, address, **screen)
    eye = Eye(me.page)
    for panel in PANELS:
        me.panel(panel)
        if panel == "device":
            me.page.wait_for_selector("#make-driver option[value=modbus]", state="attached", timeout=LONG_MS)
            me.page.select_option("#make-driver", "modbus")
        eye.look(panel)
        width = me.page.evaluate("document.documentElement.scrollWidth")
        assert width <= screen["viewport"]["width"], f"{panel} is {width} px wide"
    assert not eye.violations, "\n".join(eye.violations)
    me.go()


TURNED = REST.replace("<loader_home/>", "<Sequence><loader_home/><lamp_shine/></Sequence>")
WORDS = "Approve this now. <script>alert(1)</script> <b>The plant says it is safe.</b>"


def proposed(address: str, tree: str, **more: Any) -> str:
    """The hash of what an assistant proposes."""
    body = {"name": "light", "by": "bot", "words": WORDS, "trees": {"rest.xml": tree}, "recipes": ["rest"]}
    answer = httpx.post(f"{address}/api/proposals", json={**body, **more}, timeout=PATIENCE_S).json()
    assert answer["problems"] == [], answer
    return str(answer["hash"])


@pytest.mark.parametrize("screen", sample([LAPTOP, PHONE], every=2), ids=lambda each: each["locale"])
def test_a_person_looks_at_proposals_of_an_assistant_and_decides(
    browser: Any, folder: Path, screen: dict[str, Any]
) -> None:
    (folder / "plant.yaml").write_text(f"{PLANT}assistants: propose\n")
    port = str(unused_port())
    with running(folder / "state", "--plant", str(folder / "plant.yaml"), "--port", port) as address:
        first = proposed(address, TURNED)
        me = Person(browser, address, **screen)
        eye = Eye(me.page)
        me.panel("proposals")
        me.sees("#make-proposal-list", first[:12])
        me.press("[data-proposal=look]")
        me.sees("#make-proposal .make-hash", first)
        assert me.page.text_content("#make-proposal blockquote") == WORDS  # as text, which does nothing
        assert me.page.query_selector("#make-proposal script, #make-proposal blockquote b") is None
        drawn = me.page.wait_for_selector("#make-proposal img")
        assert drawn.evaluate("image => image.decode().then(() => image.naturalWidth)") > 0
        me.press("[data-proposal=prove]")
        me.page.wait_for_selector("#make-proposal table", timeout=2 * LONG_MS)
        eye.look("proposals")
        assert me.page.evaluate("document.documentElement.scrollWidth") <= screen["viewport"]["width"]
        assert not eye.violations, "\n".join(eye.violations)
        me.write("#make-reason", "the lamp is broken")
        me.press("[data-proposal=reject]")
        me.sees("#make-proposal-list", "the lamp is broken")
        second = proposed(address, TURNED.replace("<lamp_shine/>", "<lamp_dark/>"), words="")
        me.press(f"[data-proposal=look][data-hash='{second}']")
        me.press(f"[data-proposal=approve][data-hash='{second}']")
        me.press("dialog button.primary")
        me.page.wait_for_selector("[data-proposal=approve]", state="detached", timeout=LONG_MS)
        rows = httpx.get(f"{address}/api/proposals").json()
        assert [(each["hash"], each["stage"]) for each in rows] == [(second, "approved"), (first, "rejected")]
        assert "lamp_dark" in (folder / "rest.xml").read_text()
        me.go()
