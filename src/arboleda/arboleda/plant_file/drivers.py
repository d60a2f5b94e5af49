"""Drivers of devices and their settings: drivers of Arboleda, of files that `uses` names, or of packages."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from arboleda.drivers.port import GROUP, DriverSpec, FitsDevice, GivesEvidence, ShowsMessages, spec_of
from arboleda.host.packages import entry_points
from arboleda.kinds.declared import verbs_of
from arboleda.model.outside import plain
from arboleda.model.plant_model import DriverUse, Evidence, Link, PlantModel, Robot

from .deadlines import is_proven
from .document import Document, Place, choice, nearest, shown
from .given_settings import FAULTY, Taker, given, loaded
from .not_installed import why_nobody
from .python_uses import LONGEST, PythonUses, error_text
from .shapes import ROBOT_KEYS
from .shared import SECTION as SHARED

KEY, SHORT = "driver", "link"
HOW = 'one of your own is a class with @driver("its name") before it, in a file that "uses" names'


def link(document: Document, place: Place, written: str, allowed: Sequence[str]) -> Link:
    """The link to a device, from its key `driver`, else from its short form `link`, which is `written`."""
    here = (*place, KEY)
    if not document.has(here):
        return Link(written)
    if document.has((*place, SHORT)):
        document.problem(here, f'"{SHORT}: X" is the short form of "{KEY}: X"; keep one of them')
    value = document.value(here)
    if not _comes_with_it(value):
        return Link.DRIVER
    if value not in allowed:
        document.problem(here, f"must be {choice(allowed)} or a driver of your own, is {shown(value)}")
    return Link(value)


def driver_uses(document: Document, used: PythonUses) -> dict[str, DriverUse]:
    """The driver of each device that names one which is not Arboleda's, by the device's name."""
    uses: dict[str, DriverUse] = {}
    for name, place in named(document):
        use = _use(document, place, used)
        if use is not None:
            uses[name] = use
    return uses


def with_drivers(document: Document, plant: PlantModel | None, used: PythonUses) -> PlantModel | None:
    """The plant whose devices have their drivers; where there is any problem, the plant as it is."""
    if plant is None or any(document.problems):
        return plant
    uses = driver_uses(document, used)
    if not uses:
        return plant
    driven: dict[str, Robot] = {}
    for name, place in named(document):
        if name in uses:
            driven[name] = _driven(document, place, plant.robots[name], uses[name])
            _check(document, place, driven[name])

    def with_driver(robot: Robot) -> Robot:
        return driven.get(robot.name, robot)

    return replace(plant, cells=tuple(cell.with_robots(with_driver) for cell in plant.cells))


def messages_of(plant: PlantModel) -> Iterator[str]:
    """Lines on the messages of each device whose driver can show them."""
    for device in plant.robots.values():
        settings = None if device.driver is None else device.driver.settings
        if isinstance(settings, ShowsMessages):
            yield from settings.shown(device)


def named(document: Document) -> Iterator[tuple[str, Place]]:
    """The devices whose key `driver` names none of Arboleda's, with the place of that key."""
    cells: list[Place] = [("cells", cell) for cell in document.keys(("cells",))]
    places: list[Place] = [(*cell, role) for cell in cells for role in ROBOT_KEYS]
    for devices in [*((*cell, "devices") for cell in cells), (SHARED,)]:
        places += [(*devices, role) for role in document.keys(devices)]
    for place in places:
        if document.has((*place, KEY)) and not _comes_with_it(document.value((*place, KEY))):
            yield str(document.value((*place, "name")) or place[-1]), (*place, KEY)


def _comes_with_it(value: object) -> bool:
    return isinstance(value, str) and value in COME_WITH_IT


def _use(document: Document, place: Place, used: PythonUses) -> DriverUse | None:
    value = document.value(place)
    if isinstance(value, dict) and len(value) == 1:
        name = str(next(iter(value)))
        here: Place = (*place, name)
    elif isinstance(value, str):
        name, here = value, place
    else:
        form = "or one name with its settings, {my_plc: {host: 10.0.0.7}}"
        document.problem(place, f"must be the name of a driver, {form}; is {shown(value)}")
        return None
    spec = used.drivers.get(name) or _installed(document, place, name, used)
    if spec is None:
        return None
    read = _settings(document, here, spec, used)
    if read is FAULTY:
        return None
    recovers = _offered(document, here, read, RECOVERS, False) is True
    is_claim = _offered(document, here, read, CLAIM, False) is True
    return DriverUse(
        name=name,
        settings=read,
        make=partial(spec.make, read),
        pace=_pace(document, here, read),
        facts=_facts(document, here, read),
        recovers=recovers,
        home_moves=_offered(document, here, read, MOVES, not recovers) is True and not is_claim,
        home_is_claim=is_claim,
        watches_plant=_offered(document, here, read, WATCHES, False) is True,
    )


