"""Every name that a command had goes on: it does what the new one does, and says the new one."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli import verbs
from arboleda.cli.commands import commands
from arboleda.cli.main import cli
from arboleda.cli.old_names import GONE, OLD_NAMES
from arboleda.model.verbs import Verb

WORDS = {  # as they were typed
    "automatic": ("sis_a",),
    "logs": ("nowhere.mcap", "--cell", "sis_a", "--follow"),
    "replay": ("nowhere.mcap", "--task", "lot42", "--set", "timing.stale_after_s=3"),
    "run": ("sis_x 0B 7", "--no-ros", "--rate", "10", "--wait-for-devices", "20"),
    "unload": ("sis_a", "7"),
    "versions": ("--plant", "nowhere.yaml"),
}


class Notes(list[tuple[Verb, str]]):
    """Stands for the plant: verb and scope of every act."""

    def operate(self, verb: Verb, scope: str, **_: object) -> dict[str, object]:
        self.append((verb, scope))
        return {}


def typed(*words: str) -> tuple[int, str, str]:
    """Exit status, output without the line on the name, and that line."""
    ran = CliRunner().invoke(cli, words)
    told, _, others = ran.output.partition("\n") if "is called" in ran.output else ("", "", ran.output)
    return ran.exit_code, f"{others}{ran.exception}", told


@pytest.fixture(autouse=True)
def acts(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Notes:
    acts = Notes()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(verbs, "client", lambda *_: acts)
    return acts


@pytest.mark.parametrize(("old", "new"), OLD_NAMES.items())
def test_an_old_name_does_what_the_new_one_does(old: str, new: tuple[str, ...], acts: Notes) -> None:
    status, output, told = typed(old, *WORDS[old])
    before = [*acts]
    assert told.startswith(f"`arboleda {old}` is called `arboleda {' '.join(new)}`")
    assert (status, output, "") == typed(*new, *WORDS[old])
    assert acts == before * 2
    assert "No such" not in output and "nexpected" not in output


@pytest.mark.parametrize("gone", GONE)
def test_a_command_that_is_gone_says_what_does_it_now(gone: str) -> None:
    status, output, _ = typed(gone, "--plant", "nowhere.yaml")
    assert status == 2 and output.startswith(f"`arboleda {gone}` is gone: ") and output.count("\n") == 1


@pytest.mark.parametrize("old", [*OLD_NAMES, *GONE])
def test_an_old_name_is_in_no_list(old: str) -> None:
    assert old not in commands()
    for topic in ("", "run", "operate", "make", "test", "history"):
        listed = typed("help", *([topic] if topic else []))[1]
        assert f"\n  {old} " not in listed


def test_what_was_typed_for_every_old_name_is_tried() -> None:
    assert list(WORDS) == list(OLD_NAMES)
