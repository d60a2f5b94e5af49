"""The twin in a real browser: what it draws against what the boards said."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import yaml

from arboleda.dashboard.shell import assets
from arboleda.dashboard.twin import bodies
from arboleda.dashboard.twin.parts import PART_HEIGHT_M
from arboleda.kinds.arm import Arm
from arboleda.kinds.mobile import Mobile
from arboleda.model.plant_model import MotionState, PlantModel, Robot
from arboleda.plant_file import loader
from arboleda.plant_file.urdf import robot_urdf, root_link
from arboleda.testing import shipped
from arboleda.wire import payloads, topics, units
from arboleda.wire.topics import Channel
from arboleda.wire.values import Presence, Telemetry

from ..chromium import FEW_FRAMES, browsers, leave
from ..patience import PATIENCE_MS, PATIENCE_S, SOON_S
from ..unit.description import drawn
from ..unit.kinds.test_places import PLANT as PARTS_AT_PLACES
from ..unit.kinds.test_places import written
from .conftest import SHIPPED, Process, paths

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright", "xacro", "urdf_parser_py")]

SOFTWARE = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
NO_WEBGL = ("--disable-gpu", "--disable-3d-apis")
# Drawn in software, each point costs time, and no test looks at one.
COARSE = {"viewport": {"width": 900, "height": 640}, "device_scale_factor": 0.25, "locale": "en"}
ACCURACY = 1e-6  # m, and of unit vectors
Pose = tuple[float, ...]
Linked = dict[str, list[float]]  # link -> 16 numbers, row by row


class Heard:
    """Every pose that the boards reported, with its time."""

    def __init__(self, model: PlantModel, broker: str) -> None:
        from paho.mqtt.client import CallbackAPIVersion, Client

        self.poses: dict[str, list[tuple[float, Pose]]] = {name: [] for name in model.robots}
        self._boards = {robot.mqtt: robot for robot in model.robots.values()}
        self.client = Client(CallbackAPIVersion.VERSION2)
        self.client.on_message = self._hear
        self.client.on_connect = lambda client, *_: client.subscribe("+/sensores")
        host, _, port = broker.partition(":")
        self.client.connect(host, int(port))
        self.client.loop_start()

    def last(self, robot: str) -> Pose:
        return self.poses[robot][-1][1]

    def close(self) -> None:
        self.client.disconnect()
        self.client.loop_stop()

    def _hear(self, client: Any, data: Any, message: Any) -> None:
        robot = self._boards[topics.parse(message.topic)[0]]
        axes = len(robot.joints) if isinstance(robot, Arm) else None
        said = payloads.decode(Channel.TELEMETRY, message.payload, axes=axes)
        assert isinstance(said, Telemetry)
        self.poses[robot.name].append((time.time(), pose_of(robot, said)))


def pose_of(robot: Robot, said: Telemetry) -> Pose:
    """The joints of a report, rad and m."""
    if isinstance(robot, Mobile):
        assert said.node is not None
        return robot.grid.position(said.node)
    assert isinstance(robot, Arm) and said.q is not None
    return tuple(units.from_wire(joint, value) for joint, value in zip(robot.joints, said.q, strict=True))


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
    troubles: list[str] = []
    with ExitStack() as opened:

        def go(address: str, part: str = "twin", **more: Any) -> Any:
            context = browser.new_context(**(COARSE | more))
            opened.callback(leave, context)
            context.add_init_script(FEW_FRAMES)
            page = context.new_page()
            page.set_default_timeout(PATIENCE_MS)
            page.on("pageerror", lambda error: troubles.append(str(error)))
            page.goto(f"{address}/?tab={part}")
            page.wait_for_function("document.getElementById('connection')?.hidden")
            if part == "twin":
                page.wait_for_function(
                    "window.arboledaTwin.view() && Object.keys(arboledaTwin.drawn()).length"
                )
            return page

        yield go
    assert troubles == []


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
    """Have the page keep `what` at every frame that it draws; all that it kept, with the time of each."""
    page.evaluate(f"""() => {{
        const draw = arboledaTwin.frame;
        window.kept = [];
        arboledaTwin.frame = (...frame) => {{
            draw(...frame);
            kept.push([Date.now() / 1000, {what}]);
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


def follow(place: Place, told: list[tuple[float, Pose]], seen: list[tuple[float, Linked]]) -> None:
    """What was seen is what was told, in the same order, at most SOON_S late."""
    number = 0
    for at, links in seen:
        while not same(links, place.links(told[number][1])):
            number += 1
            assert number < len(told), f"{links} was never reported, or not any more"
        rest = (when for when, pose in told[number:] if pose != told[number][1])
        assert next(rest, math.inf) > at - SOON_S, f"what was drawn at {at} was out of date"
    assert len({str(links) for _, links in seen}) >= 3, "it was never seen to move"


def test_every_link_is_where_the_last_telemetry_puts_it(
    plant: Plant, heard: Heard, places: dict[str, Place], look: Any
) -> None:
    page = look(plant.page)
    wait_for(lambda: all(heard.poses.values()))
    kept = keep(page, "arboledaTwin.links()")
    submit(page, "sis_a 0B 7", "sis_b 1C 3", "sis_c 2A 5")
    wait_for(lambda: ended(page, 3))

    def at_rest() -> bool:
        drawn_now = page.evaluate("arboledaTwin.links()")
        return all(same(drawn_now[name], places[name].links(heard.last(name))) for name in places)

    wait_for(at_rest)
    seen = kept()
    for name, place in places.items():
        follow(place, heard.poses[name], [(at, robots[name]) for at, robots in seen])


def test_an_arm_of_ones_own_is_drawn_where_its_telemetry_puts_it(tmp_path: Path, look: Any) -> None:
    file = Path(__file__).parents[2] / "examples/plants/own_arm.yaml"
    model = loader.load(file)
    place = Place(model, "tender")
    with running(tmp_path, "--no-ros", "--plant", str(file)) as plant, ExitStack() as opened:
        heard = Heard(model, plant.broker)
        opened.callback(heard.close)
        page = look(plant.page)
        wait_for(lambda: bool(heard.poses["tender"]))
        kept = keep(page, "arboledaTwin.links()")
        submit(page, "tending 0B 1")
        wait_for(lambda: ended(page, 1))
        wait_for(
            lambda: same(page.evaluate("arboledaTwin.links()")["tender"], place.links(heard.last("tender")))
        )
        follow(place, heard.poses["tender"], [(at, robots["tender"]) for at, robots in kept()])


def middle_of_part(tool: Sequence[float]) -> tuple[float, ...]:
    """Where the middle of a part is that this frame of a tool takes."""
    return tuple(tool[4 * row + 3] + tool[4 * row + 2] * PART_HEIGHT_M / 2 for row in range(3))


def close_to(drawn: Sequence[Sequence[float]], wanted: Sequence[Sequence[float]]) -> bool:
    return len(drawn) == len(wanted) and all(
        any(math.dist(one, other) < ACCURACY for other in drawn) for one in wanted
    )


def test_parts_are_drawn_at_their_places_and_in_the_hand(tmp_path: Path, look: Any, look_flat: Any) -> None:
    file = written(tmp_path, PARTS_AT_PLACES, 'take("rack_1"), put("nest")')
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
        for _, (parts, books, links) in kept():
            wanted = [at(name) for name, count in books["places"].items() if count]
            if books["carriers"]:
                wanted.append(middle_of_part(links[tip]))
                carried += 1
            assert close_to(parts, wanted)
        assert carried > 3
        flat = look_flat(plant.page)
        wait_for(lambda: close_to(flat.evaluate("arboledaTwin.parts()"), [at("rack_2"), at("nest")]))


def test_nothing_is_sent_to_a_page_that_shows_something_else(plant: Plant, look: Any) -> None:
    frames: list[str] = []
    page = look(plant.page, "tasks")
    page.on("websocket", lambda socket: socket.on("framereceived", lambda data: frames.append(str(data))))
    page.reload()
    page.wait_for_function("document.getElementById('connection')?.hidden")
    submit(page, "sis_a 0A 1")
    page.wait_for_selector("[data-rows=tasks] [data-s=running]", state="attached")
    page.wait_for_selector("[data-rows=tasks] [data-s=running]", state="detached")
    assert frames and not any("arboledaTwin.frame" in frame for frame in frames)
    page.click("[data-tab=twin]")
    wait_for(lambda: page.evaluate("1") and any("arboledaTwin.frame" in frame for frame in frames))


def test_the_view_is_turned_with_keys_and_put_back(plant: Plant, look: Any) -> None:
    page = look(plant.page)
    label = "document.querySelector('.twin-labels span')?.style.transform"
    before = page.wait_for_function(label).json_value()
    page.focus("#twin canvas")
    for key in ("ArrowLeft", "ArrowUp", "+"):
        page.keyboard.press(key)
    page.wait_for_function(f"before => {label} !== before", arg=before)
    page.click("[data-twin=reset]")
    page.wait_for_function(f"before => {label} === before", arg=before)
    page.click("[data-twin-cell=sis_b]")
    page.wait_for_function(f"before => {label} !== before", arg=before)


def test_a_cell_of_which_nothing_is_drawn_has_the_whole_plant_seen(plant: Plant, look: Any) -> None:
    page = look(plant.page)
    label = "document.querySelector('.twin-labels span')?.style.transform"
    before = page.wait_for_function(label).json_value()
    page.click("[data-twin-cell=sis_b]")
    page.wait_for_function(f"before => {label} !== before", arg=before)
    page.evaluate("document.querySelector('[data-twin-cell=sis_b]').dataset.twinCell = 'office'")
    page.click("[data-twin-cell=office]")
    page.wait_for_function(f"before => {label} === before", arg=before)


def test_what_is_drawn_is_read_in_spanish_too(plant: Plant, look: Any) -> None:
    page = look(plant.page, locale="es")
    page.wait_for_function("document.querySelector('#twin-robots').textContent.includes('ra1: medido')")


def test_without_webgl_the_plant_is_drawn_from_above(
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


FOOTPRINTS = [
    ({"kind": "box", "size": [0.2, 0.1, 0.3]}, (-0.1, -0.05, 0.1, 0.05)),
    ({"kind": "cylinder", "size": [0.05, 0.4]}, (-0.05, -0.05, 0.05, 0.05)),
    ({"kind": "sphere", "size": [0.05]}, (-0.05, -0.05, 0.05, 0.05)),
]


@pytest.mark.parametrize(
    ("shape", "box"), FOOTPRINTS, ids=lambda value: value["kind"] if isinstance(value, dict) else ""
)
def test_a_shape_seen_from_above_is_its_outline(
    plant: Plant, look_flat: Any, shape: Any, box: Sequence[float]
) -> None:
    page = look_flat(plant.page)
    draw = f"async ([shape, place]) => (await import('{assets()}/twin_flat.js')).footprint(shape, place)"
    moved = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 3, 9, 1]  # column by column: shifted to 2, 3, 9
    x, y = zip(*page.evaluate(draw, [shape, moved]), strict=True)
    assert (min(x) - 2, min(y) - 3, max(x) - 2, max(y) - 3) == pytest.approx(box)
    lying = [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1]  # its z points against y
    _, deep = zip(*page.evaluate(draw, [shape, lying]), strict=True)
    assert max(deep) == pytest.approx(shape["size"][-1] / (1 if shape["kind"] == "sphere" else 2))


class Board:
    """`ra1`'s board, played by the test."""

    Q = (30.0, -45.0, 90.0)  # deg; the last of the pinion

    def __init__(self, client: Any) -> None:
        self._client = client
        self._seq = 0
        client.publish(
            topics.topic("ra_1", Channel.PRESENCE), payloads.encode(Presence(online=True)), retain=True
        )

    def say(self, **more: Any) -> None:
        self._seq += 1
        told = {"state": MotionState.STOPPED, "q": self.Q, "node": None, "homed": True, "boot_id": 7} | more
        said = Telemetry(seq=self._seq, **told)
        self._client.publish(topics.topic("ra_1", Channel.TELEMETRY), payloads.encode(said))


def kind(page: Any) -> str | None:
    return page.evaluate("arboledaTwin.drawn()['robot/ra1']?.kind")


def test_a_board_that_falls_silent_is_grey_and_says_for_how_long(
    mosquitto: Callable[[int], Any], free_port: int, tmp_path: Path, look: Any
) -> None:
    mosquitto(free_port)
    broker = f"127.0.0.1:{free_port}"
    heard = Heard(shipped(), broker)
    board = Board(heard.client)
    with running(tmp_path, "--no-ros", "--boards", "real", "--broker", broker) as plant:
        page = look(plant.page)
        assert kind(page) == "unknown"

        def measured() -> bool:
            board.say()
            return kind(page) == "measured"

        wait_for(measured)
        stood = page.evaluate("arboledaTwin.links().ra1")
        assert same(stood, Place(shipped(), "ra1").links(heard.last("ra1")))
        page.wait_for_function(
            "document.querySelector('#twin-robots').textContent.includes('ra1: silent for 2 s')"
        )
        assert same(page.evaluate("arboledaTwin.links().ra1"), stood)
        board.say(homed=False, state=MotionState.NOT_HOMED)
        wait_for(lambda: kind(page) == "unhomed")
    heard.close()


def test_between_two_nodes_a_mobile_is_estimated_beside_where_it_was_measured(
    plant: Plant, look: Any
) -> None:
    page = look(plant.page)
    told = "arboledaTwin.drawn()['robot/rm_sis_a']"
    submit(page, "sis_a 1A 5")
    page.wait_for_function(f"{told}.kind === 'measured' && {told}.estimate && {told}.goal")
    page.wait_for_function(f"{told}.kind === 'measured' && !{told}.estimate && !{told}.goal")


def test_a_zone_says_who_has_it(tmp_path: Path, look: Any) -> None:
    file = tmp_path / "zoned.yaml"
    told = yaml.safe_load(SHIPPED.read_text()) | {"zones": {"centre": {"poses": ["sis_a pickup"]}}}
    told["cells"]["sis_a"]["arm"]["speeds"] = {"q1_deg_s": 9}  # a zone that is held for a moment is not seen
    file.write_text(yaml.safe_dump(told))
    with running(tmp_path, "--no-ros", "--plant", str(file), "--rate", "3") as plant:
        page = look(plant.page)
        spans = "[...document.querySelectorAll('.twin-labels span')]"
        label = f"{spans}.find(each => each.dataset.s === '{{}}')?.textContent"
        page.wait_for_function(f"{label.format('free')} === 'centre: free'")
        submit(page, "sis_a 1B 7")
        page.wait_for_function(f"{label.format('held')} === 'centre: ra1'")


@pytest.mark.requires("rclpy")
def test_what_is_drawn_solid_is_what_joint_states_say(
    quick_discovery: None, observer: Any, tmp_path: Path, look: Any
) -> None:
    from sensor_msgs.msg import JointState

    names = {"ra1": "/r1/joint_states", "ra3": "/r3/joint_states", "rm_sis_a": "/rm_sis_a/joint_states"}
    observer.listen(JointState, *names.values(), qos=1000)  # asking for the tasks takes its time
    with running(tmp_path) as plant:
        page = look(plant.page)
        observer.wait(lambda: all(observer.heard.values()), "no joint states")
        kept = keep(page, "arboledaTwin.drawn()")
        submit(page, "sis_a 0B 7", "sis_c 2A 5")
        observer.wait(lambda: ended(page, 2), "the tasks did not end")
        over = time.time()

        def heard_since() -> bool:
            stamps = [observer.heard[topic][-1].header.stamp for topic in names.values()]
            return all(stamp.sec + stamp.nanosec / 1e9 > over for stamp in stamps)

        observer.wait(heard_since, "nothing was said after the end of the tasks")

        def said(robot: str) -> list[list[float]]:
            return [list(message.position) for message in observer.heard[names[robot]]]

        def at_rest() -> bool:
            drawn_now = page.evaluate("arboledaTwin.drawn()")
            return all(drawn_now[f"robot/{robot}"]["q"] == pytest.approx(said(robot)[-1]) for robot in names)

        observer.wait(at_rest, "what is drawn is not the last that was said")
        seen = [frame for _, frame in kept()]
        for robot in names:
            known = {tuple(round(value, 9) for value in q) for q in said(robot)}
            poses = {tuple(round(value, 9) for value in frame[f"robot/{robot}"]["q"]) for frame in seen}
            assert len(poses) >= 3 and poses <= known


@pytest.mark.requires("rclpy")
def test_a_robot_that_only_says_whether_it_moves_is_estimated(
    quick_discovery: None, observer: Any, tmp_path: Path, look: Any
) -> None:
    from std_msgs.msg import UInt8

    file = Path(__file__).parents[2] / "examples/plants/by_hand.yaml"
    told = "arboledaTwin.drawn()['robot/rm_sis_a']"
    with running(tmp_path, "--plant", str(file)) as plant:
        page = look(plant.page)
        says = {name: observer.publisher(UInt8, f"/{name}/motion_state") for name in ("rm_sis_a", "ra1")}
        for state in says.values():
            state.publish(UInt8(data=0))
        assert page.evaluate(f"{told}.kind") == "unknown"
        submit(page, "sis_a 0B 7")
        page.wait_for_function(f"{told}.goal")
        says["rm_sis_a"].publish(UInt8(data=1))
        says["rm_sis_a"].publish(UInt8(data=0))
        page.wait_for_function(
            f"{told}.kind === 'estimated' && {told}.q === null && {told}.estimate[1] === 0.4"
        )
        assert "rm_sis_a: estimated" in page.inner_text("#twin-robots")
        assert not page.evaluate("arboledaTwin.solid('rm_sis_a')")
