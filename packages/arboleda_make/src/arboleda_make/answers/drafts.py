"""Draft of the plant's files, its check, and what is tried of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any


@dataclass(frozen=True, kw_only=True)
class Editing:
    """Editor of the draft, and the time since when."""

    name: str
    since: Annotated[str, "In UTC, ISO 8601."]


@dataclass(frozen=True, kw_only=True)
class DraftState:
    """State of the draft."""

    file: Annotated[str, "The plant file's name."]
    digest: Annotated[str, "Of the files of the draft: another step makes it another."]
    editor: Editing | None
    changes: Annotated[list[str], "What the draft would change in the files, a line each."]
    waiting: Annotated[list[str], "What the files have and only the next start of the plant takes."]
    undo: Annotated[int, "How many steps can be undone."]
    redo: int
    values: Annotated[dict[str, Any], "The plant file of the draft as plain values."]
    trees: Annotated[list[str], "The files of trees of the draft."]
    restart: Annotated[list[str], "Those of its changes that only a restart takes, and why."]
    is_ours: Annotated[bool, "False where its files cannot be changed before they are made one's own."]
    set_aside: Annotated[list[str], "What of an earlier draft could not be read, and where it is now."]


@dataclass(frozen=True, kw_only=True)
class DraftCheck:
    """Findings of `arboleda check` on the draft."""

    problems: Annotated[list[str], "With file, line and column; none where it is good."]
    warnings: list[str]


@dataclass(frozen=True, kw_only=True)
class DraftChoice:
    """Value that the plant file could have, and what would stand there."""

    text: Annotated[str, "What would stand in the plant file."]
    value: Annotated[dict[str, Any], "The value to set."]


@dataclass(frozen=True, kw_only=True)
class DraftOffer:
    """Offer to state what nobody knows: one of these values at this place of the plant file."""

    sentence: Annotated[str, "What nobody knows, as the plant file does not state it."]
    place: Annotated[list[str], "Where in the plant file it would stand."]
    choices: Annotated[list[DraftChoice], "Of these one is so; a person knows which."]


@dataclass(frozen=True, kw_only=True)
class CheckedDraft(DraftCheck):
    """Findings of `arboleda check` on the draft with this digest, and what its plant file could state."""

    digest: Annotated[str, "Of the files that were checked, for `of` of the step that sets a value."]
    offers: Annotated[list[DraftOffer], "What the plant file could state, and does not."]


@dataclass(frozen=True, kw_only=True)
class KeptDraft(DraftCheck):
    """The draft, kept as a version; None with its problems where nothing was changed."""

    version: Annotated[int | None, "Its number; null, with its problems, if nothing was changed."]


@dataclass(frozen=True, kw_only=True)
class AppliedDraft(KeptDraft):
    """The version, put to work: when each cell takes it."""

    cells: Annotated[dict[str, str], "By cell when it takes it: now, or when which task has ended."]
    cancelled: Annotated[list[str], "The ids of tasks that waited and that it does not offer."]
    restart: Annotated[list[str], "Why the plant that runs goes on as it is; the next start has it."]


@dataclass(frozen=True, kw_only=True)
class TreesText:
    """File of trees of the draft."""

    file: str
    text: str


@dataclass(frozen=True, kw_only=True)
class DraftCells:
    """Cells of the draft."""

    cells: Annotated[list[dict[str, Any]], "Name, devices, targets, carriers, recipes."]
    faults: Annotated[list[dict[str, str]], "The kinds that can befall it: name, title, about."]
    problems: Annotated[list[str], "Where there are some, the cells are those of before."]


@dataclass(frozen=True, kw_only=True)
class RunState:
    """State of what is tried or proved."""

    state: Annotated[str, "idle, running, done, failed or stopped."]
    sentence: str | None = None
    doing: str | None = None
    done: int | None = None
    total: int | None = None


@dataclass(frozen=True, kw_only=True)
class Objection:
    """Problem of the draft with a device that a form has."""

    place: Annotated[str, "In the plant file, as `kinds.lamp.verbs.shine`; empty where it names none."]
    sentence: str


@dataclass(frozen=True, kw_only=True)
class DriverRow:
    """Driver that a device of a declared kind can have."""

    name: str
    about: str
    why_not: Annotated[str, "Empty where it can be used here."]
    keys: Annotated[list[dict[str, Any]], "Name, form, choices, required, default, about."]
