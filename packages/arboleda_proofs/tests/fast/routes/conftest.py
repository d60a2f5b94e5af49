"""The application of a plant behind its guard, asked in this process."""

from __future__ import annotations

from tests.unit.web.conftest import no_threads as no_threads
from tests.unit.web.conftest import serve as serve
from tests.web_plant import local as local
from tests.web_plant import open_to_all as open_to_all
from tests.web_plant import plant as plant
from tests.web_plant import web as web
