"""A package from outside adds a part to the page, with a script of its own; one that breaks harms nobody."""

from __future__ import annotations

from pathlib import Path

import pytest

from ..added_package import install, register
from ..chromium import browsers, people
from .page import connected, running, show

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]

CODE = """
from arboleda.dashboard.asset_files import Assets
from arboleda.dashboard.page_part import PageAct, PagePart, Place, Section
from arboleda.dashboard.tags import live, tag


def shelf(spot):
    tag("p", id="{name}")
    live("p", "{name}")


async def take(request):
    request.say(f"taken: {{request.of}}", good=True)


PAGE = PagePart(
    assets=Assets(package="{name}", script="shelf.js", styles=("shelf",)),
    sections=(Section(place=Place.TAB, name="{name}", build=shelf),),
    acts={{"fetch": PageAct(name="Fetch", take=take)}},
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


ORDERS = """
from arboleda.extension import Act, Chart, Field, Page, Part, Rows, Tab, Value


class Orders(Part):
    def start(self):
        self.keep([{"id": "a", "customer": "<b>ana</b>", "amount": 2}])

    def keep(self, open):
        self.open = open
        amounts = {row["customer"]: row["amount"] for row in open}
        self.plant.show(open=open, amounts=amounts, count={"sis_a": len(open)})


def add(asked):
    part = asked.part(Orders)
    part.keep([*part.open, {"id": asked.values["customer"], **asked.values}])


def cancel(asked):
    part = asked.part(Orders)
    part.keep([row for row in part.open if row["id"] != asked.of])
    return f"{asked.of} is cancelled"


FIELDS = [Field("customer"), Field("amount", lower=1, upper=20), Field("way", choices=["road", "rail"])]
CANCEL = Act("cancel", "Cancel", cancel, asks="Cancel the order of {of}?")
PAGE = Page(
    tabs=[
        Tab("orders", "Orders", [
            Act("add", "Order", add, fields=FIELDS),
            Rows("open", "Open", columns=["customer", "amount"], acts=[CANCEL], empty="None is open."),
            Chart("amounts", "Amounts", kind="bars"),
        ])
    ],
    card=[Value("count", "open orders")],
    settings=[Act("drop", "Drop all", lambda asked: asked.part(Orders).keep([]))],
    script="orders.js",
)
"""
ORDERS_SCRIPT = """
import { changed, send, value } from "../arboleda.js";

export function start() {
  const seen = document.documentElement.dataset;
  changed("orders/open", (open) => (seen.open = `${open.length} ${value("orders/count").sis_a}`));
  window.cancel = async (of) => {
    const { sentence, good } = await send("orders.cancel", of);
    seen.said = `${sentence} ${good}`;
  };
}
"""


def test_a_page_that_is_declared_takes_orders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    site = tmp_path / "site"
    (site / "orders/assets").mkdir(parents=True)
    (site / "orders/__init__.py").write_text(ORDERS, "utf-8")
    (site / "orders/assets/orders.js").write_text(ORDERS_SCRIPT, "utf-8")
    points = {"arboleda.page": ["orders = orders:PAGE"], "arboleda.parts": ["orders = orders:Orders"]}
    register(site, "orders", points)
    monkeypatch.syspath_prepend(site)
    with running(tmp_path / "state") as address, browsers() as launch, people(launch()) as new:
        page = new()
        page.goto(address)
        connected(page)
        page.wait_for_selector("[data-live='orders:count:sis_a']:text('1')", state="attached")
        show(page, "orders")
        orders = page.locator("#part-orders")
        assert orders.locator(".column-0").all_inner_texts() == ["<b>ana</b>"]
        page.fill("[name=customer]", "eva")
        page.fill("[name=amount]", "7")
        page.click("#part-orders [type=submit]")
        page.wait_for_selector("#part-orders .outcome:text('Done: Order.')")
        page.wait_for_selector("#part-orders [data-row=eva]:has-text('7')")
        page.wait_for_function("document.documentElement.dataset.open === '2 2'")
        assert page.input_value("[name=customer]") == ""
        assert orders.locator("rect").count() == 2
        assert orders.locator("[data-live='orders:amounts.about']").inner_text().startswith("Last 7 (eva)")
        page.evaluate("document.querySelector('#part-orders form').noValidate = true")
        page.fill("[name=customer]", "eva")
        page.fill("[name=amount]", "70")
        page.press("[name=amount]", "Enter")
        page.wait_for_selector(".outcome[data-s=bad]:text('amount is a whole number from 1 to 20, not')")
        assert page.input_value("[name=amount]") == "70"
        page.click("[data-row=eva] .act")
        page.click("dialog button:text('Yes')")
        page.wait_for_selector("#answer:text('eva is cancelled')")
        page.evaluate("void cancel('a')")
        page.click("dialog:has-text('Cancel the order of a?') button:text('Yes')")
        page.wait_for_function("document.documentElement.dataset.said?.startsWith('a is cancelled true')")
        page.wait_for_selector("#part-orders .empty:text('None is open.')")
        page.click(".tabs [data-tab=settings]")
        page.click("#part-settings [type=submit]")
        page.wait_for_selector("#part-settings .outcome:text('Done: Drop all.')")
