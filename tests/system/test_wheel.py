"""The wheel is whole: what a checkout has of the packages is in it, and it works outside a checkout."""

from __future__ import annotations

import subprocess
import sys
import sysconfig
import venv
from collections.abc import Callable
from pathlib import Path
from zipfile import ZipFile

import httpx
import pytest
from packaging.metadata import Metadata
from tests.packages import PACKAGES as BESIDE

from arboleda import __version__

from ..patience import PATIENCE_S
from ..scripts import load
from .conftest import Process

ROOT = Path(__file__).parents[2]
CHECK = load("wheel-check")
PACKAGES = ("src/arboleda/arboleda", "src/arboleda_ros/arboleda_ros")
DESCRIPTION = "src/arboleda_description/arboleda_description"
RUN = "from arboleda.cli.entry import main; main()"
Command = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture(scope="module")
def clone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A release is made of one: nothing that lies about here can slip into it."""
    folder = tmp_path_factory.mktemp("clone")
    subprocess.run(["git", "clone", "--quiet", ROOT, folder], check=True)
    return folder


@pytest.fixture(scope="module")
def wheel(clone: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return built(clone, tmp_path_factory.mktemp("release"))


def built(source: Path, folder: Path) -> Path:
    building = f"from setuptools import build_meta; build_meta.build_wheel({str(folder)!r})"
    subprocess.run([sys.executable, "-c", building], cwd=source, check=True, capture_output=True)
    (found,) = folder.glob("*.whl")
    return found


@pytest.fixture
def installed(wheel: Path, tmp_path: Path) -> Command:
    """The command out of the unpacked wheel, in an empty folder."""
    with ZipFile(wheel) as opened:
        opened.extractall(tmp_path / "site")
    (tmp_path / "here").mkdir()

    def run(*words: str) -> subprocess.CompletedProcess[str]:
        environment = {"PYTHONPATH": str(tmp_path / "site"), "XDG_STATE_HOME": str(tmp_path), "HOME": "/"}
        return subprocess.run(
            [sys.executable, "-c", RUN, *words],
            cwd=tmp_path / "here",
            env=environment,
            capture_output=True,
            text=True,
            timeout=2 * PATIENCE_S,
            check=False,
        )

    return run


def tracked(package: str) -> set[str]:
    """The files of a package, by their paths in a wheel."""
    listed = subprocess.run(
        ["git", "ls-files", package], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.split()
    return {str(Path(file).relative_to(Path(package).parent)) for file in listed}


def test_it_holds_the_packages_and_nothing_else_and_what_it_says_of_itself_is_valid(wheel: Path) -> None:
    wanted = set().union(*(tracked(each) for each in (*PACKAGES, DESCRIPTION)))
    wanted.remove("arboleda/examples")  # leads to the folder of the examples
    # The lessons and their notebooks stay in the checkout, beside their pages.
    here = tracked("examples")
    examples = {file for file in here if file.count("/") > 1 and not file.startswith("examples/notebooks/")}
    with ZipFile(wheel) as opened:
        held = {name for name in opened.namelist() if ".dist-info/" not in name}
        (name,) = (each for each in opened.namelist() if each.endswith(".dist-info/METADATA"))
        said = Metadata.from_email(opened.read(name))
    assert held == wanted | {f"arboleda/{file}" for file in examples}
    assert str(said.version) == __version__
    assert said.description_content_type == "text/markdown" and "ros" in (said.provides_extra or ())


def test_it_brings_nothing_that_only_developers_or_only_some_plants_need(wheel: Path) -> None:
    assert CHECK.unwanted(wheel) == []


def test_building_it_leaves_nothing_that_colcon_takes_for_a_package(clone: Path, wheel: Path) -> None:
    assert wheel.is_file() and (clone / ".build").is_dir()
    assert CHECK.left_behind(clone) == []


def test_the_folder_for_colcon_makes_no_wheel_of_the_same_name(clone: Path, tmp_path: Path) -> None:
    with pytest.raises(subprocess.CalledProcessError) as refused:
        built(clone / "src/arboleda", tmp_path)
    assert b"Give pip the folder above src, where pyproject.toml is." in refused.value.stderr


@pytest.mark.parametrize("name", BESIDE)
def test_the_wheel_of_a_package_beside_it_holds_the_package(name: str, clone: Path, tmp_path: Path) -> None:
    wanted = {file for file in tracked(f"packages/{name}/src/{name}") if "/README." not in file}
    with ZipFile(built(clone / "packages" / name, tmp_path)) as opened:
        held = {file for file in opened.namelist() if file.startswith(f"{name}/")}
    assert held == wanted
    assert CHECK.left_behind(clone) == []


@pytest.mark.system
@pytest.mark.smoke
def test_it_runs_a_plant_where_nothing_else_is(installed: Command) -> None:
    ran = installed("up", "--once", "sis_a 0B 7", "--no-ros", "--rate", "10")
    assert ran.returncode == 0, ran.stderr


@pytest.fixture
def extended(clone: Path, wheel: Path, tmp_path: Path) -> Path:
    """The command of an environment that has libraries, the wheel of the runner, and beside it that of
    examples/extension."""
    extension = built(clone / "examples/extension", tmp_path / "extension")
    venv.create(tmp_path / "environment", with_pip=True)
    python = tmp_path / "environment/bin/python"
    libraries = tmp_path / "libraries"
    libraries.mkdir()
    for each in Path(sysconfig.get_path("purelib")).iterdir():
        if "arboleda" not in each.name and each.suffix != ".pth":
            (libraries / each.name).symlink_to(each)
    site = "import sysconfig; print(sysconfig.get_path('purelib'))"
    folder = subprocess.run([python, "-c", site], check=True, capture_output=True, text=True).stdout.strip()
    (Path(folder) / "libraries.pth").write_text(f"{libraries}\n", "utf-8")
    pip = (python, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps")
    subprocess.run([*pip, wheel, extension], check=True)
    return python.with_name("arboleda")


@pytest.mark.system
def test_an_extension_is_installed_beside_it(
    extended: Path, start: Callable[..., Process], tmp_path: Path
) -> None:
    alone = {"PYTHONPATH": "", "HOME": str(tmp_path), "XDG_STATE_HOME": str(tmp_path)}

    def arboleda(*words: str, language: str = "en") -> Process:
        return start(
            str(extended), *words, "--state", str(tmp_path / "state"), env=alone | {"ARBOLEDA_LANG": language}
        )

    for count, language, said in (
        (1, "en", "sis_a: 1 tasks that ended here"),
        (2, "es", "sis_a: 2 tareas que terminaron aquí"),
    ):
        plant = arboleda("up", "--no-ros", "--rate", "10")
        plant.wait_for("HTTP API")
        assert arboleda("submit", f"sis_a 0B {count}", "--wait").wait() == 0
        asked = arboleda("ended", language=language)
        assert asked.wait() == 0 and said in asked.lines, asked.output
        page = next(line.split()[-1] for line in plant.lines if line.startswith("Page:"))
        assert httpx.get(f"{page}/api/ended").json()["sis_a"] == count
        assert "ended:counts:sis_a" in httpx.get(page).text
        assert plant.interrupt() == 0, plant.output
        assert "left out" not in plant.output and "Traceback" not in plant.output, plant.output
