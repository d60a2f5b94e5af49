"""First message of a record: all that the core was made of, so that it can be made once more."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from arboleda.model.messages import Fact, KeptTask
from arboleda.model.plant_files import NO_FILES, PlantFiles

from .errors import NoRecord
from .plain_data import Memory, kept_from, memory_from, plain

FORMAT = 2  # of what is in a file; a higher one is of a newer version


@dataclass(frozen=True, kw_only=True)
class Beginning:
    """Start of a plant: its files, the memory of earlier starts, and the time by the plant's clock.

    `virtual`: its devices with drivers had virtual boards instead. `simulated`: all of its devices had.
    """

    plant: str
    version: str
    epoch: int
    now: float
    rate: float
    virtual: bool
    memory: Mapping[Fact, Mapping[str, str]]
    kept: Sequence[KeptTask]
    files: PlantFiles
    simulated: bool = False

    @property
    def shipped(self) -> bool:
        """True if the plant file is the one that comes with Arboleda, which need not be named."""
        return self.plant == "arboleda" and self.files.plant == NO_FILES.plant

    def data(self) -> bytes:
        """The beginning without the files, as JSON."""
        return json.dumps(
            {
                "plant": self.plant,
                "version": self.version,
                "epoch": self.epoch,
                "now": self.now,
                "rate": self.rate,
                "virtual": self.virtual,
                "simulated": self.simulated,
                "memory": plain(self.memory),
                "kept": plain(list(self.kept)),
                "file": self.files.plant,
            }
        ).encode()


def beginning_from(data: bytes, contents: Mapping[str, bytes]) -> Beginning:
    """The beginning in `data`, with its files; raises NoRecord for anything else."""
    try:
        rows: dict[str, Any] = json.loads(data)
        files = PlantFiles(plant=str(rows["file"]), contents=contents)
        memory: Memory = memory_from(rows["memory"])
        return Beginning(
            plant=str(rows["plant"]),
            version=str(rows["version"]),
            epoch=int(rows["epoch"]),
            now=float(rows["now"]),
            rate=float(rows["rate"]),
            virtual=bool(rows["virtual"]),
            memory=memory,
            kept=[kept_from(each) for each in rows["kept"]],
            files=files,
            simulated=bool(rows.get("simulated", False)),
        )
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise NoRecord("its beginning is not as a plant writes it") from error
