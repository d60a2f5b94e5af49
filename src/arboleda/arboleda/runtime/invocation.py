"""Commands that a sentence names, written as the person who started this process would type them."""

from __future__ import annotations

import shutil
import sys


def command() -> str:
    """`arboleda` if a shell finds it, else the path of the one that runs."""
    return "arboleda" if shutil.which("arboleda") else sys.argv[0]


def python() -> str:
    """The Python that Arboleda is installed in."""
    return "python" if shutil.which("arboleda") else sys.executable
