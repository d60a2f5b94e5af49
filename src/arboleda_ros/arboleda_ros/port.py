"""Base of the ROS 2 ports: a node, its topics and its health."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.clock import Clock, ClockType
from rclpy.node import Node

from arboleda.runtime.host_claim import node_claim
from arboleda.wire.status import ERROR, OK, WARN
from arboleda_ros import qos, statuses
from arboleda_ros.exclusive_topics import DISCOVERY_S
from arboleda_ros.node_topics import NodeTopics

NAMED = "arboleda: "  # prefix of the names of all our statuses
_DIAGNOSTICS_S = 1.0


@dataclass(frozen=True, kw_only=True)
class PortHealth:
    """Health of a port for `/diagnostics`: sentences to warn of, errors, and counts since the start."""

    warnings: tuple[str, ...]
    errors: tuple[str, ...]
    refused: int
    failures: int


class Port:
    """One node with its `topics`, which tells its health."""

    def __init__(self, node: Node, clock: Callable[[], float]) -> None:
        self._node = node
        self._clock = clock
        self.topics = NodeTopics(node, clock, self._tell_health)
        self._claim = node_claim(node.context.get_domain_id(), node.get_fully_qualified_name())
        self._intrusions: tuple[str, ...] = ()  # as told last
        self._diagnostics = self.topics.speak(DiagnosticArray, "/diagnostics", qos.COMMAND)
        node.create_timer(_DIAGNOSTICS_S, self._tell_health, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def check_alone(self, wait_s: float = DISCOVERY_S) -> None:
        """Raise StartError as soon as another node is found that publishes what only this one may."""
        self._claim.take()
        self.topics.alone.check(wait_s)

    def close(self) -> None:
        """End everything that others still wait for; the executor runs on until they know."""

    def destroy(self) -> None:
        """Release everything that does not end with the node; nothing is delivered any more."""
        self._claim.release()

    def health(self) -> PortHealth:
        """The health now; a node that joined topics of this port's own is logged, each time it comes."""
        errors = self.topics.alone.look()
        for sentence in errors:
            if sentence not in self._intrusions:
                self.topics.log.error(sentence)
        self._intrusions = errors
        return PortHealth(
            warnings=tuple(self.topics.warnings),
            errors=errors,
            refused=self.topics.refused,
            failures=self.topics.failures,
        )

    def _diagnosed(self, what: str) -> str:
        """The name of a status with its namespace, as plants of all namespaces share `/diagnostics`."""
        namespace = self._node.get_namespace().strip("/")
        return f"{NAMED}{namespace}/{what}" if namespace else f"{NAMED}{what}"

    def _publish_diagnostics(self, status: list[DiagnosticStatus]) -> None:
        message = DiagnosticArray(status=status)
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._diagnostics.publish(message)

    def _links(self) -> list[DiagnosticStatus]:
        """The diagnostic statuses of further links of this node."""
        return []

    def _tell_health(self) -> None:
        health = self.health()
        level = ERROR if health.errors else WARN if health.warnings or health.failures else OK
        sentence = "; ".join(health.errors + health.warnings) or "ready"
        counts = {"refused": str(health.refused), "failures": str(health.failures)}
        name = self._diagnosed(f"{self._node.get_name()} on ROS 2")
        here = statuses.diagnostic(name, "ros", level, sentence, counts)
        self._publish_diagnostics([here, *self._links()])
