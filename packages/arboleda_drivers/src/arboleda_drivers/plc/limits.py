"""Settings that drivers of PLCs have in common, and their limits."""

from __future__ import annotations

from arboleda.drivers import DriverError

from .handshake import SequencePlaces

SHORTEST_POLL_S = 0.005


class Watched:
    """Settings of a device whose PLC may watch for a heartbeat of the plant."""

    heartbeat: object

    @property
    def watches_plant(self) -> bool:
        """True where the PLC stops by itself without a heartbeat."""
        return self.heartbeat is not None


def check_polling(*, port: int, poll_s: float, timeout_s: float) -> None:
    """Raises DriverError if the port or the times of a driver that polls are out of their limits."""
    if not 0 < port < 65536:
        raise DriverError(f"port is {port}; allowed: 1 to 65535")
    if not SHORTEST_POLL_S <= poll_s <= 0.5:
        raise DriverError(f"poll_s is {poll_s:g}; allowed: {SHORTEST_POLL_S:g} to 0.5")
    if not 0.01 <= timeout_s <= 5:
        raise DriverError(f"timeout_s is {timeout_s:g}; allowed: 0.01 to 5")


def check_alive(alive_s: float) -> None:
    """Raises DriverError if the time in which a program has to show that it runs is none."""
    if not alive_s > 0:
        raise DriverError(f"alive_s is {alive_s:g}; allowed: more than 0")


def check_sequence(sequence: SequencePlaces) -> None:
    """Raises DriverError if a sequence has not one word for accepted, or two for what has failed."""
    if (sequence.accepted is None) == (sequence.busy is None):
        raise DriverError("needs either accepted, a number, or busy, true while it is at work")
    if sequence.busy is not None and sequence.write is None:
        raise DriverError("busy needs write, the variable of the number that it is busy with")
    if sequence.error is not None and (sequence.failed is not None or sequence.failure is not None):
        raise DriverError("error is in place of failed and failure: the number of done is that which failed")
