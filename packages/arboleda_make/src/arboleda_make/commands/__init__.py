"""Commands of the command line that this package adds."""

from __future__ import annotations

from arboleda.extension import Command

COMMANDS = {
    "apply": Command(
        "arboleda_make.commands.apply",
        "Check a plant file and all that it uses, show how it differs from what is at work, and "
        "put it to work.",
    ),
    "mcp": Command(
        "arboleda_make.commands.mcp",
        "Let an assistant (a language model) look at a plant, try its plant file, and propose changes.",
        section="Run a plant",
    ),
}
