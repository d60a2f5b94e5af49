"""Folder of a plant's files: the one that was given, or a copy of one's own where nobody can change that."""

from __future__ import annotations

import os
from pathlib import Path, PurePosixPath

from arboleda.drivers import quoted
from arboleda.extension import StartError
from arboleda.plant_file.draft import root_of
from arboleda.plant_file.versions import Version, Versions, write_files
from arboleda.plant_file.yaml_edit import EditRefused
from arboleda_make.drafts.api import DraftRefused
from arboleda_make.drafts.draft import Draft, check_name

OWN = "files"  # in the state directory
NOT_OURS = "these files cannot be changed where they are; make them your own first"
THERE = "there is a plant of your own already: start the plant with --plant {file}"
TREES_THERE = (
    "{file} is there already, in the plant's folder, and the plant does not use it; choose another name"
)
YOURS = "this plant was made yours: `arboleda up --plant {file}` starts that one"


class PlantFolder:
    """Folder with the plant file `file`; None for the plant that comes with Arboleda, until it is copied."""

    def __init__(self, file: Path | None, state: Path) -> None:
        self.file = file
        self._own = state / OWN

    @property
    def is_ours(self) -> bool:
        """True where its files can be changed."""
        return self.file is not None and all(
            os.access(each, os.W_OK) for each in (self.file, self.file.parent)
        )

    @property
    def ours(self) -> Path:
        """Its plant file, to be changed; DraftRefused where that cannot be."""
        if self.file is None or not self.is_ours:
            raise DraftRefused(NOT_OURS)
        return self.file

    @property
    def versions(self) -> Versions | None:
        """The versions beside it; None where there can be none."""
        return None if self.file is None else Versions(self.file)

    @property
    def note(self) -> str:
        """The line for who starts a plant of which there is a copy of his own; "" where there is none."""
        copies = [] if self.is_ours or not self._own.is_dir() else sorted(self._own.glob("**/*.yaml"))
        return YOURS.format(file=copies[0]) if copies else ""

    def tree_name(self, draft: Draft, file: str) -> str:
        """The path of a file of trees in a draft, of one that it has or of a new one beside the plant file;
        DraftRefused where a file of another use lies there."""
        if file in draft.files.contents:
            return file
        try:
            check_name(file)  # before anybody learns whether there is such a file
        except EditRefused as error:
            raise DraftRefused(error.sentence) from error
        name = str(PurePosixPath(draft.files.plant).parent / file)
        known = draft.files.contents.keys() | draft.base.contents.keys()
        if name not in known and (root_of(draft.files, self.ours) / name).exists():
            raise DraftRefused(TREES_THERE.format(file=quoted(file)))
        return name

    def own(self, at_work: Version) -> Path:
        """Copy all of its files and go on there; DraftRefused or StartError, and nothing is copied, if that
        cannot be."""
        if self._own.exists():
            raise DraftRefused(THERE.format(file=self._own / at_work.files.plant))
        try:
            others = self._others(at_work)
        except OSError as error:
            raise StartError(f"{error.filename} cannot be read: {error.strerror or error}") from error
        write_files(self._own, {**at_work.files.contents, **others})
        self.file = self._own / at_work.files.plant
        return self.file

    def _others(self, at_work: Version) -> dict[str, bytes]:
        """The files that are not kept with what is at work, such as Python."""
        if self.file is None:
            return {}
        root = root_of(at_work.files, self.file)
        return {name: (root / name).read_bytes() for name in at_work.others}
