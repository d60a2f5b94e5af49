"""`arboleda virtual`: its help, and what it refuses before anything starts."""

from __future__ import annotations

from tests.unit.cli.test_overview import help_of, is_whole
from tests.unit.cli.test_refusals import Typed
from tests.unit.cli.test_refusals import typed as typed


def test_no_sentence_of_the_group_is_cut_off() -> None:
    assert is_whole(help_of("virtual", "--help"))


def test_a_fault_that_a_controller_does_not_have_is_refused(typed: Typed) -> None:
    status, said = typed("virtual", "dobot", "--fault", "mut")
    assert status == 2 and "no fault 'mut'" in said
