"""A cable that is pulled while an order is sent, and put back: what was sent is on its way all the time."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from arboleda.drivers import Command, Driver

from ..peers.cable import Cable, at_port
from .driven import Heard, is_heard, is_lost

ARRIVES_S = 0.2


@contextmanager
def pulled(port: int) -> Iterator[Cable]:
    """The cable to a port."""
    cable = Cable(at_port(port))
    try:
        yield cable
    finally:
        cable.close()


def sent_over_a_pulled_cable(cable: Cable, driver: Driver, heard: Heard, order: Command) -> None:
    """Send an order that has no answer; once the device is heard again, all that can arrive has."""
    heard.until(is_heard)
    cable.cut(silent=True)
    with suppress(Exception):  # where a driver waits for the answer
        driver.send(order)
    heard.until(is_lost)
    cable.mend()
    heard.until(is_heard)
    time.sleep(ARRIVES_S)
