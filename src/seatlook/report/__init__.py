"""The gallery page: one static folder that opens without a server and without a network."""

from seatlook.model.table import Table
from seatlook.report.page.data import Check, MapView, PageData, RigHead
from seatlook.report.page.write import write_page

__all__ = ["Check", "MapView", "PageData", "RigHead", "Table", "write_page"]
