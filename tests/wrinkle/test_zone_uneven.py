"""Figures of zones on uneven elements: each against its definition, none of them replaceable."""

import dataclasses

import numpy as np
import pytest

from seatlook import wrinkle
from seatlook.model import Criteria
from support.wrinkle_samples import shaped

SIZE, H = (0.14, 0.1), 0.004
LEFT, RIGHT = "left", "right"


def bumpy(X):
    """Waves of three lengths and directions, the shorter to the right, on a sheet pulled askew."""
    x, y = X.T
    z = 0.0006 * np.sin(150 * x + 60 * y) * (x / 0.14) ** 2 + 0.0004 * np.sin(90 * y - 40 * x)
    return np.column_stack([1.01 * x + 0.01 * y, 0.985 * y, z])


def figures(solution, indices, net=None):
    """Rows of the table by zone, as mappings."""
    values = {name: getattr(indices, name) for name in ("w2", "w_stretch", "w_compression")}
    rows = wrinkle.zone_table(
        solution.cover,
        values if net is None else values | {"w2_net": net},
        criteria=Criteria(curvature="tensor", thresholds=(4.0,)),
    )
    return {row.zone: row.values() for row in rows}


@pytest.fixture(scope="module")
def sample():
    """Solution of two slanted zones and an empty one between them in the list, and its indices."""
    solution = shaped(bumpy, h=H, kind="graded", size=SIZE)
    cover = solution.cover
    centre = cover.rest[cover.faces].mean(axis=1)
    zone = np.where(centre @ [1.0, 0.5] > 0.09, 2, 0)
    cover = dataclasses.replace(cover, zone=zone, zone_names=(LEFT, "empty", RIGHT))
    solution = dataclasses.replace(solution, cover=cover)
    indices = wrinkle.wrinkle_indices(
        *wrinkle.surface_strains(solution), cover.thickness, 4.0, "tensor"
    )
    return solution, indices


def rows_of(sample):
    solution, indices = sample
    net = indices.w2 * np.linspace(0.2, 1.4, len(indices.w2))
    for number, name in ((0, LEFT), (2, RIGHT)):
        inside = solution.cover.zone == number
        yield figures(solution, indices, net)[name], inside, solution.cover.rest_area[inside], net


def test_empty_zones_are_left_out(sample):
    assert list(figures(*sample)) == [LEFT, RIGHT]


def test_error_is_the_root_mean_square_over_the_area(sample):
    solution, indices = sample
    error = wrinkle.recovery_error(solution.cover.rest, solution.cover.faces, indices.w2)
    for row, inside, area, _ in rows_of(sample):
        own = error[inside]
        assert row["w2_face_rms"] == pytest.approx(np.sqrt(own**2 @ area / area.sum()), rel=1e-12)
        # The sample tells it from all that it could be mistaken for.
        others = {
            "mean": abs(own @ area / area.sum()), "mean size": np.abs(own) @ area / area.sum(),
            "mean square": own**2 @ area / area.sum(), "largest": np.abs(own).max(),
            "of faces": np.sqrt((own**2).mean()), "spread": own.std(),
        }  # fmt: skip
        for name, value in others.items():
            assert abs(value / row["w2_face_rms"] - 1.0) > 1e-4, name


def test_means_and_shares_are_over_the_area(sample):
    _, indices = sample
    for row, inside, area, net in rows_of(sample):
        for name, values in (
            ("w2_mean", indices.w2), ("w_stretch_mean", indices.w_stretch),
            ("w_compression_mean", indices.w_compression), ("w2_net_mean", net),
            ("w2_area_share", indices.w2 > 1), ("w2_net_area_share", net > 1),
        ):  # fmt: skip
            own = values[inside].astype(float)
            assert row[name] == pytest.approx(own @ area / area.sum(), rel=1e-12), name
            assert abs(own.mean() / row[name] - 1.0) > 1e-4, name
        assert 1e-4 * row["area_cm2"] == pytest.approx(area.sum())
        assert row["stretch_share"] == pytest.approx(
            (indices.w_stretch[inside] @ area) / (indices.w2[inside] @ area), rel=1e-12
        )
        assert 0.1 < row["stretch_share"] < 0.9


def test_p95_has_a_twentieth_of_the_area_above_it(sample):
    _, indices = sample
    for row, inside, area, net in rows_of(sample):
        for name, values in (("w2_p95", indices.w2[inside]), ("w2_net_p95", net[inside])):
            above = area[values > row[name]].sum() / area.sum()
            at_least = area[values >= row[name]].sum() / area.sum()
            assert above <= 0.05 < at_least
            assert abs(np.quantile(values, 0.95) / row[name] - 1.0) > 1e-4


def test_element_size_is_the_mean_edge_at_rest(sample):
    solution, _ = sample
    corners = solution.cover.rest[solution.cover.faces]
    edges = [np.linalg.norm(corners[:, k] - corners[:, k - 1], axis=1) for k in range(3)]
    sizes = []
    for row, inside, _, _ in rows_of(sample):
        assert 1e-3 * row["element_size_mm"] == pytest.approx(np.mean(edges, axis=0)[inside].mean())
        sizes.append(1e-3 * row["element_size_mm"])
    assert abs(sizes[0] / sizes[1] - 1.0) > 1e-4


def test_net_figures_are_absent_where_it_was_not_evaluated(sample):
    for row in figures(*sample).values():
        assert all(row.get(f"w2_net_{name}") is None for name in ("mean", "p95", "area_share"))
