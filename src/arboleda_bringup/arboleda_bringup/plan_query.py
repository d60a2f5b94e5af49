"""The plan of a launch, asked of the Python that will also run its nodes."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Mapping
from pathlib import Path

from .row import Plan, Row


def plan_of(texts: Mapping[str, str], share: Path) -> Plan:
    """The plan for these launch arguments; RuntimeError with a sentence if they are refused.

    `ros2` runs on the Python of its installation, which need not have the libraries of the plant file; the
    nodes run on the `python3` of the shell, which has.
    """
    question = json.dumps({"texts": dict(texts), "share": str(share)})
    command = ["python3", "-m", __package__]
    answer = subprocess.run(command, input=question, capture_output=True, text=True, check=False)
    if answer.returncode:
        raise RuntimeError(answer.stderr.strip())
    plan = json.loads(answer.stdout)
    rows = [Row(**{**row, "arguments": tuple(row["arguments"])}) for row in plan["rows"]]
    return Plan(rows=rows, environment=plan["environment"], notes=plan["notes"])
