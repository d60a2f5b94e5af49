"""File of a draft in a plant's state directory: the files that it began with, and what they are to become.

Each step replaces the file as a whole, so that neither a kill nor a power cut leaves half of a draft.
"""

from __future__ import annotations

import json
import logging
import shutil
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from arboleda.drivers import plain
from arboleda.extension import ArboledaError, StartError
from arboleda.host.files import sync_folder
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file import versions
from arboleda.runtime.state import replace_file
from arboleda_make.drafts.draft import Draft, draft_of
from arboleda_make.drafts.process import from_texts, texts

LOG = logging.getLogger("arboleda.operators")
FILE, DAMAGED = "draft.json", ".damaged"
FOLDER, OPENED, MEANT = "draft", "opened", "meant"  # where drafts were before they had a file
LOST = "{file} was no whole draft; it is {aside} now, and the draft begins anew with the plant's files"


class DraftFile:
    """DraftFile: the draft of one plant, which outlives its process. `lost` says what could not be read."""

    def __init__(self, state: Path) -> None:
        self._file, self._folder = state / FILE, state / FOLDER
        self.lost: tuple[str, ...] = ()

    def read(self) -> Draft | None:
        """The draft of an earlier start; None if there is none that is whole: what is not is set aside."""
        self._move_folder()
        try:
            data = json.loads(self._file.read_bytes())
            return replace(draft_of(_files(data[OPENED])), files=_files(data[MEANT]))
        except FileNotFoundError:
            return None
        except OSError as error:
            raise ArboledaError(f"{self._file} cannot be read: {error.strerror or error}") from error
        except (ValueError, KeyError, TypeError, AttributeError):
            self._set_aside(self._file)
            return None

    def write(self, draft: Draft) -> None:
        """Keep a draft; StartError, and the one before is still there, if the disk refuses."""
        try:
            replace_file(self._file, json.dumps({OPENED: _data(draft.base), MEANT: _data(draft.files)}))
        except OSError as error:
            raise StartError(f"{self._file} cannot be written: {error.strerror or error}") from error

    def remove(self) -> None:
        """Forget the draft, and what was lost of an earlier one. Idempotent."""
        self.lost = ()
        try:
            self._file.unlink(missing_ok=True)
            sync_folder(self._file.parent)
        except OSError as error:
            raise StartError(f"{self._file} cannot be deleted: {error.strerror or error}") from error

    def _move_folder(self) -> None:
        """Move a draft from the folder of before into the file."""
        if not self._folder.is_dir():
            return
        if not self._file.exists():
            try:
                draft = _in_folder(self._folder)
            except StartError:
                self._set_aside(self._folder)
                return
            self.write(draft)
        shutil.rmtree(self._folder, ignore_errors=True)

    def _set_aside(self, path: Path) -> None:
        aside = path.with_name(path.name + DAMAGED)
        shutil.rmtree(aside, ignore_errors=True)
        try:
            path.replace(aside)
        except OSError as error:
            raise ArboledaError(f"{path} cannot be moved: {error.strerror or error}") from error
        self.lost = (LOST.format(file=plain(str(path)), aside=plain(str(aside))),)
        LOG.warning("%s", self.lost[0])


def _in_folder(folder: Path) -> Draft:
    """The draft in a folder; StartError if its files are not whole."""
    base = versions.read(folder / OPENED).files
    meant = folder / MEANT
    return replace(draft_of(base), files=versions.read(meant).files if meant.is_dir() else base)


def _data(files: PlantFiles) -> dict[str, Any]:
    return {"plant": files.plant, "contents": texts(files.contents)}


def _files(data: Mapping[str, Any]) -> PlantFiles:
    """The files of plain data; ValueError, KeyError, TypeError or AttributeError if the data is not whole."""
    found = PlantFiles(plant=data["plant"], contents=from_texts(data["contents"]))
    if found.plant not in found.contents:
        raise ValueError(found.plant)
    return found
