"""Every bug for `prove`, and those of which `check`, a calm run and single faults say nothing.

`python -m tools.tests.mutants.planted_proof` says who finds each.
"""

from __future__ import annotations

from .proof_bugs_of_arms import BUGS_OF_ARMS
from .proof_bugs_of_benches import BUGS_OF_BENCHES
from .proof_bugs_of_labs import BUGS_OF_LABS

PROOF_BUGS = (*BUGS_OF_BENCHES, *BUGS_OF_ARMS, *BUGS_OF_LABS)
BY_FAULTS = frozenset(
    {
        ("lab_bench", "What the pump says does not matter."),
        ("rail", "What the oven says does not matter."),
        ("rail", "What the driver says does not matter."),
    }
)
"""Those that neither `check` nor a calm run finds, but a fault."""
LIES_BY_ITSELF = "a part lies in the vise by itself, before anybody holds it and after"
EQUAL = {
    ("assembly", "The left arm stays where it was."): "the next task begins as well from there",
    ("machine_tending", "The jaw opens before the clamp holds."): LIES_BY_ITSELF,
    ("machine_tending", "The clamp opens before anybody grips."): LIES_BY_ITSELF,
    ("lab", "The clamp holds no part."): "the recipe opens the clamp in time, so it never holds one in vain",
    ("rail", "The carriage may leave while the jaw holds."): "the recipe opens the jaw before",
}
"""Those with which the plant does the same as without, as far as its file says what is so; and why."""
NO_PART_AT_SENSORS = "the virtual belt sees no part that nobody told it of"
NOT_FOUND = {
    ("machine_tending", "Nobody looks whether the belt is clear."): NO_PART_AT_SENSORS,
    ("machine_tending", "The belt is never told to clear."): NO_PART_AT_SENSORS,
}
"""Those that do other things, of which nobody says anything; and why."""
