"""Both entrances bring the same libraries: pip by pyproject.toml; ROS 2 by rosdep keys, pip for the rest."""

from __future__ import annotations

import re
from importlib.metadata import requires
from pathlib import Path

from packaging.requirements import Requirement
from tests.packages import PACKAGES

ROOT = Path(__file__).parents[2]
KEY = re.compile(r"<(?:exec_)?depend>(?:python3-)?([\w-]+)</")


def without_comments(name: str) -> list[str]:
    lines = (ROOT / name).read_text(encoding="utf-8").splitlines()
    return [line for line in lines if line and not line.startswith("#")]


def asked_of_pip() -> list[str]:
    """The dependencies of pyproject.toml, each with its bounds."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    block = re.search(r"^dependencies = \[\n(.*?)^\]$", text, re.MULTILINE | re.DOTALL)
    assert block
    return re.findall(r'^ *"([^";]+)', block[1], re.MULTILINE)


def asked_of_packages() -> set[str]:
    """The dependencies of packages beside the cell runner, without the packages themselves."""
    lines = [line for name in PACKAGES for line in requires(name) or () if "extra ==" not in line]
    return {line.replace(" ", "") for line in lines if Requirement(line).name not in {"arboleda", *PACKAGES}}


def key(dependency: str) -> str:
    """The rosdep key of a library, without `python3-`."""
    name = re.split(r"[<>=]", dependency)[0].lower()
    return {"pyyaml": "yaml"}.get(name, name)


def test_the_requirements_beside_ros_2_have_the_bounds_of_pyproject() -> None:
    requirements = without_comments("requirements-ros.txt")
    assert requirements
    assert set(requirements) <= {*asked_of_pip(), *asked_of_packages()}


def test_each_library_comes_by_one_way_beside_ros_2() -> None:
    packages = [path.read_text(encoding="utf-8") for path in ROOT.glob("src/*/package.xml")]
    keys = {found for text in packages for found in KEY.findall(text)}
    by_pip = set(without_comments("requirements-ros.txt"))
    ways = {name: (key(name) in keys) + (name in by_pip) for name in asked_of_pip()}
    assert ways == dict.fromkeys(ways, 1)


def needed_on(machine: str) -> set[str]:
    """All libraries of the smallest install on such a processor."""
    reached: set[str] = set()
    wanted = [Requirement(each) for each in asked_of_pip()]
    while wanted:
        each = wanted.pop()
        where = {"platform_machine": machine, "extra": ""}
        if (each.marker is not None and not each.marker.evaluate(where)) or each.name.lower() in reached:
            continue
        reached.add(each.name.lower())
        wanted += [Requirement(line) for line in requires(each.name) or ()]
    return reached


def test_the_smallest_install_needs_the_same_on_every_processor() -> None:
    assert {"nicegui", "starlette"} <= needed_on("x86_64") == needed_on("aarch64")


def test_the_wheels_of_ros_2_are_asked_for_where_they_exist_only() -> None:
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    asked = re.findall(r'^ *"(ros-(?:jazzy|kilted)-.*)",$', text, re.MULTILINE)
    assert asked and all(Requirement(each).marker is not None for each in asked)
    elsewhere = {"platform_machine": "aarch64", "sys_platform": "linux"}
    assert not any(marker.evaluate(elsewhere) for each in asked if (marker := Requirement(each).marker))
