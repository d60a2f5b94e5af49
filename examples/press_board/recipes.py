"""What the press does with a part that lies in it."""

from __future__ import annotations

from arboleda.recipes import Choice, recipe, work


@recipe("stamp")
def stamp(cell, program: Choice[1, 2]):
    """Clamp the part, press it and give it free again, where there is one."""
    press = cell.device("press")
    seen = press.look()
    pressed = [press.clamp(on=True), press.close(), press.press(program=program), press.relieve()]
    freed = [press.open(), press.clamp(on=False)]
    return work(
        seen, cell.choose(seen, {"present": [*pressed, *freed], "absent": cell.fail("there is no part")})
    )
