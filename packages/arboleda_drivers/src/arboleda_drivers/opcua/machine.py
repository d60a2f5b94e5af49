"""Device behind OPC UA: the call or the writes for a command; reading and reports are the handshake's."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from arboleda.drivers import Command, Robot, Stop, Value
from arboleda_drivers.plc.handshake import Handshake, Read, stop_order

from .nodes import Order
from .settings import Settings

__all__ = ["Call", "NodeValue", "OpcUaDevice", "Read", "Writing"]


@dataclass(frozen=True, kw_only=True)
class Call:
    """Method to call, with its arguments, each with its type in OPC UA."""

    method: str
    on: str
    given: tuple[tuple[str, Value], ...] = ()


@dataclass(frozen=True, kw_only=True)
class NodeValue:
    """Value to write to a node, with its type in OPC UA."""

    node: str
    type: str
    value: Value


@dataclass(frozen=True, kw_only=True)
class Writing:
    """Values to write, one step after another; those of a step in any order.

    `begins_last`: the device does nothing before the last step, so one that fails has begun nothing.
    """

    steps: tuple[tuple[NodeValue, ...], ...]
    begins_last: bool


class OpcUaDevice(Handshake):
    """Device behind OPC UA: makes calls and writes of commands, and reports of values read."""

    def __init__(self, device: Robot, settings: Settings) -> None:
        super().__init__(device, settings)
        self._mapping = settings

    def order(self, command: Command) -> Call | Writing | None:
        """The call or writing for a command; None for a stop without either, NotSent for no such verb."""
        if isinstance(command, Stop):
            stop = stop_order(self._mapping, command.mode)
            return None if stop is None else _made(stop, {}, None)
        called, sequence = self.verb(command), self._mapping.sequence
        verb, values = self._mapping.verbs[called.verb], dict(called.values)
        if sequence is None:
            return _made(verb, values, None)
        given = self.number(called)
        value = float(given) if sequence.floats else given
        return _made(verb, values, NodeValue(node=sequence.write or "", type=sequence.type, value=value))


def _made(order: Order, values: Mapping[str, Value], number: NodeValue | None) -> Call | Writing:
    """An order, with the values of its verb put in, and the number of its command last."""
    if order.call is not None and order.on is not None:
        given = tuple((each.type, each.filled(values)) for each in order.given)
        last = () if number is None else ((number.type, number.value),)
        return Call(method=order.call, on=order.on, given=(*given, *last))
    puts = tuple(NodeValue(node=each.node, type=each.type, value=each.filled(values)) for each in order.write)
    if number is None:
        return Writing(steps=tuple((put,) for put in puts), begins_last=len(puts) == 1)
    return Writing(steps=(puts, (number,)), begins_last=True)
