"""The shipped plant and the examples become the plant that the design describes."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from tests.added_package import install
from tests.packages import leave_out

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import Evidence, Link, MqttVersion, PlantModel, Timing
from arboleda.plant_file import loader
from arboleda.store import schemes
from arboleda.testing.storage_layout import StorageLayout
from arboleda_bench.cost.counter import count

EXAMPLES = Path(__file__).parents[3] / "examples" / "plants"
PATHS = {
    "0A": (0, 3, 6),
    "0B": (0, 3, 4, 7),
    "0C": (0, 3, 4, 5, 8),
    "1A": (1, 4, 3, 6),
    "1B": (1, 4, 7),
    "1C": (1, 4, 5, 8),
    "2A": (2, 5, 4, 3, 6),
    "2B": (2, 5, 4, 7),
    "2C": (2, 5, 8),
}
CELLS = {  # arm, MQTT, twin, model, mobile, home, pick-up of exit B in degrees and mm
    "sis_a": ("ra1", "ra_1", "r1", "scara", "rm_sis_a", (0, 0, 0), (45, 10, 0)),
    "sis_b": ("ra2", "ra_2", "r2", "scara", "rm_sis_b", (0, 0, 0), (35, 10, 0)),
    "sis_c": ("ra3", "ra_3", "r3", "cr10a", "rm_sis_c", (0,) * 6, (35, 10)),
}


@pytest.fixture(scope="module")
def shipped() -> PlantModel:
    return loader.load()


def wire_values(plant: PlantModel, cell: str, q: tuple[float, ...]) -> list[float]:
    """Degrees and millimetres, as the design's table gives poses."""
    joints = StorageLayout(plant.cell(cell)).arm.joints
    return [v * 1000 if j.unit == "m" else math.degrees(v) for j, v in zip(joints, q, strict=True)]


@pytest.mark.parametrize("name", CELLS)
def test_a_shipped_cell_is_the_one_of_the_design(shipped: PlantModel, name: str) -> None:
    arm, mqtt, twin, model, mobile, home, pickup = CELLS[name]
    cell = shipped.cell(name)
    layout = StorageLayout(cell)
    assert (layout.arm.name, layout.arm.mqtt, layout.arm.twin, layout.arm.model) == (arm, mqtt, twin, model)
    assert (layout.mobile.name, layout.mobile.mqtt) == (mobile, mobile)
    assert wire_values(shipped, name, layout.home.q) == list(home)
    assert layout.pickup_of(layout.path("0B")) is layout.pickup
    assert wire_values(shipped, name, layout.pickup.q)[: len(pickup)] == pytest.approx(list(pickup))
    assert {path.code: path.nodes for path in layout.paths} == PATHS


