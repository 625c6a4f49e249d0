"""Log ratio and SSIM by hand, and the verdict over all measures."""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import spearmanr

from seatlook.errors import InputError
from seatlook.visibility.cross_check import Measures, dissimilarity, log_ratio, more_visible
from seatlook.visibility.vwi import score
from support.seen.ridges import PPD, scenes


def naive_ssim(x, y):
    """Mean SSIM of 11 x 11 windows that lie inside, sigma 1.5."""
    r = np.arange(-5, 6)
    w = np.exp(-(r**2) / (2 * 1.5**2))
    w = np.outer(w, w) / w.sum() ** 2
    values = []
    for i in range(5, x.shape[0] - 5):
        for j in range(5, x.shape[1] - 5):
            a, b = (p[i - 5 : i + 6, j - 5 : j + 6] for p in (x, y))
            ma, mb = (w * a).sum(), (w * b).sum()
            va, vb = (w * (a - ma) ** 2).sum(), (w * (b - mb) ** 2).sum()
            c = (w * (a - ma) * (b - mb)).sum()
            values.append(
                (2 * ma * mb + 1e-4) * (2 * c + 9e-4) / ((ma**2 + mb**2 + 1e-4) * (va + vb + 9e-4))
            )
    return np.mean(values)


def test_ssim_is_that_of_the_publication():
    rng = np.random.default_rng(2)
    x = rng.uniform(0.2, 0.9, (24, 20))
    y = np.clip(x + rng.normal(0, 0.05, x.shape), 0, 1)
    inside = np.zeros(x.shape, dtype=bool)
    inside[5:-5, 5:-5] = True
    result = dissimilarity(300 * x**2.2, 300 * y**2.2, white=300.0, mask=inside)
    assert result == pytest.approx(1 - naive_ssim(x, y), rel=1e-9)


def test_what_is_brighter_than_white_cannot_differ_on_a_display():
    a, b = np.full((16, 16), 500.0), np.full((16, 16), 900.0)
    assert dissimilarity(a, b, white=400.0) == 0.0
    assert log_ratio(a, b) == pytest.approx(np.log(1.8))


def test_black_does_not_decide():
    a, b = np.full((16, 16), 10.0), np.full((16, 16), 10.0)
    a[0, 0] = 0.0
    assert log_ratio(a, b) == pytest.approx(np.log(10 / 1e-3) / 16)
    assert log_ratio(np.zeros((16, 16)), np.zeros((16, 16))) == 0.0


def test_a_tie_of_some_or_a_disagreement_is_no_order():
    a = Measures(vwi=2.0, log_ratio=0.1, dissimilarity=0.3)
    b = Measures(vwi=1.0, log_ratio=0.2, dissimilarity=0.2)
    assert more_visible(a, b) == "not separable"
    assert more_visible(a, Measures(vwi=1.0, log_ratio=0.1, dissimilarity=0.2)) == "not separable"


def test_the_same_twice_is_equal_not_inseparable():
    a = Measures(vwi=2.0, log_ratio=0.2, dissimilarity=0.1)
    assert more_visible(a, a) == "equal"


def test_white_must_be_a_luminance():
    with pytest.raises(InputError, match="white: got 0, expected a luminance above 0"):
        dissimilarity(np.ones((16, 16)), np.ones((16, 16)), white=0)


@pytest.fixture(scope="module")
def sweep():
    """Measures of the 54 scenes, and what ColorVideoVDP was recorded to say of them."""
    record = json.loads((Path(__file__).parents[1] / "data" / "cvvdp.json").read_text())
    result = {}
    for name, test, reference in scenes():
        vwi = score(test, reference, pixels_per_degree=PPD).vwi
        result[name] = (vwi, log_ratio(test, reference))
    assert list(result) == list(record["lost"])
    return np.array(list(result.values())).T, np.array(list(record["lost"].values()))


@pytest.mark.validate
def test_vwi_ranks_as_an_independent_metric_does(sweep):
    """Two models of one family: agreement between models, not truth."""
    (vwi, ratio), lost = sweep
    assert spearmanr(vwi, lost).statistic > 0.9
    assert spearmanr(vwi, lost).statistic > spearmanr(ratio, lost).statistic


@pytest.mark.validate
def test_both_name_the_same_worst_light_for_most_looks(sweep):
    (vwi, _), lost = sweep
    same = vwi.reshape(9, 6).argmax(axis=1) == lost.reshape(9, 6).argmax(axis=1)
    assert same.sum() >= 6, same
