"""Process of the workshop: requests and answers as pickles, from and to the plant that has started it."""

from __future__ import annotations

import os
import pickle
import sys
from typing import Any

from arboleda.extension import ArboledaError
from arboleda.host.limits import give_way

from .workshop_plant import WorkshopPlant

KINDNESS = 10  # that of `nice`: whatever the plant does comes first


def main() -> None:
    """Answer requests, (name, values) each, until there are no more."""
    give_way(KINDNESS)
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a plant's Python prints is no answer
    plant = WorkshopPlant()
    while (request := _next()) is not None:
        pickle.dump(_answer(plant, *request), answers)
        answers.flush()
    os._exit(0)  # whatever threads the plant's Python has started


def _next() -> tuple[str, tuple[Any, ...]] | None:
    try:
        found: tuple[str, tuple[Any, ...]] = pickle.load(sys.stdin.buffer)
        return found
    except EOFError:
        return None


def _answer(plant: WorkshopPlant, name: str, values: tuple[Any, ...]) -> tuple[Any, str]:
    """The result and "", or None and the sentence of a refusal."""
    try:
        return getattr(plant, name)(*values), ""
    except ArboledaError as error:
        return None, str(error)
    except Exception as error:  # noqa: BLE001 - a draft may be anything
        return None, f"the draft cannot be looked at: {type(error).__name__}: {error}"
