"""The script that builds the images of `container/`."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "container"


@pytest.mark.parametrize("builder", ["podman", "docker"])
def test_one_command_builds_for_both_machines(tmp_path: Path, builder: str) -> None:
    (tmp_path / builder).write_text("#!/bin/sh\n")
    (tmp_path / builder).chmod(0o755)
    for tool in ("sh", "sed", "dirname", "mkdir"):
        (tmp_path / tool).symlink_to(str(shutil.which(tool)))
    ran = subprocess.run(
        [FOLDER.parent / "scripts/images", "--print"],
        env={"PATH": str(tmp_path)},
        capture_output=True,
        text=True,
    )
    assert ran.returncode == 0, ran.stderr
    words = ran.stdout.split()
    assert words[0] == builder and "linux/amd64,linux/arm64" in words
    assert FOLDER.parent / words[words.index("--file") + 1] == FOLDER / "Containerfile"
