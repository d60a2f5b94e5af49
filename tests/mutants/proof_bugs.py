"""Every bug for `prove`, and those of which `check`, a calm run and single faults say nothing.

`python -m tests.mutants.planted_proof` says who finds each.
"""

from __future__ import annotations

from .proof_bugs_of_arms import BUGS_OF_ARMS
from .proof_bugs_of_benches import BUGS_OF_BENCHES
from .proof_bugs_of_labs import BUGS_OF_LABS

PROOF_BUGS = (*BUGS_OF_BENCHES, *BUGS_OF_ARMS, *BUGS_OF_LABS)
BY_FAULTS = frozenset(
    {
        ("lab_bench", "What the pump says does not matter."),
    }
)
"""Those that neither `check` nor a calm run finds, but a fault."""
LIES_BY_ITSELF = "a part lies in the vise by itself, as far as anybody knows"
NO_PART_AT_SENSORS = "the virtual belt sees no part that nobody told it of"
NOT_FOUND = {
    ("kitting", "The cart rolls in before it is there."): "the lift needs nothing of the cart",
    ("assembly", "The left arm stays where it was."): "nobody says that it ends at home",
    ("machine_tending", "The jaw opens before the clamp holds."): LIES_BY_ITSELF,
    ("machine_tending", "The clamp opens before anybody grips."): LIES_BY_ITSELF,
    ("machine_tending", "Nobody looks whether the belt is clear."): NO_PART_AT_SENSORS,
    ("machine_tending", "The belt is never told to clear."): NO_PART_AT_SENSORS,
    ("lab", "The clamp holds no part."): "the recipe opens the clamp in time",
    ("rail", "What the oven says does not matter."): "a fault finds it, after more than 2,000 runs",
    ("rail", "What the driver says does not matter."): "a fault finds it, after more than 2,000 runs",
    ("rail", "The carriage may leave while the jaw holds."): "the recipe opens the jaw before",
}
