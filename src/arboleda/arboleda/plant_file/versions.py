"""Versions of a plant: the files that were put to work, and when, in a folder beside the plant file."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from hashlib import blake2b
from pathlib import Path
from typing import Any

from arboleda.host.files import sync_folder
from arboleda.model.errors import ConfigError, StartError
from arboleda.model.plant_files import PlantFiles

from .draft import root_of
from .recipe_forms import XML

FOLDER, FACTS, CONTENTS = ".arboleda", "version.json", "files"
MARK = "bringing_back"  # a file with the number of the version whose files are being written
FORMAT = 1
DIGITS = 4  # of the name of a version's folder


@dataclass(frozen=True, kw_only=True)
class Version:
    """Version: plant file and trees as they were, and a digest of each other file that was used.

    `at` is the time in UTC (ISO 8601), `by` the person. `changes` has a line for each change against the
    version before.
    """

    number: int
    at: str
    by: str = ""
    note: str = ""
    changes: tuple[str, ...] = ()
    files: PlantFiles
    others: Mapping[str, str]

    @property
    def digest(self) -> str:
        """One hash of all files of the version; equal hashes are equal plants."""
        return _digest_of(self.files.plant, {**_digests(self.files.contents), **self.others})


def version_of(files: PlantFiles, *, at: str, number: int = 0, by: str = "", note: str = "") -> Version:
    """A version of a plant's files that no folder has yet."""
    editable = {name: each for name, each in files.contents.items() if is_editable(files, name)}
    others = {name: each for name, each in files.contents.items() if name not in editable}
    editable_files = replace(files, contents=editable)
    return Version(number=number, at=at, by=by, note=note, files=editable_files, others=_digests(others))


def is_editable(files: PlantFiles, name: str) -> bool:
    """True for the plant file and for trees, which a version can bring back."""
    return name == files.plant or name.endswith(XML)


def whole(version: Version) -> PlantFiles:
    """The files of a version for a comparison; of a file without content, the digest stands for it."""
    digests = {name: each.encode() for name, each in version.others.items()}
    return replace(version.files, contents={**digests, **version.files.contents})


class Versions:
    """Versions of one plant file, oldest first, in a folder `.arboleda` beside it."""

    def __init__(self, plant_file: Path) -> None:
        self._plant_file = plant_file
        self._folder = plant_file.parent / FOLDER / plant_file.name

    def all(self) -> list[Version]:
        """Every version that is there; StartError where one cannot be read."""
        try:
            names = sorted(os.listdir(self._folder)) if self._folder.is_dir() else []
        except OSError as error:
            raise StartError(f"{self._folder} cannot be read: {error.strerror}") from error
        return [read(self._folder / name) for name in names if name.isdigit()]

    def last(self) -> Version | None:
        """The last version; None if there is none."""
        return next(iter(reversed(self.all())), None)

    def find(self, number: int) -> Version:
        """A version by its number; ConfigError if there is none."""
        versions = self.all()
        version = next((each for each in versions if each.number == number), None)
        if version is None:
            numbers = ", ".join(str(each.number) for each in versions) or "none"
            raise ConfigError((f"there is no version {number} of {self._plant_file}; kept: {numbers}",))
        return version

    def keep(self, version: Version) -> Version:
        """Keep a version under the next number; StartError, and nothing is kept, if the disk refuses."""
        last = self.last()
        numbered = replace(version, number=1 if last is None else last.number + 1)
        write(self._folder / str(numbered.number).zfill(DIGITS), numbered)
        for each in (self._folder.parent, self._plant_file.parent):  # which the first version may make
            sync_folder(each)
        return numbered

    def bring_back(self, version: Version) -> None:
        """Write plant file and trees of a version to where they were, all or none; StartError if that fails.

        Where a crash cuts this off, `go_on` completes it at the next start.
        """
        mark = self._folder / MARK
        if len(version.files.contents) > 1:
            _replace(mark, str(version.number).encode())
        written: dict[Path, bytes | None] = {}
        try:
            for name, content in version.files.contents.items():
                file = self._path(version, name)
                before = _content(file)
                _replace(file, content)
                written[file] = before
        except StartError:
            _put_back(written)
            self._unmark()
            raise
        self._unmark()

    def _unmark(self) -> None:
        """Remove the mark for good: a mark that came back by a power cut would undo later edits of people."""
        mark = self._folder / MARK
        if mark.exists():
            mark.unlink(missing_ok=True)
            sync_folder(self._folder)

    def forget(self, version: Version) -> None:
        """Delete a version that never was at work; a kill leaves all of it or nothing."""
        folder = self._folder / str(version.number).zfill(DIGITS)
        gone = _aside(folder)
        with suppress(OSError):
            folder.rename(gone)
        shutil.rmtree(gone, ignore_errors=True)

    def go_on(self) -> Version | None:
        """Bring back the version whose `bring_back` was cut off, and return it; None if none was cut off."""
        try:
            number = int((self._folder / MARK).read_text("ascii"))
        except (OSError, ValueError):  # no mark, or a folder of an impossible name
            return None
        version = self.find(number)
        self.bring_back(version)
        return version

    def is_in_place(self, version: Version) -> bool:
        """True where plant file and trees are those of this version."""
        rows = version.files.contents.items()
        return all(_digest_now(self._path(version, name)) == _digest(each) for name, each in rows)

    def others_now(self, version: Version) -> tuple[str, ...]:
        """The other files that are gone or different from those of the version; they do not come back."""
        return tuple(
            name
            for name, digest in version.others.items()
            if _digest_now(self._path(version, name)) != digest
        )

    def _path(self, version: Version, name: str) -> Path:
        is_plant = name == version.files.plant
        return self._plant_file if is_plant else root_of(version.files, self._plant_file) / name


