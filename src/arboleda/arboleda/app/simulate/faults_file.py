"""What `--faults FILE` holds: faults as a person writes them, or a broken seed that `--json` wrote."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from arboleda.core.errors import ConfigError
from arboleda.simulator.run import MINUTE_S

SUMMARY = "seeds"  # the key that a file of --json has, and no other


@dataclass(frozen=True, kw_only=True)
class Told:
    """`climate` is what Climate.from_file takes; of a broken seed also which it is, and how long it ran."""

    climate: Any
    seed: int | None = None
    plant: str | None = None
    seconds: float | None = None


def read(path: Path, seed: int | None) -> Told:
    """The file; of a summary the broken seed of that number, None for its first one. Else ConfigError."""
    data = _data(path)
    if not isinstance(data, dict) or SUMMARY not in data:
        return Told(climate=data)
    try:
        return _broken(path, data[SUMMARY], seed)
    except (KeyError, TypeError):
        raise ConfigError((f"{path}: is not what `arboleda simulate --json` writes",)) from None


def _broken(path: Path, rows: list[dict[str, Any]], seed: int | None) -> Told:
    broken = [row for row in rows if row["broken"]]
    for row in broken:
        if seed in (None, row["seed"]):
            seconds = row["broken"]["minutes"] * MINUTE_S
            climate = {"faults": row["broken"]["faults"]}
            return Told(climate=climate, seed=row["seed"], plant=row["plant"], seconds=seconds)
    there = f"; there are {', '.join(str(row['seed']) for row in broken)}" if broken else ""
    raise ConfigError((f"{path}: has no broken seed{'' if seed is None else f' {seed}'}{there}",))


def _data(path: Path) -> Any:
    try:
        text = path.read_text(encoding="utf-8")
        return json.loads(text) if path.suffix == ".json" else yaml.safe_load(text)
    except OSError as error:
        raise ConfigError((f"{path}: cannot be read: {error.strerror}",)) from None
    except (ValueError, yaml.YAMLError, RecursionError) as error:
        sentence = " ".join(str(error).split())
        raise ConfigError((f"{path}: cannot be read: {sentence}",)) from None
