"""What no file of the repository may say, and what documents must."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from fnmatch import fnmatch
from functools import cache
from pathlib import Path

import pytest
from PIL import Image

ROOT = Path(__file__).parents[2]
FORBIDDEN = {
    # A key of VDA 5050 3.0, "active" and this, is of the vehicle's own button; a method of Moonraker,
    # "printer." and this, shuts Klipper down.
    "a software stop is no safety function and is not called one": (
        r"(?i)(?<!active)(?<!printer\.)emergency[\s_-]*stop"
    ),
    "a path of somebody's machine": r"(?<![\w.$}])/(?:work|root)/",
    "a host of a package index": r"(?i)\b(?:pypi|pythonhosted|debian|npmjs|ubuntu)\.(?:org|com|net)\b",
}


@cache
def texts() -> dict[str, str]:
    """Every file of the repository that is text, new ones included."""
    contents = {path.relative_to(ROOT).as_posix(): path.read_bytes() for path in present() if path.is_file()}
    return {name: data.decode() for name, data in contents.items() if b"\0" not in data}


def present() -> Iterator[Path]:
    """Every file but those of git and those that `.gitignore` names."""
    lines = ["/.git", "/.git/"]
    lines += [line for line in (ROOT / ".gitignore").read_text().splitlines() if line and line[0] != "#"]
    for folder, folders, names in os.walk(ROOT):
        here = Path(folder).relative_to(ROOT)
        folders[:] = [each for each in folders if not is_ignored(here / each, lines, "/")]
        yield from (Path(folder, each) for each in names if not is_ignored(here / each, lines))


def is_ignored(path: Path, lines: list[str], ending: str = "") -> bool:
    """A line that begins with / is for this path alone; one that ends with it is for folders."""
    return any(fnmatch(f"/{path}{ending}", line if line[0] == "/" else f"*/{line}") for line in lines)


@pytest.mark.parametrize("pattern", FORBIDDEN.values(), ids=FORBIDDEN)
def test_no_file_contains(pattern: str) -> None:
    assert [name for name, text in texts().items() if re.search(pattern, text)] == []


@pytest.mark.parametrize(
    "parts",
    [
        ("Emergency", "\n", "Stop"),
        ("emergency", "-stop"),
        ("at /", "root/x"),
        ("/", "work/y"),
        ("files.py", "pi.org"),
    ],
)
def test_the_patterns_find_what_they_are_for(parts: tuple[str, ...]) -> None:
    assert any(re.search(pattern, "".join(parts)) for pattern in FORBIDDEN.values())


def heading_levels(name: str) -> list[int]:
    """Levels of the headings of a Markdown file, in order; `#` inside code blocks is no heading."""
    prose = re.sub(r"^```.*?^```$", "", texts()[name], flags=re.MULTILINE | re.DOTALL)
    return [len(marks) for marks in re.findall(r"^(#+) ", prose, re.MULTILINE)]


def test_the_spanish_readme_has_the_headings_of_the_english_one() -> None:
    assert heading_levels("README.md")
    assert heading_levels("README.es.md") == heading_levels("README.md")


@pytest.mark.parametrize("name", ["README.md", "README.es.md"])
def test_a_readme_is_read_in_three_minutes(name: str) -> None:
    lines = texts()[name].splitlines()
    assert len(lines) <= 80 and max(map(len, lines)) <= 130


@pytest.mark.parametrize(("name", "other"), [("README.md", "README.es.md"), ("README.es.md", "README.md")])
def test_a_readme_leads_to_that_of_the_other_language_and_has_the_same_code(name: str, other: str) -> None:
    assert f"[{other}]({other})" in texts()[name].splitlines()[2]
    boxes = [re.findall(r"^```\w*\n(.*?)^```$", texts()[each], re.M | re.S) for each in (name, other)]
    typed, other_typed = ([re.sub(r" +# .*", "", box) for box in each] for each in boxes)
    assert typed == other_typed
    assert "make run\nmake test\n" in typed


def test_the_changelog_has_a_page_for_each_version() -> None:
    unreleased, *versions = re.split(r"^## ", texts()["CHANGELOG.md"], flags=re.MULTILINE)[1:]
    assert unreleased.startswith("[Unreleased]\n") and versions
    assert [version for version in versions if len(version.splitlines()) > 80] == []


def test_the_picture_of_the_readme_moves_and_is_small() -> None:
    file = ROOT / "docs/images/task.webp"
    assert all(f"docs/images/{file.name}" in texts()[name] for name in ("README.md", "README.es.md"))
    assert file.stat().st_size < 1_000_000
    with Image.open(file) as picture:
        assert getattr(picture, "n_frames", 1) > 10


def test_make_help_explains_every_target() -> None:
    targets = re.findall(r"^[a-z-]+:.*", texts()["Makefile"], re.MULTILINE)
    assert [line for line in targets if "  ## " not in line] == []
