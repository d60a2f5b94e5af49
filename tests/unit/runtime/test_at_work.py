"""What the last start of a plant was made of, and the command line as a person types it again."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from tests.cuts import each_cut

from arboleda.model.plant_files import PlantFiles
from arboleda.runtime import at_work, invocation

AT = "2026-11-25T20:00:00+00:00"


def files(content: bytes) -> PlantFiles:
    return PlantFiles(plant="p.yaml", contents={"p.yaml": content, "r.py": b"1"})


def test_each_start_replaces_what_the_last_one_was_made_of(tmp_path: Path) -> None:
    assert at_work.version(tmp_path) is None
    for content in (b"name: a", b"name: b"):
        at_work.keep(tmp_path, files(content), AT)
    found = at_work.version(tmp_path)
    assert (
        found is not None and found.files.contents == {"p.yaml": b"name: b"} and [*found.others] == ["r.py"]
    )
    assert [each.name for each in tmp_path.iterdir()] == [at_work.FOLDER]


def test_of_a_start_without_a_record_nothing_is_known(tmp_path: Path) -> None:
    at_work.keep(tmp_path, files(b"name: a"), AT)
    at_work.keep(tmp_path, None, AT)
    assert at_work.version(tmp_path) is None


def test_a_kill_leaves_what_was_at_work_before_or_what_is_now(tmp_path: Path) -> None:
    state = tmp_path / "state"
    at_work.keep(state, files(b"name: a"), AT)
    for cut in each_cut(state, lambda: at_work.keep(state, files(b"name: b"), AT)):
        found = at_work.version(state)
        if not cut.power:
            assert found is not None and found.files.contents["p.yaml"] in (b"name: a", b"name: b"), cut


def test_a_start_goes_on_after_a_power_cut(tmp_path: Path) -> None:
    state = tmp_path / "state"
    at_work.keep(state, files(b"name: a"), AT)
    for cut in each_cut(state, lambda: at_work.keep(state, files(b"name: b"), AT)):
        at_work.keep(state, files(b"name: c"), AT)
        found = at_work.version(state)
        assert found is not None and found.files.contents["p.yaml"] == b"name: c", cut


@pytest.mark.parametrize(
    ("pip", "uv", "said"),
    [
        (object(), "/bin/uv", "python -m pip install"),
        (None, "/bin/uv", f"uv pip install --python {sys.executable}"),
        (None, None, "python -m pip install"),
    ],
)
def test_what_installs_is_there(
    pip: object, uv: str | None, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(invocation, "find_spec", lambda _name: pip)
    monkeypatch.setattr(invocation.shutil, "which", lambda name: uv if name == "uv" else f"/bin/{name}")
    assert invocation.pip_install() == said
