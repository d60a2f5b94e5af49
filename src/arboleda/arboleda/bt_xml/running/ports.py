"""What a node is given: values that stand in the file, or variables that are looked up when it is ticked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from arboleda.bt_xml import values
from arboleda.bt_xml.values import Variable
from arboleda.model.outside import quoted

from .memory import Scope, Value
from .scripts import ScriptError, is_true


@dataclass(frozen=True)
class Given:
    """The ports of one node, by name."""

    node: str
    said: Mapping[str, str]

    def text(self, name: str, scope: Scope, default: str | None = None) -> Value:
        """The value of a port; ScriptError where there is none."""
        written = self.said.get(name, default)
        if written is None:
            raise ScriptError(f"{self.node} needs {name}")
        said = values.read(name, written)
        if not isinstance(said, Variable):
            return said
        found = scope.get(said.name)
        if found is None:
            raise ScriptError(f"{name} of {self.node} is the variable {said.name}, which has no value")
        return found

    def found(self, name: str, scope: Scope) -> Value | None:
        """The same where a variable may have no value; None then."""
        said = values.read(name, self.said.get(name, ""))
        return scope.get(said.name) if isinstance(said, Variable) else said

    def number(self, name: str, scope: Scope, default: str | None = None) -> float:
        """The same of a port that takes a number."""
        found = self.text(name, scope, default)
        if not isinstance(found, str):
            return float(found)
        if values.objection("double", found) and values.objection("int", found):
            raise ScriptError(f"{name} of {self.node} must be a number, is {quoted(found)}")
        return values.number(found.strip())

    def is_set(self, name: str, scope: Scope, default: str) -> bool:
        return is_true(self.text(name, scope, default))

    def variable(self, name: str) -> str:
        """The variable that a port names, in braces or without."""
        said = values.read(name, self.said[name])
        return said.name if isinstance(said, Variable) else said
