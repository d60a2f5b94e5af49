"""What tests share: no network where time is moved by hand, no thread left behind, tools by name."""

from __future__ import annotations

import _thread
import gc
import importlib.util
import os
import re
import shutil
import signal
import socket
import subprocess
import threading
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from functools import lru_cache
from importlib import import_module
from itertools import groupby
from multiprocessing.process import BaseProcess
from operator import attrgetter
from pathlib import Path
from typing import NoReturn
from unittest import mock
from uuid import uuid4

import pytest
import typer.main
import typer.testing
from hypothesis import HealthCheck, settings

from arboleda.plant_file import recipe_trial
from arboleda.testing.domains import Domain

from . import tried_here
from .dealing import dealt, share
from .lengths import length
from .patience import PATIENCE_S
from .ports import unused_port
from .postgres import PASSWORD, Server

# How fast a machine is does not decide a test.
EXAMPLES = length(10, whole=300)
os.environ["ARBOLEDA_LANG"] = "en"  # whatever the locale here is: what commands print is compared
settings.register_profile(
    "arboleda", max_examples=EXAMPLES, deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("arboleda")

HERE = Path(__file__).parent
ROOT = HERE.parent
YOUNG = 200_000  # objects before a collection
BESIDE = (  # what tests that move time by hand have none of
    (threading.Thread, "start", "a thread"),
    (_thread, "start_new_thread", "a thread"),
    (subprocess.Popen, "__init__", "a process"),
    (BaseProcess, "start", "a process"),
    (os, "posix_spawn", "a process"),
    (os, "fork", "a fork"),
)
SEARCH_PATH = os.pathsep.join([os.environ.get("PATH", os.defpath), "/usr/sbin"])  # Debian keeps servers there


def pytest_configure() -> None:
    """Let Ctrl-C reach the programs that tests start.

    A shell starts what runs in the background with SIGINT ignored, and programs hand that on.
    """
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_sessionstart() -> None:
    """Look for garbage seldom: what tests make mostly dies without that.

    Looking as often as Python does by itself costs a fifth of collecting and up to 4 % of unit tests, and
    nothing where plants are simulated.
    """
    gc.set_threshold(YOUNG)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--about", metavar="WORD", help="only tests that have this word in their names: a driver"
    )
    parser.addoption(
        "--one-in",
        metavar="N",
        type=int,
        default=1,
        help="only the first of each N tests of a file: a sample",
    )


def folder(item: pytest.Item | pytest.Module) -> str:
    """The folder below `tests`, here, in a package or in tools, that the test is in; else nothing."""
    below = item.path.relative_to(ROOT).parts if item.path.is_relative_to(ROOT) else ()
    return below[below.index("tests") + 1] if "tests" in below else ""


def by_hand(item: pytest.Item | pytest.Module) -> bool:
    """Whether the test moves time by hand, in this thread alone."""
    return folder(item) in {"fast", "unit", "scenario", "meta"}


def is_real(item: pytest.Item | pytest.Module) -> bool:
    """Whether the test is of real parts, which have threads of their own."""
    return folder(item) in {"real", "processes", "contract", "system", "tutorial", ""}


def find_tool(name: str) -> str | None:
    """The program's path, or the name of an importable module; None if there is neither."""
    return shutil.which(name, path=SEARCH_PATH) or (name if importlib.util.find_spec(name) else None)


def need_tool(name: str) -> str:
    """The tool, else the test is skipped with the tool's name in the summary."""
    tool = find_tool(name)
    if tool is None:
        pytest.skip(f"{name} is not installed")
    return tool


def about(word: str, items: list[pytest.Item]) -> list[pytest.Item]:
    """Those with the whole word in the name of file, test or case: `ur`, not `measured`."""
    found = re.compile(rf"(?<![a-z0-9]){re.escape(word)}(?![a-z0-9])", re.IGNORECASE)
    return [item for item in items if found.search(item.nodeid)]


def one_in(count: int, items: list[pytest.Item]) -> list[pytest.Item]:
    """The first of each `count` tests of a file: some of every file that there is."""
    files = groupby(items, key=attrgetter("path"))
    return [item for _, tests in files for item in [*tests][::count]]


