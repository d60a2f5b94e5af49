"""What `scripts/install` says on a machine that lacks something."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[2]


def install(
    folder: Path, python: str, *words: str, tools: tuple[str, ...] = (), uv: str = "", **environ: str
) -> subprocess.CompletedProcess[str]:
    """Run the script in a copy of the project where `python3` is the given shell script, without c++.

    Programs named in `tools` are there, but do nothing; `uv` is another shell script, or not there.
    """
    (folder / "scripts").mkdir()
    for name in ("install", "ros-prefix"):
        shutil.copy(ROOT / "scripts" / name, folder / "scripts")
    for name in ("pyproject.toml", "constraints.txt", "constraints-kilted.txt"):
        shutil.copy(ROOT / name, folder)
    for each in (*ROOT.glob("packages/*/setup.py"), ROOT / "tools/bench/setup.py"):
        (folder / each.parent.relative_to(ROOT)).mkdir(parents=True)
        shutil.copy(each, folder / each.relative_to(ROOT))
    path = folder / "programs"
    path.mkdir()
    for name in ("sh", "dirname", "cat", "chmod", "cksum", "mkdir", "rm", "tail"):
        (path / name).symlink_to(str(shutil.which(name)))
    programs = {"python3": python, **dict.fromkeys(tools, ""), **({"uv": uv} if uv else {})}
    for name, script in programs.items():
        (path / name).write_text(f"#!/bin/sh\n{script}\n")
        (path / name).chmod(0o755)
    command = [folder / "scripts/install", *words]
    return subprocess.run(
        command, env={"PATH": str(path), **environ}, capture_output=True, text=True, check=False
    )


def python(version: str, *, lacks: str = "nothing") -> str:
    """A stand-in for an interpreter: knows its version and where it is, cannot import `lacks`."""
    return f"""
case "$2" in
*{lacks}*) exit 1 ;;
*version_info*) echo {version} ;;
*realpath*) echo "$0" ;;
esac"""


def test_an_unsupported_python_gets_one_sentence(tmp_path: Path) -> None:
    result = install(tmp_path, python("3.9"))
    assert result.returncode == 1
    assert result.stderr.startswith("install: Arboleda needs Python 3.10 to 3.14, and python3 is 3.")
    assert result.stderr.count("\n") == 1


def test_a_missing_ensurepip_gets_the_line_to_type(tmp_path: Path) -> None:
    result = install(tmp_path, python("3.11", lacks="ensurepip"))
    assert result.returncode == 1
    assert result.stderr.startswith("install: this Python has no ensurepip; ")
    assert result.stderr.count("\n") == 1


def test_a_sourced_ros_of_another_python_gets_one_sentence(tmp_path: Path) -> None:
    result = install(tmp_path, python("3.11", lacks="rclpy"), ROS_DISTRO="jazzy")
    assert result.returncode == 1
    assert "ROS 2 jazzy is sourced, but Python 3.11" in result.stderr
    assert result.stderr.count("\n") == 1


UV = """
case "$1" in
venv) mkdir -p .venv/bin && cat /dev/null >.venv/bin/python && chmod +x .venv/bin/python ;;
pip)
    for each in a b c d e f; do echo "Downloading $each"; done
    echo "Installed 6 packages"
    exit {status}
    ;;
esac"""


def test_an_installation_takes_a_few_lines_and_a_log_has_the_other_ones(tmp_path: Path) -> None:
    result = install(tmp_path, python("3.11"), uv=UV.replace("{status}", "0"))
    assert (result.returncode, result.stderr) == (0, "")
    lines = result.stdout.splitlines()
    assert lines[-2:] == ["install: Installed 6 packages", "install: done: .venv/bin/arboleda"]
    assert len(lines) == 4
    assert "Downloading f" in (tmp_path / ".venv/install.log").read_text("utf-8")


def test_an_installation_that_fails_names_its_log_and_shows_its_end(tmp_path: Path) -> None:
    result = install(tmp_path, python("3.11"), uv=UV.replace("{status}", "1"))
    assert result.returncode == 1
    assert "Downloading f" in result.stderr and "Downloading a" not in result.stderr
    assert "(.venv/install.log says more); try again when it is" in result.stderr
    assert not (tmp_path / ".venv/installed-run").exists()
