"""Prints wire_vectors/stepper as a C++ header, without the rows that a trace of them must have."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

VECTORS = Path(__file__).parents[2] / "wire_vectors" / "stepper"
HEAD = """\
#pragma once

#include <stddef.h>
#include <stdint.h>

enum class What : uint8_t { kSetAcceleration, kSetMaxSpeed, kMoveTo, kStop, kSetCurrentPosition };

struct Command {
    uint32_t at_us;
    What what;
    double value;
};

struct Scenario {
    const char* name;
    uint32_t poll_us;
    uint32_t boot_us;
    uint32_t gap_start_us;
    uint32_t gap_us;
    const Command* commands;
    size_t count;
};
"""


def scenarios() -> list[dict[str, Any]]:
    """All recorded scenarios, by name."""
    return [json.loads(path.read_text(encoding="utf-8")) for path in sorted(VECTORS.glob("*.json"))]


def header(recorded: list[dict[str, Any]]) -> str:
    """The scenarios as constants of C++."""
    commands = [
        f"constexpr Command kCommands{at}[] = {{{_commands(each)}}};" for at, each in enumerate(recorded)
    ]
    rows = ",\n    ".join(_scenario(at, each) for at, each in enumerate(recorded))
    return "\n".join([HEAD, *commands, "", f"constexpr Scenario kScenarios[] = {{\n    {rows}}};"])


def _commands(scenario: dict[str, Any]) -> str:
    return ", ".join(
        f"{{{at_us}U, What::k{what[0].upper()}{what[1:]}, {argument[0] if argument else 0}}}"
        for at_us, what, *argument in scenario["commands"]
    )


def _scenario(at: int, scenario: dict[str, Any]) -> str:
    start_us, length_us = scenario["gap_us"] or (0, 0)
    times = f"{scenario['poll_us']}U, {scenario['boot_us']}U, {start_us}U, {length_us}U"
    return f'{{"{scenario["name"]}", {times}, kCommands{at}, {len(scenario["commands"])}}}'


if __name__ == "__main__":
    print(header(scenarios()))
