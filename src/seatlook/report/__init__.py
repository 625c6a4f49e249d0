"""The gallery page: one static folder that opens without a server and without a network."""

from seatlook.report.data import Check, MapView, PageData, RigHead, Table
from seatlook.report.page import write_page

__all__ = ["Check", "MapView", "PageData", "RigHead", "Table", "write_page"]
