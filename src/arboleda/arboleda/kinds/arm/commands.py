"""Commands of arms beside those of any robot of joints."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.model.commands import Switch
from arboleda.model.facts import Facts


@dataclass(frozen=True, kw_only=True)
class SetEffector(Switch):
    """Switch an arm's effector; `on`: it takes hold of a part."""

    on: bool

    @property
    def sets(self) -> Facts:
        return (("effector", self.on),)

    @property
    def grips(self) -> bool:
        return self.on
