"""The page of a package: its items are drawn and filled with what its part shows, and its acts are done."""

from __future__ import annotations

import asyncio
import json
import re
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest
from tests.added_package import install, register
from tests.threads import run_here

from arboleda.dashboard import asset_files, shell
from arboleda.dashboard import page as whole_page
from arboleda.dashboard.added import AddedParts
from arboleda.dashboard.desk import Desk
from arboleda.dashboard.feed import Feed
from arboleda.dashboard.package_page import page as package_page
from arboleda.dashboard.page_part import GROUP
from arboleda.dashboard.wording import words
from arboleda.host.pieces import Pieces
from arboleda.testing import shipped
from arboleda.testing.plugin import MakePlantWith
from arboleda.views import view
from arboleda.web.access.auth import Role

CODE = """
from arboleda.dashboard.package_page import Act, Chart, Field, Page, Rows, Tab, Value
from arboleda.model.errors import ArboledaError
from arboleda.model.sentence import Phrase
from arboleda.web.access.auth import Role

OPEN = Phrase("orders.open", "Open orders", es="Pedidos abiertos")
TAKEN = Phrase("orders.taken", "{amount} for {customer}", es="{amount} para {customer}")
HEARD = []


class Orders:
    def add(self, values):
        if values["customer"] == "nobody":
            raise ArboledaError("nobody orders nothing")
        HEARD.append(values)


def add(asked):
    asked.part(Orders).add(asked.values)
    return TAKEN(amount=asked.values["amount"], customer=asked.values["customer"])


def cancel(asked):
    HEARD.append(asked.of)


def look(asked):
    HEARD.append((asked.role, asked.values))


FIELDS = [
    Field("amount", "Amount", lower=1, upper=20),
    Field("customer"),
    Field("cell", choices={"a": "Cell A", "b": "Cell B"}),
    Field("note", required=False),
]
CANCEL = Act("cancel", "Cancel", cancel, asks="Cancel order {of}?")
PAGE = Page(
    tabs=[
        Tab("orders", OPEN, [
            Act("add", "Order", add, fields=FIELDS),
            Rows("open", OPEN, columns={"customer": "Customer", "amount": "Amount"}, acts=[CANCEL]),
            Chart("per_hour", "Orders an hour", kind="bars"),
            Act("look", "Look", look, role=Role.VIEWER),
        ]),
        Tab("prices", "Prices", [Value("price")]),
    ],
    card=[Value("count", "tasks that ended here")],
    settings=[Act("limit", "Set the limit", look, fields=[Field("most", lower=0.5, upper=2.0)])],
)
"""
SHOWN = {
    "open": [{"id": "o-1", "customer": "<b>", "amount": 2}, {"customer": "ana", "amount": 1, "acts": []}],
    "per_hour": {"08": 3, "09": 5},
    "count": {"sis_a": 7},
}
TYPED = {"amount": "2", "customer": " ana ", "cell": "a", "note": ""}
LAYOUT = view.layout(shipped())
Put = Callable[[str], AddedParts]


class Plant:
    """A plant whose parts offer these things."""

    def __init__(self, *things: object) -> None:
        self.things = {type(each): each for each in things}

    def ask(self, kind: type) -> Any:
        return self.things.get(kind)

    def layout(self) -> dict[str, Any]:
        return LAYOUT


class Browser:
    """A page of somebody; `said` is what it was told."""

    has_socket_connection = True

    def __init__(self, role: Role = Role.OPERATOR) -> None:
        self.environ = {"asgi.scope": {"arboleda.role": role}}
        self.said: list[str] = []

    def run_javascript(self, code: str) -> None:
        self.said.append(code)


