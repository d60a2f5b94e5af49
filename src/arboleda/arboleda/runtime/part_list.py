"""Parts of one process in the order in which they start; they end in the opposite one."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager, nullcontext
from importlib.metadata import EntryPoint
from typing import NamedTuple

from arboleda.host.packages import left_out
from arboleda.host.pieces import Piece, Pieces, naming, piece_of
from arboleda.model.errors import StartError
from arboleda.model.sentence import Phrase
from arboleda.plant_file.python_uses import error_text

from .packaged import packaged
from .parts.part import Part
from .registry import Assembly, Factory

KEEPS = Phrase("piece.keeps", "{package} keeps the plant from starting: {why}")


class _Made(NamedTuple):
    part: Part
    piece: Piece | None  # that is left out where the part breaks; None for one that the plant needs


class PartList:
    """PartList: makes, starts and ends parts.

    A part of the runner that cannot start keeps the plant from starting, and so does a part of a package that
    the plant needs. Another part of a package may be for a count or a card on the page: where it breaks,
    robots work without it, and `notes` say so. A StartError is raised, whoever raises it, with the name of
    the package.
    Packages in `off` have no part.
    """

    def __init__(self, off: Collection[str] = ()) -> None:
        self.pieces = Pieces(error_text, off=off)
        self._made: list[_Made] = []
        self._started: list[_Made] = []

    def __iter__(self) -> Iterator[Part]:
        return (each.part for each in self._made)

    @property
    def notes(self) -> list[str]:
        """A line for each piece that is left out, with the reason; whole packages first."""
        return [*left_out(), *self.pieces.notes]

    def make(self, assembly: Assembly, own: Iterable[Factory]) -> None:
        """Make all parts, of the runner's `own` factories and of packages, in the order of their phases."""
        factories = [*((None, each) for each in own), *packaged(self.pieces)]
        for point, factory in sorted(factories, key=lambda each: each[1].phase):
            spared = None if factory.is_needed else point
            piece = _piece(point, "the factory", factory.make, factory.what)
            with self._calling(None if spared is None else piece), naming(piece):
                parts = [*factory.make(assembly)]
                self._made += [_Made(part, _piece(spared, "the part", type(part))) for part in parts]

    def start(self) -> None:
        for each in self._made:
            self._started.append(each)
            with self._calling(each.piece):
                each.part.start()

    def stop(self) -> None:
        """End the parts that were started in the opposite order; idempotent. One of a package that does not
        end is left."""
        while self._started:
            part, piece = self._started.pop()
            with nullcontext() if piece is None else self.pieces.ending(piece):
                part.stop()

    @contextmanager
    def _calling(self, piece: Piece | None) -> Iterator[None]:
        if piece is None:
            yield
            return
        try:
            with self.pieces.calling(piece):
                yield
        except StartError as error:
            raise StartError(KEEPS(package=piece.of, why=error.sentence)) from error


def _piece(point: EntryPoint | None, what: str, named: object, said: str = "") -> Piece | None:
    name = getattr(named, "__name__", type(named).__name__)
    return None if point is None else piece_of(point, said or f"{what} {name}")
