"""The virtual board of a SCARA under a script, and what may happen to the arm that it moves."""

from __future__ import annotations

from dataclasses import replace

from arboleda.kinds.arm import Arm
from arboleda.model.plant_model import Evidence
from arboleda.sim.arm import ArmBody
from arboleda.sim.board import Board
from arboleda.testing import shipped

from .author import FIRST_BOOT
from .scripts import CHANNELS, PLACES, Setting
from .virtual import Virtual


class Reference(Virtual):
    """One virtual SCARA, told the lines of a script."""

    def __init__(self, setting: Setting, now_us: int) -> None:
        arm = shipped("sis_a").cell("sis_a").roles["arm"]
        assert isinstance(arm, Arm)
        self.arm: Arm = replace(arm, evidence=Evidence.IDS if setting.ids else Evidence.JOINTS)
        self.body = ArmBody(
            self.arm, start=self._si(setting.start), pickups=[self._si(place) for place in PLACES]
        )
        board = Board(self.arm, self.body, boot_id=FIRST_BOOT, now_us=now_us)
        super().__init__(self.arm, board, now_us, CHANNELS)

    def _si(self, steps: tuple[int, ...]) -> tuple[float, ...]:
        return tuple(count * joint.step for count, joint in zip(steps, self.arm.joints, strict=True))

    def _reboot(self, boot_id: str, homed: str = "1") -> None:
        self.board._assume_homed = homed == "1"
        super()._reboot(boot_id)

    def _slip(self, joint: str, steps: str) -> None:
        self.body.motors.lose_steps(int(joint), int(steps))

    def _drop(self) -> None:
        self.body.lose_piece()

    def _supplied(self, yes: str) -> None:
        self.body.supplied = yes == "1"

    def _grips(self, yes: str) -> None:
        self.body.grips = yes == "1"

    def _stuck(self, yes: str) -> None:
        self.body.stuck = yes == "1"

    def _probe(self) -> None:
        numbers = (*self.body.motors.position, *self.body.motors.true_position, self.board.refusals)
        self.said.append(f"{self.now_us} @ " + " ".join(str(number) for number in numbers))
