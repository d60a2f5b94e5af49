"""Both entrances bring the same libraries: pip by pyproject.toml; ROS 2 by rosdep keys, pip for the rest."""

from __future__ import annotations

import ast
import re
from importlib.metadata import requires
from itertools import chain
from pathlib import Path

from packaging.requirements import Requirement
from tests.packages import PACKAGES

ROOT = Path(__file__).parents[2]
HOUSES = (ROOT / "src/arboleda/arboleda", PACKAGES["arboleda_trees"])  # with libraries behind extras
IMPORTED_AS = {"msgpack": "msgpack", "pillow": "PIL", "pyzmq": "zmq"}
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


def asked_of_extras() -> dict[str, list[str]]:
    """The libraries, with their bounds, that extras bring and nobody needs who does not ask for them."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    pictures = re.search(r"^pictures = \[(.*)\]$", text, re.MULTILINE)
    assert pictures
    groot2 = [line for line in requires("arboleda_trees") or () if 'extra == "groot2"' in line]
    return {
        "groot2": [line.partition(";")[0].replace(" ", "") for line in groot2],
        "pictures": re.findall(r'"([^"]+)"', pictures[1]),
    }


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
    extras = chain(*asked_of_extras().values())
    assert set(requirements) <= {*asked_of_pip(), *asked_of_packages(), *extras}


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


def imported_at_once(path: Path, house: Path) -> set[str]:
    """The modules that a file imports as soon as it is loaded itself, by their whole names."""
    package = path.relative_to(house.parent).parent.parts
    found = set()
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else ()
            start = ".".join((*above, *filter(None, [node.module])))
            found |= {start, *(f"{start}.{alias.name}" for alias in node.names)}
    return found


def test_the_library_of_an_extra_is_loaded_where_it_is_asked_for_and_nobody_needs_it() -> None:
    libraries = [Requirement(each).name for each in chain(*asked_of_extras().values())]
    assert len(libraries) == len(IMPORTED_AS) and not {*libraries} & {
        Requirement(e).name for e in asked_of_pip()
    }
    files = [
        (path, house) for house in HOUSES for path in house.rglob("*.py") if "examples" not in path.parts
    ]
    imports = {path.relative_to(house.parent): imported_at_once(path, house) for path, house in files}
    names = {IMPORTED_AS[each] for each in libraries}
    users = {path: names & {each.partition(".")[0] for each in found} for path, found in imports.items()}
    users = {path: found for path, found in users.items() if found}
    assert set().union(*users.values()) == names
    modules = {".".join(path.with_suffix("").parts) for path in users}
    assert [str(path) for path, found in imports.items() if found & modules] == []
