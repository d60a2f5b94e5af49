"""Campaign of many seeds, one after the other in this process; `workers.py` has one for several processes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from types import TracebackType
from typing import Generic, NamedTuple, Protocol, TypeVar

Tick = Callable[[], None]


class SoFar(NamedTuple):
    """Amount that was simulated so far, in seeds under way too."""

    minutes: int = 0
    cycles: int = 0
    faults: int = 0


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


class Campaign(Generic[R]):
    """Campaign: runs `seeds` in turn, to the first broken one with `until_failure`.

    `so_far` is how much was simulated; `tick` is called now and then meanwhile.
    """

    def __init__(
        self, setting: Runs[R], seeds: Iterable[int], *, until_failure: bool = False, tick: Tick
    ) -> None:
        self.setting = setting
        self.seeds = iter(seeds)
        self.tick = tick
        self._until_failure = until_failure
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
        before = self._so_far
        self._so_far = SoFar(before.minutes + minutes, before.cycles + cycles, before.faults + faults)
        self.tick()
