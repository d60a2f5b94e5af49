"""Files of versions in a record: written before the step that is told of them, read again, copied."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.plant_files import PlantFiles
from arboleda.recorder.copying import as_mcap
from arboleda.recorder.errors import NoRecord
from arboleda.recorder.reader import alone
from arboleda.recorder.version_files import VersionFiles, versions_in
from arboleda.recorder.writing import Writing
from arboleda.testing import shipped

from .recorded import DEFAULT, beginning_of

FILES = PlantFiles(plant="plant.yaml", contents={"plant.yaml": b"name: a", "own.py": b"\x00\xff"})


def written(folder: Path, *versions: VersionFiles) -> Path:
    """The file of a record with these versions."""
    writing = Writing(folder, beginning_of(shipped("sis_a")), DEFAULT)
    writing.open()
    for version in versions:
        assert list(writing.put(version)) == []
    writing.close()
    return next(folder.glob("*.mcap"))


def test_each_byte_of_a_version_comes_back(tmp_path: Path) -> None:
    path = written(tmp_path, VersionFiles(digest="d1", files=FILES), VersionFiles(digest="d2", files=FILES))
    assert versions_in([path]) == {"d1": FILES, "d2": FILES}


def test_a_record_without_any_has_none(tmp_path: Path) -> None:
    assert versions_in([written(tmp_path)]) == {}


def test_a_copy_has_them_too(tmp_path: Path) -> None:
    path = written(tmp_path, VersionFiles(digest="d1", files=FILES))
    copy = tmp_path / "copy.mcap"
    as_mcap(alone(path), copy, (1,))
    assert versions_in([copy]) == {"d1": FILES}


def test_a_torn_file_has_those_before_the_tear(tmp_path: Path) -> None:
    path = written(tmp_path, VersionFiles(digest="d1", files=FILES), VersionFiles(digest="d2", files=FILES))
    content = path.read_bytes()
    path.write_bytes(content[: content.index(b"version/d2") + 20])
    assert versions_in([path]) == {"d1": FILES}


def test_what_no_plant_writes_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(VersionFiles, "data", lambda self: b"[]")
    path = written(tmp_path, VersionFiles(digest="d1", files=FILES))
    with pytest.raises(NoRecord, match="a version of the plant"):
        versions_in([path])
