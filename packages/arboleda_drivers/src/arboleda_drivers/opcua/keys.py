"""Keys of a device behind OPC UA in a plant file."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Literal

from arboleda.drivers import DriverError
from arboleda_drivers.plc.limits import Watched, check_alive, check_sequence
from arboleda_drivers.plc.numbers import LAST
from arboleda_drivers.plc.variables import FORMS, LIMITS, Form

from .nodes import Order, Variable, check_node, check_number


@dataclass(frozen=True, kw_only=True)
class Verb(Order):
    """Call or writing for a verb, and the variable with the answer to a query."""

    answer: Variable | None = None


@dataclass(frozen=True, kw_only=True)
class Sequence:
    """Variables for the number of a command, which a method takes as its last argument, and of which `write`
    is written last where a verb is written; and those that echo it.

    `busy` is for a program that echoes no accepted number, `error` for one that has a code for how the last
    command ended in place of other numbers.
    """

    done: str
    accepted: str | None = None
    type: Form = "uint16"
    write: str | None = None
    busy: str | None = None
    error: Variable | None = None
    rejected: str | None = None
    reason: Variable | None = None
    failed: str | None = None
    failure: Variable | None = None

    def __post_init__(self) -> None:
        check_number("type", self.type)
        check_sequence(self)
        for node in (self.accepted, self.done, self.write, self.busy, self.rejected, self.failed):
            if node is not None:
                check_node(node)

    @property
    def greatest(self) -> int:
        """The greatest number of a command of that type."""
        return LIMITS[self.type][1] if self.type in LIMITS else LAST

    @property
    def floats(self) -> bool:
        """True if numbers are shown as floats."""
        return self.type in FORMS[float]


@dataclass(frozen=True, kw_only=True)
class OpcUaKeys(Watched):
    """Keys of the driver `opcua`: the connection, and the mapping of one device.

    Passwords are in the environment, under the prefix `secrets`.
    """

    url: str
    security: Literal["none", "sign", "sign_and_encrypt"] = "sign_and_encrypt"
    policy: Literal["basic256sha256", "aes128_sha256_rsaoaep", "aes256_sha256_rsapss"] = "basic256sha256"
    secrets: str = "ARBOLEDA_OPCUA"
    user: str | None = field(default=None, metadata={"hidden": True})
    password: str | None = field(default=None, metadata={"hidden": True})
    publish_s: float = 0.05
    timeout_s: float = 0.5
    state: Variable | None = None
    boot: str | None = None
    alive: str | None = None
    alive_s: float = 1.0
    heartbeat: str | None = None
    heartbeat_type: Form = "uint16"
    facts: dict[str, Variable] = field(default_factory=dict)
    verbs: dict[str, Verb] = field(default_factory=dict)
    sequence: Sequence | None = None
    halt: Order | None = None
    latch: Order | None = None
    clear: Order | None = None

    def __post_init__(self) -> None:
        if not re.fullmatch(r"[A-Z][A-Z0-9_]*", self.secrets):
            raise DriverError("secrets is how names in the environment begin: capitals, digits and _")
        if "@" in self.url or self.user is not None or self.password is not None:
            names = f"{self.secrets}_USER and {self.secrets}_PASSWORD"
            raise DriverError(f"user and password are never in a plant file; set {names} in the environment")
        if not re.fullmatch(r"opc\.tcp://[^\s/:]+:\d{1,5}(/\S*)?", self.url):
            raise DriverError(f"url is {self.url}; write opc.tcp://10.0.0.30:4840")
        if not 0.01 <= self.publish_s <= 0.5:
            raise DriverError(f"publish_s is {self.publish_s:g}; allowed: 0.01 to 0.5")
        if not 0.05 <= self.timeout_s <= 5:
            raise DriverError(f"timeout_s is {self.timeout_s:g}; allowed: 0.05 to 5")
        check_alive(self.alive_s)
        check_number("heartbeat_type", self.heartbeat_type)
        for node in (self.boot, self.alive, self.heartbeat):
            if node is not None:
                check_node(node)
