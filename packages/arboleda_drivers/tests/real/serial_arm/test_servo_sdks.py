"""The makers' own clients of bus servos at the virtual ones: Feetech's and Robotis', each from PyPI.

What the driver writes was written after the same documents as the virtual servos; these two were not.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import dynamixel_sdk
import pytest
import scservo_sdk
from tests.patience import PATIENCE_S

from arboleda_drivers.serial_arm.virtual.faults import FAULTS
from arboleda_drivers.serial_arm.virtual.machine import VirtualServos
from arboleda_drivers.virtual.faults import Faults
from arboleda_drivers.virtual.pty_line import PtyLine

BAUD = 1_000_000
OK = 0


class Bench:
    """A virtual arm on a pseudo terminal."""

    def __init__(self, maker: str) -> None:
        self.faults = Faults(FAULTS)
        self.servos = VirtualServos(self.faults, maker=maker)
        self.line = PtyLine(self.servos)
        self.line.start()


@pytest.fixture
def bench(request: pytest.FixtureRequest) -> Iterator[Bench]:
    bench = Bench(request.param)
    yield bench
    bench.line.stop()


@pytest.fixture
def feetech(bench: Bench) -> Iterator[Any]:
    port = scservo_sdk.PortHandler(bench.line.path)
    assert port.openPort()
    yield scservo_sdk.sms_sts(port)
    port.closePort()


@pytest.fixture
def dynamixel(bench: Bench) -> Iterator[Callable[..., Any]]:
    port, handler = dynamixel_sdk.PortHandler(bench.line.path), dynamixel_sdk.PacketHandler(2.0)
    assert port.openPort() and port.setBaudRate(BAUD)
    yield lambda name, *values: getattr(handler, name)(port, *values)
    port.closePort()


def wait_for(holds: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE_S
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.01)


FEETECH = pytest.mark.parametrize("bench", ["feetech"], indirect=True)
DYNAMIXEL = pytest.mark.parametrize("bench", ["dynamixel"], indirect=True)


@FEETECH
def test_the_client_of_feetech_moves_servos_and_hears_their_alarms(bench: Bench, feetech: Any) -> None:
    wait_for(lambda: feetech.ping(1) == (777, OK, OK))
    wait_for(lambda: feetech.ReadPos(1) == (2048, OK, OK))
    wait_for(lambda: feetech.write1ByteTxRx(1, scservo_sdk.SMS_STS_TORQUE_ENABLE, 1) == (OK, OK))
    wait_for(lambda: feetech.WritePosEx(1, 2500, 1500, 50) == (OK, OK))
    wait_for(lambda: feetech.ReadPos(1)[0] == 2500)

    for id in (1, 2):
        switch = partial(feetech.write1ByteTxRx, id, scservo_sdk.SMS_STS_TORQUE_ENABLE, 1)
        wait_for(lambda switch=switch: switch() == (OK, OK))
        feetech.SyncWritePosEx(id, 2000 + id, 1500, 50)
    assert feetech.groupSyncWrite.txPacket() == OK
    place = scservo_sdk.SMS_STS_PRESENT_POSITION_L
    group = scservo_sdk.GroupSyncRead(feetech, place, 2)
    for id in (1, 2):
        group.addParam(id)

    def places() -> list[int]:
        return [group.getData(id, place, 2) for id in (1, 2)] if group.txRxPacket() == OK else []

    wait_for(lambda: places() == [2001, 2002])

    bench.faults.switch("overheating", on=True)
    wait_for(lambda: feetech.ReadPos(3)[2] == 4)
    assert feetech.getRxPacketError(4) == "[ServoStatus] Overheat error!"
    bench.faults.switch("mute", on=True)
    wait_for(lambda: feetech.ReadPos(1)[1] == scservo_sdk.COMM_RX_TIMEOUT)
    bench.faults.switch("mute", on=False)
    bench.faults.switch("broken_frames", on=True)
    wait_for(lambda: feetech.ReadPos(1)[1] == scservo_sdk.COMM_RX_CORRUPT)


@DYNAMIXEL
def test_the_client_of_dynamixel_moves_servos_and_ends_their_alarms(
    bench: Bench, dynamixel: Callable[..., Any]
) -> None:
    wait_for(lambda: dynamixel("ping", 1) == (1200, OK, OK))
    wait_for(lambda: sorted(dynamixel("broadcastPing")[0]) == [1, 2, 3, 4, 5, 6])
    wait_for(lambda: dynamixel("write1ByteTxRx", 1, 64, 1) == (OK, OK))
    wait_for(lambda: dynamixel("write4ByteTxRx", 1, 112, 100) == (OK, OK))
    wait_for(lambda: dynamixel("write4ByteTxRx", 1, 116, 2500) == (OK, OK))
    wait_for(lambda: dynamixel("read4ByteTxRx", 1, 132)[0] == 2500)

    wait_for(lambda: dynamixel("write1ByteTxRx", 3, 64, 1) == (OK, OK))
    bench.faults.switch("overheating", on=True)
    wait_for(lambda: dynamixel("read1ByteTxRx", 3, 70) == (4, OK, 0x80))  # with the alert bit
    wait_for(lambda: dynamixel("read1ByteTxRx", 3, 64)[:2] == (0, OK))
    bench.faults.switch("overheating", on=False)
    wait_for(lambda: dynamixel("reboot", 3)[0] == OK)
    wait_for(lambda: dynamixel("read1ByteTxRx", 3, 70) == (0, OK, OK))
    bench.faults.switch("broken_frames", on=True)
    wait_for(lambda: dynamixel("read4ByteTxRx", 1, 132)[1] == dynamixel_sdk.COMM_RX_CORRUPT)
