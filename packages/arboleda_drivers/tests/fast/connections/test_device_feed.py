"""Messages of devices on their way into drivers."""

from __future__ import annotations

from arboleda_drivers.connections.device_feed import taking


def test_what_breaks_on_a_message_is_told_with_the_message_and_goes_no_further() -> None:
    told: list[str] = []
    with taking(b"\x1b[2J", told.append):
        raise ValueError("no such mode")
    assert told == [r"it has said what cannot be taken, b'\x1b[2J' (ValueError: no such mode)"]


def test_what_is_taken_is_not_told() -> None:
    told: list[str] = []
    with taking(b"{}", told.append):
        pass
    assert told == []
