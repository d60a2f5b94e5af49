"""The core's board and the plant's virtual board say the same, word for word, at the same microsecond."""

from __future__ import annotations

import os

import pytest

from . import core
from .reference import Reference
from .scripts import Author

SCRIPTS = int(os.environ.get("ARBOLEDA_SCRIPTS", "600"))
GROUPS = 4


@pytest.mark.timeout(3600)
@pytest.mark.parametrize("group", range(GROUPS))
def test_boards_say_the_same_under_random_scripts(group: int) -> None:
    late = 0
    for seed in range(group, SCRIPTS, GROUPS):
        author = Author(seed)
        now_us = author.now_us
        script = author.script()
        wanted = Reference(author.setting, now_us).run(script)
        assert core.run(script) == wanted, f"script {seed}"
        assert len(wanted) > 2
        late += any('"rechazo":"tarde"' in line for line in wanted)
    assert late > SCRIPTS / GROUPS / 10  # else the scripts are too short to say
