"""Tests of the repository as a whole are left out where packages/ was moved away.

They count, link and compare what stands there as well: each of them would fail for what is missing, and say
nothing of the cell runner. All other tests are the same with packages and without.
"""

from __future__ import annotations

from ..packages import PACKAGES

OF_THE_WHOLE = (
    "class_sizes",
    "dependencies",
    "engine_face",
    "found_in_every_language",
    "imports",
    "kinds",
    "links",
    "missed_packages",
    "names_taken",
    "other_systems",
    "pages_in_spanish",
    "paths_in_documents",
    "proof_page",
    "public_names",
    "ros_scripts",
    "tutorial_commands",
    "wheel_check",
)
collect_ignore = [] if PACKAGES else [f"test_{name}.py" for name in OF_THE_WHOLE]
