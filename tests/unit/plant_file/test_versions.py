"""Versions of a plant, kept whole and brought back, and the source of its recipes as one hash."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.cuts import each_cut

from arboleda.model.errors import ConfigError, StartError
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file.source_text import source_of
from arboleda.plant_file.versions import FACTS, FOLDER, Version, Versions, version_of, whole

AT = "2026-11-25T20:00:00+00:00"


def files(**contents: bytes) -> PlantFiles:
    named = {name.replace("__", "/").replace("_", "."): each for name, each in contents.items()}
    return PlantFiles(plant="plant.yaml", contents={"plant.yaml": b"name: a\n", **named})


def version(of: PlantFiles) -> Version:
    return version_of(of, at=AT, by="ana", note="why")


def test_a_version_is_read_as_it_was_kept(tmp_path: Path) -> None:
    kept = Versions(tmp_path / "plant.yaml")
    assert kept.all() == [] and kept.last() is None
    first = kept.keep(version(files(t_xml=b"<root/>", r_py=b"secret = 1")))
    second = kept.keep(version(files(sub__t_xml=b"\xff\x00")))
    assert [each.number for each in kept.all()] == [1, 2]
    assert (
        kept.find(1) == first and kept.last() == second and second.files.contents["sub/t.xml"] == b"\xff\x00"
    )


def test_of_python_only_a_digest_is_kept_which_stands_for_it(tmp_path: Path) -> None:
    kept = Versions(tmp_path / "plant.yaml")
    first, second = (kept.keep(version(files(r_py=each))) for each in (b"secret = 1", b"secret = 2"))
    assert first.digest != second.digest
    assert whole(first).contents["r.py"] != whole(second).contents["r.py"]
    assert all(b"secret" not in each.read_bytes() for each in tmp_path.rglob("*") if each.is_file())


def test_a_version_comes_back_and_names_what_does_not(tmp_path: Path) -> None:
    plant = tmp_path / "plant.yaml"
    first = Versions(plant).keep(version(files(t_xml=b"<a/>", r_py=b"1", s_py=b"1")))
    for name, content in {"plant.yaml": b"name: b\n", "r.py": b"2", "s.py": b"1"}.items():
        (tmp_path / name).write_bytes(content)
    plant.chmod(0o640)
    Versions(plant).bring_back(first)
    assert plant.read_bytes() == b"name: a\n" and (tmp_path / "t.xml").read_bytes() == b"<a/>"
    assert plant.stat().st_mode & 0o777 == 0o640
    assert Versions(plant).others_now(first) == ("r.py",)
    assert sorted(each.name for each in tmp_path.iterdir()) == [FOLDER, "plant.yaml", "r.py", "s.py", "t.xml"]


def test_a_version_comes_back_whole_or_not_at_all(tmp_path: Path) -> None:
    plant = tmp_path / "plant.yaml"
    plant.write_bytes(b"name: b\n")
    (tmp_path / "u.xml").mkdir()  # a folder in the way
    first = Versions(plant).keep(version(files(t_xml=b"<a/>", u_xml=b"<b/>")))
    with pytest.raises(StartError, match=r"u\.xml cannot be written"):
        Versions(plant).bring_back(first)
    assert plant.read_bytes() == b"name: b\n" and not (tmp_path / "t.xml").exists()
    assert Versions(plant).go_on() is None


def test_two_plant_files_in_a_folder_have_versions_of_their_own(tmp_path: Path) -> None:
    Versions(tmp_path / "a.yaml").keep(version(files()))
    assert Versions(tmp_path / "b.yaml").all() == []


def test_a_number_that_is_not_kept_is_answered_with_those_that_are(tmp_path: Path) -> None:
    kept = Versions(tmp_path / "plant.yaml")
    with pytest.raises(ConfigError, match=r"no version 1 .*; kept: none"):
        kept.find(1)
    kept.keep(version(files()))
    with pytest.raises(ConfigError, match="kept: 1"):
        kept.find(7)


@pytest.mark.parametrize("name", ["../x.xml", "/x.xml"])
def test_a_version_that_leads_out_of_its_folder_is_refused(tmp_path: Path, name: str) -> None:
    kept = Versions(tmp_path / "plant.yaml")
    kept.keep(version(files()))
    facts = next(tmp_path.rglob(FACTS))
    facts.write_text(facts.read_text().replace('"plant.yaml"\n', f'"plant.yaml", "{name}"\n'))
    with pytest.raises(StartError, match="delete it"):
        kept.all()


def test_a_version_that_cannot_be_written_leaves_nothing(tmp_path: Path) -> None:
    (tmp_path / FOLDER).write_text("a file in the way")
    with pytest.raises(StartError, match="cannot be written"):
        Versions(tmp_path / "plant.yaml").keep(version(files()))
    assert [each.name for each in tmp_path.iterdir()] == [FOLDER]


def test_a_version_that_is_forgotten_is_there_whole_or_not_at_all(tmp_path: Path) -> None:
    plant = tmp_path / "plant" / "plant.yaml"
    plant.parent.mkdir()
    kept = Versions(plant)
    first, second = kept.keep(version(files())), kept.keep(version(files(t_xml=b"<a/>")))
    for cut in each_cut(plant.parent, lambda: kept.forget(second)):
        assert kept.all() in ([first], [first, second]), cut


RECIPE = b"def work(cell, count=3):\n    return cell.retry(cell.arm.pick('rack'), times=count)\n"
PLACE = Path("/plant")


def hash_of(content: bytes, name: str = "recipes.py", folder: Path = PLACE) -> str:
    return source_of({folder / name: content}, folder)


def test_layout_and_comments_do_not_count() -> None:
    head = b"# what it does\ndef work(cell, count = 3):\n\n"
    same = head + b'    return cell.retry(\n        cell.arm.pick("rack"), times=count)\n'
    assert hash_of(same) == hash_of(RECIPE)


def test_the_folder_of_the_plant_does_not_count() -> None:
    assert hash_of(RECIPE, folder=Path("/elsewhere")) == hash_of(RECIPE)


@pytest.mark.parametrize(
    "other",
    [
        RECIPE.replace(b"3", b"4"),
        RECIPE.replace(b"count)", b"-count)"),
        RECIPE.replace(b"'rack'", b"b'rack'"),
        RECIPE + b"# no Python any more\n(",
    ],
)
def test_each_other_change_counts(other: bytes) -> None:
    assert hash_of(other) != hash_of(RECIPE)


def test_which_end_of_a_slice_is_left_out_counts() -> None:
    assert hash_of(b"x[1:]") != hash_of(b"x[:1]")


def test_the_name_of_a_file_counts_and_what_is_no_source_does_not() -> None:
    assert hash_of(RECIPE, name="other.py") != hash_of(RECIPE)
    files = {PLACE / "recipes.py": RECIPE}
    assert source_of({**files, PLACE / "arm.urdf": b"<robot/>"}, PLACE) == source_of(files, PLACE)
    assert source_of({**files, PLACE / "tree.xml": b"<root/>"}, PLACE) != source_of(files, PLACE)
