"""`pytest --about WORD`: the tests of a driver, by its name."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from ..shared import about


@pytest.mark.parametrize(
    ("test", "is_wanted"),
    [
        ("packages/arboleda_drivers/tests/fast/ur/test_ur_machine.py::test_a_stop", True),
        ("packages/arboleda_drivers/tests/real/contract/test_drivers.py::test_reject[ur]", True),
        ("packages/arboleda_drivers/tests/fast/ur/test_x.py::test_y", True),
        ("tests/unit/core/test_x.py::test_what_is_measured_during_a_course", False),
        ("packages/arboleda_drivers/tests/real/contract/test_drivers.py::test_reject[dobot]", False),
    ],
)
def test_a_whole_word_in_the_name_of_file_test_or_case(test: str, is_wanted: bool) -> None:
    item: Any = SimpleNamespace(nodeid=test)
    assert about("ur", [item]) == [item] * is_wanted
