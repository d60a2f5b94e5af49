"""Commands of the command line that this package adds."""

from __future__ import annotations

from arboleda.extension import Command

COMMANDS = {
    "exercise": Command(
        "arboleda_class.exercises.command",
        "Exercises with a judge: cells that are not right yet, to be put right.",
        section="Learn it",
    ),
    "class": Command(
        "arboleda_class.students.command",
        "Write a plant for each student, with tokens, and say what each student opens.",
        section="Learn it",
    ),
}
