"""Pieces of installed packages: each call of one is named where it takes long, and left out where it breaks.

Every call of a package goes through `Pieces`, so one that breaks takes nothing with it but that piece.
"""

from __future__ import annotations

import logging
from collections import defaultdict
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from functools import partial
from importlib.metadata import EntryPoint

from arboleda.model.errors import ArboledaError, StartError
from arboleda.model.outside import plain

from .packages import package_of, registered
from .timer import called_after, told_after

LOG = logging.getLogger(__name__)
LONGEST = 300  # characters of an error of a package
SLOW_S, ENDS_S = 5.0, 3.0
LEFT_OUT = "Arboleda goes on without {piece}: {why}"
SLOW = "Arboleda has waited for {piece} for more than {seconds:g} s"
HANGS = "it does not end within {seconds:g} s"
NAME_TAKEN = "{whose} has this name already"
RUNNER = "Arboleda"  # has what is of no package
THE_PARTS, THE_PAGE = "the parts", "the part of the page"  # of a package, as pieces


@dataclass(frozen=True, kw_only=True)
class Piece:
    """Piece of an installed package.

    `what` names it, as `the part Counter`; `of` the distribution that brings it, with its version; `package`
    is the name under which it registers what it adds.
    """

    what: str
    of: str
    package: str

    def __str__(self) -> str:
        return plain(f"{self.what} of {self.of}", LONGEST)


class Hangs(BaseException):
    """A piece does not end; raised in the middle of its work, which has no handler for it."""


def piece_of(point: EntryPoint, what: str) -> Piece:
    """A piece that comes by this entry point."""
    of = getattr(point, "dist", None)
    named = package_of(point) if of is None else f"{of.name} {of.version}"
    return Piece(what=what, of=named, package=package_of(point))


_CALLED = ContextVar[Piece | None]("called", default=None)


@contextmanager
def naming(piece: Piece | None) -> Iterator[None]:
    """Time in which what this thread calls is of a piece, so that what it registers is known to be of it.

    None stands for the runner itself.
    """
    before = _CALLED.get()
    _CALLED.set(piece)
    try:
        yield
    finally:
        _CALLED.set(before)


def registrant(what: str) -> Piece | None:
    """The piece of a package that registers just now; None where the runner itself does."""
    called = _CALLED.get()
    return None if called is None else replace(called, what=what)


def short(error: BaseException) -> str:
    """An error in a few words."""
    return str(error) if isinstance(error, ArboledaError) else f"{type(error).__name__}: {error}"


class Pieces:
    """Pieces: calls those of one process, and says which of them are left out.

    Nothing of the packages in `off` is among them.
    """

    def __init__(
        self,
        text_of: Callable[[BaseException], str] = short,
        tell: Callable[[str], None] | None = None,
        off: Collection[str] = (),
    ) -> None:
        self._text_of = text_of
        self._tell = tell or partial(LOG.warning, "%s")
        self._off = off
        self._left_out: dict[Piece, str] = {}
        self._behind = defaultdict[Piece, list[Callable[[], object]]](list)

    def __contains__(self, piece: Piece) -> bool:
        """True unless the piece is left out."""
        return piece not in self._left_out

    @property
    def notes(self) -> list[str]:
        """A line for each piece that is left out, in the order of time."""
        return [*self._left_out.values()]

    @property
    def without_routes(self) -> list[str]:
        """The lines for pieces that are left out before anybody knows their routes."""
        routed = ("the part", "the factory", "the routes")
        return [line for piece, line in self._left_out.items() if piece.what.startswith(routed)]

    def why_not(self, piece: Piece) -> str:
        """The line that a piece is left out; "" where it is not."""
        return self._left_out.get(piece, "")

    def take_along(self, piece: Piece, end: Callable[[], object]) -> None:
        """Have `end` called once the piece is left out: what it has begun ends with it."""
        self._behind[piece].append(end)

    def registered(self, group: str) -> list[EntryPoint]:
        """The entry points of a group, in the order of their names, of packages that are not off."""
        return [each for each in registered(group) if package_of(each) not in self._off]

    @contextmanager
    def calling(self, piece: Piece) -> Iterator[None]:
        """Time in which a piece is called: named after SLOW_S, and left out if it breaks."""
        slow = partial(self._tell, SLOW.format(piece=piece, seconds=SLOW_S))
        with self.sparing(piece), told_after(SLOW_S, slow):
            yield

    @contextmanager
    def sparing(self, piece: Piece) -> Iterator[None]:
        """Time in which a piece is called so often that it has no timer, and left out if it breaks.

        A StartError is raised: the plant must not start.
        """
        try:
            with naming(piece):
                yield
        except StartError:
            raise
        except (Exception, SystemExit, Hangs) as error:  # noqa: BLE001 - whatever a package does, the rest goes on
            self.leave_out(piece, error)

    @contextmanager
    def ending(self, piece: Piece) -> Iterator[None]:
        """Time in which a piece ends: left out after ENDS_S."""
        with self.calling(piece), called_after(ENDS_S, _give_up):
            yield

    def leave_out(self, piece: Piece, error: BaseException) -> None:
        """Note once that a piece is left out."""
        LOG.debug("%s broke", piece, exc_info=error)
        if piece in self._left_out:
            return
        why = str(error) if isinstance(error, Hangs) else self._text_of(error)
        line = LEFT_OUT.format(piece=piece, why=plain(why, LONGEST))
        self._left_out[piece] = line
        self._tell(line)
        for end in self._behind.pop(piece, ()):
            end()

    def leave_out_taken(self, piece: Piece, whose: str, sentence: str = NAME_TAKEN) -> None:
        """Leave out a piece whose name, or address, is of another package or of the runner."""
        self.leave_out(piece, ArboledaError(sentence.format(whose=whose)))


def _give_up() -> None:
    raise Hangs(HANGS.format(seconds=ENDS_S))
