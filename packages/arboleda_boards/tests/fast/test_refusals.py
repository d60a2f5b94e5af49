"""What `arboleda conformance` refuses before anything starts."""

from __future__ import annotations

from tests.unit.cli.test_refusals import Typed
from tests.unit.cli.test_refusals import typed as typed


def test_a_robot_of_a_kind_that_is_not_tested_is_refused_with_those_that_are(typed: Typed) -> None:
    status, said = typed("conformance", "--robot", "rm_sis_a", "--yes")
    assert status == 2 and "there are ra1, ra2, ra3, ra_1, ra_2, ra_3" in said
