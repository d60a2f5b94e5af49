"""Code of this host and of another: a worker with other files would come to other results."""

from __future__ import annotations

import sys
from collections.abc import Collection, Iterator, Mapping
from functools import lru_cache
from hashlib import blake2b
from importlib.util import find_spec
from pathlib import Path

from arboleda import __version__
from arboleda.host.packages import entry_points

PYTHON, ARBOLEDA = "Python", "Arboleda"
GROUPS = ("checks", "drivers", "kinds", "parts", "recipes")  # of packages that have a say in runs


def packages(others: Collection[str] = ()) -> frozenset[str]:
    """The names of all packages that can decide on what comes of a run; `others` without Python's own."""
    ours = (point.module for group in GROUPS for point in entry_points(f"arboleda.{group}"))
    names = {each.partition(".")[0] for each in (*ours, *others, "arboleda")}
    return frozenset(names - sys.stdlib_module_names - {"__main__"})


@lru_cache(maxsize=4)
def code(names: frozenset[str]) -> Mapping[str, str]:
    """The versions of Python and of Arboleda here, and the digest of each file of packages; of a package that
    is not here there is none.
    """
    found = {PYTHON: "{}.{}".format(*sys.version_info), ARBOLEDA: __version__}
    for package in sorted(names):
        for name, path in _files(package):
            found[name] = blake2b(path.read_bytes(), digest_size=8).hexdigest()
    return found


def difference(ours: Mapping[str, str], theirs: Mapping[str, str]) -> str:
    """The first difference of the code of another host, as words behind its name; "" where there is none.

    A package that the other host does not have is none: a plant that needs it cannot be read there.
    """
    for what in (PYTHON, ARBOLEDA):
        if ours[what] != theirs[what]:
            return f"has {what} {theirs[what]}, and here is {ours[what]}"
    there = {_package(name) for name in theirs}
    changed = [name for name in ours if _package(name) in there and theirs.get(name) != ours[name]]
    changed += [name for name in theirs if name not in ours]
    return f"has another {min(changed)} than this machine" if changed else ""


def _package(name: str) -> str:
    return name.partition("/")[0]


def _files(package: str) -> Iterator[tuple[str, Path]]:
    """The files of an installed package with their names in it; Python's own compiled ones are left out."""
    spec = find_spec(package)
    for folder in (spec and spec.submodule_search_locations) or ():
        for path in sorted(Path(folder).rglob("*")):
            inside = path.relative_to(folder)
            if path.is_file() and "__pycache__" not in inside.parts:
                yield f"{package}/{inside.as_posix()}", path
    if spec is not None and spec.submodule_search_locations is None and spec.origin is not None:
        yield f"{package}/{Path(spec.origin).name}", Path(spec.origin)
