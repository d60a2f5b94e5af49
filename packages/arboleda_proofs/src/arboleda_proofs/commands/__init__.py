"""Commands of the command line that this package adds."""

from __future__ import annotations

from arboleda.extension import Command

TEST, PAST = "Put it to the test", "Look back"
COMMANDS = {
    "simulate": Command(
        "arboleda_proofs.commands.simulate",
        "Run whole plants under virtual time, with faults drawn from a seed, and judge every step.",
        section=TEST,
    ),
    "prove": Command(
        "arboleda_proofs.commands.prove",
        "Try every single fault at every kind of moment of every recipe, and judge each run.",
        section=TEST,
    ),
    "fault": Command(
        "arboleda_proofs.commands.fault",
        "Have something go wrong with a virtual device: cut its link, reboot its board, lose its part.",
        section=TEST,
    ),
    "record replay": Command(
        "arboleda_proofs.commands.replay",
        "Execute a record again, and compare every step with what it was.",
        section=PAST,
    ),
    "record unlike": Command(
        "arboleda_proofs.commands.unlike",
        "Say what devices of a record told that their virtual ones cannot tell.",
        section=PAST,
    ),
    "report": Command(
        "arboleda_proofs.commands.report",
        "Write why a task failed: one HTML file, without network, in English and Spanish.",
        section=PAST,
    ),
}
