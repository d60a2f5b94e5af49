"""Drivers that a plant file names: found, with their settings read, or refused with file and line."""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib.metadata import EntryPoint, EntryPoints
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.drivers.port import spec_of
from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import Link, PlantModel, Robot
from arboleda.plant_file import drivers, loader

from ...plants import plant_text, rows

PLANT = plant_text(__file__, "own_drivers")
USE = "driver: {my_plc: {host: 10.0.0.7, slots: [1, 2]}}"
RECIPES = """\
from arboleda.recipes import recipe

@recipe("heat")
def heat(cell):
    return cell.device("oven").heat()
"""
DRIVER = """\
from dataclasses import dataclass
from arboleda.drivers import driver

@dataclass(frozen=True, kw_only=True)
class Settings:
    host: str
    port: int = 502
    slots: tuple[int, ...] = ()

    def __post_init__(self):
        if self.port > 65535:
            raise ValueError("port is beyond 65535")

@driver("my_plc", settings=Settings)
class MyPlc:
    def __init__(self, settings):
        self.settings = settings

    def start(self, devices, hear, clock): ...
    def send(self, command): ...
    def stop(self): ...

@driver("plain")
class Plain(MyPlc):
    def __init__(self): ...
    def start(self, devices, hear, clock): ...
"""


@pytest.fixture
def load(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., PlantModel]:
    """Reads a plant whose device has this use of a driver, beside files with these contents."""
    monkeypatch.chdir(tmp_path)

    def made(use: str = USE, driver: str = DRIVER, plant: str = PLANT) -> PlantModel:
        Path("drivers").mkdir(exist_ok=True)
        Path("drivers/my_plc.py").write_text(driver, "utf-8")
        Path("recipes.py").write_text(RECIPES, "utf-8")
        Path("plant.yaml").write_text(plant.replace(USE, use), "utf-8")
        return loader.load(Path("plant.yaml"))

    return made


def oven(model: PlantModel) -> Robot:
    return model.robots["oven"]


def problems(load: Callable[..., PlantModel], *args: str, **more: str) -> list[str]:
    with pytest.raises(ConfigError) as refusal:
        load(*args, **more)
    return list(refusal.value.problems)


def test_a_driver_beside_the_plant_file_is_made_with_its_settings(load: Callable[..., PlantModel]) -> None:
    found = oven(load())
    assert found.link is Link.DRIVER and found.driver is not None
    settings = found.driver.make().settings
    assert (settings.host, settings.port, settings.slots) == ("10.0.0.7", 502, (1, 2))


def test_a_driver_without_settings_is_named_by_its_name(load: Callable[..., PlantModel]) -> None:
    found = oven(load("driver: plain"))
    assert found.driver is not None
    assert type(found.driver.make()).__name__ == "Plain" and found.driver.settings is None


@pytest.mark.parametrize(
    ("use", "link"),
    [
        ("driver: mqtt", Link.MQTT),
        ("driver: ros", Link.ROS),
        ("link: ros", Link.ROS),
        ("mqtt: o1", Link.MQTT),
    ],
)
def test_what_comes_with_arboleda_is_named_in_the_same_way(
    load: Callable[..., PlantModel], use: str, link: Link
) -> None:
    assert oven(load(use)).link is link


def test_robots_have_drivers_too(load: Callable[..., PlantModel]) -> None:
    text = PLANT + "      car: {kind: mobile, driver: plain}\n    targets:\n      home: {car: {node: 0}}\n"
    car = load(plant=text).robots["car"]
    assert car.link is Link.DRIVER and car.driver is not None and car.driver.name == "plain"


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("use", "place", "told"),
    rows(__file__, "uses_of_drivers"),
)
def test_a_use_that_is_wrong_is_told_with_its_place(
    load: Callable[..., PlantModel], use: str, place: str, told: str
) -> None:
    (problem,) = problems(load, use)
    assert problem.startswith("plant.yaml:10:") and f" {place}: " in problem and told in problem


