"""Campaigns on the workers of a scheduler of Dask, which may be on other hosts."""

from __future__ import annotations

import logging
import time
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, wait
from itertools import chain, count, islice
from types import TracebackType
from typing import Any, NamedTuple
from uuid import uuid4

from distributed import Client
from distributed.scheduler import KilledWorker

from arboleda.extension import ArboledaError

from . import far_work
from .campaign import Batch, Campaign, R, SoFar
from .far_work import Done
from .workers import TICK_S

CONNECT_S = 10.0
LEFT_S = 60.0  # so long a campaign whose workers have all died waits for another one
PORTION_S = 2.0  # of runs that are handed out at a time: handing out takes some milliseconds
MOST = 64  # runs of a portion
THREADS = "has {threads} threads, and runs need a process each: start it with --nthreads 1"
NOBODY = (
    "{address} has no worker for these runs; start some: dask worker {address} --nworkers -1 --nthreads 1"
)
KILLED = "the same runs killed one worker after the other; workers with more memory may do them"
Say = Callable[[str], None]


class Portion(NamedTuple):
    """Portion of the seeds that a worker runs."""

    number: int
    seeds: tuple[int, ...]


class Cluster:
    """Crew of the workers of a scheduler; `say` is called once for each worker that gets nothing to do."""

    def __init__(self, client: Client, address: str, say: Say) -> None:
        self.client, self.address = client, address
        self._say, self._refused = say, set[str]()

    def __enter__(self) -> Cluster:
        if not self.workers():  # said before minutes of other work
            raise self.nobody()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.client.close(timeout=CONNECT_S)

    @property
    def jobs(self) -> int:
        """The number of workers, at least one."""
        return max(1, len(self.workers()))

    def campaign(self, batch: Batch[R]) -> Campaign[R]:
        """The campaign of a batch; ArboledaError in its course where no worker is left for it."""
        return FarCampaign(batch, self)

    def workers(self) -> Mapping[str, int]:
        """The addresses of the workers that are there, each with the number of its threads."""
        try:  # scheduler_info() has no workers where the client looks by itself meanwhile
            found: Mapping[str, int] = self.client.nthreads()
        except (OSError, TimeoutError, RuntimeError, ValueError) as error:
            raise self.gone() from error
        return found

    def refuse(self, worker: str, why: str) -> None:
        """Say that a worker gets nothing to do."""
        if worker not in self._refused:
            self._refused.add(worker)
            self._say(f"{worker} gets no runs: it {why}")

    def nobody(self) -> ArboledaError:
        """The error that no worker is there that can do the runs."""
        return ArboledaError(NOBODY.format(address=self.address))

    def gone(self) -> ArboledaError:
        """The error that the scheduler is not there any more."""
        return ArboledaError(f"the scheduler {self.address} does not answer any more")


