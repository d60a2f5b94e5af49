"""Files that a file of trees includes: beside it, in a package of ROS 2, or at an absolute path."""

from __future__ import annotations

import os
from pathlib import Path

from arboleda.drivers import quoted
from arboleda.extension import ConfigError
from arboleda.plant_file import user_file
from arboleda_trees.bt_xml.markup import LARGEST
from arboleda_trees.bt_xml.reading import MissingInclude

PREFIXES = "AMENT_PREFIX_PATH"  # where packages of ROS 2 are installed, once that is sourced
MARKER = Path("share/ament_index/resource_index/packages")
HOW = "it was not looked into; name it by its path from this file to have it read"


def read(file: str, path: str, package: str) -> tuple[str, bytes]:
    """The name of an included file and its content, as `reading.Fetch` has it."""
    if "\0" in path or "\0" in package:
        raise ConfigError(("this is not the name of a file",))
    target = os.path.normpath(_placed(file, path, package))
    return target, user_file.read_bytes(Path(target), LARGEST)


def _placed(file: str, path: str, package: str) -> Path:
    """The path of an included file; as in BehaviorTree.CPP, an absolute one counts even with a package."""
    if Path(path).is_absolute():
        if not Path(path).exists():
            raise MissingInclude(
                (f"{quoted(path)} is an absolute path, and there is no such file here; {HOW}",)
            )
        return Path(path)
    return _share(path, package) / path if package else Path(file).parent / path


def _share(path: str, package: str) -> Path:
    """The shared folder of a package."""
    prefixes = [Path(each) for each in os.environ.get(PREFIXES, "").split(os.pathsep) if each]
    for prefix in prefixes:
        if Path(package).name == package and (prefix / MARKER / package).is_file():
            return prefix / "share" / package
    why = (
        "is not among those that are sourced here"
        if prefixes
        else "cannot be found: no ROS 2 is sourced here"
    )
    named = f"{quoted(path)} lies in the ROS package {quoted(package)}, which {why}"
    raise MissingInclude((f"{named}; {HOW}",))
