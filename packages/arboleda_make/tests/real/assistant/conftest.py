"""The real server before a prepared plant, as tests of the API have it."""

from tests.contract.web.conftest import local, open_to_all, plant, serve, web

__all__ = ["local", "open_to_all", "plant", "serve", "web"]
