"""A process of a host whose wall clock is stepped sees that, and nothing else does."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from arboleda_kills.database import NoServer, Server
from arboleda_kills.hosts.clocks import Clocks

from ..patience import PATIENCE_S

pytestmark = [pytest.mark.system, pytest.mark.requires("cc")]
HOUR_S = 3600.0
ROUNDED_S = 0.01  # of clocks that are read in other programs
SAY = """
import datetime, json, sys, threading, time
for line in sys.stdin:
    threading.Event().wait(0.01)
    time.sleep(0.01)
    said = [time.time(), datetime.datetime.now().timestamp(), time.clock_gettime(time.CLOCK_REALTIME)]
    print(json.dumps({"wall": said, "steady": time.monotonic()}), flush=True)
"""


@pytest.fixture
def clocks() -> Iterator[Clocks]:
    with TemporaryDirectory(prefix="arboleda-clocks-", dir="/tmp") as folder:
        Path(folder).chmod(0o755)  # a database is run by another user
        made = Clocks(Path(folder), ["stepped", "right"])
        yield made
        made.close()


class Meanwhile:
    """What a clock of this process said before and after something, however long that took."""

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock, self._before = clock, clock()

    def has(self, said: float, ahead_s: float = 0.0) -> bool:
        """Whether a clock that is so much ahead said that meanwhile."""
        return self._before - ROUNDED_S <= said - ahead_s <= self._clock() + ROUNDED_S


WAITS = """
#include <errno.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdio.h>
#include <time.h>

static struct timespec soon(clockid_t clock) {
    struct timespec at;
    clock_gettime(clock, &at);
    at.tv_nsec += 100000000;
    if (at.tv_nsec >= 1000000000) { at.tv_nsec -= 1000000000; at.tv_sec++; }
    return at;
}

static int is_over(const struct timespec *until, clockid_t clock) {
    struct timespec at;
    clock_gettime(clock, &at);
    return at.tv_sec > until->tv_sec || (at.tv_sec == until->tv_sec && at.tv_nsec >= until->tv_nsec);
}
static void said(const char *what, const struct timespec *until, clockid_t clock) {
    printf("%s %s\\n", what, is_over(until, clock) ? "late" : "early");
}
static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER, taken = PTHREAD_MUTEX_INITIALIZER;

static void *lock(void *until) {
    pthread_mutex_timedlock(&taken, until);
    return until;
}

int main(void) {
    pthread_cond_t real = PTHREAD_COND_INITIALIZER, steady;
    pthread_condattr_t about;
    pthread_condattr_init(&about);
    pthread_condattr_setclock(&about, CLOCK_MONOTONIC);
    pthread_cond_init(&steady, &about);
    sem_t semaphore;
    sem_init(&semaphore, 0, 0);
    pthread_mutex_lock(&mutex);
    pthread_mutex_lock(&taken);
    struct timespec until = soon(CLOCK_REALTIME);
    pthread_cond_timedwait(&real, &mutex, &until), said("condition", &until, CLOCK_REALTIME);
    until = soon(CLOCK_MONOTONIC);
    pthread_cond_timedwait(&steady, &mutex, &until), said("steady condition", &until, CLOCK_MONOTONIC);
    until = soon(CLOCK_REALTIME);
    sem_timedwait(&semaphore, &until), said("semaphore", &until, CLOCK_REALTIME);
    until = soon(CLOCK_REALTIME);
    clock_nanosleep(CLOCK_REALTIME, TIMER_ABSTIME, &until, 0), said("sleep", &until, CLOCK_REALTIME);
    until = soon(CLOCK_REALTIME);
    pthread_t other;
    pthread_create(&other, 0, lock, &until), pthread_join(other, 0), said("lock", &until, CLOCK_REALTIME);
    return 0;
}
"""


def test_a_process_sees_the_steps_of_its_host_and_waits_neither_shorter_nor_an_hour_longer(
    clocks: Clocks, tmp_path: Path
) -> None:
    with subprocess.Popen(
        [*clocks.before("stepped"), sys.executable, "-c", SAY],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as child:
        assert child.stdin is not None and child.stdout is not None
        for ahead_s in (0.0, HOUR_S, -HOUR_S, 1.25, 0.0):
            clocks.step("right", 77.0)
            clocks.step("stepped", ahead_s)
            wall, steady = Meanwhile(time.time), Meanwhile(time.monotonic)
            print("wait", file=child.stdin, flush=True)
            said = json.loads(child.stdout.readline())
            assert all(wall.has(each, ahead_s) for each in said["wall"])
            assert steady.has(said["steady"])
        child.stdin.close()

    source, program = tmp_path / "waits.c", tmp_path / "waits"
    source.write_text(WAITS)
    subprocess.run(["cc", "-pthread", "-o", program, source], check=True)
    for ahead_s in (HOUR_S, -HOUR_S):
        clocks.step("stepped", ahead_s)
        command = [*clocks.before("stepped"), program]
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S, check=True)
        waits = dict(line.rsplit(" ", 1) for line in done.stdout.splitlines())
        assert waits == dict.fromkeys(
            ("condition", "steady condition", "semaphore", "sleep", "lock"), "late"
        ), ahead_s


def test_a_database_goes_by_the_clock_of_its_host(clocks: Clocks, free_port: int) -> None:
    try:
        server = Server(free_port, before=clocks.before("stepped"))
    except NoServer as error:
        pytest.skip(str(error))
    try:
        with server.connection() as db:
            for ahead_s in (HOUR_S, -HOUR_S, 0.0):
                clocks.step("stepped", ahead_s)
                wall = Meanwhile(time.time)
                (said,) = db.execute("SELECT extract(epoch FROM clock_timestamp())::FLOAT8").fetchone() or ()
                (now,) = db.execute("SELECT extract(epoch FROM now())::FLOAT8").fetchone() or ()
                assert wall.has(said, ahead_s) and wall.has(now, ahead_s)
    finally:
        server.remove()
