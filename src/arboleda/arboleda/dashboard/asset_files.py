"""Files for browsers: folders `assets` of Python packages, each at an address that changes with them."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path

FOLDER = "assets"


@dataclass(frozen=True, kw_only=True)
class Assets:
    """The folder `assets` of a Python package.

    It is served below the page's own, whose modules its scripts import as `../live.js`. `script` is the
    module that the page loads, "" for none. `styles` are names of style sheets, which apply after the page's.
    """

    package: str
    script: str = ""
    styles: tuple[str, ...] = ()

    @property
    def folder(self) -> Path:
        return Path(str(resources.files(self.package).joinpath(FOLDER)))

    @property
    def address(self) -> str:
        return f"{own_address()}/{self.package}-{_hash(self.folder)}"

    def of(self, file: str) -> str:
        """The address of a file."""
        return f"{self.address}/{file}"


def own_folder() -> Path:
    return Path(str(resources.files(__package__).joinpath(FOLDER)))


def own_address() -> str:
    """The address of the page's own files."""
    return f"/arboleda/{_hash(own_folder())}"


def own(file: str) -> str:
    """The address of a file of the page's own."""
    return f"{own_address()}/{file}"


@cache
def _hash(folder: Path) -> str:
    """Another one whenever a file has changed, as browsers keep files."""
    files = sorted(each for each in folder.iterdir() if each.is_file())
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()[:12]
