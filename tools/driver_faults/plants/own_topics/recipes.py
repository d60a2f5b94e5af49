"""There and back."""

from typing import Any

from arboleda.recipes import recipe, work


@recipe("swing")
def swing(cell: Any) -> Any:
    arm = cell.device("arm")
    return work(arm.turn(to=90), arm.turn(to=0))
