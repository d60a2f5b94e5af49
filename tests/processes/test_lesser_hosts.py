"""No module of Arboleda needs at its import what Linux alone has; only `host/` asks which system this is."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

from arboleda.host import signals

from ..lesser_host import NOWHERE
from ..packages import PACKAGES

TESTS = Path(__file__).parents[1]
PACKAGE = TESTS.parent / "src/arboleda/arboleda"
IMPORT_ALL = f"""
import sys; sys.path[:0] = [{str(TESTS)!r}]
import importlib, os, pkgutil, lesser_host
lesser_host.load_libraries()  # once: they take as long as all else
for platform in sys.argv[1:]:
    if os.fork():
        if os.wait()[1]: sys.exit(platform)
        continue
    lesser_host.pretend(platform)
    for name in {["arboleda", *PACKAGES]!r}:
        for module in pkgutil.walk_packages(importlib.import_module(name).__path__, name + "."):
            importlib.import_module(module.name)
    print(platform, len([name for name in sys.modules if name.startswith("arboleda")]))
    break
"""


def test_every_module_is_imported_where_the_system_has_less() -> None:
    command = [sys.executable, "-c", IMPORT_ALL, *NOWHERE]
    path = os.pathsep.join(map(str, (PACKAGE.parent, *(each.parent for each in PACKAGES.values()))))
    environ = {**os.environ, "PYTHONPATH": path}
    ran = subprocess.run(command, env=environ, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    imported = dict(line.split() for line in ran.stdout.splitlines())
    assert imported.keys() == {"win32", "darwin"} and min(map(int, imported.values())) > 1000


def test_a_process_ends_with_its_group() -> None:
    with subprocess.Popen(
        [sys.executable, "-c", "input()"], stdin=subprocess.PIPE, start_new_session=True
    ) as run:
        signals.kill_group(run.pid)
        assert run.wait() == -signal.SIGKILL
    signals.kill_group(run.pid)
