"""Values that only a server of OPC UA can show, and stops that it has no methods for."""

from __future__ import annotations

import pytest

from arboleda.drivers import Stop, StopMode
from arboleda_drivers.opcua.machine import Call
from arboleda_drivers.plc.plc_snapshot import UnreadableValue

from ..plc.plcs import PLCS

OPCUA = PLCS["opcua"]


@pytest.mark.parametrize("name", ["part_at", "gate", "mm_s", "state", "boot", "alive", "done", "reason"])
@pytest.mark.parametrize("value", [None, [1], True, 1.5, float("nan"), -1.5, b"\x00", {}, object()])
def test_no_value_of_another_type_is_a_report(name: str, value: object) -> None:
    machine = OPCUA.made()
    with pytest.raises(UnreadableValue, match=f"^ns=2;s={name} is "):
        machine.report(5.0, OPCUA.shown(machine, **{name: value}))


def test_without_a_latch_a_latch_is_a_halt_and_no_clear_is_no_call() -> None:
    plain = OPCUA.made(latch=None, clear=None)
    latched = plain.order(Stop(id="s", robot="belt", mode=StopMode.LATCH))
    assert latched == Call(method="ns=2;s=Halt", on="ns=2;s=Device")
    assert plain.order(Stop(id="s", robot="belt", mode=StopMode.CLEAR)) is None
