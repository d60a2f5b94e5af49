"""Values of a node's ports: constants of the file, or variables that are looked up at each tick."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from arboleda.drivers import quoted
from arboleda.recipes import Phrase
from arboleda_trees.bt_xml import values
from arboleda_trees.bt_xml.values import Variable

from .memory import Scope, Value
from .scripts import ScriptError, is_true

NEEDED = Phrase("xml.needed", "{node} needs {port}")
UNSET_AT = Phrase("xml.unset", "{port} of {node} is the variable {variable}, which has no value")
WANTED = Phrase("xml.wanted", "{port} of {node} must be {wanted}, is {value}")
LISTED = Phrase("xml.listed", "{port} of {node} is {value}; there are {known}")
THRESHOLD = Phrase("xml.threshold", "{port} of {node} is {number}, and it has {many} children")
BETWEEN = Phrase("xml.between", "from {lower:g} to {upper:g}")
TYPES = {
    "int": Phrase("xml.int", values.TYPES["int"][0]),
    "unsigned": Phrase("xml.unsigned", values.TYPES["unsigned"][0]),
    "msec": Phrase("xml.msec", values.TYPES["msec"][0]),
    "double": Phrase("xml.double", values.TYPES["double"][0]),
    "bool": Phrase("xml.bool", values.TYPES["bool"][0]),
    "status": Phrase("xml.status", values.TYPES["status"][0]),
}
"""The values that a port takes, in words, by its type."""


@dataclass(frozen=True)
class NodePorts:
    """Ports of one node, by name."""

    node: str
    texts: Mapping[str, str]

    def text(self, name: str, scope: Scope, default: str | None = None) -> Value:
        """The value of a port; ScriptError if the node has none, or its variable."""
        written = self.texts.get(name, default)
        if written is None:
            raise ScriptError(NEEDED(node=self.node, port=name))
        value = values.read(name, written)
        if not isinstance(value, Variable):
            return value
        present = scope.get(value.name)
        if present is None:
            raise ScriptError(UNSET_AT(port=name, node=self.node, variable=value.name))
        return present

    def value_if_set(self, name: str, scope: Scope) -> Value | None:
        """The value of a port; None if its variable has no value."""
        value = values.read(name, self.texts.get(name, ""))
        return scope.get(value.name) if isinstance(value, Variable) else value

    def number(self, name: str, scope: Scope, default: str | None = None) -> float:
        """The value of a port as a number; ScriptError if the value is no number."""
        value = self.text(name, scope, default)
        if not isinstance(value, str):
            return float(value)
        if values.objection("double", value) and values.objection("int", value):
            raise ScriptError(
                WANTED(port=name, node=self.node, wanted=TYPES["double"](), value=quoted(value))
            )
        return values.number(value.strip())

    def is_set(self, name: str, scope: Scope, default: str) -> bool:
        return is_true(self.text(name, scope, default))

    def variable(self, name: str) -> str:
        """The variable that a port names, in braces or without."""
        value = values.read(name, self.texts[name])
        return value.name if isinstance(value, Variable) else value
