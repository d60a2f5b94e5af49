"""Factories of all that reaches robots: broker, ROS 2, bridge, drivers, and virtual boards."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from arboleda.adapters.broker_login import MQTT_PORT, address
from arboleda.model.errors import StartError
from arboleda.model.packages import BOARDS, MISSING
from arboleda.model.plant_model import MqttVersion, PlantModel

from ..options import Options
from ..parts.bridge import BridgePart
from ..parts.broker import OtherBroker, OwnBroker
from ..parts.broker_survey import BrokerSurvey
from ..parts.devices import DeviceBench, DevicesPart, FirmwareBoards
from ..parts.drivers import DriversPart
from ..parts.part import Broker, Part
from ..registry import Assembly


class RosPart:
    """The ROS 2 link as a part."""

    def __init__(self, link: Any) -> None:
        self._link = link

    def start(self) -> None:
        self._link.start()

    def stop(self) -> None:
        self._link.close()


def links(assembly: Assembly) -> Iterator[Part]:
    """The broker, and ROS 2 after it."""
    link, broker = assembly.options.link, broker_of(assembly.model, assembly.options, assembly.parts)
    assembly.offer(Broker, broker)
    if link is not None:
        assembly.notes.append(lambda: link.notes)
        assembly.links.add(lambda: {"ros": {"notes": list(link.notes)}})
    if assembly.model.has_boards:
        assembly.notes.append(lambda: [f"MQTT broker: {broker.address}"])
    yield broker
    if link is not None:
        yield RosPart(link)


def bridge(assembly: Assembly) -> Iterator[Part]:
    """The bridge to the boards on MQTT."""
    if "bridge" not in assembly.parts:
        return
    broker, scout = assembly.need(Broker), "broker" not in assembly.parts
    part = BridgePart(
        assembly.model,
        max(assembly.began, assembly.epoch),
        broker,
        assembly.crash,
        waits=scout and "devices" in assembly.parts,
        has_lease=assembly.holdings.memory.lead.renew_s is not None,
    )

    def broker_state() -> dict[str, Any]:
        connected, refused = part.links()
        return {"broker": {"address": str(broker.address), "connected": connected}, "refused": refused}

    assembly.offer(BridgePart, part)
    assembly.links.add(broker_state)
    yield part


def boards(assembly: Assembly) -> Iterator[Part]:
    """The boards that play the real ones: the firmware's where wanted and possible, else virtual."""
    if "devices" not in assembly.parts:
        return
    broker, scout = assembly.need(Broker), "broker" not in assembly.parts

    def survey(boards: Sequence[str], clear: Callable[[], None]) -> Part:
        return BrokerSurvey(broker, boards, clear, assembly.crash)

    compiled, elsewhere = list[Part](), list[str]()
    if assembly.options.firmware:
        make = assembly.ask(FirmwareBoards)
        if make is None:
            raise StartError(MISSING(what="--boards linux", package=BOARDS))
        robots, part = make(assembly.model, broker, assembly.crash, survey if scout else None)
        compiled, elsewhere = [part], [*robots]
    waiting = assembly.ask(BridgePart) if scout else None
    virtual = DevicesPart(
        assembly.model,
        assembly.began,
        broker,
        assembly.crash,
        scout=scout,
        joined=_nothing if waiting is None else waiting.join,
        elsewhere=elsewhere,
        bench=assembly.ask(DeviceBench),
    )
    assembly.offer(DevicesPart, virtual)
    yield virtual
    yield from compiled


def drivers(assembly: Assembly) -> Iterator[Part]:
    """The drivers of robots that no board speaks for."""
    if "orchestrator" in assembly.parts and assembly.model.driven:
        part = DriversPart(assembly.model, assembly.epoch, assembly.crash, assembly.need(Broker))
        assembly.offer(DriversPart, part)
        yield part


def broker_of(model: PlantModel, options: Options, parts: frozenset[str]) -> OwnBroker | OtherBroker:
    """The broker that is wanted; StartError where there can be none."""
    if "broker" in parts and model.mqtt_version is not MqttVersion.V3_1_1:
        raise StartError("the plant's own broker speaks MQTT 3.1.1 only; name another one with --broker")
    if "broker" not in parts:
        return OtherBroker(address(options.broker or f"127.0.0.1:{MQTT_PORT}"), options.credentials)
    names = frozenset(robot.mqtt for robot in model.robots.values())
    found_by_port = options.broker_users is not None or "bridge" not in parts
    return OwnBroker(
        options.broker_host, options.broker_users, names, found_by_port=found_by_port, tls=options.broker_tls
    )


def _nothing() -> None: ...
