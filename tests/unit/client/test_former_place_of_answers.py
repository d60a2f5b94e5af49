"""`arboleda.client` has what other modules have now, for one minor version and with a warning."""

from __future__ import annotations

import pytest

from arboleda import client
from arboleda.client import answers
from arboleda.client.answers.plant import Cell
from arboleda.host import packages


def test_a_type_is_found_with_a_warning_that_says_where_it_is() -> None:
    with pytest.warns(DeprecationWarning, match=r"use `from arboleda\.client\.answers\.plant import Cell`"):
        assert answers.Cell is Cell


def test_where_its_package_is_missing_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(packages, "import_module", missing)
    with (
        pytest.warns(DeprecationWarning, match="Draft"),
        pytest.raises(ImportError, match=r"^arboleda\.client\.Draft needs the package make"),
    ):
        client.Draft  # noqa: B018 - asking for it is the test


def missing(name: str) -> None:
    raise ModuleNotFoundError(name=name.partition(".")[0])


def test_another_name_is_not_there() -> None:
    with pytest.raises(AttributeError, match="Nothing"):
        answers.Nothing  # noqa: B018 - asking for it is the test
