"""Bugs for `prove` that its answers and those of `check` alone do not mend, as far as it was measured.

`python -m tools.tests.mutants.followed_mends` says of each bug what comes of it.
"""

from __future__ import annotations

RULE = "the rule itself is the mistake, and rules are never changed"
BY_FAULTS = "it is found by faults alone, of which a run with a budget of 0 tells nothing"
NOTHING_FOUND = "nobody finds anything of it"
UNMENDED = {
    (
        "lab_bench",
        "Nobody looks at the answer of the scale.",
    ): "the way that is gone has no name",
    ("lab_bench", "What the pump says does not matter."): BY_FAULTS,
    ("lab_bench", "Heating needs an open lid."): RULE,
    ("assembly", "The left arm stays where it was."): NOTHING_FOUND,
    ("assembly", "The zone is free while the ram is down."): RULE,
    ("assembly", "Pressing needs an open clamp."): RULE,
}
MEASURED = ("lab_bench", "assembly")
"""The plants whose bugs were all measured."""
