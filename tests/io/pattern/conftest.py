import pytest

from support.dxf_sheet import Sheet


@pytest.fixture
def sheet(tmp_path):
    return Sheet(tmp_path / "a.dxf")
