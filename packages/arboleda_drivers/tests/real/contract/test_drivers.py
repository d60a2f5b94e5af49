"""Our drivers go through the contract of all drivers.

A driver takes part with a bench in the folder of its maker, which plays its device by hand. The tests of its
machine in tests/fast prove most of the cases. So here each driver does one work, each kind of link
has one story of a stop and a lost connection, and one driver has the whole contract; at night all drivers do.
"""

from __future__ import annotations

import pytest
from tests.lengths import length

from arboleda.testing.drivers import Bench, DriverContract
from arboleda.testing.drivers.contract import misfit

from .benches import BENCHES, SAME_LINK

pytestmark = pytest.mark.system

ALL = list(BENCHES)
LINKS = [name for name in ALL if name not in SAME_LINK]
WORK = DriverContract.test_accept_and_done.__name__
STORY = DriverContract.test_what_was_stopped_or_lost_under_way_is_never_done.__name__
BREAKS = DriverContract.test_a_message_that_breaks_what_takes_it.__name__
BY_DAY = {WORK: ALL, STORY: LINKS, BREAKS: ["gcode", "modbus", "opcua", "vda5050"]}
AT_NIGHT = {STORY: LINKS}


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Each case for the drivers that have it by day, or at night."""
    case = metafunc.function.__name__
    drivers = length(BY_DAY.get(case, ["line_tcp"]), AT_NIGHT.get(case, ALL))
    marks = [pytest.mark.smoke] if case == WORK else []
    fit = [name for name in drivers if not misfit(metafunc.function, BENCHES[name])]
    metafunc.parametrize("bench", [pytest.param(name, marks=marks) for name in fit], indirect=True)


class TestDrivers(DriverContract):
    @pytest.fixture
    def bench(self, request: pytest.FixtureRequest, ros_domain: int, quick_discovery: None) -> Bench:
        return BENCHES[request.param]
