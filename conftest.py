"""Tests in `tests/`, `packages/*/tests` and `tools/tests` share fixtures and hooks."""

pytest_plugins = ["tests.shared"]
