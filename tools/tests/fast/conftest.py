"""Tests of tools that need packages are left out where packages/ was moved away."""

from __future__ import annotations

from tests.packages import PACKAGES

OF_PACKAGES = (
    "bench/test_command.py",
    "bench/test_cost.py",
    "drawn",
    "fuzzers",
    "kills/test_leaders.py",
    "mutation/test_engine_bugs.py",
    "mutation/test_mutants_apply.py",
    "test_campaign.py",
)
collect_ignore = [] if PACKAGES else [*OF_PACKAGES]
