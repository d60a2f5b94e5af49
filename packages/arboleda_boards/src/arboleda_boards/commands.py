"""Commands of the command line that this package adds."""

from __future__ import annotations

from arboleda.extension import Command

COMMANDS = {
    "conformance": Command(
        "arboleda_boards.conformance.command",
        "Test the board of an arm or of a declared kind against the contract, and say which level "
        "it reaches.",
    ),
    "firmware-config": Command(
        "arboleda_boards.firmware_config.command",
        "Write the header with which the boards' firmware becomes a device of a declared kind.",
    ),
}
