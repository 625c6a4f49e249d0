import subprocess
import sys

import pytest

import seatlook.io

CODE = """
import sys
import seatlook.io
heavy = {"ezdxf", "trimesh", "shapely", "scipy", "numpy"} & set(sys.modules)
assert not heavy, heavy
import seatlook.io.material
assert not {"ezdxf", "trimesh", "shapely", "scipy"} & set(sys.modules)
"""


def test_import_loads_no_format():
    subprocess.run([sys.executable, "-c", CODE], check=True, timeout=60)


@pytest.mark.parametrize("name", seatlook.io.__all__)
def test_every_public_name_is_there(name):
    assert callable(getattr(seatlook.io, name))


def test_no_public_name_is_hidden_by_a_module():
    names = set(seatlook.io.__all__)
    modules = {name.rsplit(".", 1)[1] for name in sys.modules if name.startswith("seatlook.io.")}
    assert not names & modules
    with pytest.raises(AttributeError, match="no attribute 'write_step'"):
        seatlook.io.write_step  # noqa: B018
