"""`arboleda --help`."""

from __future__ import annotations

from collections import Counter

import pytest
from typer.main import get_command
from typer.testing import CliRunner

from arboleda.cli import overview
from arboleda.cli.commands import OURS
from arboleda.cli.main import cli


def test_each_command_is_listed_below_one_heading() -> None:
    listed = Counter(
        name for names in overview.Overview(name="arboleda").sections(None).values() for name in names
    )
    assert listed == Counter(list(get_command(cli).commands))  # type: ignore[attr-defined]


def test_a_heading_whose_package_is_not_installed_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(overview, "commands", lambda: OURS)
    assert "Learn it" not in overview.Overview(name="arboleda").sections(None)


@pytest.mark.parametrize("group", [(), ("virtual",), ("record",), ("service",)])
def test_no_sentence_is_cut_off(group: tuple[str, ...]) -> None:
    shown = CliRunner().invoke(cli, [*group, "--help"])
    assert shown.exit_code == 0 and "..." not in shown.output.partition("[ARGS]...")[2]
    assert "e.g.\n" not in shown.output
