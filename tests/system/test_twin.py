"""The twin in a real browser: what it draws against what the boards said."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from arboleda.dashboard.asset_files import own_address
from arboleda.geometry import bodies
from arboleda.geometry.part_size import PART_HEIGHT_M
from arboleda.kinds.arm import Arm
from arboleda.kinds.mobile import Mobile
from arboleda.model.plant_model import PlantModel, Robot
from arboleda.plant_file import loader
from arboleda.plant_file.urdf import robot_urdf, root_link
from arboleda.testing import shipped
from arboleda.wire import payloads, topics, units
from arboleda.wire.topics import Channel
from arboleda.wire.values import Telemetry

from ..chromium import FEW_FRAMES, browsers, people
from ..patience import PATIENCE_S
from ..plants import written
from ..unit.description import drawn
from ..unit.kinds.test_places import PLANT as PARTS_AT_PLACES
from ..unit.kinds.test_places import recipe_of
from .conftest import Process, paths

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright", "xacro", "urdf_parser_py")]

SOFTWARE = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
NO_WEBGL = ("--disable-gpu", "--disable-3d-apis")
# Drawn in software, each point costs time, and no test looks at one.
COARSE = {"viewport": {"width": 1000, "height": 640}, "device_scale_factor": 0.25, "locale": "en"}
ACCURACY = 1e-6  # m, and of unit vectors
Pose = tuple[float, ...]
Linked = dict[str, list[float]]  # link -> 16 numbers, row by row


class Heard:
    """Every pose that the boards reported."""

    def __init__(self, model: PlantModel, broker: str) -> None:
        from paho.mqtt.client import CallbackAPIVersion, Client

        self.poses: dict[str, list[Pose]] = {name: [] for name in model.robots}
        self._boards = {robot.mqtt: robot for robot in model.robots.values()}
        self.client = Client(CallbackAPIVersion.VERSION2)
        self.client.on_message = self._hear
        self.client.on_connect = lambda client, *_: client.subscribe("+/sensores")
        host, _, port = broker.partition(":")
        self.client.connect(host, int(port))
        self.client.loop_start()

    def last(self, robot: str) -> Pose:
        return self.poses[robot][-1]

    def close(self) -> None:
        self.client.disconnect()
        self.client.loop_stop()

    def _hear(self, client: Any, data: Any, message: Any) -> None:
        robot = self._boards[topics.parse(message.topic)[0]]
        axes = len(robot.joints) if isinstance(robot, Arm) else None
        said = payloads.decode(Channel.TELEMETRY, message.payload, axes=axes)
        assert isinstance(said, Telemetry)
        self.poses[robot.name].append(pose_of(robot, said))


def pose_of(robot: Robot, said: Telemetry) -> Pose:
    """The joints of a report, rad and m."""
    if isinstance(robot, Mobile):
        assert said.node is not None
        return robot.grid.position(said.node)
    assert isinstance(robot, Arm) and said.q_deg is not None
    return tuple(units.from_wire(joint, value) for joint, value in zip(robot.joints, said.q_deg, strict=True))


class Place:
    """Where the links of a robot are in the world, by the URDF and another reader of it than the twin's."""

    def __init__(self, model: PlantModel, name: str) -> None:
        robot = model.robots[name]
        assert isinstance(robot, Arm | Mobile)
        floor = robot.base if isinstance(robot, Arm) else robot.grid.origin
        self._urdf = drawn.read(robot_urdf(model, name))
        assert self._urdf.get_root() == root_link(robot)
        self._base = drawn.product(drawn.shifted(floor.x, floor.y, 0), drawn.turned((0, 0, 1), floor.yaw))
        self._known: dict[Pose, Linked] = {}

    def links(self, q: Pose) -> Linked:
        if q not in self._known:
            self._known[q] = {link.name: self._link(link.name, q) for link in self._urdf.links}
        return self._known[q]

    def _link(self, name: str, q: Pose) -> list[float]:
        matrix = drawn.product(self._base, drawn.place(self._urdf, name, q))
        return [value for row in matrix for value in row]


def same(one: Linked, other: Linked) -> bool:
    """Whether all the links are in the same places."""
    return one.keys() == other.keys() and all(
        math.isclose(a, b, rel_tol=0, abs_tol=ACCURACY)
        for name in one
        for a, b in zip(one[name], other[name], strict=True)
    )


