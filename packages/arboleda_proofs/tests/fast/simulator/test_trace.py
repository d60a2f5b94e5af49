"""The lines of a trace are for people: they have no notation of the program."""

from __future__ import annotations

import re

from arboleda_proofs.simulator.run import Simulation

from .test_general_invariants import storing

NOTATION = re.compile(r"\w+\(\w+=|=<|\(\(|'\)")


def test_commands_of_declared_devices_are_said_by_their_verb_and_its_values() -> None:
    lines = Simulation(storing(), 1, lambda minute: (), keep=True).run(cycles=2).lines
    calls = [line for line in lines if " plant " in line and " verb=" in line]
    assert calls and not [line for line in lines if NOTATION.search(line) and " plant " in line]
