"""Hand of a robot in a drawn recipe: its tool, or its own effector."""

from __future__ import annotations

from arboleda_proofs.simulator.chance import Dice

from .layout import Layout, Need
from .steps import Grip, LetGo, Step, Tell


class Hand:
    """Hand: how a robot takes hold and lets go, and what has to be so before."""

    def __init__(self, layout: Layout, role: str, dice: Dice) -> None:
        self.role = role
        self.tool = layout.robot(role).tool
        self._layout = layout
        self._dice = dice

    @property
    def grip(self) -> tuple[Step, list[Need]]:
        """The step, and its needs."""
        return self._with_tool("close" if self._kind == "gripper" else "grip", Grip(role=self.role))

    @property
    def let_go(self) -> tuple[Step, list[Need]]:
        return self._with_tool("open" if self._kind == "gripper" else "let_go", LetGo(role=self.role))

    @property
    def _kind(self) -> str:
        return self._layout.device(self.tool).kind.name if self.tool else ""

    def _with_tool(self, verb: str, own: Step) -> tuple[Step, list[Need]]:
        if not self.tool:
            return own, []
        known = self._layout.device(self.tool).kind.verb(verb)
        values = (("width_mm", 30), ("force_n", self._dice.pick((5, 40)))) if verb == "close" else ()
        return Tell(role=self.tool, verb=verb, values=values), self._layout.all_needs(self.tool, known)