@pytest.fixture(autouse=True)
def _here(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(package_page, "run_in_threadpool", run_here)


@pytest.fixture
def told() -> list[str]:
    """What is said of pieces that are left out."""
    return []


@pytest.fixture
def put(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, told: list[str]) -> Iterator[Put]:
    """Installs a package `orders` with this code, and gives what is added to the page."""
    monkeypatch.syspath_prepend(tmp_path / "site")

    def put(code: str = CODE) -> AddedParts:
        install(tmp_path / "site", "orders", code, group=GROUP, what="PAGE")
        return AddedParts(Pieces(tell=told.append), whole_page.OWN)

    yield put
    for name in [each for each in sys.modules if each.partition(".")[0] == "orders"]:
        del sys.modules[name]


def html(parts: AddedParts, role: Role | None = None, language: str = "en") -> str:
    plant: Any = Plant()
    return whole_page.drawn(parts, plant, LAYOUT, words(language), role and role.value)


def face(parts: AddedParts, shown: Any = SHOWN, language: str = "en") -> dict[str, Any]:
    cells = [
        {"name": name, "teaching": None, "state": "idle", "not_ready": None} for name in ("sis_a", "sis_b")
    ]
    moment: Any = SimpleNamespace(snapshot={"cells": cells}, links={"orders": shown}, words=words(language))
    return {key: value for key, value in parts.face(moment).items() if "orders" in key}


def answers(
    parts: AddedParts,
    act: str,
    more: object,
    *,
    of: str = "",
    role: Role = Role.OPERATOR,
    language: str = "en",
    part: object = None,
) -> list[tuple[Any, ...]]:
    """What somebody is answered who asks for an act of a part: (sentence, good)."""
    plant: Any = Plant(part or sys.modules["orders"].Orders())
    browser: Any = Browser(role)
    asyncio.run(
        Desk(browser, plant, Feed(plant), words(language), parts.acts).take(f"orders.{act}", of, more)
    )
    return [tuple(json.loads(f"[{code[16:-1]}]")) for code in browser.said]


def heard() -> list[Any]:
    """What the acts of the package have taken."""
    taken: list[Any] = sys.modules["orders"].HEARD
    return taken


def test_tabs_stand_in_one_place_with_labels_in_each_language(put: Put) -> None:
    parts = put(CODE)
    shown = html(parts)
    assert 'data-tab="orders" data-parts="orders prices"' in shown and ">Open orders</a>" in shown
    assert ">Pedidos abiertos</a>" in html(parts, language="es")
    tab = shown.partition('id="part-orders"')[2].partition("</section>")[0]
    assert tab.index('data-takes="orders.add"') < tab.index('data-rows="orders:open"')
    assert 'data-chart="orders:per_hour" data-kind="bars"' in tab
    assert 'data-live="orders:price"' in shown.partition('id="part-prices"')[2]


def test_a_card_has_the_value_of_its_cell(put: Put) -> None:
    parts = put(CODE)
    shown = html(parts)
    assert all(f'data-live="orders:count:{cell["name"]}"' in shown for cell in LAYOUT["cells"])
    found = face(parts)
    assert found["text/orders:count:sis_a"] == ["7", ""] and found["text/orders:count:sis_b"] == ["", ""]


def test_the_settings_have_its_form(put: Put) -> None:
    settings = html(put(CODE)).partition('id="part-settings"')[2]
    assert 'data-takes="orders.limit"' in settings
    assert (
        'type="number" name="most" autocomplete="off" required="true" min="0.5" max="2" step="any"'
        in settings
    )


def test_rows_have_texts_and_the_acts_that_are_offered(put: Put) -> None:
    found = face(put(CODE))
    assert found["rows/orders:open"] == ["o-1", "1"]
    offer = {"act": "orders.cancel", "of": "o-1", "label": "Cancel", "does": ""}
    assert found["row/orders:open/o-1"] == {"state": "", "cell": "", "texts": ["<b>", "2"], "acts": [offer]}
    assert found["row/orders:open/1"]["acts"] == []


def test_a_chart_says_its_numbers_in_words_as_well(put: Put) -> None:
    parts = put(CODE)
    found = face(parts)
    assert found["chart/orders:per_hour"] == [["08", 3], ["09", 5]]
    assert found["text/orders:per_hour.about"] == ["Last 5 (09), least 3 (08), most 5 (09)", ""]
    assert face(parts, {})["text/orders:per_hour.about"] == ["There are no numbers yet.", ""]


def test_parts_that_a_package_registers_by_names_of_their_own_are_shown_as_well(put: Put) -> None:
    links = {"orders.prices": {"price": 5.25}, "orderly": {"price": 6}, "orders": SHOWN}
    moment: Any = SimpleNamespace(snapshot={"cells": []}, links=links, words=words("en"))
    found = put(CODE).face(moment)
    assert found["text/orders:price"] == ["5.25", ""] and found["rows/orders:open"] == ["o-1", "1"]


def test_before_the_part_shows_anything_all_is_empty(put: Put, told: list[str]) -> None:
    found = face(put(CODE), {})
    assert found["rows/orders:open"] == [] and found["text/orders:price"] == ["", ""] and told == []


@pytest.mark.parametrize(
    ("broken", "piece"),
    [
        ({"open": [7]}, "open"),
        ({"open": 7}, "open"),
        ({"per_hour": [7]}, "per_hour"),
        ({"per_hour": {"08": "many"}}, "per_hour"),
        ({"per_hour": {"08": float("nan")}}, "per_hour"),
        ({"price": ["5"]}, "price"),
    ],
)
def test_an_item_whose_data_are_wrong_is_left_out_alone(
    put: Put, told: list[str], broken: dict[str, Any], piece: str
) -> None:
    parts = put(CODE)
    face(parts, SHOWN | broken)
    (said,) = told
    assert said.startswith(f"Arboleda goes on without the section orders.{piece} of orders 1: ")
    assert " is no " in said
    shown = html(parts)
    names = {"open": "data-rows", "per_hour": "data-chart", "price": "data-live"}
    there = {name for name, kind in names.items() if f'{kind}="orders:{name}"' in shown}
    assert there == {*names} - {piece} and 'data-takes="orders.add"' in shown
    assert "text/orders:count:sis_a" in face(parts)


def test_an_act_gets_plain_values_and_says_what_came_of_it(put: Put) -> None:
    parts = put(CODE)
    assert answers(parts, "add", TYPED) == [("2 for ana", True)]
    assert answers(parts, "add", TYPED, language="es") == [("2 para ana", True)]
    assert answers(parts, "limit", {"most": "1.5"}) == [("Done: Set the limit.", True)]
    taken = {"amount": 2, "customer": "ana", "cell": "a", "note": None}
    assert heard() == [taken, taken, (Role.OPERATOR, {"most": 1.5})]


@pytest.mark.parametrize(
    ("typed", "refusal"),
    [
        ({"amount": "21"}, "Amount is a whole number from 1 to 20, not '21'"),
        ({"amount": "1.5"}, "Amount is a whole number from 1 to 20, not '1.5'"),
        ({"amount": "nan"}, "Amount is a whole number from 1 to 20, not 'nan'"),
        ({"customer": "  "}, "customer is missing"),
        ({"customer": {"a": 1}}, "customer is missing"),
        ({"customer": "a" * 201}, "customer has 201 characters; at most 200 are taken"),
        ({"cell": "c"}, "cell cannot be 'c'; there are a, b"),
        ({"customer": "nobody"}, "nobody orders nothing"),
    ],
)
def test_what_is_typed_wrong_and_what_the_act_refuses_is_said(
    put: Put, told: list[str], typed: dict[str, Any], refusal: str
) -> None:
    parts = put(CODE)
    assert answers(parts, "add", TYPED | typed) == [(refusal, False)]
    assert heard() == [] and told == []


def test_what_is_no_form_at_all_is_refused(put: Put) -> None:
    assert answers(put(CODE), "add", "a word") == [("Amount is missing", False)]


def test_without_its_part_an_act_is_refused(put: Put) -> None:
    parts = put(CODE.replace("asked.part(Orders)", "asked.part(Page)"))
    assert answers(parts, "add", TYPED) == [("this plant runs no part Page", False)]


def test_an_act_in_a_row_is_told_which_row(put: Put) -> None:
    assert answers(put(CODE), "cancel", False, of="o-1") == [("Done: Cancel.", True)]
    assert heard() == ["o-1"]


def test_a_viewer_sees_and_may_what_is_for_viewers_alone(put: Put) -> None:
    parts = put(CODE)
    shown = html(parts, Role.VIEWER)
    assert re.findall(r'data-takes="([\w.]+)"', shown) == ["orders.look"]
    assert answers(parts, "look", {"x": 1}, role=Role.VIEWER) == [("Done: Look.", True)]
    assert heard() == [(Role.VIEWER, {"x": 1})]
    (refusal,) = answers(parts, "add", TYPED, role=Role.ASSISTANT)
    assert "Order needs an operator" in refusal[0] and refusal[1] is False


def test_an_act_that_breaks_is_left_out_alone_with_its_form(put: Put, told: list[str]) -> None:
    parts = put(CODE.replace("asked.part(Orders).add", "(1 / 0)"))
    broke = ("Order does not work, and is left out until the plant starts anew. The log says why.", False)
    assert answers(parts, "add", TYPED) == answers(parts, "add", TYPED) == [broke]
    assert told == [
        "Arboleda goes on without the act orders.add of orders 1: ZeroDivisionError: division by zero"
    ]
    assert answers(parts, "limit", {"most": "1"}) == [("Done: Set the limit.", True)]
    takes = re.findall(r'data-takes="([\w.]+)"', html(parts))
    assert takes == ["orders.look", "orders.limit"]


def test_the_page_is_told_what_to_ask_before_an_act(put: Put) -> None:
    asks = put(CODE).asks(words("en"))
    assert asks == {"orders.cancel": "Cancel order {of}?"}
    assert json.dumps(asks) in shell.head(words("en"), asks=asks)


def test_a_request_with_a_number_is_answered_by_that(put: Put) -> None:
    parts, browser, plant = put(CODE), Browser(), Plant()
    desk: Any = Desk(browser, plant, Feed(plant), words("en"), parts.acts)  # type: ignore[arg-type]
    asyncio.run(desk.hear(SimpleNamespace(args=["orders.cancel", "o-1", False, 4])))
    assert browser.said == ['arboleda.answer("Done: Cancel.", true, 4)', "arboleda.over(4)"]


SCRIPT = 'settings=[], script="orders.js", '


def test_a_script_gets_all_that_the_part_shows(put: Put, told: list[str], tmp_path: Path) -> None:
    plain = CODE.partition("settings=")[0] + SCRIPT + ")\n"
    (tmp_path / "site/orders/assets").mkdir(parents=True)
    (tmp_path / "site/orders/assets/orders.js").write_text("export function start() {}", "utf-8")
    parts = put(plain)
    (tmp_path / "site/orders.py").rename(tmp_path / "site/orders/__init__.py")
    sys.modules.pop("orders", None)
    parts = AddedParts(Pieces(tell=told.append), whole_page.OWN)
    assert [each.script for each in parts.assets if each.package == "orders"] == ["orders.js"]
    shown = {"more": ({"a": 1.5},), "said": sys.modules["orders"].OPEN()}
    found = face(parts, shown, language="es")
    assert found["shown/orders/more"] == [{"a": 1.5}] and found["shown/orders/said"] == "Pedidos abiertos"
    face(parts, {"more": object()})
    assert told[-1].endswith("the face of the page of orders 1: TypeError: object is no plain data")


@pytest.mark.parametrize(
    ("code", "why"),
    [
        (
            CODE.replace('Field("amount", "Amount", lower=1, upper=20)', 'Field("amount", lower=1)'),
            "one limit",
        ),
        (CODE.replace('Act("limit"', 'Act("add"'), "two acts of the page are called add"),
    ],
)
def test_a_page_that_contradicts_itself_is_left_out(put: Put, told: list[str], code: str, why: str) -> None:
    assert "part-orders" not in html(put(code))
    assert (
        told[0].startswith("Arboleda goes on without the part of the page of orders 1: ") and why in told[0]
    )


COLUMNS = "it takes Mapping[str, Text] | Sequence[str]"


@pytest.mark.parametrize(
    ("right", "wrong", "declaration", "why"),
    [
        (
            'columns={"customer": "Customer", "amount": "Amount"}',
            "columns=7",
            "Rows 'open'",
            f"columns of Rows 'open' is 7; {COLUMNS}",
        ),
        (
            "fields=FIELDS",
            'fields=["amount"]',
            "Act 'add'",
            "fields of Act 'add' is ['amount']; it takes Sequence[Field]",
        ),
        (
            'Field("customer")',
            'Field("customer", choices=7)',
            "Act 'add'",
            f"choices of Field 'customer' is 7; {COLUMNS}",
        ),
        ('"bars"', '"pie"', "Chart 'per_hour'", "kind of Chart 'per_hour' is 'pie'; it takes "),
        (
            'Tab("prices", "Prices", [Value("price")])',
            '"prices"',
            "'prices'",
            "one of tabs of the page is 'prices'; it takes Sequence[Tab]",
        ),
        (
            '[Value("price")]',
            '[Value("price"), "count"]',
            "'count'",
            "one of items of Tab 'prices' is 'count'; it takes Sequence[Item]",
        ),
        (
            'card=[Value("count", "tasks that ended here")]',
            'card="count"',
            "card of the page",
            "card of the page is 'count'; it takes Sequence[Item]",
        ),
        ('"Prices"', "7", "Tab 'prices'", "label of Tab 'prices' is 7; it takes Text"),
    ],
)
def test_what_a_page_declares_wrongly_is_left_out_alone_before_anybody_looks(
    put: Put, told: list[str], right: str, wrong: str, declaration: str, why: str
) -> None:
    parts = put(CODE.replace(right, wrong))
    (said,) = told
    assert said.startswith(f"Arboleda goes on without the declaration {declaration} of orders 1: {why}")
    takes = {*re.findall(r'data-takes="([\w.]+)"', html(parts))}
    assert ("orders.add" in takes) is (declaration != "Act 'add'")
    assert {"orders.look", "orders.limit"} <= takes and len(told) == 1


@pytest.mark.parametrize("folder", [True, False])
def test_a_file_that_is_not_there_is_left_out_alone(
    put: Put, told: list[str], tmp_path: Path, folder: bool
) -> None:
    page = tmp_path / "site/orders"
    page.mkdir(parents=True)
    (page / "__init__.py").write_text(CODE.replace("tabs=[", 'script="order.js", tabs=[', 1), "utf-8")
    if folder:
        (page / "assets").mkdir()
    register(tmp_path / "site", "orders", {GROUP: ["orders = orders:PAGE"]})
    parts = AddedParts(Pieces(tell=told.append), whole_page.OWN)
    assert told == [
        "Arboleda goes on without the file order.js of the page of orders 1: there is no such file in "
        f"{page / 'assets'}"
    ]
    assert 'data-takes="orders.add"' in html(parts) and parts.assets == AddedParts().assets


def test_what_is_inside_a_tab_whose_name_is_taken_is_left_out_with_it(put: Put, told: list[str]) -> None:
    shown = html(put(CODE.replace('Tab("orders"', 'Tab("links"')))
    assert told == ["Arboleda goes on without the section links of orders 1: Arboleda has this name already"]
    assert "orders.add" not in shown and 'data-live="orders:price"' in shown


HOW_TO = Path(__file__).parents[3] / "docs/how-to/write-an-extension.md"


def example(has: str, page: Path = HOW_TO) -> str:
    """The only Python of a page in which this stands."""
    codes = re.findall(r"```python\n(.*?)```", page.read_text("utf-8"), re.DOTALL)
    (found,) = [each for each in codes if has in each]
    return str(found)


def module(name: str, code: str, monkeypatch: pytest.MonkeyPatch) -> Any:
    """A module with this code, for the time of a test."""
    made = ModuleType(name)
    monkeypatch.setitem(sys.modules, name, made)
    exec(code, made.__dict__)
    return made


@pytest.mark.usefixtures("put")
def test_the_example_of_the_documentation_works(
    tmp_path: Path, told: list[str], plant_with: MakePlantWith
) -> None:
    part, code = example("Counter"), example("tabs=[")
    (script,) = re.findall(r"```js\n(.*?)```", HOW_TO.read_text("utf-8"), re.DOTALL)
    files = {"__init__.py": "", "part.py": part, "page.py": code, "assets/orders.js": script}
    for name, content in files.items():
        (tmp_path / "site/orders" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "site/orders" / name).write_text(content, "utf-8")
    register(tmp_path / "site", "orders", {GROUP: ["orders = orders.page:PAGE"]})
    parts = AddedParts(Pieces(tell=told.append), whole_page.OWN)
    orders: Any = sys.modules["orders.part"].Orders
    plant = plant_with(orders)
    by_hand = partial(answers, parts, part=plant.part(orders))
    assert by_hand("add", TYPED) == [("Ordered for ana.", True)]
    assert face(parts, plant.shown(orders))["row/orders:open/1"]["texts"] == ["ana", "2"]
    plant.restart()
    by_hand = partial(answers, parts, part=plant.part(orders))
    assert by_hand("limit", {"most": "1"}) == [("Done: Set the limit.", True)]
    assert by_hand("add", TYPED) == [("an order has at most 1", False)]
    assert plant.shown(orders)["ordered"] == {"ana": 2}
    assert by_hand("cancel", False, of="1") == [("Done: Cancel.", True)]
    assert plant.shown(orders) == {"open": [], "count": 0, "ordered": {}}
    shown = html(parts)
    assert all(f'data-takes="orders.{act}"' in shown for act in ("add", "limit")) and told == []
    own = (asset_files.own_folder() / "arboleda.js").read_text("utf-8")
    (names,) = re.findall(r"import \{ (.*) \} from \"../arboleda.js\"", script)
    assert {*names.split(", ")} == {
        *re.findall(r"^export (?:const|async function|function) (\w+)", own, re.MULTILINE)
    }


def test_the_section_of_the_documentation_is_drawn(put: Put, told: list[str]) -> None:
    parts = put(example("PagePart("))
    shown = html(parts)
    assert ">Shelf</a>" in shown and all(f'data-live="shelf.{place}"' in shown for place in "ABCD")
    links = {"shelf": {"parts": {"A": "lot"}}}
    found = parts.face(SimpleNamespace(snapshot={"cells": []}, links=links, words=words("en")))  # type: ignore[arg-type]
    assert (found["text/shelf.A"], found["text/shelf.B"]) == (["lot", ""], ["empty", ""]) and told == []


def test_the_events_of_the_documentation_are_sent(
    plant_with: MakePlantWith, monkeypatch: pytest.MonkeyPatch
) -> None:
    changes = module("changes", example("text/event-stream"), monkeypatch).Changes
    plant = plant_with(changes)
    part: Any = plant.part(changes)
    (route,) = part.routes().routes

    async def two() -> list[str]:
        lines = (await route.endpoint()).body_iterator
        first = await anext(lines)
        plant.submit("sis_a 0B 7 #lot")
        return [first, await anext(lines)]

    assert asyncio.run(two()) == ["data: {}\n\n", 'data: {"id": "lot", "state": "running"}\n\n']


def test_the_test_of_a_driver_of_the_documentation_passes(monkeypatch: pytest.MonkeyPatch) -> None:
    driver = example('@driver("my_plc"', HOW_TO.with_name("write-a-driver.md"))
    module("arboleda_oven", "", monkeypatch)
    module("arboleda_oven.driver", driver, monkeypatch)
    module("test_oven", example("arboleda_oven.driver"), monkeypatch).test_it_says_what_it_has_done()
