"""The draft of a plant that is open: made of its files, or taken from an earlier start."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from arboleda.extension import ArboledaError
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file.draft import root_of
from arboleda.plant_file.versions import Version
from arboleda.runtime import at_work

from .api import DraftRefused
from .draft import Draft, draft_of
from .file import DraftFile
from .plant_folder import PlantFolder

UNKNOWN = "this plant does not keep what it was started with (record: off), so there is nothing to draft from"
MOVED = "{files}: changed by hand since this draft was begun; discard the draft, or bring the file back"
NOTHING = "the draft changes nothing"


class OpenDraft:
    """Draft beside the files that it changes; the caller holds a lock."""

    def __init__(self, folder: PlantFolder, state: Path) -> None:
        self._folder = folder
        self._state = state
        self._file = DraftFile(state)
        self._draft: Draft | None = None

    @property
    def set_aside(self) -> list[str]:
        """The files of drafts that could not be read."""
        return list(self._file.lost)

    @property
    def started(self) -> Version:
        """The version that the plant was started with."""
        found = at_work.version(self._state)
        if found is None:
            raise DraftRefused(UNKNOWN)
        return found

    @property
    def on_disk(self) -> PlantFiles:
        """Plant file and trees as they are now."""
        files, plant_file = self.started.files, self._folder.file
        if plant_file is None:
            return files
        root = root_of(files, plant_file)
        try:
            contents = {
                name: (plant_file if name == files.plant else root / name).read_bytes()
                for name in files.contents
            }
        except OSError as error:
            raise ArboledaError(f"{error.filename} cannot be read: {error.strerror}") from error
        return replace(files, contents=contents)

    def read(self) -> Draft:
        """The draft that there is, in this process or from an earlier start; else a new one of the files, as
        they are now. What changes nothing is begun anew once the files were changed elsewhere.
        """
        if self._draft is None:
            self._draft = self._saved() or draft_of(self.on_disk)
        if self._draft.files == self._draft.base and self._draft.base != (now := self.on_disk):
            self.close()
            self._draft = draft_of(now)
        return self._draft

    def is_still(self, draft: Draft) -> bool:
        """True while nobody has made a step since this was the draft."""
        return self._draft is draft

    def write(self, draft: Draft) -> None:
        """Take another step as the draft, and keep it for the next start."""
        self._file.write(draft)
        self._draft = draft

    def close(self) -> None:
        """Forget the draft."""
        self._file.remove()
        self._draft = None

    def must_fit(self, draft: Draft) -> None:
        """Raise DraftRefused where there is nothing to keep, or what somebody else wrote would be lost."""
        if not draft.changes:
            raise DraftRefused(NOTHING)
        now = self.on_disk.contents
        if moved := [name for name, each in draft.base.contents.items() if now.get(name) != each]:
            raise DraftRefused(MOVED.format(files=", ".join(moved)))

    def _saved(self) -> Draft | None:
        """The draft of an earlier start; None where the plant's files have become all that it was to change:
        that start ended before it could forget the draft.
        """
        saved = self._file.read()
        if saved is not None and _is_in(saved, self.on_disk):
            self._file.remove()
            return None
        return saved


def _is_in(draft: Draft, files: PlantFiles) -> bool:
    """True where each file that a draft knows is as the draft has it; one that it removes is gone."""
    names = {*draft.base.contents, *draft.files.contents}
    return all(files.contents.get(name) == draft.files.contents.get(name) for name in names)
