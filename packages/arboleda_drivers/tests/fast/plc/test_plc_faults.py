"""A belt behind a PLC under its faults, on Modbus, OPC UA and S7; `tools/driver-faults` runs more seeds."""

from __future__ import annotations

import pytest
from tests.packages import ROOT

from arboleda.dispatch import evidence
from arboleda.plant_file.loader import load
from arboleda_driver_faults.modbus import ModbusRig, Registers
from arboleda_driver_faults.opcua import OpcUaRig
from arboleda_driver_faults.plc import BeltRig
from arboleda_driver_faults.rig import TASKS, run
from arboleda_driver_faults.s7 import S7Rig
from arboleda_drivers.modbus.virtual.memory import FAULTS as MODBUS_FAULTS
from arboleda_drivers.opcua.virtual.faults import FAULTS as OPCUA_FAULTS
from arboleda_drivers.plc.numbers import Numbers
from arboleda_drivers.s7.virtual.memory import FAULTS as S7_FAULTS

EXAMPLES = ROOT / "examples/plc_conveyor"
MODBUS, OPCUA, S7 = (load(EXAMPLES / file) for file in ("plant.yaml", "opcua.yaml", "s7.yaml"))
SEEDS = 4
FEW = 2  # tasks, in which a fault comes by itself


def breaches(rig: BeltRig, seed: int, *names: str, tasks: int = TASKS) -> list[str]:
    return run(rig, seed, names, tasks).breaches


@pytest.mark.sampled(4)
@pytest.mark.parametrize("seed", range(SEEDS))
def test_no_false_success_no_hang_and_the_right_cause(seed: int) -> None:
    assert breaches(ModbusRig(MODBUS), seed) == []
    assert breaches(OpcUaRig(OPCUA), seed) == []
    assert breaches(S7Rig(S7), seed) == []


@pytest.mark.sampled(7)
@pytest.mark.parametrize("fault", MODBUS_FAULTS)
def test_every_fault_of_modbus_by_itself(fault: str) -> None:
    assert breaches(ModbusRig(MODBUS), 1, fault, tasks=FEW) == []


@pytest.mark.parametrize("fault", ["mute", *sorted(set(OPCUA_FAULTS) - set(MODBUS_FAULTS))])
def test_every_fault_that_only_opcua_has_by_itself(fault: str) -> None:
    assert breaches(OpcUaRig(OPCUA), 1, fault, tasks=FEW) == []


@pytest.mark.parametrize("fault", ["mute", "refuses_reads", "refuses_writes"])
def test_every_fault_of_the_connection_of_an_s7_by_itself(fault: str) -> None:
    assert breaches(S7Rig(S7), 1, fault, tasks=FEW) == []


def test_a_belt_that_is_believed_anywhere_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(evidence, "reached", lambda entry, belief: True)
    found = [each for seed in range(3) for each in breaches(OpcUaRig(OPCUA), seed, "lies", "blind")]
    assert any("false success" in each for each in found)


def test_numbers_that_name_no_command_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Numbers, "id_of", lambda self, number: None)
    assert any("wrong cause" in each for each in breaches(ModbusRig(MODBUS), 1, "bad_part"))


def test_an_order_that_is_given_twice_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    once = Registers.order
    monkeypatch.setattr(Registers, "order", lambda wire, told: once(wire, told) or once(wire, told))
    assert any("moves were said" in each for each in breaches(ModbusRig(MODBUS), 1, "bad_part"))


def test_every_fault_has_the_reasons_that_it_may_give() -> None:
    assert set(ModbusRig(MODBUS).causes) == set(MODBUS_FAULTS)
    assert set(OpcUaRig(OPCUA).causes) == set(OPCUA_FAULTS)
    assert set(S7Rig(S7).causes) == set(S7_FAULTS)
