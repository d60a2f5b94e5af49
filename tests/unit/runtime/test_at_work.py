"""What the last start of a plant was made of."""

from __future__ import annotations

from pathlib import Path

from arboleda.recorder.preamble import PlantFiles
from arboleda.runtime import at_work

AT = "2026-11-25T20:00:00+00:00"


def files(content: bytes) -> PlantFiles:
    return PlantFiles(plant="p.yaml", contents={"p.yaml": content, "r.py": b"1"})


def test_each_start_replaces_what_the_last_one_was_made_of(tmp_path: Path) -> None:
    assert at_work.known(tmp_path) is None
    for content in (b"name: a", b"name: b"):
        at_work.keep(tmp_path, files(content), AT)
    found = at_work.known(tmp_path)
    assert (
        found is not None and found.files.contents == {"p.yaml": b"name: b"} and [*found.others] == ["r.py"]
    )
    assert [each.name for each in tmp_path.iterdir()] == [at_work.FOLDER]


def test_of_a_start_without_a_record_nothing_is_known(tmp_path: Path) -> None:
    at_work.keep(tmp_path, files(b"name: a"), AT)
    at_work.keep(tmp_path, None, AT)
    assert at_work.known(tmp_path) is None
