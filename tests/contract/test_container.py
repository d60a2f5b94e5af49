"""The script that builds the images of `container/`."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

FOLDER = Path(__file__).parents[2] / "container"


def test_one_command_builds_for_both_machines_with_the_builder_that_is_there(tmp_path: Path) -> None:
    found = {builder: printed(tmp_path / builder, builder) for builder in ("podman", "docker")}
    assert {builder: words[0] for builder, words in found.items()} == {each: each for each in found}
    for words in found.values():
        assert "linux/amd64,linux/arm64" in words
        assert FOLDER.parent / words[words.index("--file") + 1] == FOLDER / "Containerfile"


def printed(path: Path, builder: str) -> list[str]:
    """The command that the script would run where only this builder is on the path."""
    path.mkdir()
    (path / builder).write_text("#!/bin/sh\n")
    (path / builder).chmod(0o755)
    for tool in ("sh", "sed", "dirname", "mkdir"):
        (path / tool).symlink_to(str(shutil.which(tool)))
    ran = subprocess.run(
        [FOLDER.parent / "scripts/images", "--print"], env={"PATH": str(path)}, capture_output=True, text=True
    )
    assert ran.returncode == 0, ran.stderr
    return ran.stdout.split()
