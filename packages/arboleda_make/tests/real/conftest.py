"""A command line, processes and a browser, as tests of the whole system have them."""

from tests.system.conftest import arboleda, browser, start, typed

__all__ = ["arboleda", "browser", "start", "typed"]