def read(folder: Path) -> Version:
    """The version in a folder; StartError if it is not as `write` made it."""
    try:
        facts: dict[str, Any] = json.loads((folder / FACTS).read_text("utf-8"))
        contents = {name: (folder / CONTENTS / _inside(name)).read_bytes() for name in facts["files"]}
        return Version(
            number=int(facts["number"]),
            at=str(facts["at"]),
            by=str(facts["by"]),
            note=str(facts["note"]),
            changes=tuple(map(str, facts["changes"])),
            files=PlantFiles(plant=_inside(facts["plant"]), contents=contents),
            others={str(name): str(each) for name, each in facts["others"].items()},
        )
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise StartError(f"{folder} is no version of a plant: {error}; delete it") from error


def write(folder: Path, version: Version, *, syncs: bool = True) -> None:
    """Write a version into a new folder, whole or not at all; StartError if the disk refuses.

    Without `syncs` a power cut may take it.
    """
    fresh = _aside(folder)
    facts = {
        "format": FORMAT,
        "number": version.number,
        "at": version.at,
        "by": version.by,
        "note": version.note,
        "changes": version.changes,
        "plant": version.files.plant,
        "files": [*version.files.contents],
        "others": dict(version.others),
    }
    try:
        shutil.rmtree(fresh, ignore_errors=True)
        for name, content in version.files.contents.items():
            _write(fresh / CONTENTS / _inside(name), content, syncs=syncs)
        _write(fresh / FACTS, json.dumps(facts, indent=2, ensure_ascii=False).encode(), syncs=syncs)
        _put_in_place(fresh, folder, syncs=syncs)
    except OSError as error:
        shutil.rmtree(fresh, ignore_errors=True)
        raise StartError(f"{folder} cannot be written: {error.strerror or error}") from error


def write_files(folder: Path, contents: Mapping[str, bytes]) -> None:
    """Write files into a new folder, whole or not at all; StartError if the disk refuses."""
    fresh = _aside(folder)
    try:
        shutil.rmtree(fresh, ignore_errors=True)
        for name, content in contents.items():
            _write(fresh / _inside(name), content)
        _put_in_place(fresh, folder)
    except OSError as error:
        shutil.rmtree(fresh, ignore_errors=True)
        raise StartError(f"{folder} cannot be written: {error.strerror or error}") from error


def _put_in_place(fresh: Path, folder: Path, *, syncs: bool = True) -> None:
    """Give a folder that is written its name."""
    if syncs:
        for each in (fresh, *filter(Path.is_dir, fresh.rglob("*"))):
            sync_folder(each)
    fresh.rename(folder)
    if syncs:
        sync_folder(folder.parent)


def _aside(path: Path) -> Path:
    """The path of a file or folder while it is being written, or of a folder while it is being deleted."""
    return path.with_name(f".{path.name}.{os.getpid()}")


def _write(file: Path, content: bytes, *, syncs: bool = True) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("wb") as opened:
        opened.write(content)
        opened.flush()
        if syncs:
            os.fsync(opened.fileno())


def _replace(file: Path, content: bytes) -> None:
    """Put another content into a file, whole; its mode stays."""
    fresh = _aside(file)
    try:
        _write(fresh, content)
        if file.exists():
            shutil.copymode(file, fresh)
        fresh.replace(file)
        sync_folder(file.parent)
    except OSError as error:
        fresh.unlink(missing_ok=True)
        raise StartError(f"{file} cannot be written: {error.strerror or error}") from error


def _content(file: Path) -> bytes | None:
    """The content of a file; None where there is none."""
    try:
        return file.read_bytes()
    except OSError:
        return None


def _put_back(written: Mapping[Path, bytes | None]) -> None:
    """Give files their former contents, as far as the disk allows."""
    for file, content in written.items():
        with suppress(StartError):
            if content is None:
                file.unlink(missing_ok=True)
            else:
                _replace(file, content)


def _inside(name: str) -> str:
    """The name of a file within a folder; ValueError for one that leads out of it."""
    path = Path(name)
    if path.is_absolute() or os.pardir in path.parts or not path.parts:
        raise ValueError(f"{name!r} is in no folder of it")
    return name


def _digest_now(file: Path) -> str | None:
    content = _content(file)
    return None if content is None else _digest(content)


def _digest(content: bytes) -> str:
    return blake2b(content, digest_size=16).hexdigest()


def _digests(contents: Mapping[str, bytes]) -> dict[str, str]:
    return {name: _digest(each) for name, each in contents.items()}


def _digest_of(plant: str, digests: Mapping[str, str]) -> str:
    digest = blake2b(plant.encode(), digest_size=16)
    for name, each in sorted(digests.items()):
        digest.update(f"\n{name} {each}".encode())
    return digest.hexdigest()
