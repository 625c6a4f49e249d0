"""The pyramid against its matrix form, and what it must leave alone."""

import numpy as np
import pytest

from seatlook.visibility.kernels.pyramid import blur, expand, reduce

WEIGHTS = np.array([1, 4, 6, 4, 1]) / 16


def naive_reduce(image):
    """The same on a picture extended by hand: mirrored, slopes go on, within a factor two."""
    rim = naive_extend(image)
    rows, columns = image.shape
    smooth = sum(
        WEIGHTS[a] * WEIGHTS[b] * rim[a : a + rows, b : b + columns]
        for a in range(5)
        for b in range(5)
    )
    return smooth, smooth[::2, ::2]


def naive_extend(image):
    for _ in range(2):
        top, bottom = outside(image), outside(image[::-1])[::-1]
        image = np.concatenate([top, image, bottom]).T
    return image


def outside(image):
    """Two rows above the first: what lies as far inside, less twice the rise to there."""
    n = min(4, len(image) // 2)
    rise = (image[n : 2 * n].mean(axis=0) - image[:n].mean(axis=0)) / n
    rows = [image[k] - 2 * k * rise for k in (2, 1)]
    return np.clip(rows, image[0] / 2, 2 * image[0])


@pytest.mark.parametrize("shape", [(16, 16), (17, 23), (5, 40), (64, 33)])
def test_reduce_and_blur_are_the_binomial_filter(shape):
    image = np.random.default_rng(0).uniform(0, 10, shape)
    smooth, small = naive_reduce(image)
    np.testing.assert_allclose(blur(image), smooth, rtol=1e-13)
    np.testing.assert_allclose(reduce(image), small, rtol=1e-13)


@pytest.mark.parametrize("shape", [(16, 16), (17, 23), (6, 41)])
def test_even_shading_goes_down_and_up_unchanged(shape):
    y, x = np.indices(shape)
    image = 100.0 + 0.3 * x + 0.2 * y
    out = np.empty(shape)
    expand(reduce(image), out)
    np.testing.assert_allclose(out, image, rtol=1e-14)


def test_expand_keeps_the_mean_of_the_inside_and_never_turns_negative():
    small = np.zeros((8, 8))
    small[4, 4] = 1.0
    out = np.empty((16, 16))
    expand(small, out)
    assert out.sum() == pytest.approx(4.0)
    assert out.min() >= 0
    assert out[8, 8] == pytest.approx(36 / 64)
