"""A student of a class: the folder with the plant, its tokens, and the address of its page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import count
from pathlib import Path

from arboleda.cli.new import write
from arboleda.extension import Role
from arboleda.plant_file import examples
from arboleda.runtime import tokens
from arboleda.runtime.state import replace_file

STATE = "state"


@dataclass(frozen=True, kw_only=True)
class Student:
    """A student with a plant: `address` is that of its page; the token `operator` lets do everything there,
    `viewer` look and stop."""

    name: str
    plant: Path
    state: Path
    address: str
    operator: str
    viewer: str


def written(
    folder: Path, names: Sequence[str], addresses: Mapping[str, str], origin: str, port: int
) -> list[Student]:
    """Write a plant and tokens for each name, where there are none yet.

    `addresses` are those of before, by the token of a viewer; others are `origin` with a port from `port` on.
    """
    ports = (each for each in count(port) if f"{origin}:{each}" not in addresses.values())
    students = []
    for name in names:
        plant, state = folder / name / examples.PLANT, folder / name / STATE
        if not plant.exists():
            write(folder / name)
        shown = tokens.read(state)
        viewer = shown[Role.VIEWER]
        address = addresses.get(viewer) or f"{origin}:{next(ports)}"
        students.append(
            Student(
                name=name,
                plant=plant,
                state=state,
                address=address,
                operator=shown[Role.OPERATOR],
                viewer=viewer,
            )
        )
    return students


def note(file: Path, students: Sequence[Student], addresses: Mapping[str, str]) -> None:
    """Add to the tokens of a site those who are not in it; what somebody has written there stays."""
    text = file.read_text("utf-8") if file.exists() else ""
    fresh = [each for each in students if each.viewer not in addresses]
    lines = [f"{each.address} {each.viewer}  # {each.name}" for each in fresh]
    if lines:
        replace_file(file, "\n".join([*text.splitlines(), *lines, ""]))
