"""Motors of an arm: what they have counted, and where its joints truly are."""

from __future__ import annotations

from arboleda.kinds.joints import Joint

from .axis import Axis

FASTEST = 1e6  # steps/s: one per microsecond of the board's clock
STEEPEST = 9e11  # steps/s2: beyond it the ramp's first interval falls below a microsecond


class Motors:
    """One stepper per joint; `drift` is the true position minus the counted one, in motor steps per joint."""

    def __init__(self, joints: tuple[Joint, ...]) -> None:
        self._joints = joints
        self.axes = tuple(_axis(joint) for joint in joints)
        self.drift = (0,) * len(joints)

    @property
    def position(self) -> tuple[int, ...]:
        """The counted positions, in motor steps per joint."""
        return tuple([axis.position for axis in self.axes])

    @property
    def true_position(self) -> tuple[int, ...]:
        """The true positions of the axes, in motor steps per joint."""
        return tuple([axis.position + drift for axis, drift in zip(self.axes, self.drift, strict=True)])

    @property
    def targets(self) -> tuple[int, ...]:
        """The goals of the axes, in motor steps per joint."""
        return tuple(axis.target for axis in self.axes)

    @property
    def speeds(self) -> tuple[float, ...]:
        """The speed of each joint, in motor steps/s, without a sign."""
        return tuple(axis.speed for axis in self.axes)

    def lose_steps(self, joint: int, steps: int) -> None:
        """Slip by so many motor steps; the counter does not notice."""
        drift = list(self.drift)
        drift[joint] += steps
        self.drift = tuple(drift)

    def steps(self, q: tuple[float, ...]) -> tuple[int, ...]:
        """Joint positions in rad and m as motor steps."""
        return tuple(joint.steps(value) for joint, value in zip(self._joints, q, strict=True))

    def move_to(self, now_us: int, targets: tuple[int, ...]) -> int:
        """Head for targets; returns the time (us) of the arrival."""
        for axis, target in zip(self.axes, targets, strict=True):
            axis.move_to(now_us, target)
        return self._still_at_us(now_us)

    def stop(self, now_us: int) -> int:
        """Begin the ramp down; returns the time (us) at which it is over."""
        for axis in self.axes:
            axis.stop(now_us)
        return self._still_at_us(now_us)

    def _still_at_us(self, now_us: int) -> int:
        """The time at which the slowest axis comes to rest; a move of no length takes a moment, too."""
        return max(now_us + 1, *(axis.still_at_us for axis in self.axes))

    def count_anew(self) -> None:
        """Set the counters to the true positions."""
        for axis, drift in zip(self.axes, self.drift, strict=True):
            axis.shift(drift)
        self.drift = (0,) * len(self._joints)

    def restart(self) -> None:
        """Count from 0, wherever the axes are."""
        self.drift = self.true_position
        self.axes = tuple(_axis(joint) for joint in self._joints)

    def put_at(self, position: tuple[int, ...]) -> None:
        """Move the resting axes by hand to a position that is counted rightly."""
        self.drift = (0,) * len(self._joints)
        self.axes = tuple(_axis(joint) for joint in self._joints)
        for axis, steps in zip(self.axes, position, strict=True):
            axis.shift(steps)


def _axis(joint: Joint) -> Axis:
    return Axis(
        max_speed=min(joint.speed / joint.step, FASTEST),
        acceleration=min(joint.acceleration / joint.step, STEEPEST),
    )
