"""Variables, arguments and methods of a server, by their nodes."""

from __future__ import annotations

import re
from dataclasses import dataclass

from arboleda.drivers import DriverError, quoted
from arboleda_drivers.plc.variables import FORMS, Form, PlcArgument, PlcVariable

NODE = re.compile(r"(ns=\d+;|nsu=[^;]+;)?(i=\d+|s=.+|g=[0-9a-fA-F-]{36}|b=.+)")
NUMBERS = (*FORMS[int], *FORMS[float])


def check_node(node: str) -> None:
    """Raises DriverError if a text is no id of a node."""
    if not NODE.fullmatch(node):
        forms = "ns=2;s=Belt.State, nsu=http://maker.example/belt;s=State or ns=2;i=1001"
        raise DriverError(f"{quoted(node)} is no node; write it as {forms}")


def namespace(node: str) -> str | None:
    """The URI of the namespace that an id names; None for one that has a number in its place."""
    return node.removeprefix("nsu=").partition(";")[0] if node.startswith("nsu=") else None


def check_number(key: str, type: Form) -> None:
    """Raises DriverError if the type of a key is none of numbers."""
    if type not in NUMBERS:
        raise DriverError(f"{key} is {type}; allowed: {', '.join(NUMBERS)}")


@dataclass(frozen=True, kw_only=True)
class Variable(PlcVariable):
    """Variable of the server."""

    node: str

    def __post_init__(self) -> None:
        check_node(self.node)
        super().__post_init__()

    @property
    def place(self) -> str:
        return self.node


@dataclass(frozen=True, kw_only=True)
class Argument(PlcArgument):
    """Argument of a method: a value, or `$name` for the verb's parameter, and its type in OPC UA."""

    type: Form

    @property
    def form(self) -> Form:
        return self.type

    @property
    def type_name(self) -> str:
        return self.type


@dataclass(frozen=True, kw_only=True)
class Write(Argument):
    """Variable to write to, with the value."""

    node: str

    def __post_init__(self) -> None:
        super().__post_init__()
        check_node(self.node)


@dataclass(frozen=True, kw_only=True)
class Order:
    """Way to give an order: a method with its object and arguments, or values to write, in this order."""

    call: str | None = None
    on: str | None = None
    given: tuple[Argument, ...] = ()
    write: tuple[Write, ...] = ()

    def __post_init__(self) -> None:
        if (self.call is None) == (not self.write):
            raise DriverError("needs either call, a method, or write, a list of variables with their values")
        if self.call is None and (self.on is not None or self.given):
            raise DriverError("on and given belong to call; write has its values in its list")
        if self.call is not None and self.on is None:
            raise DriverError("call needs on, the object that the method belongs to")
        for node in (self.call, self.on):
            if node is not None:
                check_node(node)
