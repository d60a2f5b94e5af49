"""The last tryout of a draft as a page on a record has it: its plant is another one than that which runs."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from arboleda.extension import Phrase
from arboleda.recorder.errors import NoRecord

if TYPE_CHECKING:  # slow to load, and only needed for a record
    from arboleda_proofs.past.past import Past
    from arboleda_proofs.past.side import Start

TITLES = {"title": "make.of_draft", "leave": "make.back", "back": {"tab": "make"}}
NOTHING_TRIED = Phrase("record.nothing_tried", "Nothing of the draft has been tried yet.")


class TriedPlant:
    """TriedPlant: a record and its plant as PastSide; `made` tells it from another tryout."""

    def __init__(self, record: Path, about: Path, made: int) -> None:
        from arboleda.recorder import reader
        from arboleda_proofs.past.past import Past
        from arboleda_proofs.playback.views import Views

        known: dict[str, Any] = json.loads(about.read_text("utf-8"))
        self.made = made
        self._layout: dict[str, Any] = known["layout"] | {"titles": TITLES}
        self._urdf: dict[str, str] = known["urdf"]
        self._past = Past(Views(reader.opened(record)), self._layout)

    def layout(self) -> dict[str, Any]:
        return self._layout

    def urdf(self, robot: str) -> str:
        return self._urdf[robot]

    def past(self, epoch: int | None = None) -> Past:
        return self._past

    def starts(self) -> list[Start]:
        return []


class TriedPlants:
    """TriedPlants: the last tryout, read once; for any thread. `tried` gives its files: its record, and what
    is shown of its plant."""

    def __init__(self, tried: Callable[[], tuple[Path, Path] | None]) -> None:
        self._tried = tried
        self._known: TriedPlant | None = None

    def last(self) -> TriedPlant:
        """The last tryout; NoRecord if there is none."""
        files = self._tried()
        if files is None:
            raise NoRecord(NOTHING_TRIED())
        try:
            made = files[0].stat().st_mtime_ns
            if self._known is None or self._known.made != made:
                self._known = TriedPlant(*files, made)
        except (OSError, ValueError) as error:
            raise NoRecord(NOTHING_TRIED()) from error
        return self._known
