"""The OEE of the cells: a row each, with the figures that are unknown and the reason."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from arboleda.dashboard.faces.moment import seconds
from arboleda.extension import Face, Words
from arboleda.oee.figures import Oee

UNKNOWN = "-"


def face(figures: Sequence[Oee], words: Words) -> Face:
    found: Face = {"rows/oee": [each.cell for each in figures]}
    return found | {f"row/oee/{each.cell}": _row(each, words) for each in figures}


def _row(figures: Oee, words: Words) -> dict[str, Any]:
    shares = (figures.oee, figures.availability, figures.performance, figures.quality)
    return {
        "state": "known" if figures.missing is None else "missing",
        "cell": figures.cell,
        "texts": [
            figures.cell,
            *(UNKNOWN if share is None else f"{100 * share:.0f} %" for share in shares),
            seconds(figures.planned_s),
            words("oee.counted", done=figures.done, failed=figures.failed),
            "" if figures.missing is None else words.say(figures.missing),
        ],
    }
