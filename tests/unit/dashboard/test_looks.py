"""Light and dark differ in colours alone, so that what is where may be judged in one of them."""

from __future__ import annotations

import re
from importlib.resources import files

CSS = (files("arboleda.dashboard") / "assets/page.css").read_text(encoding="utf-8")
DARK = (r':root\[data-look="dark"\]', r'@media \(prefers-color-scheme: dark\) \{\s*:root\[data-look="auto"\]')


def declarations(selector: str) -> dict[str, str]:
    """What one rule sets."""
    (body,) = re.findall(selector + r" \{([^}]*)\}", CSS)
    return dict(re.findall(r"([-\w]+): ([^;]+);", body))


def test_the_dark_sets_nothing_but_colours_that_light_has_too() -> None:
    light = declarations(r"(?<=\*/\n\n):root")
    for selector in DARK:
        dark = declarations(selector)
        assert dark.pop("color-scheme") == "dark"
        assert dark.keys() <= light.keys()
        assert all(re.fullmatch("#[0-9a-f]{6}", colour) for colour in dark.values()), dark


def test_the_dark_of_the_system_is_the_one_that_is_chosen() -> None:
    chosen, of_the_system = map(declarations, DARK)
    assert chosen == of_the_system


def test_nothing_else_asks_for_the_dark() -> None:
    assert CSS.count("prefers-color-scheme") == 1
    assert [
        rule for rule in re.findall(r"[^}]*\{", CSS) if 'data-look="dark"' in rule and ":root" not in rule
    ] == ['\n\n.look[data-look="dark"]::before {']
