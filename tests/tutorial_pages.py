"""Commands that a person types in the tutorial, and what a page says that they print."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "docs" / "tutorial"
CONSOLE = re.compile(r"^```console\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LEFT_OUT = "..."
REAL = ("07_ros2_cell", "09_mqtt_board", "14_break_it", "15_read_a_record")  # their lessons have real clocks
LIVE = ("examples/10_plant.py", "arboleda up")  # so do these commands
LONG = ("examples/11_first_recipe.py", "examples/13_declared_device.py", "examples/16_drawn_tree.py")
"""Commands that compute for a second, and try recipes in processes of their own."""
SHELL = frozenset("|>;&")


def pages(language: str = "en") -> list[Path]:
    """The pages of the lessons in a language."""
    spanish = sorted(FOLDER.glob("[0-9]*.es.md"))
    if language == "es":
        return spanish
    return [page for page in sorted(FOLDER.glob("[0-9]*.md")) if page not in spanish]


def commands(page: Path) -> Iterator[tuple[str, list[str]]]:
    """Each command of a page with the lines that it prints; LEFT_OUT stands for any lines, or any words."""
    for box in CONSOLE.findall(page.read_text("utf-8")):
        for part in re.split(r"^\$ ", box, flags=re.MULTILINE)[1:]:
            command, *expected = part.splitlines()
            yield command, expected


def is_plain(page: Path, command: str) -> bool:
    """Whether a command needs no shell, no process, and no clock but one that is moved by hand."""
    if page.stem.removesuffix(".es") in REAL or SHELL & set(command):
        return False
    return not any(each in command for each in (*LIVE, *LONG))


def differs(expected: list[str], printed: str) -> str:
    """What was printed, where a page says something else; nothing where it is as the page says."""
    lines = [line.rstrip() for line in printed.splitlines() if line.strip()]
    text = "".join(f"{line}\n" for line in lines)
    return "" if re.fullmatch(_pattern(expected), text) and "Traceback" not in text else text or "nothing"


def _pattern(expected: list[str]) -> str:
    lines = [line.rstrip() for line in expected if line.strip()]
    parts = [
        r"(?:.*\n)*?" if line == LEFT_OUT else re.escape(line).replace(re.escape(LEFT_OUT), ".*") + r"\n"
        for line in lines
    ]
    return "".join(parts)
