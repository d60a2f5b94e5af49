"""The page on drivers: what it shows works, and `check` says what it says."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

import arboleda.drivers as public
from arboleda.drivers.supervisor import FIRST_RETRY_S, LAST_RETRY_S
from arboleda.model.errors import ConfigError
from arboleda.model.messages import Report
from arboleda.model.plant_model import Link, MotionState
from arboleda.plant_file import loader

from ..kinds.station import STATION, plant

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs/how-to/write-a-driver.md").read_text("utf-8")
EXAMPLE = ROOT / "examples/own_driver"
CODE = PAGE.split("```python\n")[1].partition("```")[0]
USE = PAGE.split("```yaml\n")[1].partition("```")[0]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the example, where the commands of the page are typed."""
    shutil.copytree(EXAMPLE, tmp_path / "shop")
    monkeypatch.chdir(tmp_path / "shop")
    return tmp_path / "shop"


def test_the_driver_of_the_page_is_one_and_its_device_is_heard(folder: Path) -> None:
    Path("drivers/my_plc.py").write_text(CODE, "utf-8")
    text = (
        Path("plant.yaml")
        .read_text("utf-8")
        .replace("line_tcp.py", "my_plc.py")
        .replace("line_tcp:", "my_plc:")
    )
    Path("plant.yaml").write_text(text, "utf-8")
    use = loader.load(Path("plant.yaml")).robots["press"].driver
    assert use is not None
    driver, heard = use.make(), list[Report]()
    driver.start(tuple(plant().robots.values()), heard.append, lambda: 5.0)
    warm = STATION.command(id="9-1", robot="station", verb="warm", values={"celsius": 40.0})
    with pytest.raises(public.NotSent, match="the PLC knows no"):
        driver.send(warm)
    driver.send(public.Stop(id="9-2", robot="station", mode=public.StopMode.HALT))
    assert [(each.state, each.accepted) for each in heard] == [
        (MotionState.STOPPED, None),
        (MotionState.STOPPED, "9-2"),
    ]


def test_the_plant_file_of_the_page_is_that_of_the_example(folder: Path) -> None:
    text = Path("plant.yaml").read_text("utf-8")
    head, _, _ = text.partition("cells:")
    _, _, cells = USE.partition("cells:")
    assert USE.splitlines()[0] in head
    Path("plant.yaml").write_text(f"{head}cells:{cells}", "utf-8")
    assert loader.load(Path("plant.yaml")).robots["press"].link is Link.DRIVER


def test_check_says_of_mistakes_what_the_page_says(folder: Path) -> None:
    head, _, _ = Path("plant.yaml").read_text("utf-8").partition("cells:")
    _, _, cells = USE.partition("cells:")
    found = []
    good = Path("drivers/line_tcp.py").read_text("utf-8")
    for plc, driver in (("prt: 1, ", good), ("", good.replace("    def stop(", "    def end("))):
        rest = f"cells:{cells}kinds:{head.partition('kinds:')[2]}"
        text = f"uses: [recipes.py, drivers/line_tcp.py]\nname: shop\n{rest}"
        Path("plant.yaml").write_text(text.replace("{host:", "{" + plc + "host:"), "utf-8")
        Path("drivers/line_tcp.py").write_text(driver, "utf-8")
        with pytest.raises(ConfigError) as refusal:
            loader.load(Path("plant.yaml"))
        found += refusal.value.problems
    lines = PAGE.splitlines()
    assert [problem for problem in found if problem.partition(": ")[2] not in PAGE] == [], found
    assert all(any(line.partition(": ")[2] == each.partition(": ")[2] for line in lines) for each in found)


def test_the_page_names_all_that_is_public_and_the_times_that_there_are() -> None:
    assert [name for name in public.__all__ if name not in PAGE and name not in UNSAID] == []
    assert f"after {FIRST_RETRY_S:g} s" in PAGE and f"up to {LAST_RETRY_S:g} s" in PAGE


UNSAID = (
    "Clock",
    "Driver",
    "DriverError",
    "Hear",
    "Robot",
    "StopMode",
)  # types for annotations, and modes by name
