"""The public questions against 40-digit references, by two independent routes each."""

from types import ModuleType

import numpy as np
import pytest
from mpmath import mpf
from sympy import MatrixBase

import stability as st
from stability.errors import SceneError

EPS = 2.0**-52


def cases(reference):
    """Yield (closure, flow, parameters, point, q, angle, matrix, expected) of every reference eigenvalue set."""
    geometry = reference["meta"]["parameters"]
    for row in reference["values"]:
        at = ({"r": row["r"], "theta": row["theta"]}, row["wavenumber"], row["wave_angle"])
        yield "rigid_plastic", "radial_hopper", geometry, *at, "full", row["rigid_plastic"]
        yield "perturbed", "radial_hopper", geometry | {"epsilon": "2e-5"}, *at, "leading", row["M"]
        for flow in ("radial_hopper", "radial_hopper_compatible"):
            for epsilon, matrices in row[flow].items():
                for matrix, expected in matrices.items():
                    yield "perturbed", flow, geometry | {"epsilon": epsilon}, *at, matrix, expected


def test_float64_meets_the_reference_to_1e_12(reference):
    # Scale |lambda|. On the stress characteristic (28 degrees on the axis, 2a = k) the leading terms of rigid-plastic
    # flow and of D' cancel exactly, so there the rounding of the inputs alone, 34 degrees in radians for one, moves
    # lambda by a rounding of mu q^2: four of those are allowed, to these two only.
    count = 0
    for closure, flow, parameters, point, q, angle, matrix, expected in cases(reference):
        numbers = {w: float(v) for w, v in parameters.items()}
        found = st.eigenvalues(
            closure, flow, numbers, {w: float(v) for w, v in point.items()}, float(q), float(angle), matrix
        )
        assert found.shape == (len(expected),)
        viscosity = 1.6  # an upper bound of mu at the reference points
        for value, (real, imaginary) in zip(found, expected, strict=True):
            scale = abs(complex(float(real), float(imaginary)))
            tolerance = 1e-12 * scale + 4 * EPS * viscosity * float(q) ** 2 * (
                matrix != "full" or closure == "rigid_plastic"
            )
            assert abs(mpf(value.real) - mpf(real)) <= tolerance
            assert abs(mpf(value.imag) - mpf(imaginary)) <= tolerance
            count += 1
    assert count == 180 * (1 + 2 + 2 * 2 * 4)


def test_the_growth_rate_on_the_papers_parameters_is_relative_to_1e_12(reference):
    # The main case: the full D of the perturbed system on the appendix flow; here relative to |Re lambda| itself.
    for closure, flow, parameters, point, q, angle, matrix, expected in cases(reference):
        if (flow, matrix, closure) == ("radial_hopper", "full", "perturbed"):
            numbers = {w: float(v) for w, v in parameters.items()}
            at = {w: float(v) for w, v in point.items()}
            found = st.eigenvalues(closure, flow, numbers, at, float(q), float(angle))
            for value, (real, _) in zip(found, expected, strict=True):
                assert abs(mpf(value.real) / mpf(real) - 1) < 1e-12


def test_asking_for_digits_gives_them(reference):
    for closure, flow, parameters, point, q, angle, matrix, expected in list(cases(reference))[::23]:
        found = st.eigenvalues(closure, flow, parameters, point, q, angle, matrix, digits=40)
        assert found.dtype == object
        for value, (real, imaginary) in zip(found, expected, strict=True):
            # at least 35 of the printed digits are significant
            assert abs(value.real - mpf(real)) <= mpf(10) ** -34 * (abs(mpf(real)) + mpf(10) ** -20)
            assert abs(value.imag - mpf(imaginary)) <= mpf(10) ** -34 * (abs(mpf(imaginary)) + mpf(10) ** -20)


def test_shapes_broadcast(perturbed_hopper):
    point = {"r": 1.0, "theta": 0.0}
    found = st.eigenvalues("perturbed", "radial_hopper", perturbed_hopper, point, np.ones(3), np.zeros((2, 1)))
    assert found.shape == (2, 3, 2)
    constrained = {w: v for w, v in perturbed_hopper.items() if w != "epsilon"}
    assert st.eigenvalues("rigid_plastic", "radial_hopper", constrained, point, 1.0, 0.0).shape == (1,)
    precise = st.eigenvalues("perturbed", "radial_hopper", perturbed_hopper, point, [1, 2], [[0], [1], [2]], digits=20)
    assert precise.shape == (3, 2, 2)


def test_eigenvalues_come_by_decreasing_real_part(perturbed_hopper):
    found = st.eigenvalues(
        "perturbed",
        "radial_hopper",
        perturbed_hopper,
        {"r": 1, "theta": 0},
        np.geomspace(1, 1e8, 50),
        np.arange(50) * 7,
    )
    assert np.all(found[:, 0].real >= found[:, 1].real * (1 + 4 * EPS))


REFUSALS = [
    ({"wavenumber": 0.0}, "wavenumber = 0 1/m lies outside"),
    ({"wavenumber": -2.0}, "wavenumber = -2 1/m lies outside"),
    ({"wave_angle": np.nan}, "wave_angle holds values that are not finite"),
    ({"matrix": "whole"}, "matrix = 'whole' is unknown: use one of full, truncated, leading"),
    ({"digits": 0}, "digits = 0 lies outside"),
    ({"closure": "purturbed"}, "did you mean 'perturbed'"),
    ({"flow": "hopper"}, "flow 'hopper' is unknown"),
    ({"point": {"r": 1}}, "point theta is missing"),
]


@pytest.mark.parametrize(("change", "sentence"), REFUSALS)
def test_bad_questions_are_refused_with_one_clear_sentence(perturbed_hopper, change, sentence):
    question = {
        "closure": "perturbed", "flow": "radial_hopper", "parameters": perturbed_hopper,
        "point": {"r": 1, "theta": 0}, "wavenumber": 1.0, "wave_angle": 0.0,
    } | change  # fmt: skip
    with pytest.raises(SceneError, match=sentence):
        st.eigenvalues(**question)


def test_the_tangent_matrix_is_a_sympy_matrix_that_a_notebook_shows():
    D = st.tangent_matrix("perturbed")
    assert isinstance(D, MatrixBase) and D.shape == (2, 2)
    assert "\\mu" in D._repr_latex_() and "epsilon" in D._repr_latex_()
    with pytest.raises(SceneError, match="unknown"):
        st.tangent_matrix("perturbed", matrix="half")


def test_public_names_exist():
    assert {"CLOSURES", "FLOWS", "eigenvalues", "tangent_matrix", "neutral_curve", "load_scene", "run"} <= set(dir(st))
    with pytest.raises(AttributeError, match="no attribute 'eigenvalue'"):
        st.eigenvalue  # noqa: B018


def test_every_public_name_is_what_it_says_however_often_it_is_asked_for():
    # A subpackage of the same name would take its place once it is imported.
    found = [[getattr(st, name) for name in st.__all__] for _ in range(2)]
    assert found[0] == found[1] and not any(isinstance(each, ModuleType) for each in found[0])
