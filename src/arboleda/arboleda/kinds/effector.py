"""An effector that is on or off, as a device of its own: a suction cup, a magnet."""

from __future__ import annotations

from arboleda.kinds import Kind, kind, switch


@kind("effector")
def effector() -> Kind:
    """Holds a part while it is on: a suction cup, a magnet."""
    return Kind(
        facts={"on": bool},
        verbs={
            "grip": switch(sets={"on": True}, holds_part=True),
            "let_go": switch(sets={"on": False}, holds_part=True),
        },
    )
