"""The line below the card of each cell."""

from arboleda.extension import Page, Value

from . import ENDED

PAGE = Page(card=[Value("counts", ENDED)])
