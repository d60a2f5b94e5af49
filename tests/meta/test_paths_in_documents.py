"""Every path that developers are told of in documents exists, and so does the order of imports there."""

from __future__ import annotations

import ast
import os
import re
from collections.abc import Iterator
from fnmatch import fnmatch
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [
    *(ROOT / name for name in ("ARCHITECTURE.md", "CONTRIBUTING.md", "src/arboleda/README.md")),
    *sorted(ROOT.glob("packages/*/README.md")),
    *sorted(ROOT.glob("tools/**/README.md")),
]
CODE = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
QUOTED = re.compile(r"`([^`\n]+)`")
PATH = re.compile(r"[\w*][\w.*-]*(/[\w.*-]+)*/?")
FILE = re.compile(r"\.(py|js|yaml|toml|css|h)$")
MADE = ("build", "dist")  # of no checkout


@cache
def places() -> frozenset[str]:
    """All files and folders, each by its path from the root and by each end of that."""
    found = set()
    for folder, folders, files in os.walk(ROOT):
        folders[:] = [name for name in folders if name not in MADE and not name.startswith(".")]
        parts = Path(folder).relative_to(ROOT).parts
        for name in (*folders, *files):
            whole = (*parts, name)
            found |= {"/".join(whole[start:]) for start in range(len(whole))}
    return frozenset(found)


def lost(text: str) -> Iterator[str]:
    """The paths in a document that lead nowhere: with a slash, or the name of a file."""
    for quoted in QUOTED.findall(CODE.sub("", text)):
        for word in quoted.split():
            path = word.rpartition("=")[2]
            if not ("/" in path or FILE.search(path)) or not PATH.fullmatch(path) or path.startswith(MADE):
                continue
            name = path.rstrip("/")
            if not (any(fnmatch(each, name) for each in places()) if "*" in name else name in places()):
                yield path


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_path_in_a_document_exists(page: Path) -> None:
    assert list(lost(page.read_text("utf-8"))) == []


def test_lost_paths_are_found() -> None:
    assert list(lost("`core/plant.py` `plant.py` `src/*/setup.py` `dist/*` `/api/a` `Plant`")) == []
    wrong = ["core/nowhere.py", "nowhere.py", "src/*/nowhere.py"]
    assert list(lost("".join(f"`{path}` and " for path in wrong))) == wrong


def test_the_order_of_imports_is_that_of_the_contract() -> None:
    (layers,) = re.findall(
        r'^type = "layers"\nlayers = (\[.*?^\])', (ROOT / "pyproject.toml").read_text("utf-8"), re.M | re.S
    )
    (told,) = re.findall(
        r"## The order of imports\n\n```\n(.*?)```", (ROOT / "ARCHITECTURE.md").read_text("utf-8"), re.S
    )
    wanted = [layer.replace("arboleda.", "") for layer in ast.literal_eval(layers)]
    assert [" ".join(layer.split()) for layer in told.split(">")] == wanted
