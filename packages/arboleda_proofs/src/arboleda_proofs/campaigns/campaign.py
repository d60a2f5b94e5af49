"""Campaign of many seeds, one after the other in this process; `workers.py` has one for several processes,
`cluster.py` one for several hosts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from types import TracebackType
from typing import Generic, NamedTuple, Protocol, TypeVar

from .plants import Plant

Tick = Callable[[], None]


class SoFar(NamedTuple):
    """Amount that was simulated so far, in seeds under way too."""

    minutes: int = 0
    cycles: int = 0
    faults: int = 0

    def and_(self, minutes: int, cycles: int, faults: int) -> SoFar:
        """This amount with so much more."""
        return SoFar(self.minutes + minutes, self.cycles + cycles, self.faults + faults)


class Passed(Protocol):
    """Function that is called now and then by a run, with what passed in it since the call before."""

    def __call__(self, minutes: int = 1, cycles: int = 0, faults: int = 0, /) -> None: ...


class Judged(Protocol):
    """Result that is true in `broken` where something broke."""

    @property
    def broken(self) -> object: ...


R = TypeVar("R", bound=Judged)
Made = TypeVar("Made", covariant=True)


class Runs(Protocol[Made]):
    """Runs of numbers, which are seeds, in this process or in others: all of it can be pickled."""

    def run(self, seed: int, *, tick: Passed | None = None) -> Made: ...


@dataclass(frozen=True, kw_only=True)
class Batch(Generic[R]):
    """Batch of runs, of `seeds` in turn, to the first broken one with `until_failure`.

    `plants` are those of the runs that are read from files. `tick` is called now and then meanwhile. `ahead`:
    so much is handed out to each worker, of which it has begun one.
    """

    runs: Runs[R]
    seeds: Iterable[int]
    tick: Tick
    plants: Sequence[Plant] = ()
    until_failure: bool = False
    ahead: int = 2


class Campaign(Generic[R]):
    """Campaign: does the runs of a batch; `so_far` is how much was simulated."""

    def __init__(self, batch: Batch[R]) -> None:
        self.setting = batch.runs
        self.seeds = iter(batch.seeds)
        self.tick = batch.tick
        self._until_failure = batch.until_failure
        self._so_far = SoFar()

    def __enter__(self) -> Campaign[R]:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        pass

    @property
    def minutes(self) -> int:
        return self.so_far.minutes

    @property
    def so_far(self) -> SoFar:
        return self._so_far

    def results(self) -> Iterator[R]:
        """Results of seeds in the order of their ends; after a failure, seeds that had begun still end."""
        for result in self._run():
            if result.broken and self._until_failure:
                self.seeds = iter(())
            yield result

    def _run(self) -> Iterator[R]:
        while (seed := next(self.seeds, None)) is not None:
            yield self.setting.run(seed, tick=self._passed)

    def _passed(self, minutes: int = 1, cycles: int = 0, faults: int = 0, /) -> None:
        self._so_far = self._so_far.and_(minutes, cycles, faults)
        self.tick()


class Crew(Protocol):
    """Crew: processes of this machine, or workers of others, that do the runs of campaigns."""

    @property
    def jobs(self) -> int:
        """The number of runs that they do at a time."""

    def campaign(self, batch: Batch[R]) -> Campaign[R]:
        """The campaign that does this batch."""
