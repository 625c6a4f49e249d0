import pytest

from seatlook.errors import InputError
from seatlook.solver import SheetSettings, SolverSettings


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"method": "xpbd"}, "method: got 'xpbd', expected 'lbfgs', 'newton'"),
        ({"dt": 0.0}, "dt: got 0.0, expected above 0 s"),
        ({"dt": float("nan")}, "dt: got nan, expected above 0 s"),
        ({"iterations": 0}, "iterations: got 0, expected 1 or more"),
    ],
)
def test_wrong_settings_are_refused(wrong, message):
    with pytest.raises(InputError, match=message):
        SolverSettings(**wrong)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"method": "xpbd"}, "method: got 'xpbd', expected 'lbfgs', 'newton'"),
        ({"steps": 0}, "steps: got 0, expected 1 or more"),
    ],
)
def test_wrong_settings_of_a_sheet_are_refused(wrong, message):
    with pytest.raises(InputError, match=message):
        SheetSettings(**wrong)
