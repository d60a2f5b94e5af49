"""The command `arboleda virtual gcode`."""

from __future__ import annotations

from typing import Any

import pytest
import typer

from arboleda_drivers.gcode.virtual.command import Dialect, run


def test_marlin_cannot_begin_homed() -> None:
    with pytest.raises(typer.BadParameter, match="does not tell whether it is homed"):
        run(dialect=Dialect.MARLIN, homed=True)


@pytest.mark.parametrize("wrong", [{"homed": True}, {"link": "/tmp/line"}])
def test_moonraker_is_at_a_port_and_begins_not_homed(wrong: dict[str, Any]) -> None:
    with pytest.raises(typer.BadParameter, match="begins not homed, at a port"):
        run(dialect=Dialect.MOONRAKER, **wrong)