MISTAKES = {  # id: (what stands there, what stands there instead, the line, what is told)
    "no method": (
        "    def stop(self): ...",
        "",
        14,
        "cannot be imported: the driver my_plc has no method stop",
    ),
    "not frozen": (
        "frozen=True, ",
        "",
        14,
        "cannot be imported: the settings of the driver my_plc must be a frozen dataclass",
    ),
    "no name": ('"plain"', '"a driver"', 26, '"a driver" cannot be the name of a driver'),
    "taken": ('"plain"', '"mqtt"', 26, 'the driver "mqtt" comes with Arboleda'),
    "twice": ('"plain"', '"my_plc"', 26, 'the driver "my_plc" is there twice; the other is on line 19 of'),
    # From Python 3.14 on an annotation is looked at where somebody asks for it.
    "no type": (
        "slots: tuple[int, ...]",
        "slots: Slots",
        19 if sys.version_info >= (3, 14) else 8,
        "NameError",
    ),
    "raises": ("class Plain(MyPlc):", "class Plain(Plc):", 24, "cannot be imported: NameError"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_driver_that_is_wrong_is_told_with_its_line(load: Callable[..., PlantModel], mistake: str) -> None:
    old, new, line, told = MISTAKES[mistake]
    assert old in DRIVER
    (problem,) = problems(load, driver=DRIVER.replace(old, new, 1))
    assert problem.startswith(f"drivers/my_plc.py:{line}:1: ") and told in problem


def test_settings_of_a_type_that_no_file_can_have_are_told(load: Callable[..., PlantModel]) -> None:
    text = DRIVER.replace("import dataclass\n", "import dataclass\nfrom threading import Event\n")
    (problem,) = problems(load, driver=text.replace("slots: tuple[int, ...] = ()", "slots: Event = None"))
    assert problem.startswith(
        "drivers/my_plc.py:20:1: the settings of my_plc have a type that no plant file can give; it can "
    )


SHARE = """
    @property
    def model_speed_share(self):
        return {}

    def __post_init__(self):
"""


@pytest.mark.parametrize("share", ["0.05", "1"])
def test_a_share_of_the_model_s_speed_is_the_robot_s_pace(
    load: Callable[..., PlantModel], share: str
) -> None:
    paced = DRIVER.replace("\n    def __post_init__(self):\n", SHARE.format(share))
    assert oven(load(driver=paced)).pace == float(share)
    assert oven(load()).pace == 1.0


@pytest.mark.parametrize("share", ["0", "2", "True", "'fast'", "1 / 0"])
def test_a_share_that_is_none_is_told_with_its_place(load: Callable[..., PlantModel], share: str) -> None:
    paced = DRIVER.replace("\n    def __post_init__(self):\n", SHARE.format(share))
    assert [each for each in problems(load, driver=paced) if "my_plc: " in each]


OFFERS = """
    @property
    def {}(self):
        return {}

    def __post_init__(self):
"""


def test_facts_and_a_way_out_of_faults_that_settings_offer_are_the_robot_s(
    load: Callable[..., PlantModel],
) -> None:
    offers = OFFERS.format("reported_facts", '("health",)') + "        pass\n"
    offering = offers + OFFERS.format("home_clears_faults", "True")
    use = oven(load(driver=DRIVER.replace("\n    def __post_init__(self):\n", offering))).driver
    assert use is not None and (use.facts, use.recovers) == (("health",), True)
    use = oven(load()).driver
    assert use is not None and (use.facts, use.recovers) == ((), False)


@pytest.mark.parametrize("facts", ["'health'", "(1,)", "('two words',)", "1 / 0"])
def test_facts_that_are_no_names_are_told_with_their_place(
    load: Callable[..., PlantModel], facts: str
) -> None:
    offering = OFFERS.format("reported_facts", facts)
    wrong = DRIVER.replace("\n    def __post_init__(self):\n", offering)
    assert [each for each in problems(load, driver=wrong) if "my_plc: " in each]


def test_check_finds_nothing_wrong_with_a_plant_with_drivers(load: Callable[..., PlantModel]) -> None:
    load()
    outcome = CliRunner().invoke(cli, ["check", "plant.yaml"])
    assert outcome.exit_code == 0, outcome.output


def test_an_installed_package_brings_a_driver(
    load: Callable[..., PlantModel], monkeypatch: pytest.MonkeyPatch
) -> None:
    load()  # which leaves the files
    monkeypatch.syspath_prepend(str(Path("drivers").absolute()))
    named = {"bought": "my_plc:Plain", "wrong": "my_plc:Settings", "gone": "my_plc_2:Plain"}
    points = EntryPoints(EntryPoint(name, value, drivers.GROUP) for name, value in named.items())
    monkeypatch.setattr(drivers, "entry_points", lambda group: points.select(group=group))
    document = drivers.Document("plant.yaml", PLANT.replace(USE, "driver: bought").encode())
    try:
        uses = drivers.driver_uses(document, drivers.PythonUses())
        assert type(uses["oven"].make()).__name__ == "Plain"
        for name, told in (("wrong", "is installed as a driver and is none"), ("gone", "cannot be imported")):
            document = drivers.Document("plant.yaml", PLANT.replace(USE, f"driver: {name}").encode())
            assert drivers.driver_uses(document, drivers.PythonUses()) == {}
            with pytest.raises(ConfigError, match=told):
                document.finish()
    finally:
        sys.modules.pop("my_plc", None)


def test_a_driver_whose_package_is_not_installed_is_named_with_the_line_that_installs_it(
    load: Callable[..., PlantModel], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(drivers, "entry_points", lambda group: EntryPoints())
    with pytest.raises(ConfigError, match=r"driver modbus needs .* type pip install 'arboleda\[drivers\]'"):
        load("driver: {modbus: {host: 10.0.0.7}}")


def test_a_device_that_cells_share_has_a_driver(load: Callable[..., PlantModel]) -> None:
    own = "oven: {shared: oven}\n      spare: {kind: oven}\nshared:\n  oven: {kind: oven, "
    text = PLANT.replace("oven: {kind: oven, ", own)
    found = oven(load(plant=text))
    assert found.driver is not None and found.driver.name == "my_plc"


def test_a_subclass_of_a_driver_is_none_itself(load: Callable[..., PlantModel]) -> None:
    found = oven(load("driver: plain"))
    assert found.driver is not None
    plain = type(found.driver.make())
    assert spec_of(plain) is not None and spec_of(type("Other", (plain,), {})) is None


def test_without_recipes_a_plant_file_is_read_without_its_drivers(load: Callable[..., PlantModel]) -> None:
    load()
    found = oven(loader.load(Path("plant.yaml"), recipes=False))
    assert found.link is Link.DRIVER and found.driver is None


STORAGE = plant_text(__file__, "own_drivers_storage")
ITS_USE = "driver: {my_plc: {host: 10.0.0.7}}"


def test_a_robot_of_a_cell_of_storage_may_have_a_driver(load: Callable[..., PlantModel]) -> None:
    model = load(plant=STORAGE)
    arm, mobile = model.robots["ra1"], model.robots["rm1"]
    assert (arm.link, mobile.link) == (Link.DRIVER, Link.MQTT)
    assert arm.driver is not None and arm.driver.make().settings.host == "10.0.0.7"
    assert [each.name for each in model.driven] == ["ra1"]


def test_its_mobile_robot_may_have_one_of_a_package(
    load: Callable[..., PlantModel], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "acme_plc.py").write_text(DRIVER, "utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    about = tmp_path / "acme_plc-1.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: acme_plc\nVersion: 1\n", "utf-8")
    (about / "entry_points.txt").write_text("[arboleda.drivers]\nplain = acme_plc:Plain\n", "utf-8")
    here = STORAGE.replace("uses: [drivers/my_plc.py]\n", "").replace(ITS_USE, "link: none")
    model = load(plant=here.replace("rm1, link: mqtt", "rm1, driver: plain"))
    assert model.robots["rm1"].link is Link.DRIVER and model.robots["rm1"].driver is not None


@pytest.mark.parametrize(
    ("use", "begin", "words"),
    rows(__file__, "uses_of_drivers_in_storage"),
)
def test_what_is_wrong_with_it_is_told_with_its_place(
    load: Callable[..., PlantModel], use: str, begin: str, words: str
) -> None:
    found = [each for each in problems(load, plant=STORAGE.replace(ITS_USE, use)) if words in each]
    assert [each[: len(begin)] for each in found] == [begin]
