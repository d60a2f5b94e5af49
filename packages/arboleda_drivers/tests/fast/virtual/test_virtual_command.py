"""`arboleda virtual`: its help, and what it refuses before anything starts."""

from __future__ import annotations

from typing import Any

import pytest
import typer
from tests.unit.cli.test_overview import help_of, is_whole
from tests.unit.cli.test_refusals import Typed
from tests.unit.cli.test_refusals import typed as typed

from arboleda_drivers.gcode.virtual.command import Dialect, run


def test_no_sentence_of_the_group_is_cut_off() -> None:
    assert is_whole(help_of("virtual", "--help"))


def test_a_fault_that_a_controller_does_not_have_is_refused(typed: Typed) -> None:
    status, said = typed("virtual", "dobot", "--fault", "mut")
    assert status == 2 and "no fault 'mut'" in said


def test_marlin_cannot_begin_homed() -> None:
    with pytest.raises(typer.BadParameter, match="does not tell whether it is homed"):
        run(dialect=Dialect.MARLIN, homed=True)


@pytest.mark.parametrize("wrong", [{"homed": True}, {"link": "/tmp/line"}])
def test_moonraker_is_at_a_port_and_begins_not_homed(wrong: dict[str, Any]) -> None:
    with pytest.raises(typer.BadParameter, match="begins not homed, at a port"):
        run(dialect=Dialect.MOONRAKER, **wrong)
