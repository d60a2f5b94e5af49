"""Every peer that can be had, by its name: what has to be installed for it, and how it is played."""

from __future__ import annotations

import os
import sys
import tty
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from functools import partial
from importlib import import_module
from pathlib import Path

import pytest
from tests.contract.conftest import Mosquitto
from tests.ports import unused_port
from tests.shared import need_tool

from arboleda.drivers import Driver
from arboleda.model.plant_model import PlantModel
from arboleda_lines.line import FORMS
from arboleda_lines.relay import TcpRelay

from ..modbus.bench import DRIVER as MODBUS
from ..opcua.bench import DRIVER as OPCUA
from ..s7.bench import DRIVER as S7
from . import plants
from .cable import Cable, at_line, at_port
from .peer import Peer

HERE = Path(__file__).parent
PREFIX = Path(sys.prefix)
SNAP7 = PREFIX / "snap7"
O6 = PREFIX / "o6"  # open62541 for Python
LIBMODBUS = PREFIX / "libmodbus/libmodbus.so.5"
VEHICLE = HERE.with_name("vda5050") / "virtual_agv.js"
NODE = PREFIX / "npm/node_modules"
NO_WORD = {"refusal": 0}  # of a device that refuses nothing
TCP_FORMS = tuple(word for word in FORMS if word != "echo")  # which is of two wires, and these are TCP
WRITTEN_AT_ONCE = tuple(word for word in TCP_FORMS if word != "baud_9600")
"""Those of a driver whose `send` waits for no answer: a stop waits for what was told before."""
STREAM_FORMS = ("slow", "jitter", "late_once", "cut", "joined", "half_open", "reset")
"""Those of a stream of which nothing is lost; at 9,600 baud a stop waits for what was told before."""


@dataclass
class Stage:
    """Stage of a peer: what it needs is ended with `stack`. `relay` is there where its line is bad."""

    stack: ExitStack
    folder: Path
    is_bad: bool
    relay: TcpRelay | None = None

    def started(self, *command: str, **environment: str) -> Peer:
        peer = Peer(*command, **environment)
        self.stack.callback(peer.close)
        return peer

    def cable(self, far: Callable[[], int]) -> tuple[Cable, int]:
        """A cable, and the port at which the driver reaches it."""
        cable = Cable(far)
        self.stack.callback(cable.close)
        if not self.is_bad:
            return cable, cable.port
        self.relay = TcpRelay(cable.port)
        self.stack.enter_context(self.relay)
        return cable, self.relay.port

    def line(self) -> tuple[int, str]:
        """A pseudo terminal: the end of the cable, and the name of the other one."""
        device, client = os.openpty()
        self.stack.callback(os.close, device)
        self.stack.callback(os.close, client)
        tty.setraw(client)
        return device, os.ttyname(client)


Played = tuple[Peer, Cable, PlantModel]


@dataclass(frozen=True, kw_only=True)
class Bench:
    """Bench of a peer: `play` starts it, with a cable to it and the plant that reaches it by that."""

    driver: str  # the place of its class
    play: Callable[[Stage], Played]
    needs: tuple[str, ...] = ()
    installed: Path = HERE  # where there is something if it is installed
    goes: Mapping[str, int] = field(default_factory=dict)  # what of a day is other at it
    forms: tuple[str, ...] = TCP_FORMS  # in which its line may be bad

    def driver_class(self) -> type[Driver]:
        module, _, name = self.driver.partition(":")
        found: type[Driver] = getattr(import_module(f"arboleda_drivers.{module}"), name)
        return found

    @contextmanager
    def played(self, folder: Path, *, is_bad: bool) -> Iterator[tuple[Stage, Played]]:
        for each in self.needs:
            need_tool(each)
        if not self.installed.exists():
            pytest.skip(f"{self.installed} is not there; virtual-controllers.md says how to get it")
        with ExitStack() as stack:
            stage = Stage(stack, folder, is_bad)
            yield stage, self.play(stage)


def _script(name: str) -> tuple[str, str]:
    return sys.executable, str(HERE / name)


def _snap7(stage: Stage) -> Played:
    peer = stage.started(*_script("press.py"), "snap7", PYTHONPATH=str(SNAP7))
    cable, port = stage.cable(at_port(peer.port))
    return peer, cable, plants.press(stage.folder, quick(S7) % port)


def _libmodbus(stage: Stage) -> Played:
    peer = stage.started(*_script("press.py"), "libmodbus", str(LIBMODBUS))
    cable, port = stage.cable(at_port(peer.port))
    return peer, cable, plants.press(stage.folder, quick(MODBUS) % port)


