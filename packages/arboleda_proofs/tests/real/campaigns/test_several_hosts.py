"""Campaigns on the workers of a real scheduler, which are killed, frozen and cut off meanwhile."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from distributed import Client
from tests.patience import LONG_S
from tests.system.conftest import paths

import arboleda_proofs

pytestmark = pytest.mark.system

MAIN = "from arboleda.cli.main import main; main()"
DASK = (sys.executable, "-m", "dask")
SEEDS = ("--seeds", "8", "--cycles", "1", "--faults", "few")
TTL_S = 5  # after which a worker that is not heard of is gone
HERE, THERE = "10.78.0.1", "10.78.0.2"


class Site:
    """A scheduler, and workers of it as processes."""

    def __init__(self, start: Callable[..., Any], host: str = "127.0.0.1") -> None:
        self._start = start
        env = {"DASK_DISTRIBUTED__SCHEDULER__WORKER_TTL": f"{TTL_S}s", "PYTHONPATH": paths()}
        self.scheduler = start(*DASK, "scheduler", "--host", host, "--port", "0", "--no-dashboard", env=env)
        self.address = said(self.scheduler, "Scheduler at:")

    def worker(self, *before: str, first: str = "") -> Any:
        """One more worker; `first`: a folder whose packages it takes before others."""
        one = ("--nworkers", "1", "--nthreads", "1", "--no-nanny", "--no-dashboard")
        path = os.pathsep.join(filter(None, (first, paths())))
        worker = self._start(*before, *DASK, "worker", self.address, *one, env={"PYTHONPATH": path})
        worker.address = said(worker, "Start worker at:")
        worker.wait_for("Registered to:")
        return worker

    def simulate(self, file: Path, *words: str) -> Any:
        """A campaign on the workers that are there."""
        words = (*(words or SEEDS), "--on", self.address, "--json", str(file))
        return self._start(sys.executable, "-c", MAIN, "simulate", *words, env={"PYTHONPATH": paths()})

    def wait_until_at_work(self, *workers: Any, at_work: bool = True) -> None:
        """Wait until each of these workers runs something of a campaign; or none of them."""
        until = time.monotonic() + LONG_S
        with Client(self.address, set_as_default=False) as client:
            while any(self._is_at_work(client, each) is not at_work for each in workers):
                assert time.monotonic() < until, f"{self.scheduler.output}\n{workers[0].output}"
                time.sleep(0.05)

    def _is_at_work(self, client: Any, worker: Any) -> bool:
        return any(key.startswith("run-") for key in client.processing()[worker.address])


def said(process: Any, words: str) -> str:
    """The last word of the line in which a process says this."""
    process.wait_for(words)
    return str(next(each for each in process.lines if words in each).rpartition(" ")[2])


@pytest.fixture
def site(start: Callable[..., Any]) -> Site:
    return Site(start)


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The result of the campaign in one process."""
    return by_one_process(tmp_path_factory.mktemp("alone") / "out.json", *SEEDS)


def by_one_process(file: Path, *words: str) -> Any:
    command = [sys.executable, "-c", MAIN, "simulate", *words, "--jobs", "1", "--json", str(file)]
    env = {**os.environ, "PYTHONPATH": paths()}
    ended = subprocess.run(command, env=env, capture_output=True, text=True, check=False)
    assert ended.returncode in (0, 1), ended.stdout + ended.stderr
    return json.loads(file.read_text())


def result_of(run: Any, file: Path) -> Any:
    run.wait_for("seeds (1 to", patience_s=LONG_S)
    assert run.wait() in (0, 1), run.output
    assert "Traceback" not in run.output and "distributed" not in run.output
    return json.loads(file.read_text())


@pytest.fixture
def cable() -> Iterator[tuple[str, tuple[str, ...]]]:
    """The end of a cable to a host of its own, and how a command begins that runs on that host."""
    if os.geteuid() != 0:
        pytest.skip("network namespaces are for root")
    cable = f"cut{os.getpid() % 100_000}"
    name = f"arboleda-{cable}"
    inside = ("ip", "netns", "exec", name)
    try:
        for command in (
            ("ip", "netns", "add", name),
            ("ip", "link", "add", cable, "type", "veth", "peer", "name", "eth0", "netns", name),
            ("ip", "addr", "add", f"{HERE}/24", "dev", cable),
            ("ip", "link", "set", cable, "up"),
            (*inside, "ip", "addr", "add", f"{THERE}/24", "dev", "eth0"),
            (*inside, "ip", "link", "set", "eth0", "up"),
            (*inside, "ip", "link", "set", "lo", "up"),
        ):
            subprocess.run(command, check=True)
        yield cable, inside
    finally:
        subprocess.run(("ip", "link", "del", cable), check=False, stderr=subprocess.DEVNULL)
        subprocess.run(("ip", "netns", "del", name), check=False)


