"""Task texts by a grammar of our own: what is taken, as what, and what is refused."""

from __future__ import annotations

import re
from collections.abc import Iterator

from arboleda.core.text import FORM, UNKNOWN_BUT_NEAR
from arboleda.model.messages import TaskChanged, TaskRequest, TaskState
from arboleda.model.plant_model import PlantModel
from arboleda.model.sentence import Value

from ..invariants.invariant import Look, Trigger, invariant
from .tasks import is_storage_task, only_stores, stores

LONGEST = 200
ID = re.compile(r"#(?!t-)[A-Za-z0-9_.-]{1,64}", re.ASCII)


@invariant(Trigger.ASKED)
def texts_mean_what_they_say(look: Look) -> Iterator[str]:
    """A task text is taken where it names what the plant has and its cell has room, and only there."""
    requests, record = look.moment.requests, look.record
    if len(requests) != 1 or not isinstance(requests[0], TaskRequest) or requests[0].trigger:
        return
    changes = [change.message for change in record.tasks.changes if change.before is None or change.answer]
    refused = record.tasks.refused > 0
    meant = _all_meant(look.world.offers, requests[0].text)
    if not meant and not all(map(only_stores, look.world.offers.cells)):
        return  # it may be a task of another recipe
    if not meant:
        if not refused:
            yield f"{requests[0].text[:60]!r} means nothing, and was taken"
        yield from _unhelpful(look)
        return
    queued = {each.name: each.queued for each in record.before_requests.cells}
    full = [cell for cell, _, _ in meant if queued[cell] >= look.world.offers.cell(cell).queue_limit]
    id = meant[0][2]
    known = id is not None and id in record.before_requests.ids
    if not known and refused is not (len(full) == len(meant)):
        word = "refused" if refused else "taken"
        yield f"{requests[0].text!r} was {word}, so many tasks wait: {queued}"
    allowed = {(cell, words) for cell, words, _ in meant}
    if not refused and not any((task_change.cell, task_change.text) in allowed for task_change in changes):
        yield f"{requests[0].text!r} was taken as {[task_change.text for task_change in changes]}"
    if id is not None and not refused and not any(task_change.task == id for task_change in changes):
        yield f"{requests[0].text!r} has another id: {[task_change.task for task_change in changes]}"
    if (
        not known
        and not refused
        and not any(task_change.state is TaskState.QUEUED for task_change in changes)
    ):
        yield f"{requests[0].text!r} was taken, and nobody says that it waits"


def _unhelpful(look: Look) -> Iterator[str]:
    """Sentences on refusals whose example is no task for a rack's last place, or whose hint is not there."""
    for message in look.moment.sent:
        if not isinstance(message, TaskChanged) or message.state is not TaskState.REFUSED:
            continue
        for part in message.sentence.parts():
            example = str(part.values["example"]) if part.phrase is FORM else None
            if example is not None and not _is_last_place(look.world.offers, example):
                yield f"{example!r} is given as an example, and is no task"
            if part.phrase is UNKNOWN_BUT_NEAR and part.values["near"] not in _list(part.values["there"]):
                yield f"{message.sentence!r} hints at what there is not"


def _list(value: Value) -> tuple[Value, ...]:
    return value if isinstance(value, tuple) else (value,)


def _is_last_place(model: PlantModel, text: str) -> bool:
    meant = _meant(model, text)
    return meant is not None and text.endswith(f" {len(model.cell(meant[0]).stations) - 1}")


def _all_meant(model: PlantModel, text: str) -> list[tuple[str, str, str | None]]:
    """The meanings of a text in the cells that it names with commas; empty if one of them cannot do it."""
    names, space, rest = text.strip().partition(" ")
    if len(text) > LONGEST:
        return []
    meant = [_meant(model, f"{name}{space}{rest}") for name in names.split(",")]
    found = [each for each in meant if each is not None]
    return found if len({cell for cell, _, _ in found}) == len(meant) else []


def _meant(model: PlantModel, text: str) -> tuple[str, str, str | None] | None:
    """The cell, the words and the id of a text; None where it means no task."""
    words = text.split()
    id = None
    if len(text) > LONGEST:
        return None
    if words and words[-1].startswith("#"):
        if not ID.fullmatch(words[-1]):
            return None
        id = words.pop()[1:]
    if not words or not all(word.isascii() for word in words[:2]):
        return None
    name, *rest = (word.lower() for word in words[:2])
    cells = [each for each in model.cells if stores(each)]
    cell = next((each for each in cells if each.name.lower() == name), None)
    if len(words) == 2 and rest == ["palletizing"]:
        cell = cell or next((each for each in cells if each.roles["arm"].name.lower() == name), None)
        offers = cell is not None and any(each.name == "palletizing" for each in cell.recipes)
        return (cell.name, f"{cell.name} palletizing", id) if cell and offers else None
    if cell is None or len(words) != 3:
        return None
    code = next((code for code in cell.paths if code.lower() == rest[0]), None)
    if code is None or not is_storage_task(cell, f"{cell.name} {code}"):
        return None
    if words[2] not in map(str, range(len(cell.stations))):
        return None
    return cell.name, f"{cell.name} {code} {words[2]}", id


TEXTS = (texts_mean_what_they_say,)
