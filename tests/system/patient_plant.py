"""The shipped plant with more patience for its boards."""

from __future__ import annotations

from pathlib import Path

import arboleda

SHIPPED = Path(arboleda.__file__).parent / "plants" / "plant.yaml"
# Where the machine is busy, its boards may say nothing for seconds.
PATIENT = "timing: {stale_after_s: 20, deadline_floor_s: 60}\n"


def patient_plant(folder: Path) -> Path:
    """Write the plant's file into a folder."""
    file = folder / "plant.yaml"
    file.write_text(SHIPPED.read_text("utf-8") + PATIENT, "utf-8")
    return file