def mark_long(items: list[pytest.Item]) -> None:
    """Mark the cases of tests that are `sampled`, but for each so manieth of a test."""
    seen: Counter[tuple[Path, str]] = Counter()
    for item in items:
        marker = item.get_closest_marker("sampled")
        if marker is not None and isinstance(item, pytest.Function):
            case = (item.path, item.originalname)
            if seen[case] % marker.args[0]:
                item.add_marker(pytest.mark.long)
            seen[case] += 1


@pytest.hookimpl(wrapper=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> Iterator[None]:
    """Leave out what is not asked for; several workers get the rest in an order that keeps all cores busy."""
    mark_long(items)
    yield
    wanted = one_in(config.getoption("--one-in"), items)
    if word := config.getoption("--about"):
        wanted = about(word, wanted)
    if len(wanted) < len(items):
        config.hook.pytest_deselected(items=[item for item in items if item not in set(wanted)])
        items[:] = wanted
    workers = getattr(config, "workerinput", {}).get("workercount", 1)
    if workers == 1:
        return
    waiting: dict[Path, list[pytest.Item]] = {}
    computing = []
    for item in items:
        group = waiting.setdefault(item.path, []) if item.get_closest_marker("system") else computing
        group.append(item)
    items[:] = dealt(list(waiting.values()), computing, workers)


def import_share(config: pytest.Config) -> None:
    """Have a worker import its share of the test files before all workers import every file in one order.

    In a fresh clone an import has to rewrite a file's assertions and to compile it. Workers that go through
    the files side by side all do that for each file; so they find most of them compiled by another one.
    """
    worker = getattr(config, "workerinput", {"workerid": "gw0", "workercount": 1})
    number, workers = int(worker["workerid"].removeprefix("gw")), worker["workercount"]
    folders = [folder for folder in map(Path.absolute, map(Path, config.args)) if folder.is_relative_to(ROOT)]
    files = [file for folder in folders for file in sorted(folder.rglob("test_*.py"))]
    for file in share(files, number, workers):
        with suppress(Exception, pytest.skip.Exception):  # of which collecting tells
            import_module(".".join(file.relative_to(ROOT).with_suffix("").parts))


@pytest.hookimpl(wrapper=True)
def pytest_collection(session: pytest.Session) -> Iterator[object]:
    """Plants that tests load as they are imported are tried in this process, too."""
    with mock.patch.object(recipe_trial, "verdict", tried_here.verdict):
        import_share(session.config)
        return (yield)


def pytest_collection_finish() -> None:
    """Let no collection of garbage look at what was collected again: it all stays to the end."""
    gc.collect()
    gc.freeze()


@pytest.fixture(autouse=True, scope="session")
def commands_made_once() -> Iterator[None]:
    """The command line is made of its functions once, which takes a tenth of a second; it keeps nothing."""
    made = lru_cache(typer.main.get_command)
    with (
        mock.patch.object(typer.main, "get_command", made),
        mock.patch.object(typer.testing, "_get_command", made),
    ):
        yield


@pytest.fixture
def require() -> Callable[[str], str]:
    """`require("mosquitto")`: the program's path (a module's name), or the test is skipped."""
    return need_tool


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Skip a test marked `requires(...)` where one of its tools is absent."""
    for marker in item.iter_markers("requires"):
        for name in marker.args:
            need_tool(name)


def fail_if_skipped(report: pytest.TestReport | pytest.CollectReport) -> None:
    """Under ARBOLEDA_REQUIRE=all a skip is a failure."""
    skipped = report.outcome == "skipped" and not hasattr(report, "wasxfail")
    if skipped and os.environ.get("ARBOLEDA_REQUIRE") == "all":
        report.outcome = "failed"
        report.longrepr = f"skipped, which ARBOLEDA_REQUIRE=all forbids: {report.longrepr[-1]}"


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport() -> Iterator[None]:
    report = yield
    fail_if_skipped(report)
    return report


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report() -> Iterator[None]:
    report = yield
    fail_if_skipped(report)
    return report


class LocalSocket(socket.socket):
    """A socket that refuses to be one of a network; event loops may keep their socket pairs."""

    def __init__(self, family: int = -1, *args: object, **kwargs: object) -> None:
        if family in (-1, socket.AF_INET, socket.AF_INET6):
            raise RuntimeError("a unit or scenario test opened a network socket")
        super().__init__(family, *args, **kwargs)


def refused(what: str) -> Callable[..., NoReturn]:
    """Fails a test that calls it, also where errors are caught."""

    def refuse(*_: object, **__: object) -> NoReturn:
        pytest.fail(f"a test that moves time by hand started {what}: replace it, or move to tests/processes")

    return refuse


@pytest.fixture(autouse=True, scope="module")
def nothing_beside(request: pytest.FixtureRequest) -> Iterator[None]:
    """Tests that move time by hand have no network, and no thread or process but their own."""
    if not by_hand(request.node):
        yield
        return
    with ExitStack() as kept:
        kept.enter_context(mock.patch.object(socket, "socket", LocalSocket))
        for owner, name, what in BESIDE:
            kept.enter_context(mock.patch.object(owner, name, refused(what)))
        yield


@pytest.fixture(autouse=True, scope="module")
def quick_trials(request: pytest.FixtureRequest) -> Iterator[None]:
    """Python of a plant is tried in this process, but for tests of real parts; these wait for another process
    however long that takes by the clock."""
    if is_real(request.node):
        with mock.patch.multiple(recipe_trial, WAITS=200.0, STUCK_S=3000.0):
            yield
        return
    with mock.patch.object(recipe_trial, "verdict", tried_here.verdict):
        yield


@pytest.fixture(autouse=True)
def no_thread_left() -> Iterator[None]:
    """A thread that outlives its test fails it; one that ends by itself may do so."""
    before = set(threading.enumerate())
    yield
    started = set(threading.enumerate()) - before
    for thread in started:
        with suppress(RuntimeError):  # it is being started in this very moment, by one that ends
            thread.join(PATIENCE_S)
    left = sorted(thread.name for thread in started if thread.is_alive())
    assert not left, f"threads left behind: {', '.join(left)}"


@pytest.fixture
def ctrl_c_raises() -> Iterator[None]:
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def free_port() -> int:
    return unused_port()


@pytest.fixture
def page_ports() -> tuple[int, int]:
    """Ports of two pages that stay open when their plants end: the usual one is taken by the next plant of
    any test, and they would show that one."""
    return unused_port(), unused_port()


@pytest.fixture(scope="session")
def postgres() -> Iterator[Server]:
    """A PostgreSQL server for all tests of this process; a test that stops it starts it again."""
    server = Server(unused_port())
    yield server
    server.remove()


@pytest.fixture
def database(postgres: Server, monkeypatch: pytest.MonkeyPatch) -> str:
    """The address of its database; the password is where people have it. A server is silent for as long as
    it likes: in this process that decides nothing but where a test says so. One that has ended between two
    tests is started again, with a warning that has its last words."""
    if not postgres.runs:
        warnings.warn(f"PostgreSQL had ended: {postgres.last_words()}", stacklevel=1)
        postgres.start()
    monkeypatch.setenv("PGPASSWORD", PASSWORD)
    monkeypatch.setattr("arboleda_fleet.postgres.server.ANSWER_S", PATIENCE_S)
    return postgres.address


@pytest.fixture
def plant() -> str:
    """The name of a plant that the database does not know yet."""
    return f"plant_{uuid4().hex[:8]}"


@pytest.fixture
def ros_domain(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[int]:
    """A ROS domain id of one's own, this machine only, for the test and the processes it starts."""
    domain = Domain()
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain.id))
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "ros-log"))
    yield domain.id
    domain.close()


@pytest.fixture
def quick_discovery(monkeypatch: pytest.MonkeyPatch) -> None:
    """Processes of the test find each other at once, not within 3 s as by default."""
    for name in ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE"):
        monkeypatch.setenv(name, str(HERE / "quick_discovery.xml"))
