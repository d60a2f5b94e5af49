"""Keys of a plant file set to other values, as `timing.stale_after_s=3` names them."""

from __future__ import annotations

from collections.abc import Sequence

import yaml

from arboleda.drivers import quoted
from arboleda.extension import ConfigError


def with_settings(content: bytes, settings: Sequence[str]) -> bytes:
    """The plant file with these keys set; all else stays as it is written. ConfigError for a bad one."""
    root = yaml.compose(content, Loader=yaml.SafeLoader)
    for setting in settings:
        key, equals, value = setting.partition("=")
        if not (key and equals and value):
            raise ConfigError((f"--set {quoted(setting, 60)}: must be KEY=VALUE: timing.stale_after_s=3",))
        _set(root, key.split("."), _value(setting, value), setting)
    return bytes(yaml.serialize(root, encoding="utf-8"))


def _value(setting: str, text: str) -> yaml.Node:
    try:
        node = yaml.compose(text, Loader=yaml.SafeLoader)
    except yaml.YAMLError:
        node = None
    if node is None:
        raise ConfigError((f"--set {quoted(setting, 60)}: the value is not as in a plant file",))
    assert isinstance(node, yaml.Node)
    return node


def _set(node: yaml.Node | None, keys: Sequence[str], value: yaml.Node, setting: str) -> None:
    """Set the value that the keys lead to from here; a missing mapping is made."""
    first, *rest = keys
    if isinstance(node, yaml.SequenceNode) and first.isdecimal() and int(first) < len(node.value):
        if rest:
            _set(node.value[int(first)], rest, value, setting)
        else:
            node.value[int(first)] = value
        return
    if not isinstance(node, yaml.MappingNode):
        raise ConfigError((f"--set {quoted(setting, 60)}: {quoted(first, 40)} is in nothing that has keys",))
    pairs = node.value
    at = next((n for n, (key, _) in enumerate(pairs) if key.value == first), len(pairs))
    if at == len(pairs):
        key_node = yaml.ScalarNode("tag:yaml.org,2002:str", first)
        pairs.append((key_node, yaml.MappingNode("tag:yaml.org,2002:map", [])))
    if rest:
        _set(pairs[at][1], rest, value, setting)
    else:
        pairs[at] = (pairs[at][0], value)