@pytest.mark.parametrize("name", CELLS)
def test_a_station_takes_q1_from_its_column_and_q2_from_its_row(shipped: PlantModel, name: str) -> None:
    cell = shipped.cell(name)
    layout = StorageLayout(cell)
    assert [pose.name for pose in cell.stations] == [f"station {number}" for number in range(9)]
    for number, pose in enumerate(cell.stations):
        q1, q2, *_ = wire_values(shipped, name, pose.q)
        assert (q1, q2) == pytest.approx((10 * (number % 3), 10 * (number // 3)))
    assert (layout.palletizing.pick, layout.palletizing.place) == (layout.pickup, cell.stations[8])


def test_shipped_robots_prove_motion_by_ids_over_mqtt(shipped: PlantModel) -> None:
    assert list(shipped.robots) == ["ra1", "rm_sis_a", "ra2", "rm_sis_b", "ra3", "rm_sis_c"]
    for robot in shipped.robots.values():
        assert (robot.link, robot.evidence) == (Link.MQTT, Evidence.IDS)
        assert robot.has_stop
        assert not robot.assume_homed


def test_shipped_times_and_limits_of_the_queue_are_the_defaults(shipped: PlantModel) -> None:
    assert (shipped.name, shipped.timing, shipped.mqtt_version) == ("arboleda", Timing(), MqttVersion.V3_1_1)
    for cell in shipped.cells:
        layout = StorageLayout(cell)
        assert (layout.arm.timeout_s, layout.mobile.timeout_s) == (10, 20)
        assert (cell.queue_limit, cell.drive_to_start) == (100, True)
        assert layout.mobile.grid.size == 9


def test_the_shipped_plant_is_read_with_few_calls(shipped: PlantModel) -> None:
    """Counted, as no clock tells a slow program from a busy machine: 20,000 calls take some hundredths of a
    second."""
    read: list[PlantModel] = []
    calls = count(lambda: read.append(loader.load()))
    assert read == [shipped]
    assert sum(calls.values()) < 30_000


def test_the_example_by_hand_listens_to_typed_motion_states() -> None:
    plant = loader.load(EXAMPLES / "by_hand.yaml")
    assert [(r.link, r.evidence) for r in plant.robots.values()] == [(Link.ROS, Evidence.STATE)] * 2
    assert StorageLayout(plant.cell("sis_a")).palletizing.place.name == "station 8"


def test_a_robot_may_be_only_drawn(tmp_path: Path) -> None:
    file = tmp_path / "drawn.yaml"
    file.write_text((EXAMPLES / "by_hand.yaml").read_text().replace("link: ros", "link: none"))
    assert {robot.link for robot in loader.load(file).robots.values()} == {Link.NONE}


def test_the_example_joints_has_numbered_stations_with_an_approach() -> None:
    plant = loader.load(EXAMPLES / "joints.yaml")
    cell = plant.cell("sis_a")
    assert [(r.link, r.evidence) for r in plant.robots.values()] == [(Link.MQTT, Evidence.JOINTS)] * 2
    assert [pose.name for pose in cell.stations] == ["station 0", "station 1", "station 2"]
    assert cell.stations[1].q[2] == 0.04
    assert cell.stations[1].above == pytest.approx((*cell.stations[1].q[:2], 0.02))
    assert StorageLayout(cell).arm.joints[0].lower == math.radians(-20)


def test_a_board_without_stop_is_a_warning(tmp_path: Path, shipped: PlantModel) -> None:
    text = (EXAMPLES / "joints.yaml").read_text("utf-8")
    file = tmp_path / "plant.yaml"
    file.write_text(text.replace("mqtt: ra_1", "mqtt: ra_1\n      stop: none"), "utf-8")
    (warning,) = loader.warnings(loader.load(file))
    assert warning.startswith("ra1: ")
    assert loader.warnings(shipped) == ()


def test_a_store_is_the_address_of_a_database_without_its_password(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(tmp_path)
    install(tmp_path, "shelf", "class Shelf: ...", group=schemes.GROUP, what="Shelf")
    content = (EXAMPLES / "by_hand.yaml").read_bytes()

    def parsed(store: str) -> PlantModel:
        return loader.parse(
            "plant.yaml", content.replace(b"\ncells:", f"\nstore: {store}\ncells:".encode(), 1)
        )

    assert parsed("shelf://me@db.example/plants").store == "shelf://me@db.example/plants"
    assert loader.parse("plant.yaml", content).store == ""
    with pytest.raises(ConfigError, match="store: must be postgresql://USER@HOST:PORT/DATABASE"):
        parsed("plants.sqlite")
    with pytest.raises(ConfigError, match=r"keeps a memory at attic://; there are .*shelf"):
        parsed("attic://me@db.example/plants")
    with pytest.raises(ConfigError, match="store: has a password in it; leave it to PGPASSWORD") as refused:
        parsed("shelf://me:hidden@db.example/plants")
    assert "hidden" not in str(refused.value)


@pytest.mark.parametrize(
    ("key", "what"),
    [
        ("store: postgresql://me@db.example/plants", "store: postgresql://"),
        ("opcua_view: {port: 4840}", "opcua_view: opcua_view"),
    ],
)
def test_a_key_whose_package_is_missing_is_named_with_the_line_that_installs_it(
    key: str, what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    content = (EXAMPLES / "by_hand.yaml").read_bytes()
    content = content.replace(b"\ncells:", f"\n{key}\ncells:".encode(), 1)
    leave_out(monkeypatch, tmp_path, "arboleda_fleet")
    with pytest.raises(
        ConfigError, match=rf"{what} needs the package fleet, .* pip install 'arboleda\[fleet\]'"
    ):
        loader.parse("plant.yaml", content)


@pytest.mark.parametrize(
    ("line", "level"),
    [
        ("", "off"),
        ("assistants: off\n", "off"),
        ("assistants: read\n", "read"),
        ("assistants: propose\n", "propose"),
    ],
)
def test_assistants_may_look_only_where_the_file_says_so(tmp_path: Path, line: str, level: str) -> None:
    assert loader.load(written(tmp_path, line)).assistants.value == level


def test_what_assistants_may_give_tasks_to_needs_limits(tmp_path: Path) -> None:
    lines = 'assistants: submit\nassistant_limits: {cells: [%s], at_once: 2, hours: "%s"}\n'
    plant = loader.load(written(tmp_path, lines % ("sis_a", "22:00-06:30")))
    limits = plant.assistant_limits
    assert (plant.assistants.value, limits.cells, limits.at_once) == ("submit", ("sis_a",), 2)
    assert limits.hours is not None and limits.hours.text == "22:00-06:30"
    assert [limits.hours.include(minute) for minute in (0, 389, 390, 1319, 1320)] == [
        True,
        True,
        False,
        False,
        True,
    ]
    for text, problem in (
        ("assistants: submit\n", r'assistants: needs "assistant_limits"'),
        (lines % ("sis_z", "08:00-18:00"), r"assistant_limits\.cells\[0\]: must be sis_a"),
        (lines % ("sis_a", "8-18"), r'hours: must be hours of a day such as "07:30-18:00"'),
        (lines % ("sis_a", "08:00-24:30"), "hours: must be hours"),
        (lines % ("sis_a", "08:00-08:00"), "hours: must be hours"),
        ("assistants: read\nassistant_limits: {cells: [sis_a]}\n", "counts only with"),
    ):
        with pytest.raises(ConfigError, match=problem):
            loader.load(written(tmp_path, text))


@pytest.mark.parametrize("word", ["proposes", "true", "all"])
def test_there_is_no_other_level_of_assistants(tmp_path: Path, word: str) -> None:
    with pytest.raises(ConfigError, match=r"assistants: .*off.*read"):
        loader.load(written(tmp_path, f"assistants: {word}\n"))


def written(folder: Path, line: str) -> Path:
    """The shipped plant with a line more."""
    file = folder / "plant.yaml"
    file.write_text((EXAMPLES / "by_hand.yaml").read_text("utf-8") + line, "utf-8")
    return file
