"""DraftApi of the plant in this process: its draft, kept in its state directory, and the one who edits it."""

from __future__ import annotations

import logging
import shutil
import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from arboleda.model.errors import ArboledaError
from arboleda.model.outside import plain
from arboleda.plant_file import versions
from arboleda.plant_file.changes import changes
from arboleda.plant_file.draft import Draft, draft_of
from arboleda.plant_file.draft_check import Checked, root_of
from arboleda.plant_file.draft_process import CheckProcess
from arboleda.plant_file.versions import Version, Versions, version_of
from arboleda.plant_file.yaml_edit import EditRefused
from arboleda.plant_file.yaml_marks import parse
from arboleda.recorder.preamble import PlantFiles
from arboleda.web.draft_api import DraftApi, DraftRefused, Place, State

from . import at_work

LOG = logging.getLogger("arboleda.operators")
FOLDER, OPENED, MEANT = "draft", "opened", "meant"
UNKNOWN = "this plant does not keep what it was started with (record: off), so there is nothing to draft from"
NOBODY = "nobody edits this draft; begin to edit it first"
OTHER = "{name} edits this draft since {since}; take it over to edit it"
MOVED = "{files}: changed by hand since this draft was begun; discard the draft, or bring the file back"
NOTHING = "the draft changes nothing"
MEANWHILE = "the draft was changed while it was checked; try again"
Check = Callable[[PlantFiles, Path], Checked]


@dataclass(frozen=True, kw_only=True)
class Editor:
    """Editor of a draft: the id of a page or tool, the name that others see, and since when, in UTC."""

    id: str
    name: str
    since: str


class DraftDesk(DraftApi):
    """DraftDesk: one draft and one editor, for threads of a server; `check` stands in for the process of its
    own in which drafts are checked."""

    def __init__(self, plant_file: Path, state: Path, check: Check | None = None) -> None:
        self._plant_file = plant_file
        self._state = state
        self._process = CheckProcess()
        self._check = check or self._process.check
        self._turns = threading.Lock()
        self._editor: Editor | None = None
        self._draft: Draft | None = None

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
            self._opened()
            before, self._editor = self._editor, Editor(id=editor, name=name, since=_now())
            if before is not None and before.id != editor:
                LOG.info("the draft is taken over by %s from %s", plain(name), plain(before.name))
            return self._shown()

    def set(self, editor: str, place: Place, value: Any) -> State:
        return self._step(editor, lambda draft: draft.with_value(tuple(place), value))

    def remove(self, editor: str, place: Place) -> State:
        return self._step(editor, lambda draft: draft.without(tuple(place)))

    def undo(self, editor: str) -> State:
        return self._step(editor, Draft.undo)

    def redo(self, editor: str) -> State:
        return self._step(editor, Draft.redo)

    def discard(self, editor: str) -> State:
        with self._turns:
            self._must_edit(editor)
            self._close()
            return self._shown()

    def check(self) -> State:
        with self._turns:
            files = self._opened().files
        found = self._check(files, self._plant_file)
        return {"problems": found.problems, "warnings": found.warnings}

    def keep(self, editor: str, note: str) -> State:
        with self._turns:
            self._must_edit(editor)
            draft = self._opened()
            self._must_fit(draft)
        found = self._check(draft.files, self._plant_file)
        if found.problems:
            return {"version": None, "problems": found.problems, "warnings": found.warnings}
        with self._turns:
            self._must_edit(editor)
            if self._draft is not draft:
                raise DraftRefused(MEANWHILE)
            self._must_fit(draft)
            version = self._kept(draft, found.read, note)
            self._close()
        LOG.info("version %d of the plant is kept, by %s", version.number, plain(version.by))
        return {"version": version.number, "problems": (), "warnings": found.warnings}

    def _step(self, editor: str, step: Callable[[Draft], Draft]) -> State:
        with self._turns:
            self._must_edit(editor)
            try:
                self._draft = step(self._opened())
            except EditRefused as error:
                raise DraftRefused(error.sentence) from error
            self._save(MEANT, self._draft.files)
            return self._shown()

    def _must_edit(self, editor: str) -> None:
        if self._editor is None:
            raise DraftRefused(NOBODY)
        if self._editor.id != editor:
            raise DraftRefused(OTHER.format(name=plain(self._editor.name), since=self._editor.since))

    def _must_fit(self, draft: Draft) -> None:
        """Raise DraftRefused where there is nothing to keep, or what somebody else wrote would be lost."""
        if not draft.changes:
            raise DraftRefused(NOTHING)
        now = self._on_disk().contents
        if moved := [name for name, each in draft.base.contents.items() if now.get(name) != each]:
            raise DraftRefused(MOVED.format(files=", ".join(moved)))

    def _kept(self, draft: Draft, read: PlantFiles | None, note: str) -> Version:
        """The version that the files are now; before it, if none has that, what was at work."""
        by = self._editor.name if self._editor else ""
        kept, started = Versions(self._plant_file), self._started()
        if kept.last() is None:
            kept.keep(replace(started, note="as the plant was started"))
        fresh = version_of(read or draft.files, at=_now(), by=by, note=note)
        if read is None:
            fresh = replace(fresh, others=started.others)
        version = kept.keep(replace(fresh, changes=tuple(each.words for each in draft.changes)))
        kept.bring_back(replace(version, files=draft.files))
        return version

    def _shown(self) -> State:
        draft, editor = self._opened(), self._editor
        root, _ = parse(draft.files.contents[draft.files.plant])
        return {
            "file": self._plant_file.name,
            "editor": None if editor is None else {"name": editor.name, "since": editor.since},
            "changes": [each.words for each in draft.changes],
            "waiting": [each.words for each in changes(self._started().files, self._on_disk())],
            "undo": len(draft.past),
            "redo": len(draft.future),
            "values": root.value,
        }

    def _opened(self) -> Draft:
        """The draft that there is, in this process or from an earlier start; else a new one of the files."""
        if self._draft is None:
            base = self._saved(OPENED) or self._on_disk()
            self._draft = replace(draft_of(base), files=self._saved(MEANT) or base)
        return self._draft

    def _close(self) -> None:
        self._draft = None
        shutil.rmtree(self._state / FOLDER, ignore_errors=True)

    def _save(self, part: str, files: PlantFiles) -> None:
        folder = self._state / FOLDER
        if part == MEANT and not (folder / OPENED).is_dir() and self._draft is not None:
            self._save(OPENED, self._draft.base)
        shutil.rmtree(folder / part, ignore_errors=True)
        versions.write(folder / part, version_of(files, at=_now()), syncs=False)

    def _saved(self, part: str) -> PlantFiles | None:
        folder = self._state / FOLDER / part
        return versions.read(folder).files if folder.is_dir() else None

    def _started(self) -> Version:
        found = at_work.known(self._state)
        if found is None:
            raise DraftRefused(UNKNOWN)
        return found

    def _on_disk(self) -> PlantFiles:
        """Plant file and trees as they are now."""
        files = self._started().files
        root = root_of(files, self._plant_file)
        try:
            contents = {
                name: (self._plant_file if name == files.plant else root / name).read_bytes()
                for name in files.contents
            }
        except OSError as error:
            raise ArboledaError(f"{error.filename} cannot be read: {error.strerror}") from error
        return replace(files, contents=contents)


def _now() -> str:
    return datetime.now(timezone.utc).isoformat(timespec="seconds")
