"""A package beside the runner adds parts to a plant; where one breaks, it is named and robots work on."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator
from importlib.metadata import EntryPoint
from operator import attrgetter
from pathlib import Path
from typing import Any

import pytest
from tests.added_package import COUNTER, install
from tests.packages import PACKAGES, leave_out

from arboleda.model.errors import StartError
from arboleda.runtime import holdings, registry
from arboleda.runtime.build import App, Options, build
from arboleda.runtime.part_list import PartList
from arboleda.runtime.registry import Factory, Phase
from arboleda.testing import shipped

Install = Callable[[str, str], None]
RAISES = "from arboleda.runtime.registry import Factory, Phase\n\n\nclass Part:\n"
RAISES += "    def start(self): {start}\n    def stop(self): {stop}\n\n\n"
RAISES += "def make(assembly):\n    {make}\n    yield Part()\n\n\n"
RAISES += "PARTS = [Factory(phase=Phase.VIEWS, make=make)]\n"
WRONG = "raise ValueError('the shelf is full')"
SAID = "Arboleda goes on without {}: ValueError: the shelf is full"


@pytest.fixture
def put(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Installs a package of that name, with this code."""
    monkeypatch.syspath_prepend(tmp_path / "site")
    yield lambda name, code: install(tmp_path / "site", name, code)
    for name in ("acme", "bolt"):
        sys.modules.pop(name, None)


def built(tmp_path: Path, parts: set[str] | None = None, **options: Any) -> App:
    wanted = Options(state_dir=tmp_path / "state", page=False, **options)
    return build(shipped("sis_a"), parts or {"orchestrator"}, wanted)


def raising(*, start: str = "pass", stop: str = "pass", make: str = "pass") -> str:
    return RAISES.format(start=start, stop=stop, make=make)


def gone_on_without(app: App) -> list[str]:
    return [note for note in app.notes if "goes on without" in note]


def kinds(app: App) -> list[str]:
    return [type(each).__name__ for each in app.parts]


def test_a_part_of_a_package_is_offered_and_tells_people(tmp_path: Path, put: Install) -> None:
    put("acme", COUNTER)
    app = built(tmp_path)
    app.stop()
    acme = sys.modules["acme"]
    assert kinds(app)[-1] == "Counter" and app.offers.ask(acme.Counter) is app.parts[-1]
    assert "Counter: it counts" in app.notes


def test_a_package_is_loaded_only_when_a_plant_is_put_together(tmp_path: Path, put: Install) -> None:
    put("acme", COUNTER)
    assert "acme" in [each.name for each in registry.registered(registry.GROUP)]
    assert "acme" not in sys.modules


@pytest.mark.parametrize(
    ("code", "why"),
    [
        ("import no_such_library", "No module named 'no_such_library'"),
        ("PARTS = [7]", "acme:PARTS is neither a Part nor a sequence of factories of parts"),
        ("PARTS = 7", "'int' object is not iterable"),
        ("raise SystemExit(3)", "it ends the program"),
        (raising(make=WRONG), "ValueError: the shelf is full"),
        (raising(make="assembly.offer(int, 1); assembly.offer(int, 2)"), "another part offers a int already"),
        (raising(make="assembly.need(Part)"), "no part of this process offers a Part"),
    ],
)
def test_a_package_that_breaks_when_it_is_loaded_or_made_is_left_out_and_named(
    tmp_path: Path, put: Install, code: str, why: str
) -> None:
    put("acme", code)
    put("bolt", COUNTER)
    app = built(tmp_path)
    app.stop()
    (said,) = gone_on_without(app)
    assert re.match(r"Arboleda goes on without the (parts|factory make) of acme 1: ", said) and why in said
    assert kinds(app)[-1] == "Counter", "the other package is there"


def test_a_package_may_refuse_the_start_with_a_sentence(tmp_path: Path, put: Install) -> None:
    refuse = "from arboleda.model.errors import StartError; raise StartError('no shelf, no plant')"
    put("acme", raising(make=refuse))
    for _ in range(2):  # the second finds the state directory free
        with pytest.raises(StartError, match=r"^acme 1 keeps the plant from starting: no shelf, no plant$"):
            built(tmp_path)


LISTENS = """
from arboleda.runtime.parts.orchestrator import Orchestrator
from arboleda.runtime.registry import Factory, Phase

TOLD = []


def breaks(what):
    TOLD.append(what)
    raise ValueError("the shelf is full")


def make(assembly):
    assembly.need(Orchestrator).{listeners}.append(breaks)
    return ()


PARTS = [Factory(phase=Phase.VIEWS, make=make)]
"""


@pytest.mark.parametrize("listeners", ["listeners", "observers", "screens.watchers"])
def test_a_listener_of_a_package_that_breaks_is_left_out_once_and_the_plant_goes_on(
    tmp_path: Path, put: Install, listeners: str
) -> None:
    put("acme", LISTENS.format(listeners=listeners))
    app = built(tmp_path)
    heard: list[Any] = []
    attrgetter(listeners)(app.plant).append(heard.append)
    try:
        for id in ("lot", "next"):
            asked = app.plant.submit(f"sis_a 0B 7 #{id}")
            app.plant.loop.turn()
            app.plant.halt()  # what is shown then is shown at once
            app.plant.loop.turn()
            assert asked.done()
    finally:
        app.stop()
    assert len(sys.modules["acme"].TOLD) == 1 and len(heard) > 1
    assert gone_on_without(app) == [SAID.format("the listener breaks of acme 1")]


