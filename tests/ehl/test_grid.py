import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ehl.discrete.equations import make_grid
from ehl.discrete.grid import default_domain, face_weights, graded_nodes, hat_weights, middle_weights


@given(st.floats(1e-7, 1e12), st.integers(16, 140))
def test_nodes_rise_fill_the_domain_and_are_nested(H_c, n):
    domain = default_domain(H_c)
    X = graded_nodes(H_c, n, domain)
    fine = graded_nodes(H_c, 2 * n - 1, domain)
    assert (np.diff(X) > 0).all()
    assert (X[0], X[-1]) == domain
    np.testing.assert_allclose(fine[::2], X, rtol=1e-9, atol=1e-9 * H_c ** (2 / 3))


def test_spacing_changes_smoothly():
    h = np.diff(graded_nodes(0.05, 129, (-15.0, 2.5)))
    assert np.max(np.abs(np.diff(np.log(h)))) < 0.15


def test_face_weights_are_exact_for_parabolas_and_lie_upstream():
    X = graded_nodes(0.1, 33, (-5.0, 2.0))
    weights = face_weights(X)
    middle = 0.5 * (X[1:] + X[:-1])
    padded = np.concatenate([[0.0], X])
    for power in range(3):
        at = np.array([weights[f] @ padded[f : f + 3] ** power for f in range(X.size - 1)])
        np.testing.assert_allclose(at[1:], middle[1:] ** power, rtol=1e-12, atol=1e-12)
    assert (weights[1:, 0] < 0).all()
    assert (face_weights(X, upwind=True) == [0.0, 1.0, 0.0]).all()


def test_hat_weights_integrate_lines():
    X = graded_nodes(0.1, 33, (-5.0, 2.0))
    assert hat_weights(X) @ (3 * X + 1) == pytest.approx(1.5 * (4 - 25) + 7, rel=1e-13)


@pytest.mark.parametrize("first", [-0.3, 0.0])
def test_middle_weights_take_cubics_to_the_middle(first):
    X = np.concatenate([[first - 0.9, first - 0.5], first + np.array([0.0, 0.35, 0.6, 1.4])])
    weights = middle_weights(X)
    for power in range(4):
        assert weights @ X**power == pytest.approx(0.0**power, abs=1e-14)
    assert np.count_nonzero(weights) <= 4


def test_oil_ahead_of_the_grid_acts_as_its_integral():
    from scipy.integrate import quad

    grid = make_grid(graded_nodes(0.1, 33, (-5.0, 2.0)), 1.0, np.zeros(32), open_inlet=True)
    for i in (8, 20, 32):
        X = grid.nodes[i]
        exact, _ = quad(lambda t, X=X: np.log(X + t) / t**3, 5.0, np.inf)
        assert grid.tail[i] == pytest.approx(exact, rel=1e-3)  # the tail itself is known to 1e-2
    assert not make_grid(grid.nodes, 1.0, np.zeros(32), open_inlet=False).tail.any()