class Plant:
    """A running plant: the address of its page, and of its broker where it has one."""

    def __init__(self, process: Process) -> None:
        process.wait_for("HTTP API")
        self.page = next(line.split()[-1] for line in process.lines if line.startswith("Page:"))
        brokers = [line.split()[-1] for line in process.lines if line.startswith("MQTT broker:")]
        self.broker = brokers[0] if brokers else ""


@contextmanager
def running(state: Path, *args: str) -> Iterator[Plant]:
    main = "from arboleda.cli.main import main; main()"
    command = ("up", "--state", str(state), *args)
    process = Process(sys.executable, "-c", main, *command, env={"PYTHONPATH": paths()})
    try:
        yield Plant(process)
        assert process.interrupt() == 0, process.output
        assert "Traceback" not in process.output, process.output
    finally:
        process.kill()


@pytest.fixture(scope="module")
def launched() -> Iterator[Callable[..., Any]]:
    """`launched(*options)`: a browser with these options, the same one for all tests."""
    with browsers() as launch:
        yield cache(launch)


@contextmanager
def browsing(browser: Any) -> Iterator[Any]:
    """`open(address)`: a page of a person of its own; a script that fails fails the test."""
    with people(browser) as new:

        def go(address: str, part: str = "cells", **more: Any) -> Any:
            page = new(**(COARSE | more))
            page.context.add_init_script(FEW_FRAMES)
            page.goto(f"{address}/?tab={part}")
            page.wait_for_function("document.getElementById('connection')?.hidden")
            if part == "cells":
                page.wait_for_function(
                    "window.arboledaTwin.view() && Object.keys(arboledaTwin.drawn()).length"
                )
            return page

        yield go


@pytest.fixture(scope="module")
def plant(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Plant]:
    with running(tmp_path_factory.mktemp("state"), "--no-ros") as found:
        yield found


@pytest.fixture
def heard(plant: Plant) -> Iterator[Heard]:
    made = Heard(shipped(), plant.broker)
    yield made
    made.close()


@pytest.fixture
def places() -> dict[str, Place]:
    return {name: Place(shipped(), name) for name in shipped().robots}


@pytest.fixture
def look(launched: Callable[..., Any]) -> Iterator[Any]:
    with browsing(launched(*SOFTWARE)) as go:
        yield go


@pytest.fixture
def look_flat(launched: Callable[..., Any]) -> Iterator[Any]:
    with browsing(launched(*NO_WEBGL)) as go:
        yield go


def keep(page: Any, what: str) -> Callable[[], list[Any]]:
    """Have the page keep `what` at every frame that it draws; all that it kept."""
    page.evaluate(f"""() => {{
        const draw = arboledaTwin.frame;
        window.kept = [];
        arboledaTwin.frame = (...frame) => {{
            draw(...frame);
            kept.push({what});
        }};
    }}""")
    return lambda: page.evaluate("kept")


def submit(page: Any, *texts: str) -> None:
    for text in texts:
        answer = page.request.post(f"{page.url.partition('?')[0]}api/tasks", data={"text": text})
        assert answer.ok, answer.text()


def ended(page: Any, count: int) -> bool:
    """Whether so many tasks are done, as the page has it; to ask the API all the time is work for both."""
    return page.locator("[data-rows=tasks] [data-row][data-s=done]").count() >= count


def wait_for(true: Callable[[], bool], patience_s: float = PATIENCE_S) -> None:
    until = time.monotonic() + patience_s
    while not true():
        assert time.monotonic() < until, "it never came true"
        time.sleep(0.02)


def was_seen(place: Place, told: list[Pose], seen: list[Linked]) -> None:
    """What was seen is what was told, in the same order; none of it was invented."""
    number = 0
    for links in seen:
        while not same(links, place.links(told[number])):
            number += 1
            assert number < len(told), f"{links} was never reported, or not any more"
    assert len({str(links) for links in seen}) >= 3, "it was never seen to move"


