"""The gallery page: one static folder that opens without a server and without a network."""

from seatlook.model.table import Table
from seatlook.report.page.data import PageData, RigHead
from seatlook.report.page.types import Check, MapView
from seatlook.report.page.write import write_page

__all__ = ["Check", "MapView", "PageData", "RigHead", "Table", "write_page"]
