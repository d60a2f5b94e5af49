"""`python3 -m arboleda_bringup`: reads the arguments of a launch as JSON, writes its plan as JSON."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict


def main() -> int:
    """0 with the plan on stdout, or 1 with a sentence on stderr."""
    from arboleda_ros.missing_libraries import sentence

    try:
        from arboleda.extension import ArboledaError

        from .plan import plan
    except ImportError as error:
        return _refuse(sentence(error))
    try:
        print(json.dumps(asdict(plan(**json.load(sys.stdin)))))
    except ArboledaError as error:
        return _refuse(str(error))
    return 0


def _refuse(why: str) -> int:
    print(why, file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
