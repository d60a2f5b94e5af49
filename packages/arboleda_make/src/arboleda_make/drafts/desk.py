"""DraftApi of the plant in this process: its draft, kept in its state directory, and the one who edits it."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime, timezone
from pathlib import Path
from typing import Any, Protocol

from arboleda.drivers import plain, quoted
from arboleda.extension import StartError
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file.draft import DraftCheck
from arboleda.plant_file.recipe_forms import XML
from arboleda.plant_file.versions import Version, Versions, version_of
from arboleda.plant_file.yaml_edit import EditRefused
from arboleda.plant_file.yaml_marks import parse
from arboleda_make.drafts.api import DraftApi, DraftRefused, Place, State
from arboleda_make.drafts.draft import Draft
from arboleda_make.versions.changes import changes
from arboleda_make.versions.restart import needing_restart

from .open_draft import OpenDraft
from .plant_folder import NOT_OURS, PlantFolder

LOG = logging.getLogger("arboleda.operators")
NOBODY = "nobody edits this draft; begin to edit it first"
OTHER = "{name} edits this draft since {since}; take it over to edit it"
KNOWN = "{file} is there already; choose another name"
NO_PLANT = "no plant runs in this process that could take it"
NO_TREES = "{file} is no file of trees of this plant"
OURS = "these files are your own already, and can be changed"
MEANWHILE = "the draft was changed while it was checked; try again"
SINCE = "the draft has changed since its check, and nothing was set; check it again"
WorkBy = Callable[[Version, DraftCheck, str], State]


class Checker(Protocol):
    """Process that checks files as if they were in a folder, until `stop`."""

    def check(self, files: PlantFiles, plant_file: Path) -> DraftCheck: ...
    def stop(self) -> None: ...


@dataclass(frozen=True, kw_only=True)
class Editor:
    """Editor of a draft: the id of a page or tool, the name that others see, and since when, in UTC."""

    id: str
    name: str
    since: str


class DraftDesk(DraftApi):
    """DraftDesk: one draft and one editor, for threads of a server; `process` checks drafts.

    `work_by` puts a version to work whose files are in their place; whoever writes these holds `writing`.
    """

    def __init__(
        self,
        folder: PlantFolder,
        state: Path,
        process: Checker,
        work_by: WorkBy | None = None,
        writing: threading.Lock | None = None,
    ) -> None:
        self._folder = folder
        self._process = process
        self._work_by = work_by
        self._writing = writing or threading.Lock()
        self._turns = threading.Lock()
        self._editor: Editor | None = None
        self._open = OpenDraft(folder, state)

    def start(self) -> None:
        """Nothing: a draft is opened when somebody looks at it."""

    def stop(self) -> None:
        """End a check that is under way; the draft stays for the next start. Idempotent."""
        self._process.stop()

    def state(self) -> State:
        with self._turns:
            return self._shown()

    def take(self, editor: str, name: str) -> State:
        with self._turns:
            self._open.read()
            before, self._editor = self._editor, Editor(id=editor, name=name, since=_now())
            if before is not None and before.id != editor:
                LOG.info("the draft is taken over by %s from %s", plain(name), plain(before.name))
            return self._shown()

    def set(self, editor: str, place: Place, value: Any, of: str | None = None) -> State:
        def step(draft: Draft) -> Draft:
            if of is not None and of != _digest(draft):
                raise EditRefused(SINCE)
            return draft.with_value(tuple(place), value)

        return self._step(editor, step)

    def rewrite(self, editor: str, change: Callable[[Any], Any]) -> State:
        """Have the plant file have the values that `change` makes of its values, in one step."""
        return self._step(editor, lambda draft: draft.rewritten(change))

    def remove(self, editor: str, place: Place) -> State:
        return self._step(editor, lambda draft: draft.without(tuple(place)))

    def undo(self, editor: str) -> State:
        return self._step(editor, Draft.undo)

    def redo(self, editor: str) -> State:
        return self._step(editor, Draft.redo)

    def discard(self, editor: str) -> State:
        with self._turns:
            self._must_edit(editor)
            self._open.close()
            return self._shown()

    def check(self) -> State:
        with self._turns:
            draft = self._open.read()
        found = self._process.check(draft.files, self._folder.ours)
        offers = [each.plain for each in found.unstated]
        answer = {"problems": found.problems, "warnings": found.warnings, "offers": offers}
        return answer | {"digest": _digest(draft)}

    def keep(self, editor: str, note: str) -> State:
        found, version = self._checked_and_kept(editor, note)
        number = None if version is None else version.number
        return {"version": number, "problems": found.problems, "warnings": found.warnings}

    def apply(self, editor: str, note: str) -> State:
        if self._work_by is None:
            raise DraftRefused(NO_PLANT)
        found, version = self._checked_and_kept(editor, note)
        if version is None:
            answer: State = {"version": None, "cells": {}, "cancelled": (), "restart": ()}
            return answer | {"problems": found.problems, "warnings": found.warnings}
        return self._work_by(version, found, version.by)

    def trees(self, file: str) -> State:
        with self._turns:
            contents = self._open.read().files.contents
        if file not in contents or not file.endswith(XML):
            raise DraftRefused(NO_TREES.format(file=quoted(file)))
        return {"file": file, "text": contents[file].decode("utf-8", "replace")}

    def set_trees(self, editor: str, file: str, text: str) -> State:
        def step(draft: Draft) -> Draft:
            return draft.with_recipe(self._folder.tree_name(draft, file), text.encode("utf-8", "replace"))

        return self._step(editor, step)

    def add_trees(self, editor: str, file: str, text: str) -> State:
        """The same as `set_trees` for a file that the draft does not have; DraftRefused if it has it."""

        def step(draft: Draft) -> Draft:
            name = self._folder.tree_name(draft, file)
            if name in draft.files.contents:
                raise EditRefused(KNOWN.format(file=quoted(file)))
            return draft.with_recipe(name, text.encode())

        return self._step(editor, step)

    @property
    def files(self) -> tuple[PlantFiles, PlantFiles]:
        """The files that the draft began with, and those of the draft."""
        with self._turns:
            draft = self._open.read()
        return draft.base, draft.files

    def remove_trees(self, editor: str, file: str) -> State:
        return self._step(editor, lambda draft: draft.without_recipe(file))

    def own(self, editor: str) -> State:
        with self._turns:
            self._must_edit(editor, owns=False)
            if self._folder.is_ours:
                raise DraftRefused(OURS)
            file = self._folder.own(self._open.started)
            LOG.info("the plant's files are copied to %s", plain(str(file.parent)))
            self._open.close()
            return self._shown()

    def _checked_and_kept(self, editor: str, note: str) -> tuple[DraftCheck, Version | None]:
        """The verdict on the draft, and the version that it is now; None where there are problems."""
        with self._turns:
            self._must_edit(editor)
            draft = self._open.read()
            self._open.must_fit(draft)
        found = self._process.check(draft.files, self._folder.ours)
        if found.problems:
            return found, None
        with self._turns, self._writing:
            self._must_edit(editor)
            if not self._open.is_still(draft):
                raise DraftRefused(MEANWHILE)
            self._open.must_fit(draft)
            version = self._kept(draft, found.read, note)
            self._open.close()
        LOG.info("version %d of the plant is kept, by %s", version.number, plain(version.by))
        return found, version

    def _step(self, editor: str, step: Callable[[Draft], Draft]) -> State:
        with self._turns:
            self._must_edit(editor)
            try:
                draft = step(self._open.read())
            except EditRefused as error:
                raise DraftRefused(error.sentence) from error
            self._open.write(draft)
            return self._shown()

    def _must_edit(self, editor: str, *, owns: bool = True) -> None:
        if self._editor is None:
            raise DraftRefused(NOBODY)
        if self._editor.id != editor:
            raise DraftRefused(OTHER.format(name=plain(self._editor.name), since=_hour(self._editor.since)))
        if owns and not self._folder.is_ours:
            raise DraftRefused(NOT_OURS)

    def _kept(self, draft: Draft, read: PlantFiles | None, note: str) -> Version:
        """The version that the files are now; before it, if none has that, what was at work."""
        by = self._editor.name if self._editor else ""
        kept, started = Versions(self._folder.ours), self._open.started
        if kept.last() is None:
            kept.keep(replace(started, note="as the plant was started"))
        fresh = version_of(read or draft.files, at=_now(), by=by, note=note)
        if read is None:
            fresh = replace(fresh, others=started.others)
        version = kept.keep(replace(fresh, changes=tuple(each.words for each in draft.changes)))
        try:
            kept.bring_back(replace(version, files=draft.files))
        except StartError:
            kept.forget(version)
            raise
        return version

    def _shown(self) -> State:
        draft, editor = self._open.read(), self._editor
        root, _ = parse(draft.files.contents[draft.files.plant])
        contents = draft.files.contents
        return {
            "file": draft.files.plant.rpartition("/")[2],
            "digest": _digest(draft),
            "editor": None if editor is None else {"name": editor.name, "since": editor.since},
            "changes": [each.words for each in draft.changes],
            "waiting": [each.words for each in changes(self._open.started.files, self._open.on_disk)],
            "undo": len(draft.past),
            "redo": len(draft.future),
            "values": root.value,
            "trees": sorted(name for name in contents if name.endswith(XML)),
            "restart": needing_restart(draft.changes),
            "is_ours": self._folder.is_ours,
            "set_aside": self._open.set_aside,
        }


def _digest(draft: Draft) -> str:
    """The digest of the files of a draft, which another step makes another."""
    return version_of(draft.files, at="").digest


def _now() -> str:
    return datetime.now(timezone.utc).isoformat(timespec="seconds")


def _hour(at: str) -> str:
    """Hour and minute of such a time, in this machine's time zone."""
    return datetime.fromisoformat(at).astimezone().strftime("%H:%M")
