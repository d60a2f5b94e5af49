"""Requests of `make wheel-check` to the package index: what people install, for each machine and Python."""

from __future__ import annotations

from pathlib import Path
from zipfile import ZipFile

import pytest

from ..packages import PACKAGES
from ..scripts import load

ROOT = Path(__file__).parents[2]
CHECK = load("wheel-check")


def test_the_parts_are_those_that_who_runs_a_plant_installs() -> None:
    parts = CHECK.optional_parts((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert {"modbus", "opcua", "groot2", "pictures", "postgres", "mcp"} <= set(parts)
    assert not CHECK.OF_DEVELOPERS & set(parts)
    assert not {name.removeprefix("arboleda_") for name in PACKAGES} & set(parts)


def test_what_a_part_of_a_package_needs_is_asked_for_and_not_the_package() -> None:
    behind = CHECK.libraries((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    of_drivers = {"modbus", "opcua", "pylabrobot", "s7", "serial"}
    assert {"cluster", "groot2", "mcp", "postgres", *of_drivers} == set(behind)
    assert [each for each in behind["modbus"] if each.startswith("pymodbus")]
    assert not [each for needed in behind.values() for each in needed if each.startswith("arboleda")]


def test_nothing_but_wheels_for_that_machine_counts() -> None:
    words = CHECK.command("uv", "windows-x86_64", "3.12", ["mcp"])
    assert words[words.index("--only-binary") + 1] == ":all:"
    assert words[words.index("--python-platform") + 1] == "x86_64-pc-windows-msvc"
    assert words[words.index("--python-version") + 1] == "3.12" and "--extra=mcp" in words


def test_the_part_that_fails_is_named_with_its_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    def trouble(uv: str, machine: str, python: str, extras: list[str]) -> str:
        return "snap7 has no wheels" if "s7" in extras else ""

    monkeypatch.setattr(CHECK, "trouble", trouble)
    found = CHECK.troubles("uv", "macos-arm64", "3.14", ["mcp", "s7"])
    assert found == ["arboleda[s7] on macos-arm64, Python 3.14: snap7 has no wheels"]
    assert CHECK.troubles("uv", "macos-arm64", "3.14", ["mcp"]) == []


def test_parts_that_exclude_each_other_are_no_silence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(CHECK, "trouble", lambda _uv, _machine, _python, extras: "no" * (len(extras) > 1))
    (found,) = CHECK.troubles("uv", "macos-arm64", "3.14", ["mcp", "s7"])
    assert "not all of them together" in found


@pytest.mark.parametrize(("words", "said"), [(["amiga"], "amiga is none of"), ([], "needs uv")])
def test_what_it_cannot_do_is_one_sentence(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    monkeypatch.setattr(CHECK.shutil, "which", lambda _name: "uv" if words else None)
    assert CHECK.main(words) == 2
    assert said in capsys.readouterr().err


def wheel(folder: Path, *files: str, needs: str = "") -> Path:
    """A wheel with these files and these lines of its metadata."""
    with ZipFile(folder / "arboleda-0.1.0-py3-none-any.whl", "w") as made:
        for name in files:
            made.writestr(name, "")
        made.writestr("arboleda-0.1.0.dist-info/METADATA", needs)
    return folder / "arboleda-0.1.0-py3-none-any.whl"


def test_a_wheel_with_benchmarks_or_with_the_libraries_of_an_extra_is_refused(tmp_path: Path) -> None:
    needs = """Requires-Dist: rich
Requires-Dist: PyZMQ>=25
Requires-Dist: pyzmq>=25; extra == "groot2"
Requires-Dist: ur-rtde>=1.6; sys_platform == "linux" and extra == "test"
"""
    made = wheel(tmp_path, "arboleda/__init__.py", "arboleda_bench/__init__.py", needs=needs)
    assert CHECK.unwanted(made) == [
        "the wheel brings arboleda_bench, which no plant needs",
        "the wheel needs pyzmq, which an extra brings",
    ]


def test_a_folder_that_colcon_takes_for_a_package_is_found_where_it_looks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "tools").mkdir()
    (tmp_path / "tools/COLCON_IGNORE").touch()
    folders = ("build/lib/extension", ".build/lib/extension", "tools/build")
    monkeypatch.setattr(CHECK, "untracked", lambda _: [Path(each) / "setup.py" for each in folders])
    (found,) = CHECK.left_behind(tmp_path)
    assert found.startswith("colcon takes build/lib/extension for a package")
