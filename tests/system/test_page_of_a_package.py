"""A package from outside adds a part to the page, with a script of its own; one that breaks harms nobody."""

from __future__ import annotations

from pathlib import Path

import pytest

from ..added_package import install
from ..chromium import browsers
from .page import connected, running, show

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]

CODE = """
from arboleda.dashboard.asset_files import Assets
from arboleda.dashboard.page_part import Act, PagePart, Place, Section
from arboleda.dashboard.tags import live, tag


def shelf(spot):
    tag("p", id="{name}")
    live("p", "{name}")


async def take(request):
    request.say(f"taken: {{request.of}}", good=True)


PAGE = PagePart(
    assets=Assets(package="{name}", script="shelf.js", styles=("shelf",)),
    sections=(Section(place=Place.TAB, name="{name}", build=shelf),),
    acts={{"fetch": Act(name="Fetch", take=take)}},
    face=lambda moment: {{"text/{name}": [f"{{len(moment.snapshot['cells'])}} cells", ""]}},
)
"""
SCRIPT = """
import { send } from "../acts.js";

export function start() {
  document.getElementById("shelf").textContent = "begun";
}

export function arrive({ tab }) {
  if (tab === "shelf") send("fetch", "a box");
}
"""


def put(folder: Path, name: str, script: str) -> None:
    """Install a package with this script."""
    install(folder, name, "", group="arboleda.page", what="PAGE")
    (folder / f"{name}.py").unlink()
    (folder / name / "assets").mkdir(parents=True)
    (folder / name / "__init__.py").write_text(CODE.format(name=name), "utf-8")
    (folder / name / "assets/shelf.js").write_text(script, "utf-8")
    (folder / name / "assets/shelf.css").write_text(f"#{name} {{ color: rgb(1, 2, 3); }}", "utf-8")


def test_the_script_of_a_package_asks_its_own_code(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    site = tmp_path / "site"
    put(site, "broken", "export function start() { throw new Error('no'); }")
    put(site, "shelf", SCRIPT)
    put(site, "wrong", "this is no script")
    monkeypatch.syspath_prepend(site)
    with running(tmp_path / "state") as address, browsers() as launch:
        page = launch().new_context().new_page()
        page.goto(address)
        connected(page)
        page.wait_for_selector("#shelf:text('begun')", state="attached")
        page.wait_for_selector("#answer:text('A script of the package broken does not work: no')")
        show(page, "shelf")
        page.wait_for_selector("#answer:text('taken: a box')")
        assert page.inner_text("[data-live=shelf]").endswith(" cells")
        colour = page.evaluate("getComputedStyle(document.getElementById('shelf')).color")
        assert colour == "rgb(1, 2, 3)"
        page.click("#stop")
        page.wait_for_selector(".stop-state[data-s=stopped]")
