"""Record of one start of a plant: its settings, and the limits of all records together."""

from __future__ import annotations

from dataclasses import dataclass, field

from .plant_files import PlantFiles

DAY_S = 86_400.0
MEGABYTE = 1_000_000


@dataclass(frozen=True, kw_only=True)
class Limits:
    """Limits of all records of a plant together: at most so many `megabytes` and `days`."""

    megabytes: float = 1000.0
    days: float = 30.0


@dataclass(frozen=True, kw_only=True)
class Recording:
    """Settings of the recording of one start: the plant's files, the limits, and options.

    `virtual`: its devices with drivers of their own had virtual boards instead. `reports`: a report of each
    task that fails is written.
    """

    files: PlantFiles
    virtual: bool = False
    limits: Limits = field(default_factory=Limits)
    reports: bool = False