def _libmodbus_rtu(stage: Stage) -> Played:
    """RTU at a pseudo terminal, behind a gateway that passes its bytes on."""
    device, line = stage.line()
    peer = stage.started(*_script("press.py"), "libmodbus", str(LIBMODBUS), line)
    cable, port = stage.cable(at_line(device))
    keys = quick(MODBUS).replace("port: %d", "port: %d\n            framing: rtu")
    return peer, cable, plants.press(stage.folder, keys % port)


def _open62541(stage: Stage) -> Played:
    peer = stage.started(*_script("press.py"), "open62541", PYTHONPATH=str(O6))
    cable, port = stage.cable(at_port(peer.port))
    return peer, cable, plants.press(stage.folder, OPCUA.replace("ns=2;", "ns=1;") % port)


def _node_opcua(stage: Stage) -> Played:
    node = need_tool("node")
    pki = stage.folder.with_name("pki")
    server = (node, str(HERE / "press_node.js"), str(NODE), str(pki))
    peer = stage.started(*_script("press.py"), "node_opcua", *server)
    cable, port = stage.cable(at_port(peer.port))
    return peer, cable, plants.press(stage.folder, OPCUA.replace("ns=2;", "nsu=urn:press;") % port)


def _servos(stage: Stage, maker: str) -> Played:
    device, line = stage.line()
    peer = stage.started(*_script("servos.py"), maker, line)
    cable, port = stage.cable(at_line(device))
    joints = "[{id: 1}, {id: 2}, {id: 3}, {id: 4}, {id: 5}, {id: 6}]"
    driver = f"{{serial_arm: {{host: 127.0.0.1, port: {port}, protocol: {maker}, joints: {joints}}}}}"
    keys = "kind: arm, model: cr10a, tolerance: {deg: [0.3, 0.3, 0.3, 0.3, 0.3, 0.3]}"
    places = ([0] * 6, [30, 10, -20, 0, 5, 0], [0, 0, 0, 0, 0, 30])
    return peer, cable, plants.mover(stage.folder, driver, keys, "deg", *places)


def _vehicle(stage: Stage) -> Played:
    """A vehicle at a broker; the cable is between that and the driver."""
    folder = stage.folder.with_name("broker")
    folder.mkdir()
    broker = Mosquitto(need_tool("mosquitto"), unused_port(), folder)
    broker.start()
    stage.stack.callback(broker.stop)
    to = broker.address.port
    vehicle = (str(VEHICLE), str(NODE / "vda-5050-lib"), f"mqtt://127.0.0.1:{to}", "agv1")
    peer = stage.started(need_tool("node"), *vehicle)
    cable, port = stage.cable(at_port(to))
    where = f"broker: 127.0.0.1:{port}, manufacturer: peer, serial: agv1, version: '2.0'"
    driver = f"{{vda5050: {{{where}}}}}"
    keys = "kind: mobile, grid: {pitch_mm: 400}"
    return peer, cable, plants.mover(stage.folder, driver, keys, "node", 0, 1, 0)


def quick(mapping: str) -> str:
    """The mapping with the time for an answer that plants have if they say nothing."""
    return "\n".join(line for line in mapping.splitlines() if "timeout_s" not in line)


BENCHES: dict[str, Bench] = {
    "snap7": Bench(driver="s7.adapter:S7", play=_snap7, needs=("snap7",), installed=SNAP7),
    "libmodbus": Bench(
        driver="modbus.adapter:Modbus", play=_libmodbus, needs=("pymodbus",), installed=LIBMODBUS
    ),
    "libmodbus_rtu": Bench(
        driver="modbus.adapter:Modbus", play=_libmodbus_rtu, needs=("pymodbus",), installed=LIBMODBUS
    ),
    "node_opcua": Bench(
        driver="opcua.adapter:OpcUa",
        play=_node_opcua,
        needs=("node", "asyncua"),
        installed=NODE / "node-opcua-server",
        forms=WRITTEN_AT_ONCE,
    ),
    "open62541": Bench(
        driver="opcua.adapter:OpcUa",
        play=_open62541,
        needs=("asyncua",),
        installed=O6,
        forms=WRITTEN_AT_ONCE,
    ),
    "vda_5050_lib": Bench(
        driver="vda5050.adapter:Vda5050",
        play=_vehicle,
        needs=("node", "mosquitto"),
        installed=NODE / "vda-5050-lib",
        goes=NO_WORD,
        forms=STREAM_FORMS,
    ),
    **{
        f"servos_{maker}": Bench(
            driver="serial_arm.adapter:SerialArm",
            play=partial(_servos, maker=maker),
            needs=(library,),
            goes=NO_WORD,
        )
        for maker, library in (("dynamixel", "dynamixel_sdk"), ("feetech", "scservo_sdk"))
    },
}