def test_nothing_is_sent_to_who_looks_elsewhere_and_then_every_link_is_where_the_telemetry_puts_it(
    plant: Plant, heard: Heard, places: dict[str, Place], look: Any
) -> None:
    frames: list[str] = []
    page = look(plant.page, "tasks")
    page.on("websocket", lambda socket: socket.on("framereceived", lambda data: frames.append(str(data))))
    page.reload()
    page.wait_for_function("document.getElementById('connection')?.hidden")
    submit(page, "sis_a 0A 1")
    wait_for(lambda: ended(page, 1))
    assert frames and not any("arboledaTwin.frame" in frame for frame in frames)
    page.click("[data-tab=cells]")
    wait_for(lambda: page.evaluate("1") and any("arboledaTwin.frame" in frame for frame in frames))
    page.wait_for_function("window.arboledaTwin.view() && Object.keys(arboledaTwin.drawn()).length")
    wait_for(lambda: all(heard.poses.values()))
    kept = keep(page, "arboledaTwin.links()")
    submit(page, "sis_a 0B 7", "sis_b 1C 3", "sis_c 2A 5")
    wait_for(lambda: ended(page, 4))

    def at_rest() -> bool:
        drawn_now = page.evaluate("arboledaTwin.links()")
        return all(same(drawn_now[name], places[name].links(heard.last(name))) for name in places)

    wait_for(at_rest)
    seen = kept()
    for name, place in places.items():
        was_seen(place, heard.poses[name], [robots[name] for robots in seen])


UNTOLD = """
let twin;
Object.defineProperty(window, "arboledaTwin", {
  get: () => twin,
  set: (made) => {
    const { frame } = (twin = made);
    twin.frame = (...told) => window.letIn && frame(...told);
  },
});
"""


def test_before_the_first_picture_the_twin_says_that_it_is_drawn_and_nothing_of_any_robot(
    plant: Plant, launched: Callable[..., Any]
) -> None:
    with people(launched(*SOFTWARE)) as new:
        page = new(**COARSE)
        page.context.add_init_script(FEW_FRAMES + UNTOLD)
        page.goto(f"{plant.page}/?tab=cells")
        page.wait_for_function("window.arboledaTwin?.view() === 'solid'")
        assert page.inner_text("#twin-note") == "Drawing the plant ..."
        assert page.locator(".twin-labels span:visible").count() == 0
        page.evaluate("window.letIn = true")
        page.wait_for_selector("#twin-note", state="hidden")
        page.wait_for_selector(".twin-labels span:text-is('ra1')")


def middle_of_part(tool: Sequence[float]) -> tuple[float, ...]:
    """Where the middle of a part is that this frame of a tool takes."""
    return tuple(tool[4 * row + 3] + tool[4 * row + 2] * PART_HEIGHT_M / 2 for row in range(3))


def close_to(drawn: Sequence[Sequence[float]], wanted: Sequence[Sequence[float]]) -> bool:
    return len(drawn) == len(wanted) and all(
        any(math.dist(one, other) < ACCURACY for other in drawn) for one in wanted
    )


def test_parts_are_drawn_at_their_places_and_in_the_hand(tmp_path: Path, look: Any, look_flat: Any) -> None:
    file = written(tmp_path, PARTS_AT_PLACES, recipe_of('take("rack_1"), put("nest")'))
    model = loader.load(file)
    robot = Place(model, "mover")
    (space,) = model.cells[0].spaces
    tip = bodies.tip(bodies.read(robot_urdf(model, "mover")))

    def at(name: str) -> tuple[float, ...]:
        return middle_of_part(robot.links(tuple(space.targets[name].joints))[tip])

    with running(tmp_path / "state", "--no-ros", "--plant", str(file)) as plant:
        page = look(plant.page)
        assert page.evaluate("arboledaTwin.parts()") == []
        answer = page.request.post(f"{plant.page}/api/cells/lab/load", data={"place": "bin", "parts": 2})
        assert answer.ok, answer.text()
        wait_for(lambda: close_to(page.evaluate("arboledaTwin.parts()"), [at("bin")]))
        labels = "[...document.querySelectorAll('.twin-labels span')].map(each => each.textContent)"
        page.wait_for_function(f"{labels}.includes('bin: 2')")
        drawn_now = "arboledaTwin.drawn()['books/lab'], arboledaTwin.links().mover"
        kept = keep(page, f"[arboledaTwin.parts(), {drawn_now}]")
        submit(page, "lab try")
        wait_for(lambda: ended(page, 1))
        wait_for(lambda: close_to(page.evaluate("arboledaTwin.parts()"), [at("rack_2"), at("nest")]))
        carried = 0
        for parts, books, links in kept():
            wanted = [at(name) for name, count in books["places"].items() if count]
            if books["carriers"]:
                wanted.append(middle_of_part(links[tip]))
                carried += 1
            assert close_to(parts, wanted)
        assert carried > 3
        flat = look_flat(plant.page)
        wait_for(lambda: close_to(flat.evaluate("arboledaTwin.parts()"), [at("rack_2"), at("nest")]))