def _driven(document: Document, place: Place, device: Robot, use: DriverUse) -> Robot:
    """The device with its driver, and the evidence by its settings where the plant file does not say it."""
    found = device.evidence
    if isinstance(use.settings, GivesEvidence) and not document.has((*place[:-1], "evidence")):
        try:
            found = Evidence(use.settings.evidence_of(device))
        except Exception as error:  # noqa: BLE001 - it is user code: whatever it raises is told
            document.problem((*place, use.name), plain(error_text(error), LONGEST))
    return replace(device, driver=use, evidence=found)


def _check(document: Document, place: Place, device: Robot) -> None:
    """Keep the objections that a driver's settings have to their device."""
    assert device.driver is not None
    settings, problems = device.driver.settings, []
    if isinstance(settings, FitsDevice):
        try:
            problems = list(settings.problems(device))
        except Exception as error:  # noqa: BLE001 - it is user code: whatever it raises is told
            problems = [((), error_text(error))]
    for inside, sentence in problems:
        document.problem((*place, device.driver.name, *inside), plain(sentence, LONGEST))
    for verb in () if problems else verbs_of(device):
        is_proven(document, place[:-1], device.kind_name, verb, device.evidence)


def _settings(document: Document, place: Place, spec: DriverSpec, used: PythonUses) -> Any:
    """The settings for the driver; FAULTY, with the problems kept, if they are wrong."""

    def wrong(sentence: str) -> None:
        used.keep(document, used.spot(spec).problem(sentence))

    def form(key: str) -> str:
        return f"{KEY}: {{{spec.name}: {{{key}: ...}}}}"

    taker = Taker(what=KEY, name=spec.name, settings=spec.settings, form=form, wrong=wrong)
    return given(document, place, taker)


def _pace(document: Document, place: Place, settings: object) -> float:
    """The share of its model's speed at which a driver moves its robot, if its settings say that."""
    share = _offered(document, place, settings, SHARE, 1.0)
    if isinstance(share, int | float) and not isinstance(share, bool) and 0 < share <= 1:
        return float(share)
    document.problem(place, f"{SHARE} is {shown(share)}; allowed: more than 0, and at most 1")
    return 1.0


def _facts(document: Document, place: Place, settings: object) -> tuple[str, ...]:
    """The facts that a driver reports beside those of its device's kind, if its settings say that."""
    names = _offered(document, place, settings, FACTS, ())
    if isinstance(names, tuple) and all(isinstance(name, str) and name.isidentifier() for name in names):
        return names
    document.problem(place, f"{FACTS} is {shown(names)}; it must be a tuple of names")
    return ()


def _offered(document: Document, place: Place, settings: object, name: str, default: Any) -> Any:
    """The value of a property of the settings; `default` where there is none, or where it raises."""
    try:
        return getattr(settings, name, default)
    except Exception as error:  # noqa: BLE001 - it is user code: whatever it raises is told
        document.problem(place, plain(error_text(error), LONGEST))
        return default


def _installed(document: Document, place: Place, name: str, used: PythonUses) -> DriverSpec | None:
    """The driver of that name of an installed package; None, with the problem kept, where there is none."""
    points = {point.name: point for point in entry_points(group=GROUP)}
    point = points.get(name)
    if point is None and not used.is_whole:
        return None
    if point is None and (why := why_nobody(document, GROUP, name)):
        document.problem(place, why)
        return None
    if point is None:
        allowed = [*COME_WITH_IT, *used.drivers, *points]
        document.problem(place, f"must be {choice(allowed)}, is {shown(name)}{nearest(name, allowed)}; {HOW}")
        return None
    found = loaded(document, place, point, used)
    spec = None if found is FAULTY else spec_of(found)
    if spec is None and found is not FAULTY:
        document.problem(place, f"{point.value} is installed as a driver and is none; {HOW}")
    return spec


SHARE, FACTS = "model_speed_share", "reported_facts"
RECOVERS, MOVES, CLAIM = "home_clears_faults", "home_moves", "home_is_claim"
WATCHES = "watches_plant"
OF_DEVICES = (Link.MQTT.value, Link.ROS.value)
COME_WITH_IT = (*OF_DEVICES, Link.NONE.value)
"""The drivers that come with Arboleda, by their names in a plant file."""
