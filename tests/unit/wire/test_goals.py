"""Which goals a robot can never carry out."""

from __future__ import annotations

import pytest

from arboleda.kinds.joints import MoveJoints
from arboleda.testing import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda.wire.forms import form_of

ARM = StorageLayout(shipped("sis_a").cell("sis_a")).arm


@pytest.mark.parametrize(("beyond", "word"), [(0.0, None), (0.9e-6, None), (1.1e-6, "limite")])
def test_a_goal_beyond_its_limit_by_more_than_float32_loses_is_refused(
    beyond: float, word: str | None
) -> None:
    for joint in range(len(ARM.joints)):
        for limit, sign in ((ARM.joints[joint].upper, 1.0), (ARM.joints[joint].lower, -1.0)):
            q = tuple(limit + sign * beyond if each == joint else 0.0 for each in range(len(ARM.joints)))
            assert form_of(ARM).refusal(ARM, MoveJoints(id="1-1", robot=ARM.name, q=q)) == word
