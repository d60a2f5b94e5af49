"""Options that the commands of virtual action servers share."""

from __future__ import annotations

from typing import Annotated

import typer

Lan = Annotated[bool, typer.Option("--lan", help="Let clients on other machines reach it.")]
JointStates = Annotated[str, typer.Option(help="The topic of its joint states.")]
Rate = Annotated[float, typer.Option(min=1, max=1000, help="How often that is measured, Hz.")]
