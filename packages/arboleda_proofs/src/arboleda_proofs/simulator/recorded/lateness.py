"""Greatest age of what reaches the plant: reports wait where the bridge stalled, and on slow lines."""

from __future__ import annotations

from arboleda.rig.world import BRIDGE, World

SLOW_S = 10.0  # after the last sign of it, a bridge that stalled or a slow line may still have old reports


class Lateness:
    """Follows signs that reports are late; until `SLOW_S` after the last sign they may be of any age."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._slow_until = world.now
        self._skipped_s = world.skipped_s

    def look(self) -> None:
        world, now = self._world, self._world.now
        inbox, skipped_s = world.broker.clients[BRIDGE].inbox, world.skipped_s
        skips = skipped_s != self._skipped_s
        if skips or world.to_plant.troubles or (inbox and inbox[0].at < now):
            self._skipped_s = skipped_s
            self.expect_old()

    def expect_old(self) -> None:
        """Old reports may come, as a bridge tells a new plant all that it knows."""
        self._slow_until = self._world.now + SLOW_S

    def reports_from_s(self, at: float) -> float:
        """The time since when a position that reached the plant at `at` may have been reported."""
        return 0.0 if at < self._slow_until else at - self._world.model.timing.stale_after_s
