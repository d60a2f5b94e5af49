"""The pytest plugin, with the fixture `sim`. Every run of pytest loads it, so it imports late."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from .sim import Sim

USED: pytest.StashKey[Sim] = pytest.StashKey()


@pytest.fixture
def sim(request: pytest.FixtureRequest) -> Sim:
    """A plant under virtual time, with faults; the shipped one unless `sim.plant(...)` chooses another."""
    from .sim import Sim

    used = request.node.stash[USED] = Sim(folder=request.path.parent)
    return used


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> None:
    """Add the last events of the simulation to a failed test that does not show them already."""
    used = item.stash.get(USED, None)
    if call.excinfo is not None and used is not None and (lines := used.last_words()):
        item.add_report_section(call.when, "simulation", "\n".join(lines))
