"""Holdings: what only one process has of a plant, its state directory and its memory."""

from __future__ import annotations

import json
import logging
from typing import Any

from arboleda.engine import ACTS_TOLD
from arboleda.model.plant_model import PlantModel
from arboleda.model.sentence import OWN, Sentence, from_data, retold
from arboleda.store.act_table import ActTable, JournalEntry
from arboleda.wire import epochs

from .options import Options
from .parts.memory_pace import MemoryPace
from .state import StateDir, default_state
from .stores import history_of, memory_of

LOG = logging.getLogger(__name__)


class Holdings:
    """Holdings: the state directory and the memory of a plant, and two readers of its tasks, between `open`
    and `close`."""

    def __init__(self, model: PlantModel, options: Options, *, has_plant: bool) -> None:
        store = (options.store or model.store) if has_plant else ""
        path = options.state_dir or default_state(model.name)
        self.state = StateDir(path, plant=model.name, store=store)
        self.memory = memory_of(store, path, model.name)
        # for threads of a server, and for the plant's ports
        self.history, self.recalled = (history_of(store, path, model.name, is_checked=True) for _ in range(2))
        self.pace = MemoryPace()
        self.memory.timing = self.pace
        self.past_acts: list[dict[str, Any]] = []  # of operators, before this start

    def open(self) -> None:
        """Take both; StartError where another process has them, or they cannot be used."""
        self.state.open()
        self.memory.open()
        self.past_acts = _past_acts(self.memory.acts)

    def lead(self, now: int) -> int:
        """The number of this start, higher than that of any start before, on any host."""
        number = self.memory.lead.take(self.state.next_epoch(now))
        if epochs.objection(number, now) is not None:
            LOG.warning(
                "this start has number %d, far ahead of this machine's clock, as an earlier start had:"
                " restart the boards that refuse its heartbeat",
                number,
            )
        return number

    def close(self) -> None:
        """Give back everything that only one process may have; idempotent."""
        self.history.close()
        self.recalled.close()
        self.memory.close()
        self.state.close()


def _past_acts(acts: ActTable) -> list[dict[str, Any]]:
    """The acts of operators before this start, oldest first."""
    return [
        {"at": each.unix_s, "scope": each.scope, "cell": each.cell, "sentence": _sentence_of(each)}
        for each in reversed(acts.last())
    ]


def _sentence_of(entry: JournalEntry) -> Sentence:
    """The sentence about an act; an act of a package or of an older version is told in the words of then.

    Plain text where the entry cannot be read.
    """
    try:
        data = json.loads(entry.said or "")
        return from_data(data, ACTS_TOLD) if data["key"] in ACTS_TOLD else retold(entry.sentence, data)
    except (ValueError, TypeError, KeyError):
        return OWN(text=entry.sentence)
