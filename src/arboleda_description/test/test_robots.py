"""The package as installed carries its robot models."""

from __future__ import annotations

from importlib.resources import files

import pytest
import yaml


@pytest.mark.parametrize("model", ["scara", "cr10a", "mobile"])
def test_each_robot_model_is_a_mapping(model: str) -> None:
    text = files("arboleda_description").joinpath("robots", f"{model}.yaml").read_text(encoding="utf-8")
    assert isinstance(yaml.safe_load(text), dict)
