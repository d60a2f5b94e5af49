"""Languages: a folder each, with the words of page, nodes, login, waiting room, reports and proofs.

A package adds what it says itself: its entry point of the group `arboleda.languages` names a Python package
with a folder `languages`, in which each language has files of the same names.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from importlib import resources
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from arboleda.host.packages import registered

if TYPE_CHECKING:
    from importlib.abc import Traversable  # where Python 3.10 has it, and 3.14 no more

GROUP = "arboleda.languages"
FIRST = "en"  # in which is said what another language has no words for
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # in C where there is one, ten times as fast


def _found() -> tuple[str, ...]:
    folders = resources.files(__package__).iterdir()
    others = (each.name for each in folders if each.joinpath("page.yaml").is_file() and each.name != FIRST)
    return (FIRST, *sorted(others))


LANGUAGES = _found()


@cache
def contents(language: str, part: str) -> dict[str, Any]:
    """The file of a part of a language: page, nodes, login and so on; without what it does not say."""
    found: dict[str, Any] = {}
    for folder in _folders():
        file = folder / language / f"{part}.yaml"
        if file.is_file():
            found = _joined(found, yaml.load(file.read_text(encoding="utf-8"), LOADER))
    return found


def _folders() -> Iterator[Traversable]:
    """The folders of languages: first this one, then those of other packages, none of which is loaded."""
    yield resources.files(__package__)
    for each in registered(GROUP):
        top, *below = each.module.split(".")
        spec = find_spec(top)
        for folder in (spec and spec.submodule_search_locations) or ():
            yield Path(folder, *below, "languages")


def _joined(ours: dict[str, Any], theirs: dict[str, Any]) -> dict[str, Any]:
    """Both together, group by group; of what is in both, ours."""
    both = {key: _joined(ours[key], theirs[key]) for key in ours if isinstance(theirs.get(key), dict)}
    return theirs | ours | both


@cache
def texts(language: str, part: str) -> dict[str, str]:
    """The words of a part, in English where the language has none."""
    return contents(FIRST, part) | contents(language, part)


def spoken(wishes: Iterable[str | None]) -> str:
    """The first language of these: as addresses, cookies and browsers name it, by its first two letters."""
    words = (each.strip()[:2].lower() for each in wishes if each)
    return next((each for each in words if each in LANGUAGES), FIRST)
