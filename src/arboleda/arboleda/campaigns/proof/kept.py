"""Kept portions: what was proved already of the very same plant files and version, in a file."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from hashlib import blake2b
from pathlib import Path
from typing import Any

from arboleda import __version__
from arboleda.recorder.preamble import PlantFiles

from .outcome import outcome_from, plain
from .proof import Portion, Proof, Proved

FORMAT = 1  # of the lines; another one is another key
SUFFIX = ".jsonl"


def key_of(files: PlantFiles) -> str:
    """The digest of all that decides on what comes of a run: the version, and the content of each file."""
    digest = blake2b(f"{FORMAT} {__version__} {files.plant}".encode(), digest_size=16)
    for name, content in sorted(files.contents.items()):
        digest.update(f"\n{name} {len(content)}\n".encode() + content)
    return digest.hexdigest()


class Kept:
    """Kept: a file of proved portions in a folder, in which files of other plant files or versions go.

    `trouble` is why something could not be kept, read or removed.
    """

    def __init__(self, folder: Path, files: PlantFiles, proof: Proof) -> None:
        self._file = folder / f"{key_of(files)}{SUFFIX}"
        self.trouble: str | None = None
        self._proof = proof
        self._numbers = {_name(proof, portion): number for number, portion in enumerate(proof.portions)}

    def known(self) -> dict[int, Proved]:
        """The portions of this proof that were proved before, by number."""
        return {each.number: each for each in self._read()}

    def keep(self, proved: Proved) -> None:
        """Keep one more."""
        name = _name(self._proof, self._proof.portions[proved.number])
        outcomes = [plain(each) for each in proved.outcomes]
        row = {"portion": name, "outcomes": outcomes, "rows": proved.rows, "digest": proved.digest}
        with self._noted():
            self._file.parent.mkdir(parents=True, exist_ok=True)
            with self._file.open("a", encoding="utf-8") as file:
                file.write(json.dumps(row, ensure_ascii=False) + "\n")

    def forget(self, *, all: bool) -> None:
        """Remove what other plant files or versions left, or all."""
        with self._noted():
            for each in self._file.parent.glob(f"*{SUFFIX}"):
                if all or each != self._file:
                    each.unlink()

    def _read(self) -> Iterator[Proved]:
        lines: list[bytes] = []
        with self._noted():
            lines = self._file.read_bytes().splitlines() if self._file.exists() else []
        for line in lines:
            with suppress(ValueError, KeyError, TypeError, IndexError):  # cut off, or not ours
                yield self._proved(json.loads(line))

    @contextmanager
    def _noted(self) -> Iterator[None]:
        """Note an error of the disk, and go on: it is proved again the next time."""
        try:
            yield
        except OSError as error:
            self.trouble = f"{self._file}: {error.strerror}"

    def _proved(self, row: dict[str, Any]) -> Proved:
        number = self._numbers[row["portion"]]
        found = Proved(
            number=number,
            outcomes=tuple(map(outcome_from, row["outcomes"])),
            rows=tuple(row["rows"]),
            digest=row["digest"],
        )
        if len(found.each) != len(self._proof.faults(self._proof.portions[number])):
            raise ValueError("another number of faults")
        return found


def _name(proof: Proof, portion: Portion) -> str:
    words = (portion.instant, portion.part, portion.first, *proof.kinds)
    return " | ".join([proof.calm[portion.scenario].scenario.name, *map(str, words)])
