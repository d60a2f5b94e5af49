"""Plant files for benchmarks: as many cells as wanted, each like the first of the shipped plant."""

from __future__ import annotations

from copy import deepcopy
from importlib.resources import files
from pathlib import Path
from typing import Any

import yaml

# Poses a degree or two apart: moves of a few hundredths of a second, and every one the arm could make.
NEAR_PICKUP = {"deg": [2, 1], "mm": 0}
NEAR_STATIONS = {"columns_q1_deg": [0.5, 1, 1.5], "rows_q2_deg": [0.5, 1, 1.5]}


def write(
    file: Path, cells: int, *, timing: dict[str, Any] | None = None, near: bool = False, **robots: Any
) -> Path:
    """A plant file of `cells` cells, c1 to cN, with arms a1 to aN and mobile robots m1 to mN.

    Every robot declares `robots`, as link="ros"; `timing` is that section of the plant file. `near` puts
    the poses of an arm close together, for moves of a few hundredths of a second.
    """
    shipped = yaml.safe_load((files("arboleda") / "plants/plant.yaml").read_text(encoding="utf-8"))
    first = next(iter(shipped["cells"].values()))
    if near:
        shipped["stations"], first["pickup"] = NEAR_STATIONS, NEAR_PICKUP
    shipped["cells"] = {f"c{n}": _cell(deepcopy(first), n, robots) for n in range(1, cells + 1)}
    if timing:
        shipped["timing"] = timing
    file.write_text(yaml.safe_dump(shipped, sort_keys=False), encoding="utf-8")
    return file


def _cell(cell: dict[str, Any], n: int, robots: dict[str, Any]) -> dict[str, Any]:
    cell["arm"] |= {"name": f"a{n}", "mqtt": f"a_{n}", "twin": f"t{n}", **robots}
    cell["mobile"] |= {"name": f"m{n}", **robots}
    return cell
