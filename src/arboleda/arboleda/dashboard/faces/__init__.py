"""The contents of the page as flat plain data: key -> value. Pure; one file per part of the page.

| key | value | on the page |
|---|---|---|
| `text/<name>` | [text, state], at times with a tooltip | every element with `data-live="<name>"` |
| `bar/<name>` | share from 0 to 1 | how full a bar is |
| `rows/<list>` | [row, ...] | which rows a list has, in order |
| `row/<list>/<row>` | {state, cell, texts, acts} | one row |
| `chart/<name>` | [[label, number], ...] | a chart |
| `shown/<package>/<key>` | plain data | what a package's script shows when it has to |
| `list/<name>` | [...] | what a script shows when it has to |
| `tree/<cell>` | a drawing | a tree, drawn once per task |
| `node/<cell>/<path>` | {state, ...} | one node of it |
"""

from __future__ import annotations

from typing import Any

Face = dict[str, Any]
"""Content of a part of the page, as flat plain data by its keys: `text/<name>`, `rows/<list>`, ..."""
