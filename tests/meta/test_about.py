"""`pytest --about WORD`: the tests of a driver, by its name. `--one-in N`: a sample of each file."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from ..shared import about, one_in


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


def test_a_sample_has_some_of_every_file() -> None:
    items: Any = [
        SimpleNamespace(path=Path(file), nodeid=f"{file}::{number}")
        for file, tests in (("a.py", 5), ("b.py", 1), ("c.py", 3))
        for number in range(tests)
    ]
    assert [item.nodeid for item in one_in(3, items)] == ["a.py::0", "a.py::3", "b.py::0", "c.py::0"]
    assert one_in(1, items) == items
