"""Refusals before anything starts."""

from __future__ import annotations

from pathlib import Path

from tests.unit.cli.test_refusals import Typed
from tests.unit.cli.test_refusals import shown as shown
from tests.unit.cli.test_refusals import typed as typed


def test_a_robot_of_a_kind_that_is_not_tested_is_refused_with_those_that_are(typed: Typed) -> None:
    status, said = typed("conformance", "--robot", "rm_sis_a", "--yes")
    assert status == 2 and "there are ra1, ra2, ra3, ra_1, ra_2, ra_3" in said


def test_the_firmwares_boards_are_refused_where_the_own_broker_speaks_tls(
    typed: Typed, shown: tuple[str, ...], tmp_path: Path
) -> None:
    users = tmp_path / "users.txt"
    users.write_text("ra_9:secret\n")
    broker = ("--broker-host", "127.0.0.1", "--broker-users", str(users), "--broker-tls")
    status, said = typed("up", "--once", "sis_a 0B 7", "--no-ros", "--boards", "linux", *broker, *shown)
    assert status == 1 and "the firmware's boards speak no TLS" in said
