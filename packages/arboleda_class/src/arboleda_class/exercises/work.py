"""Works of students: folders and zips, each with a `work.yaml` that says whose it is, of which exercise."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from arboleda.drivers import plain
from arboleda.extension import ConfigError
from arboleda.plant_file.yaml_marks import YamlFault, plain_value

from .exercise import Exercise, catalog

SHEET = "work.yaml"
ZIP = ".zip"
LARGEST = 256 * 1024  # bytes of a file
DEEPEST = 4  # folders below the one that is named
LONGEST = 60  # characters of a student's name
MOST = 2000  # files of a zip that are looked at


@dataclass(frozen=True, kw_only=True)
class Work:
    """Work of a student: `files` are theirs by name; `trouble`: why it cannot be judged, else empty."""

    where: Path
    exercise: str = ""
    student: str = ""
    files: Mapping[str, bytes] = field(default_factory=dict)
    trouble: str = ""


def works(places: list[Path]) -> list[Work]:
    """The works in these folders and zips, and in folders below them; ConfigError where there is none."""
    found = [work for place in places for work in _below(place, 0)]
    if not found:
        where = ", ".join(map(str, places))
        raise ConfigError((f"{where} has no work: a folder or a zip with {SHEET}",))
    return found


def sheet(exercise: Exercise) -> str:
    """The text of `work.yaml` of a work that begins."""
    return f'# Stays with the work. / Queda con el trabajo.\nexercise: {exercise.name}\nstudent: ""\n'


def zip_name(work: Work) -> str:
    """The name of the zip in which a work is handed in; ConfigError where nobody has said whose it is."""
    if not work.student:
        raise ConfigError((f"{work.where}: whose work is it? --student NAME, or in {SHEET}",))
    called = "".join(each if each.isalnum() else "_" for each in work.student)
    return f"{work.exercise}-{called}{ZIP}"


def packed(work: Work, file: Path) -> None:
    """Write a work as a zip, whole or not at all; ConfigError where it cannot be handed in."""
    if work.trouble:
        raise ConfigError((f"{work.where}: {work.trouble}",))
    sheet = yaml.safe_dump({"exercise": work.exercise, "student": work.student}, allow_unicode=True)
    half = file.with_name(f"{file.name}.half")
    with zipfile.ZipFile(half, "w", zipfile.ZIP_DEFLATED) as pack:
        for name, content in {SHEET: sheet.encode(), **work.files}.items():
            pack.writestr(f"{work.exercise}/{name}", content)
    half.replace(file)


def _below(place: Path, depth: int) -> Iterator[Work]:
    if place.is_file() and place.suffix == ZIP:
        yield from _zipped(place)
    elif place.joinpath(SHEET).is_file():
        names = [each for each in place.iterdir() if each.is_file() and not each.is_symlink()]
        yield _read(place, {each.name: _content(each) for each in names if each.stat().st_size <= LARGEST})
    elif place.is_dir() and depth < DEEPEST:
        for each in sorted(place.iterdir()):
            yield from _below(each, depth + 1)


def _content(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError:
        return b""


def _zipped(file: Path) -> Iterator[Work]:
    """The works of a zip: each folder in it that has a sheet. Nothing is unpacked to where it says."""
    try:
        with zipfile.ZipFile(file) as pack:
            folders: dict[str, dict[str, bytes]] = {}
            for each in pack.infolist()[:MOST]:
                folder, _, name = each.filename.rpartition("/")
                if name and each.file_size <= LARGEST:
                    with pack.open(each) as member:
                        folders.setdefault(folder, {})[name] = member.read(LARGEST)
    except (OSError, ValueError, RuntimeError, NotImplementedError, zipfile.BadZipFile) as error:
        yield Work(where=file, trouble=f"the zip cannot be read: {plain(str(error), LONGEST)}")
        return
    found = [held for held in folders.values() if SHEET in held]
    yield from (_read(file, held) for held in found)
    if not found:
        yield Work(where=file, trouble=f"the zip has no {SHEET}")


def _read(where: Path, held: Mapping[str, bytes]) -> Work:
    try:
        sheet: Any = plain_value(held.get(SHEET, b""))
        name, student = str(sheet["exercise"]), str(sheet.get("student") or "")
    except (YamlFault, KeyError, TypeError, AttributeError):
        return Work(where=where, trouble=f"{SHEET} does not say which exercise it is: exercise: NAME")
    student = plain(student, LONGEST)
    if name not in catalog():
        return Work(where=where, student=student, trouble=f"there is no exercise {plain(name, LONGEST)}")
    theirs = catalog()[name].yours
    missing = [each for each in theirs if each not in held]
    return Work(
        where=where,
        exercise=name,
        student=student,
        files={each: held[each] for each in theirs if each in held},
        trouble=f"{', '.join(missing)} is missing, or has more than 256 KiB" if missing else "",
    )
