"""Bodies of boards with axes: of an arm with its effector and virtual piece, and of axes alone."""

from __future__ import annotations

from collections.abc import Collection

from arboleda.kinds.joints import Joint, Jointed
from arboleda.model.facts import Value
from arboleda.wire import units
from arboleda.wire.payloads import JointsGoal
from arboleda.wire.topics import Channel

from .body import BodyReport, Robotic, SeenState
from .motors import Motors

WIRE_ROUNDING_DEG = 1e-4


class ArmBody(Robotic):
    """Body of an arm: its `motors` and its effector; `start` and `pickups` are joint positions in rad and m.

    The piece sensor sees the piece that lies ready at each pick-up, and the one in the effector. `supplied`
    False: no piece lies there; `grips` False: the effector closes beside the piece; `stuck`: the effector
    does not follow its switch.
    """

    channels = frozenset({Channel.JOINTS, Channel.EFFECTOR, Channel.STOP, Channel.HOME, Channel.BEAT})

    def __init__(
        self, arm: Jointed, *, start: tuple[float, ...], pickups: Collection[tuple[float, ...]]
    ) -> None:
        self.axes: int | None = len(arm.joints)
        self._joints = arm.joints
        self._step_deg = tuple(units.to_wire(joint, joint.step) for joint in arm.joints)
        self.motors = Motors(arm.joints)
        self._pickups = {self.motors.steps(pickup) for pickup in pickups}
        self.supplied = self.grips = True
        self.stuck = False
        self._last_state: tuple[object, ...] = ()  # the values that `_last_report` was made of
        self._last_report = BodyReport()
        self.reset()
        self.motors.put_at(self.motors.steps(start))

    def reset(self) -> None:
        """Reset as a board comes up: counters 0, effector off; the axes stay where they are."""
        self.motors.restart()
        self.next_change_us: int | None = None
        self.effector = False
        self.holding = False

    @property
    def moving(self) -> bool:
        return self.next_change_us is not None

    @property
    def true_place(self) -> tuple[float, ...]:
        rows = zip(self._joints, self.motors.true_position, strict=True)
        return tuple(joint.step * steps for joint, steps in rows)

    @property
    def true_facts(self) -> dict[str, Value]:
        return {"effector": self.effector}

    def admits(self, goal: JointsGoal) -> bool:
        return all(_within(joint, angle) for joint, angle in zip(self._joints, goal.q_deg, strict=True))

    def start(self, now_us: int, goal: JointsGoal) -> None:
        values = (
            units.from_wire(joint, angle) for joint, angle in zip(self._joints, goal.q_deg, strict=True)
        )
        self.next_change_us = self.motors.move_to(now_us, self.motors.steps(tuple(values)))

    def home(self, now_us: int) -> None:
        """Drive to the switches: each axis gets to its true 0, whatever its counter says."""
        self.motors.count_anew()
        self.next_change_us = self.motors.move_to(now_us, (0,) * len(self._joints))

    def stop(self, now_us: int) -> None:
        self.next_change_us = self.motors.stop(now_us)

    def advance(self, now_us: int) -> None:
        if self.next_change_us is None:
            return
        for axis in self.motors.axes:
            axis.advance(now_us)
        if now_us >= self.next_change_us:
            self.next_change_us = None
            self._grip()

    def switch_effector(self, on: bool) -> None:
        if self.stuck:
            return
        self.effector = on
        self.holding = self.holding and on
        self._grip()

    def take_out(self) -> None:
        """Open the effector by hand, even one that does not follow its switch, and take the piece."""
        self.effector = False
        self.lose_piece()

    def lose_piece(self) -> None:
        """Drop the piece; the effector does not notice."""
        self.holding = False

    def place(self, seen: SeenState, *, holds: bool) -> None:
        if seen.q is not None:
            self.motors.put_at(self.motors.steps(seen.q))
        self.effector = self.effector if seen.effector is None else seen.effector
        self.holding = holds

    def put_at_reference(self) -> None:
        self.motors.put_at((0,) * len(self._joints))

    def tell(self) -> BodyReport:
        position, drift = self.motors.position, self.motors.drift
        state = (position, drift, self.next_change_us, self.effector, self.holding, self.supplied)
        if state != self._last_state:
            self._last_state = state
            q_deg = tuple([steps * step for steps, step in zip(position, self._step_deg, strict=True)])
            self._last_report = BodyReport(
                q_deg, None, self.effector, self.holding or self._piece_lies_here()
            )
        return self._last_report

    def _piece_lies_here(self) -> bool:
        return self.supplied and not self.moving and self.motors.true_position in self._pickups

    def _grip(self) -> None:
        self.holding = self.holding or (self.effector and self.grips and self._piece_lies_here())


class AxesBody(ArmBody):
    """Body of axes without an effector, to which nothing says that it holds a part."""

    channels = ArmBody.channels - {Channel.EFFECTOR}

    @property
    def true_facts(self) -> dict[str, Value]:
        return {}

    def tell(self) -> BodyReport:
        return super().tell()._replace(effector=None, piece=None)


def limits_deg(joint: Joint) -> tuple[float, float]:
    """The least and the greatest target on the wire: a limit, or the nearest motor step."""
    lower = min(joint.lower, joint.quantised(joint.lower))
    upper = max(joint.upper, joint.quantised(joint.upper))
    least, most = units.to_wire(joint, lower), units.to_wire(joint, upper)
    return least - WIRE_ROUNDING_DEG, most + WIRE_ROUNDING_DEG


def _within(joint: Joint, angle: float) -> bool:
    least, most = limits_deg(joint)
    return least <= angle <= most
