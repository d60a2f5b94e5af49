"""The command `arboleda virtual gcode`."""

from __future__ import annotations

import pytest
import typer

from arboleda.virtual.gcode.command import Dialect, run


def test_marlin_cannot_begin_homed() -> None:
    with pytest.raises(typer.BadParameter, match="does not tell whether it is homed"):
        run(dialect=Dialect.MARLIN, homed=True)
