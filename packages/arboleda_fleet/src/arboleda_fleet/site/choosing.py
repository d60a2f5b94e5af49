"""Choice of the plant for a task that names cells of several: the one expected to finish first."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import urlencode

from arboleda.engine import Prospect, best
from arboleda.extension import ArboledaError, Phrase, Sentence
from arboleda.model.sentence import OWN
from arboleda.model.text import BETWEEN_CELLS
from arboleda.recipes import Order

from .reach import NO_PLANT, PlantRefusal, PlantSilent, Reach

OF_PLANT = "/"  # between a plant and its cell
LONGEST = 500  # characters of the reason that a plant keeps

FORM = Phrase("site.form", "write plant/cell,plant/cell and the task, e.g. {example}")
NO_SUCH = Phrase("site.no_such", "there is no plant {plant} on this page")
NONE_ANSWERS = Phrase("site.none_answers", "none of these plants answers: {silent}")
MAY_HAVE_IT = Phrase(
    "site.may_have_it", "{silent}, and may have #{id} already; without an answer it is given to nobody"
)
OF_SILENT = Phrase("site.of_silent", "{plant} ({why})")
EXAMPLE = "north/sis_a,south/sis_a 0B 7"


class TaskRefused(ArboledaError):
    """A task is given to no plant; the sentence is the reason."""


@dataclass(frozen=True, kw_only=True)
class Choice:
    """The chosen plant, the text for it, and the reason, None if the plant has the task already."""

    plant: str
    text: str
    why: Sentence | None


def names_plants(text: str) -> bool:
    """True if a text itself names its plants."""
    return OF_PLANT in (text.split() or [""])[0]


async def chosen(text: str, plants: Mapping[str, Reach]) -> Choice:
    """Ask all plants that a text names; TaskRefused where one of them refuses it, or none answers.

    With an id each of them has to answer: one that does not may have that task already.
    """
    texts, id = _by_plant(text, plants)
    answers = await asyncio.gather(*(_prospects(name, each, plants[name]) for name, each in texts.items()))
    silent = {
        name: answer for name, answer in zip(texts, answers, strict=True) if isinstance(answer, Sentence)
    }
    reasons = tuple(OF_SILENT(plant=name, why=why) for name, why in silent.items())
    if len(silent) == len(texts):
        raise TaskRefused(NONE_ANSWERS(silent=reasons))
    if id and silent:
        raise TaskRefused(MAY_HAVE_IT(silent=reasons, id=id))
    if id and (known := await _known(id, texts, plants)) is not None:
        return Choice(plant=known, text=texts[known], why=None)
    prospects = [each for answer in answers if not isinstance(answer, Sentence) for each in answer]
    prospects += [_of_silent(name, why) for name, why in silent.items()]
    order, why = best(prospects)
    return Choice(
        plant=order.cell.partition(OF_PLANT)[0], text=f"{order.text} #{id}" if id else order.text, why=why
    )


def _by_plant(text: str, plants: Mapping[str, Reach]) -> tuple[dict[str, str], str]:
    """The text for each plant, which names its cells alone, and the id, "" if there is none."""
    names, *words = text.split()
    cells: dict[str, list[str]] = {}
    for name in names.split(BETWEEN_CELLS):
        plant, of_plant, cell = name.rpartition(OF_PLANT)
        if not (plant and of_plant and cell):
            raise TaskRefused(FORM(example=EXAMPLE))
        if plant not in plants:
            raise TaskRefused(NO_SUCH(plant=plant))
        cells.setdefault(plant, []).append(cell)
    id = words[-1][1:] if words and words[-1].startswith("#") else ""
    return {plant: " ".join([BETWEEN_CELLS.join(own), *words]) for plant, own in cells.items()}, id


async def _prospects(plant: str, text: str, reach: Reach) -> list[Prospect] | Sentence:
    """The promises of a plant's cells; a sentence about the silence if it does not answer."""
    try:
        rows = await reach.get(f"/api/promises?{urlencode({'text': text})}")
        return [
            Prospect(
                order=Order(text=row["text"], cell=f"{plant}{OF_PLANT}{row['cell']}", recipe=""),
                seconds=float(row["seconds"]),
                hindrance=None if row["hindrance"] is None else OWN(text=str(row["hindrance"])),
                is_full=bool(row["full"]),
            )
            for row in rows
        ]
    except PlantRefusal as error:
        raise TaskRefused(OF_SILENT(plant=plant, why=error.sentence)) from error
    except PlantSilent as error:
        return error.sentence
    except (KeyError, TypeError, ValueError):
        return NO_PLANT(url=reach.place.url)


def _of_silent(plant: str, why: Sentence) -> Prospect:
    """The prospect of a silent plant: it promises nothing, and is named among those not chosen."""
    return Prospect(
        order=Order(text="", cell=plant, recipe=""), seconds=math.inf, hindrance=why, is_full=True
    )


async def _known(id: str, texts: Mapping[str, str], plants: Mapping[str, Reach]) -> str | None:
    """The plant that has a task of this id already."""

    async def knows(plant: str) -> bool:
        try:
            await plants[plant].get(f"/api/tasks/{id}")
        except PlantRefusal:
            return False
        return True

    found = await asyncio.gather(*map(knows, texts))
    return next((plant for plant, has in zip(texts, found, strict=True) if has), None)
