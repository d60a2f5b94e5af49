"""The command line as a person types it again, and the one that installs."""

from __future__ import annotations

import sys

import pytest

from arboleda.runtime import invocation


@pytest.mark.parametrize(
    ("pip", "uv", "said"),
    [
        (object(), "/bin/uv", "python -m pip install"),
        (None, "/bin/uv", f"uv pip install --python {sys.executable}"),
        (None, None, "python -m pip install"),
    ],
)
def test_what_installs_is_there(
    pip: object, uv: str | None, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(invocation, "find_spec", lambda _name: pip)
    monkeypatch.setattr(invocation.shutil, "which", lambda name: uv if name == "uv" else f"/bin/{name}")
    assert invocation.pip_install() == said
