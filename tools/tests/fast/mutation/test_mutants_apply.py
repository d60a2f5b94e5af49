"""Each mutant of the judge's tests is an edit of what stands in the sources now."""

from __future__ import annotations

import pytest

from ...mutants.mutant import Mutant
from ...mutants.mutants import MUTANTS
from ...mutants.planted import PLANTED


@pytest.mark.parametrize("mutant", [*MUTANTS, *PLANTED], ids=lambda mutant: mutant.bug[:60])
def test_a_mutant_is_an_edit_of_what_stands_there(mutant: Mutant) -> None:
    assert all(edit.compiled() != edit.function.__code__ for edit in mutant.edits)