LINKS = """
from functools import partial

from arboleda.runtime.registry import Factory, Phase

ASKED = []


def breaks():
    ASKED.append("breaks")
    raise ValueError("the shelf is full")


def make(assembly):
    assembly.links.add(breaks)
    for name in TOLD:
        assembly.links.add(lambda name=name: {name: "acme"})
    return ()


PARTS = [Factory(phase=Phase.LINKS, make=make)]
"""


@pytest.mark.parametrize("source", ["breaks", "partial(breaks)"])
def test_a_source_of_links_that_breaks_is_left_out_and_the_others_go_on_telling(
    tmp_path: Path, put: Install, source: str
) -> None:
    put("acme", f"TOLD = ['shelf']{LINKS}".replace("add(breaks)", f"add({source})"))
    app = built(tmp_path)
    app.stop()
    links = [app.links() for _ in range(3)]
    assert [each["shelf"] for each in links] == ["acme"] * 3 and links[0]["memory"] is not None
    assert sys.modules["acme"].ASKED == ["breaks"]
    assert gone_on_without(app) == [SAID.format("a source of links of acme 1")]


@pytest.mark.parametrize("name", ["broker", "ros", "memory", "refused", "shelf"])
def test_no_source_tells_what_the_runner_or_another_one_does(tmp_path: Path, put: Install, name: str) -> None:
    put("acme", f"TOLD = ['shelf', '{name}', 'lamp']{LINKS}".replace("add(breaks)", "add(dict)"))
    app = built(tmp_path)
    app.stop()
    told = app.links()
    assert told[name] != "acme" or name == "shelf"
    assert told["lamp"] == "acme"
    said = f"Arboleda goes on without a source of links of acme 1: another source tells {name}"
    assert gone_on_without(app) == [said]


ACME: Any = EntryPoint("acme", "acme:PARTS", "arboleda.parts")


class Noted:
    """A part that notes what is done with it."""

    def __init__(self, name: str, notes: list[str], broken: str = "") -> None:
        self.name, self._notes, self._broken = name, notes, broken

    def start(self) -> None:
        self._act("start")

    def stop(self) -> None:
        self._act("stop")

    def _act(self, what: str) -> None:
        self._notes.append(f"{what} {self.name}")
        if what == self._broken:
            raise ValueError("the shelf is full")


@pytest.fixture
def listed(monkeypatch: pytest.MonkeyPatch) -> Callable[..., PartList]:
    """Parts of the runner before and after one of a package, `acme`."""

    def made(notes: list[str], *, broken: str, own: str = "", is_needed: bool = False) -> PartList:
        def factory(phase: Phase, *part: Any, **more: bool) -> Factory:
            return Factory(phase=phase, make=lambda _: [Noted(part[0], notes, part[1])], **more)

        package = factory(Phase.RECORD, "package", broken, is_needed=is_needed)
        monkeypatch.setattr("arboleda.runtime.part_list.packaged", lambda _: [(ACME, package)])
        parts = PartList()
        parts.make(None, [factory(Phase.READY, "last", own), factory(Phase.LINKS, "first", "")])
        return parts

    return made


@pytest.mark.parametrize("broken", ["", "start", "stop"])
def test_parts_start_by_their_phases_and_end_in_the_opposite_order_even_if_a_package_breaks(
    listed: Callable[..., PartList], broken: str
) -> None:
    notes: list[str] = []
    parts = listed(notes, broken=broken)
    parts.start()
    parts.stop()
    parts.stop()
    names = ["first", "package", "last"]
    assert notes == [*(f"start {each}" for each in names), *(f"stop {each}" for each in reversed(names))]
    assert parts.notes == ([SAID.format("the part Noted of acme")] if broken else [])


def test_a_part_of_the_runner_that_breaks_keeps_the_plant_from_starting(
    listed: Callable[..., PartList],
) -> None:
    parts = listed([], broken="", own="start")
    with pytest.raises(ValueError, match="the shelf is full"):
        parts.start()


def test_a_part_that_the_plant_needs_keeps_it_from_starting_though_it_is_of_a_package(
    listed: Callable[..., PartList],
) -> None:
    parts = listed([], broken="start", is_needed=True)
    with pytest.raises(ValueError, match="the shelf is full"):
        parts.start()


def test_a_shared_memory_is_refused_where_nothing_keeps_the_lead(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    memory_of = holdings.memory_of

    def leased(*about: Any) -> Any:
        memory = memory_of(*about)
        memory.lead.renew_s = 1.0
        return memory

    monkeypatch.setattr(holdings, "memory_of", leased)
    leave_out(monkeypatch, tmp_path / "nothing", "arboleda_fleet")
    with pytest.raises(StartError, match=r"needs the package fleet.*pip install 'arboleda\[fleet\]'"):
        built(tmp_path)


def test_without_packages_a_plant_has_the_parts_of_the_runner(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    leave_out(monkeypatch, tmp_path / "nothing", *PACKAGES)
    app = built(tmp_path, {"broker", "devices", "bridge", "orchestrator", "web"})
    app.stop()
    runner = ["OwnBroker", "BridgePart", "DevicesPart", "Periodic", "Orchestrator", "WebPart"]
    assert kinds(app) == runner
    assert app.links()["faults"] == [] and app.links()["demo"] is False
