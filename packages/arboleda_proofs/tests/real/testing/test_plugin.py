"""The pytest plugin in a project of somebody else, and how its failures read there."""

from __future__ import annotations

import subprocess
import sys


def test_loading_the_plugin_loads_nothing_else() -> None:
    code = "import sys, arboleda_proofs.testing.plugin as p; print(*sys.modules)"
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    packages = {name.partition(".")[0] for name in ran.stdout.split()}
    heavy = {
        "fastapi",
        "hypothesis",
        "paho",
        "py_trees",
        "pydantic",
        "rclpy",
        "rich",
        "typer",
        "yaml",
    }
    assert packages & heavy == set()
    ours = {name for name in ran.stdout.split() if name.startswith("arboleda")}
    assert ours == {"arboleda_proofs", "arboleda_proofs.testing", "arboleda_proofs.testing.plugin"}