def test_workers_of_a_scheduler_find_what_one_process_finds(site: Site, tmp_path: Path) -> None:
    words = ("--seeds", "2", "--cycles", "1", "--faults", "none")
    for _ in range(2):
        site.worker()
    run = site.simulate(tmp_path / "far.json", *words)
    assert result_of(run, tmp_path / "far.json") == by_one_process(tmp_path / "near.json", *words)


def test_another_worker_does_the_runs_of_one_that_is_killed(site: Site, alone: Any, tmp_path: Path) -> None:
    workers = [site.worker() for _ in range(3)]
    run = site.simulate(tmp_path / "far.json")
    site.wait_until_at_work(*workers)
    workers[1].kill()
    assert result_of(run, tmp_path / "far.json") == alone


def test_the_runs_of_a_frozen_worker_count_once_also_where_it_thaws(
    site: Site, alone: Any, tmp_path: Path
) -> None:
    workers = [site.worker() for _ in range(3)]
    run = site.simulate(tmp_path / "far.json")
    site.wait_until_at_work(*workers)
    os.kill(workers[1].pid, signal.SIGSTOP)
    site.scheduler.wait_for("Removing worker", patience_s=LONG_S)
    os.kill(workers[1].pid, signal.SIGCONT)
    assert result_of(run, tmp_path / "far.json") == alone


@pytest.mark.requires("ip")
def test_the_runs_of_a_worker_whose_network_is_cut_count_once(
    start: Callable[..., Any], cable: tuple[str, tuple[str, ...]], alone: Any, tmp_path: Path
) -> None:
    end, inside = cable
    site = Site(start, HERE)
    workers = [site.worker(*inside), site.worker(), site.worker()]
    assert THERE in workers[0].address
    run = site.simulate(tmp_path / "far.json")
    site.wait_until_at_work(*workers)
    subprocess.run(("ip", "link", "set", end, "down"), check=True)
    site.scheduler.wait_for("Removing worker", patience_s=LONG_S)
    subprocess.run(("ip", "link", "set", end, "up"), check=True)
    assert result_of(run, tmp_path / "far.json") == alone


def test_ctrl_c_and_a_killed_command_leave_workers_that_do_other_runs(site: Site, tmp_path: Path) -> None:
    workers = [site.worker(), site.worker()]
    for end in ("interrupt", "kill"):
        run = site.simulate(tmp_path / "far.json", "--seeds", "9", "--cycles", "2000", "--faults", "none")
        site.wait_until_at_work(*workers)
        status = getattr(run, end)()
        assert end == "kill" or (status == 130 and "interrupted; so far:" in run.output), run.output
        site.wait_until_at_work(*workers, at_work=False)
    run = site.simulate(tmp_path / "far.json", "--seeds", "2", "--cycles", "1", "--faults", "none")
    assert len(result_of(run, tmp_path / "far.json")["seeds"]) == 2


def test_a_worker_with_another_file_gets_no_runs(site: Site, tmp_path: Path) -> None:
    package = Path(str(arboleda_proofs.__file__)).parent
    shutil.copytree(package, tmp_path / package.name)
    with (tmp_path / package.name / "simulator" / "run.py").open("a") as file:
        file.write("# another one\n")
    other, same = site.worker(first=str(tmp_path)), site.worker()
    words = ("--seeds", "2", "--cycles", "1", "--faults", "none")
    run = site.simulate(tmp_path / "far.json", *words)
    assert result_of(run, tmp_path / "far.json") == by_one_process(tmp_path / "near.json", *words)
    why = "has another arboleda_proofs/simulator/run.py than this machine"
    assert f"{other.address} gets no runs: it {why}" in run.output
    same.kill()
    run = site.simulate(tmp_path / "far.json", *words)
    assert run.wait() == 1
    assert f"arboleda: {site.address} has no worker for these runs; start some" in run.output


def test_a_scheduler_that_is_not_there_or_goes_is_said(site: Site, tmp_path: Path) -> None:
    worker = site.worker()
    run = site.simulate(tmp_path / "far.json", "--seeds", "9", "--cycles", "2000", "--faults", "none")
    site.wait_until_at_work(worker)
    site.scheduler.kill()
    run.wait_for(f"arboleda: the scheduler {site.address} does not answer any more", patience_s=LONG_S)
    assert run.wait() == 1 and "Traceback" not in run.output
    again = site.simulate(tmp_path / "far.json")
    assert again.wait() == 1
    assert f"arboleda: --on: no scheduler of Dask answers at {site.address}" in again.output