FOOTPRINTS: list[tuple[dict[str, Any], tuple[float, ...]]] = [
    ({"kind": "box", "size": [0.2, 0.1, 0.3]}, (-0.1, -0.05, 0.1, 0.05)),
    ({"kind": "cylinder", "size": [0.05, 0.4]}, (-0.05, -0.05, 0.05, 0.05)),
    ({"kind": "sphere", "size": [0.05]}, (-0.05, -0.05, 0.05, 0.05)),
]


def test_without_webgl_the_plant_is_drawn_from_above_by_outlines(
    plant: Plant, heard: Heard, places: dict[str, Place], look_flat: Any
) -> None:
    page = look_flat(plant.page)
    assert page.evaluate("arboledaTwin.view()") == "flat"
    assert "no WebGL" in page.inner_text("#twin-note")
    drawn = page.wait_for_function("document.querySelector('.twin-flat .moving')?.innerHTML")
    before = drawn.json_value()
    submit(page, "sis_a 2C 8")
    page.wait_for_function(
        "before => document.querySelector('.twin-flat .moving').innerHTML !== before", arg=before
    )
    wait_for(lambda: all(heard.poses.values()))

    def drawn_as_told() -> bool:
        links = page.evaluate("arboledaTwin.links()")
        return all(same(links[name], places[name].links(heard.last(name))) for name in places)

    wait_for(drawn_as_told)
    names = page.evaluate(
        "[...document.querySelectorAll('.twin-flat .labels text')].map(each => each.textContent)"
    )
    assert {"ra1", "rm_sis_c", "sis_b"} <= set(names)
    draw = f"async ([shape, place]) => (await import('{own_address()}/twin_flat.js')).footprint(shape, place)"
    moved = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 3, 9, 1]  # column by column: shifted to 2, 3, 9
    lying = [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1]  # its z points against y
    for shape, box in FOOTPRINTS:
        x, y = zip(*page.evaluate(draw, [shape, moved]), strict=True)
        outline = (min(x) - 2, min(y) - 3, max(x) - 2, max(y) - 3)
        assert outline == pytest.approx(box), shape["kind"]
        _, deep = zip(*page.evaluate(draw, [shape, lying]), strict=True)
        half = shape["size"][-1] / (1 if shape["kind"] == "sphere" else 2)
        assert max(deep) == pytest.approx(half), shape["kind"]


def at_rest(page: Any, what: str) -> Any:
    """The value of an expression that has been the same in 30 frames: the view is no longer on its way."""
    page.evaluate("window.lastSeen = { value: null, frames: 0 }")
    same = f"""() => {{
        const value = {what}, frames = value === lastSeen.value ? lastSeen.frames + 1 : 0;
        lastSeen = {{ value, frames }};
        return frames >= 30;
    }}"""
    page.wait_for_function(same)
    return page.evaluate(what)


def test_the_view_is_turned_with_keys_put_back_and_led_to_a_cell(plant: Plant, look: Any) -> None:
    page = look(plant.page, locale="es")
    page.wait_for_function("document.querySelector('#twin-robots').textContent.includes('ra1: medido')")
    label = "document.querySelector('.twin-labels span')?.style.transform"
    near = page.wait_for_function(label).json_value()
    assert page.inner_text("#twin-title") == "Gemelo de sis_a"
    page.click("[data-twin=reset]")
    page.wait_for_function(f"near => {label} !== near", arg=near)
    assert page.inner_text("#twin-title") == "Gemelo de la planta"
    before = at_rest(page, label)
    page.focus("#twin canvas")
    for key in ("ArrowLeft", "ArrowUp", "+"):
        page.keyboard.press(key)
    page.wait_for_function(f"before => {label} !== before", arg=before)
    page.click("[data-twin=reset]")
    page.wait_for_function(f"before => {label} === before", arg=before)
    page.click("[data-choose=sis_b]")
    page.wait_for_function(f"before => {label} !== before", arg=before)
    assert page.inner_text("#twin-title") == "Gemelo de sis_b"
    page.evaluate("arboledaTwin.visit('office')")  # of which nothing is drawn: the whole plant is seen
    page.wait_for_function(f"before => {label} === before", arg=before)