def connected(address: str, say: Say) -> Cluster:
    """The workers of the scheduler at an address; ArboledaError where none answers."""
    for name in ("distributed", "distributed.client"):  # what matters is said here in sentences
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # on versions, which `prepare` compares
            client = Client(address, timeout=CONNECT_S, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        raise ArboledaError(f"--on: no scheduler of Dask answers at {address}") from error
    return Cluster(client, address, say)


class FarCampaign(Campaign[R]):
    """Campaign on the workers of a scheduler, which gives the runs of a worker that dies to another one.

    Each worker is made ready for the runs before it gets some, also a worker that comes later.
    """

    def __init__(self, batch: Batch[R], cluster: Cluster) -> None:
        super().__init__(batch)
        self._work = far_work.packed(batch.runs, batch.plants)
        self._cluster, self._ahead = cluster, batch.ahead
        self._name, self._numbers = f"arboleda-{uuid4().hex}", count()
        self._executor = cluster.client.get_executor(pure=False)
        self._asked: dict[str, Future[str]] = {}  # whether it is ready, by worker
        self._fit: set[str] = set()
        self._under_way: dict[Future[Done[R] | None], Portion] = {}
        self._in_portions: dict[int, SoFar] = {}  # under way, by number
        self._look_at = self._left_at = 0.0
        self._size = 1  # of a portion

    def __enter__(self) -> Campaign[R]:
        self._cluster.client.subscribe_topic(self._name, self._hear)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._executor.shutdown(wait=False)
        self._cluster.client.unsubscribe_topic(self._name)

    @property
    def so_far(self) -> SoFar:
        found = self._so_far
        for each in list(self._in_portions.values()):
            found = found.and_(*each)
        return found

    def _hear(self, event: tuple[float, Sequence[int]]) -> None:
        number, *passed = event[1]
        if number in self._in_portions:
            self._in_portions[number] = SoFar(*passed)

    def _run(self) -> Iterator[R]:
        while True:
            self._look()
            self._hand_out()
            if self._fit and not self._under_way:
                return
            asked = (each for each in self._asked.values() if not each.done())
            awaited: list[Future[Any]] = [*self._under_way, *asked]
            if not awaited:  # all workers have died, and others may come
                time.sleep(TICK_S)
            ended, _ = wait(awaited, TICK_S, FIRST_COMPLETED)
            self.tick()
            for future in [each for each in self._under_way if each in ended]:
                yield from self._results(future)

    def _look(self) -> None:
        """See which workers are there, and which of them are ready; ArboledaError where none is for long."""
        now = time.monotonic()
        if now >= self._look_at:
            self._look_at = now + TICK_S
            self._ask(self._cluster.workers())
        ready = {worker: self._is_ready(worker, each) for worker, each in self._asked.items() if each.done()}
        self._fit = {worker for worker, is_ready in ready.items() if is_ready}
        if self._fit:
            self._left_at = now + LEFT_S
        elif len(ready) == len(self._asked) and now >= self._left_at:
            raise self._cluster.nobody()

    def _ask(self, there: Mapping[str, int]) -> None:
        """Ask workers that are new to make themselves ready, and forget those that are gone."""
        self._asked = {worker: each for worker, each in self._asked.items() if worker in there}
        for worker in there.keys() - self._asked:
            self._asked[worker] = self._readied(worker, there[worker])

    def _readied(self, worker: str, threads: int) -> Future[str]:
        answer = Future[str]()
        if threads == 1:
            answer = self._executor.submit(far_work.prepare, self._name, self._work, workers=[worker])
        else:
            answer.set_result(THREADS.format(threads=threads))
        return answer

    def _is_ready(self, worker: str, answer: Future[str]) -> bool:
        try:
            why = answer.result()
        except CancelledError:
            return False
        except Exception as error:  # noqa: BLE001 - an old version may raise anything
            why = f"cannot do such runs: {error}"
        if why:
            self._cluster.refuse(worker, why)
        return not why

    def _hand_out(self) -> None:
        while len(self._under_way) < self._ahead * len(self._fit):
            seeds = tuple(islice(self.seeds, self._size))
            if not seeds:
                return
            portion = Portion(next(self._numbers), seeds)
            self._in_portions[portion.number] = SoFar()
            future = self._executor.submit(
                far_work.run, self._name, *portion, workers=[*self._fit], allow_other_workers=True
            )
            self._under_way[future] = portion

    def _results(self, future: Future[Done[R] | None]) -> Iterator[R]:
        portion = self._under_way.pop(future)
        self._in_portions.pop(portion.number)
        try:
            done = future.result()
        except KilledWorker as error:
            raise ArboledaError(KILLED) from error
        except CancelledError as error:
            raise self._cluster.gone() from error
        if done is None:  # no worker was left that was ready, so others had to take it
            self.seeds = chain(portion.seeds, self.seeds)
            self._asked = {}
            return
        self._so_far = self._so_far.and_(*done.passed)
        self._size = max(1, min(MOST, int(PORTION_S * len(portion.seeds) / max(done.seconds, 1e-3))))
        yield from done.results
