"""Contents of `--faults FILE`: faults and acts of people, or a broken seed of `--json`."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from arboleda.extension import ConfigError
from arboleda.plant_file import user_file
from arboleda.plant_file.yaml_marks import LARGEST, YamlFault, parse, plain_value
from arboleda_proofs.simulator.run import MINUTE_S

LARGEST_SUMMARY = 16 * 1024 * 1024  # bytes of what --json wrote of many thousand seeds
SUMMARY = "seeds"  # the key that a file of --json has, and no other
SIMULATED = ("faults", "people")  # what of a broken seed is simulated again


@dataclass(frozen=True, kw_only=True)
class FaultsFile:
    """`climate` is what Climate.from_file and script_from take; of a broken seed also which it is, and how
    long it ran.

    `broken` is all that the file says of it. `standby`: it ran on two hosts. `revises`: its files were
    changed while it ran.
    """

    climate: Any
    seed: int | None = None
    plant: str | None = None
    broken: Mapping[str, Any] = field(default_factory=dict)
    seconds: float | None = None
    standby: bool = False
    revises: bool = False


def read(path: Path, seed: int | None) -> FaultsFile:
    """The contents of the file; of a summary the broken seed of that number, None for its first one.
    ConfigError if it is neither."""
    data = _data(path)
    if not isinstance(data, dict):
        return FaultsFile(climate=data)
    if SUMMARY not in data:
        return FaultsFile(climate=data, plant=_plant(path, data))
    try:
        broken = _broken(path, data[SUMMARY], seed)
        standby, revises = (data.get(key) is True for key in ("standby", "revisions"))
        return replace(broken, standby=standby, revises=revises)
    except (KeyError, TypeError):
        raise ConfigError((f"{path}: is not what `arboleda simulate --json` writes",)) from None


def _broken(path: Path, rows: list[dict[str, Any]], seed: int | None) -> FaultsFile:
    broken = [row for row in rows if row["broken"]]
    for row in broken:
        if seed in (None, row["seed"]):
            seconds = row["broken"]["minutes"] * MINUTE_S
            climate = {key: row["broken"][key] for key in SIMULATED if key in row["broken"]}
            return FaultsFile(
                climate=climate,
                seed=row["seed"],
                plant=row["plant"],
                broken=row["broken"],
                seconds=seconds,
            )
    there = f"; there are {', '.join(str(row['seed']) for row in broken)}" if broken else ""
    raise ConfigError((f"{path}: has no broken seed{'' if seed is None else f' {seed}'}{there}",))


def _plant(path: Path, data: dict[str, Any]) -> str | None:
    plant = data.get("plant")
    if plant is None or isinstance(plant, str):
        return plant
    raise ConfigError((f"{path}: {line_of(path, ('plant',))}plant is the name of a plant, not {plant!r}",))


def line_of(path: Path, place: Sequence[str | int]) -> str:
    """The line of the file that has this place, to begin a sentence with; empty if that is unknown."""
    try:
        node, mark = parse(user_file.read_bytes(path, LARGEST))[0], None
    except (ConfigError, YamlFault):
        return ""
    for step in place:
        if step not in node.children:
            break
        node, mark = node.children[step], node.keys.get(step, node.children[step].mark)
    return f"line {mark.line}: " if mark is not None else ""


def _data(path: Path) -> Any:
    try:
        if path.suffix == ".json":  # which we have written
            return json.loads(user_file.read_text(path, LARGEST_SUMMARY))
        return plain_value(user_file.read_bytes(path, LARGEST))
    except YamlFault as fault:
        raise ConfigError((f"{path}:{fault.mark.line}:{fault.mark.column}: {fault.sentence}",)) from None
    except (ValueError, RecursionError) as error:
        sentence = " ".join(str(error).split())
        raise ConfigError((f"{path}: cannot be read: {sentence}",)) from None
