"""Pages of packages: tabs, cards and settings that are declared as data, filled with what a part shows.

A `Page` is registered under `arboleda.page`. Its values, rows and charts are those that the part of the
package shows by the same keys. Its acts are called in a thread, with what somebody typed.
"""

from .acts import Act, Asked
from .fields import Field
from .items import Chart, Page, Rows, Tab, Value

__all__ = ["Act", "Asked", "Chart", "Field", "Page", "Rows", "Tab", "Value"]
