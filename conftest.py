"""Tests in `tests/` and in `packages/*/tests` share fixtures and hooks."""

pytest_plugins = ["tests.shared"]
