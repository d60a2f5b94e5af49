"""A campaign that worker processes share; each simulation is in one thread of one of them."""

from __future__ import annotations

import gc
import os
import signal
from collections.abc import Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from itertools import islice
from multiprocessing import active_children, get_all_start_methods, get_context, parent_process
from operator import length_hint
from threading import Thread
from types import TracebackType
from typing import Any

from arboleda.extension import ArboledaError

from .campaign import Batch, Campaign, R, Runs, SoFar

TICK_S = 0.5
YOUNG = 50_000  # objects before a collection


def processors() -> int:
    """The number of processors that this process may use."""
    available = getattr(os, "sched_getaffinity", None)
    return len(available(0)) if available else os.cpu_count() or 1


def collect_rarely() -> None:
    """Have Python collect garbage in this process rarely: the objects of a simulation are freed without that,
    and collecting costs 4 %."""
    gc.freeze()
    gc.set_threshold(YOUNG)


@dataclass(frozen=True)
class Processes:
    """Crew of so many processes of this machine; one is this process."""

    jobs: int

    def campaign(self, batch: Batch[R]) -> Campaign[R]:
        """The campaign of a batch, by no more processes than it has seeds."""
        jobs = min(self.jobs, length_hint(batch.seeds, self.jobs))
        return Campaign(batch) if jobs <= 1 else Workers(batch, jobs)


class Workers(Campaign[R]):
    """Workers: `jobs` processes inside a `with` block, which end with it in any case.

    Enter it before any thread is started, as it forks the workers if the system can.
    """

    def __init__(self, batch: Batch[R], jobs: int) -> None:
        super().__init__(batch)
        context = get_context("fork" if "fork" in get_all_start_methods() else "spawn")
        self._others = frozenset(active_children())
        self._passed_by = context.Array("Q", SoFar())  # of all workers
        self._pool = ProcessPoolExecutor(jobs, context, _Worker.prepare, (self.setting, self._passed_by))
        self._under_way: dict[Future[R], int] = {}
        self._begins_with = jobs * batch.ahead

    def __enter__(self) -> Campaign[R]:
        self._hand_out(self._begins_with)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._under_way:
            for child in set(active_children()) - self._others:
                child.terminate()
        self._pool.shutdown(cancel_futures=True)

    @property
    def so_far(self) -> SoFar:
        return SoFar(*self._passed_by.get_obj())  # without the lock, which a killed worker may hold

    def _run(self) -> Iterator[R]:
        while self._under_way:
            ended, _ = wait(self._under_way, TICK_S, FIRST_COMPLETED)
            self.tick()
            for future in sorted(ended, key=self._under_way.__getitem__):
                yield self._result(future)
                self._hand_out(1)

    def _result(self, future: Future[R]) -> R:
        try:
            result = future.result()
        except BrokenProcessPool as error:
            sentence = "a worker process was killed; fewer --jobs need less memory"
            raise ArboledaError(sentence) from error
        del self._under_way[future]
        return result

    def _hand_out(self, count: int) -> None:
        for seed in islice(self.seeds, count):
            self._under_way[self._pool.submit(_Worker.run, seed)] = seed


class _Worker:
    """The data and the work of a worker process."""

    setting: Runs[Any]
    so_far: Any  # of all workers, an array shared with the parent

    @classmethod
    def prepare(cls, setting: Runs[Any], so_far: Any) -> None:
        cls.setting, cls.so_far = setting, so_far
        collect_rarely()
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent, who ends the workers
        Thread(target=_end_with_parent, daemon=True).start()

    @classmethod
    def run(cls, seed: int) -> Any:
        return cls.setting.run(seed, tick=cls.passed)

    @classmethod
    def passed(cls, minutes: int = 1, cycles: int = 0, faults: int = 0, /) -> None:
        with cls.so_far.get_lock():
            for number, more in enumerate((minutes, cycles, faults)):
                cls.so_far[number] += more


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
