"""A tree of the draft edited on the page, in a real browser: by mouse, by keys alone, by touch."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from tests.chromium import people
from tests.patience import PATIENCE_S
from tests.system.page import connected, running
from tests.system.test_accessible import Eye

from arboleda_make.editing.tree_text import TreeText, walk

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]

OWN_TREE = Path(__file__).parents[5] / "examples/own_tree/plant.yaml"
LAB_BENCH = OWN_TREE.parents[1] / "lab_bench/plant.yaml"
TEXT = OWN_TREE.with_name("tend.xml").read_text()
LAPTOP = {"viewport": {"width": 1366, "height": 900}, "locale": "en"}
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "locale": "es"}
EDITOR = "test-of-trees"
Open = Callable[..., Any]


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with running(tmp_path_factory.mktemp("state"), "--plant", str(OWN_TREE)) as found:
        yield found


@pytest.fixture
def editor(browser: Any, address: str) -> Iterator[Open]:
    """`editor()`: the editor with the tree of the plant; a script that fails fails the test."""
    with people(browser) as new:

        def go(**options: Any) -> Any:
            since = forget_draft(address)
            page = new(**(options or LAPTOP))
            mine = {"arboleda_editor": EDITOR, "arboleda_mine": since}
            page.add_init_script(f"Object.assign(sessionStorage, {json.dumps(mine)})")
            page.goto(f"{address}/?tab=draw")
            connected(page)
            page.wait_for_selector("#draw-rows [data-path='7.2']")
            return page

        yield go


def forget_draft(address: str) -> str:
    """Have the draft of the plant be as its files are; since when it is edited by EDITOR."""
    editor = {"editor": EDITOR}
    taking = editor | {"name": "a test"}
    httpx.post(f"{address}/api/draft/take", json=taking, timeout=PATIENCE_S).raise_for_status()
    state = httpx.post(f"{address}/api/draft/discard", json=editor, timeout=PATIENCE_S).raise_for_status()
    return str(state.json()["editor"]["since"])


def row(path: str) -> str:
    return f"#draw-rows [data-path='{path}']"


def labelled(page: Any, path: str, words: str) -> None:
    """Wait until the node at a path says this."""
    page.wait_for_selector(f"{row(path)}[aria-label*='{words}']")


def downloaded(page: Any) -> str:
    with page.expect_download() as download:
        page.click("[data-draw=download]")
    return Path(download.value.path()).read_text()


def kinds(text: str, tree: str) -> dict[str, str]:
    return {path: element.name for path, element in walk(TreeText(text).tree(tree))}


def middle(page: Any, selector: str, share: float = 0.5) -> tuple[float, float]:
    page.locator(selector).scroll_into_view_if_needed()
    box = page.locator(selector).bounding_box()
    return box["x"] + 40, box["y"] + box["height"] * share


def test_by_mouse_a_node_is_put_in_given_a_value_dragged_and_undone(editor: Open) -> None:
    page = editor()
    assert downloaded(page) == TEXT, "a tree that nobody changed stays as it is, byte for byte"
    page.click("[data-draw-tree=Carry]")
    page.click(row("1.0"))
    page.fill("#draw-search", "mill_run")
    page.click("[data-kind=mill_run]:visible")
    page.wait_for_selector(f"{row('1.0.2')}[data-mark=mistake]")
    page.click(row("1.0.2"))
    page.wait_for_selector("#draw-marks:has-text('needs program')")
    page.select_option("[data-port=program]", "1001")
    page.wait_for_selector(f"{row('1.0.2')}:not([data-mark])")
    page.mouse.move(*middle(page, row("1.0.2")))
    page.mouse.down()
    page.mouse.move(*middle(page, row("1.0.0"), 0.1), steps=5)
    page.mouse.up()
    labelled(page, "1.0.0", "mill_run, program=1001")
    text = downloaded(page)
    wanted = '        <Sequence>\n          <mill_run program="1001"/>\n          <mill_clamp on="true"/>'
    assert text == TEXT.replace('        <Sequence>\n          <mill_clamp on="true"/>', wanted)
    for _ in range(3):
        page.click("[data-draw=undo]")
    page.wait_for_selector("[data-draw=undo][disabled]")
    assert downloaded(page) == TEXT
    page.click("[data-draw=redo]")
    labelled(page, "1.0.2", "mill_run")
    page.click("[data-draw-tree=Tend]")
    page.fill("#draw-search", "mill_close")
    page.mouse.move(*middle(page, "[data-kind=mill_close]"))
    page.mouse.down()
    page.mouse.move(*middle(page, row("0.0"), 0.9), steps=5)
    page.mouse.up()
    labelled(page, "0.1", "mill_close")


def test_values_are_written_a_part_becomes_a_tree_and_somebody_else_is_not_overwritten(
    editor: Open, address: str
) -> None:
    page = editor()
    page.click("[data-draw-tree=Carry]")
    page.click(row("0.0"))
    page.focus("[data-port=width_mm]")
    page.evaluate("document.activeElement.select()")
    page.keyboard.type("31")
    page.keyboard.press("Tab")
    labelled(page, "0.0", "width_mm=31")
    assert page.evaluate("document.activeElement.dataset.variable") == "width_mm"
    page.keyboard.press("Tab")
    page.evaluate("document.activeElement.select()")
    page.keyboard.type("41")
    page.keyboard.press("Tab")
    labelled(page, "0.0", "width_mm=31 force_n=41")
    assert page.get_attribute("[data-port=force_n]", "max") == "60"
    page.fill("[data-port=force_n]", "99")
    page.press("[data-port=force_n]", "Tab")
    page.wait_for_selector("[data-port=force_n][aria-invalid]")
    page.wait_for_selector("#draw-marks:has-text('must be from 0 to 60')")
    page.click("[data-variable=force_n]")
    page.fill("[data-port=force_n]", "to")
    page.press("[data-port=force_n]", "Tab")
    labelled(page, "0.0", "force_n={to}")

    page.click("[data-draw-tree=Tend]")
    page.click(row("3"))
    page.fill("#draw-name", "Milling")
    page.click("[data-draw=extract]")
    page.click("[data-draw-tree=Milling]")
    page.wait_for_selector("[data-draw-tree=Milling][aria-pressed=true]")
    page.fill("#draw-name", "program")
    page.click("[data-draw=add_parameter]")
    page.wait_for_selector("[data-draw-parameter=program]")
    there = TreeText(downloaded(page))
    assert there.node("Tend", "3").value("ID") == "Milling"
    assert there.node("Milling", "root").name == "RetryUntilSuccessful"
    ben = {"editor": "test-of-ben", "name": "Ben"}
    httpx.post(f"{address}/api/draft/take", json=ben, timeout=PATIENCE_S).raise_for_status()
    page.wait_for_selector("#draw-who:has-text('Ben edits the draft since')")
    assert page.is_disabled("[data-draw=remove]")
    step = {"editor": "test-of-ben", "file": "tend.xml", "text": TEXT}
    httpx.post(f"{address}/api/draft/set_trees", json=step, timeout=PATIENCE_S).raise_for_status()
    page.click("#draw [data-make=take]")
    page.wait_for_selector("#draw-who:has-text('You edit the draft.')")
    page.wait_for_selector("[data-draw-tree=Milling]", state="detached")
    assert page.is_enabled("[data-draw=remove]")


def test_by_keys_alone_a_tree_is_drawn(editor: Open) -> None:
    page = editor()
    press = page.keyboard.press
    page.focus(row("root"))
    for _ in range(4):
        press("ArrowDown")
    press("Alt+ArrowUp")
    labelled(page, "0", "Carry")
    press("ArrowDown")
    press("Alt+ArrowUp")
    press("Alt+ArrowDown")
    press("Alt+ArrowDown")
    labelled(page, "2", "have the door open")
    press("Alt+ArrowUp")
    labelled(page, "1", "have the door open")
    press("+")
    page.keyboard.type("sleep")
    press("Enter")
    page.wait_for_selector(f"{row('1.2')}[aria-selected=true]")
    for _ in range(20):
        if page.evaluate("document.activeElement.dataset.path === '1.2'"):
            break
        press("Tab")
    press("Enter")
    page.keyboard.type("500")
    press("Tab")
    labelled(page, "1.2", "msec=500")
    found = kinds(downloaded(page), "Tend")
    assert [found[path] for path in ("0", "1", "1.0", "1.1", "1.2", "2")] == [
        "SubTree", "Fallback", "mill_says", "mill_open", "Sleep", "mill_close"
    ]  # fmt: skip


def test_by_touch_a_node_is_dragged_at_its_grip(editor: Open) -> None:
    page = editor(**PHONE)
    assert page.inner_text("[data-draw=undo]") == "Deshacer"
    page.tap(f"{row('2')} .draw-label")
    page.wait_for_selector(f"{row('2')}[aria-selected=true]")
    touch = page.context.new_cdp_session(page)
    page.evaluate("selector => document.querySelector(selector).scrollIntoView({block: 'center'})", row("3"))
    grip = page.locator(f"{row('2')} .draw-grip").bounding_box()
    to = page.locator(row("4")).bounding_box()
    x, y = grip["x"] + grip["width"] / 2, grip["y"] + grip["height"] / 2
    goal = to["y"] + to["height"] * 0.9

    def finger(type: str, *points: tuple[float, float]) -> None:
        touch.send(
            "Input.dispatchTouchEvent", {"type": type, "touchPoints": [{"x": x, "y": y} for x, y in points]}
        )

    finger("touchStart", (x, y))
    for part in range(1, 6):
        finger("touchMove", (x + 20, y + (goal - y) * part / 5))
    finger("touchEnd")
    labelled(page, "4", "mill_close")
    assert kinds(downloaded(page), "Tend")["4"] == "mill_close"


def test_a_recipe_in_python_is_copied_as_a_tree_of_the_draft_and_opens(browser: Any, tmp_path: Path) -> None:
    with running(tmp_path, "--plant", str(LAB_BENCH)) as address, people(browser) as new:
        page = new(**LAPTOP)
        page.goto(f"{address}/?tab=draw")
        connected(page)
        page.click("#draw-python-box summary")
        page.select_option("#draw-python", "weigh")
        assert page.input_value("#draw-copy") == "weigh_tree"
        page.click("[data-draw=copy_recipe]")
        page.wait_for_selector(row("3.1"))
        assert page.input_value("#draw-file") == "weigh_tree"
        page.wait_for_selector("#draw-note:has-text('weigh was copied as the tree weigh_tree')")
        trees = httpx.get(f"{address}/api/draft", timeout=PATIENCE_S).json()["trees"]
        assert trees == ["weigh_tree.xml"]
        page.goto(f"{address}/?tab=make")
        connected(page)
        page.click("[data-make-panel=cells]")
        page.click("[data-copy-recipe=incubate]")
        page.wait_for_selector(f"#part-draw {row('1.0.7')}")
        assert page.input_value("#draw-file") == "incubate_tree"


@pytest.mark.requires("axe_playwright_python")
def test_a_target_is_chosen_in_the_twin_by_a_click_and_by_keys_and_axe_finds_nothing(editor: Open) -> None:
    page = editor()
    eye = Eye(page)
    page.click(row("4"))
    page.select_option("[data-more]", "_skipIf")
    page.fill("[data-port=_skipIf]", "seen ==")
    page.press("[data-port=_skipIf]", "Tab")
    page.wait_for_selector("[data-port=_skipIf][aria-invalid]")
    eye.look("a node with a mistake")
    page.fill("#draw-search", "go")
    eye.look("a kind that is looked for")
    page.click("[data-draw-tree=TakeOut]")
    page.click(row("0"))
    value = page.input_value("[data-port=target]")
    page.click("[data-from-twin=target]")
    page.wait_for_selector(f"#draw-twin [data-point='{value}'][aria-pressed=true]:focus")
    eye.look("targets in the twin")
    assert not eye.violations, "\n".join(eye.violations)
    listed = page.eval_on_selector_all(
        "[data-port=target] option", "all => all.map(({ value }) => value).filter(Boolean)"
    )
    points = page.eval_on_selector_all("[data-point]", "all => all.map(({ dataset }) => dataset.point)")
    assert sorted(points) == sorted(listed)
    box = page.locator("#draw-twin-view").bounding_box()
    placed = "[...document.querySelectorAll('[data-point]')].every(({ style }) => style.transform)"
    page.wait_for_function(f"() => {placed}")
    for point in points:
        spot = page.locator(f"[data-point='{point}']").bounding_box()
        assert 0 < spot["x"] - box["x"] < box["width"] and 0 < spot["y"] - box["y"] < box["height"], point
    page.click("[data-point=done]")
    labelled(page, "0", "target=done")
    page.wait_for_selector("#draw-twin", state="hidden")
    page.focus("[data-from-twin=target]")
    page.keyboard.press("Enter")
    page.wait_for_selector("[data-point=done][aria-pressed=true]:focus")
    page.keyboard.press("Escape")
    page.wait_for_selector("[data-from-twin=target]:focus")
    page.keyboard.press("Enter")
    page.wait_for_selector("[data-point=done]:focus")
    page.keyboard.press("Shift+Tab")
    chosen = page.evaluate("document.activeElement.dataset.point")
    page.keyboard.press("Enter")
    labelled(page, "0", f"target={chosen}")
