"""A browser, as tests of the whole system have it, and the playground that it opens."""

from tests.system.conftest import browser

from .playground_site import playground

__all__ = ["browser", "playground"]
