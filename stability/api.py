"""The two questions that a script asks first: the eigenvalues of a wave, and the tangent matrix itself."""

from typing import TYPE_CHECKING, Any

import numpy as np

from stability import spectrum
from stability.balls import LAST_BITS
from stability.closures import CLOSURES
from stability.errors import PrecisionError, SceneError
from stability.flows import FLOWS
from stability.model import MATRICES, Model, check_range, check_waves, unknown_matrix

MACHINE_RTOL = 1e-15  # a few roundings: what a correctly rounded result may need

if TYPE_CHECKING:
    from sympy import ImmutableMatrix


def eigenvalues(
    closure: Any,
    flow: Any,
    parameters: dict,
    point: dict,
    wavenumber: Any,
    wave_angle: Any,
    matrix: str = "full",
    digits: int | None = None,
    rtol: float | None = None,
) -> np.ndarray:
    """Return every eigenvalue of each wave, by decreasing real part.

    Parameters
    ----------
    closure, flow : registered names, ``my_file.py:NAME``, or a `Closure` and a `Flow`
    parameters : words to numbers, SI units, angles in degrees
    point : coordinates of the flow's point (angles in degrees), {} for a uniform flow
    wavenumber : 1/m, positive; broadcasts against wave_angle
    wave_angle : degrees from the flow's axis
    matrix : "full" (D, P3), "truncated" (D', P7) or "leading" (M, P4)
    digits : None for float64; otherwise decimal digits of an mpmath evaluation, with parameters, point and waves taken
        as the decimals that they print as
    rtol : None, or the relative error below which every growth rate is guaranteed: float64 where its own error bound
        meets it, ball arithmetic elsewhere (parameters and point are then decimals, waves float64 numbers)

    Returns
    -------
    complex array, broadcast shape of wavenumber and wave_angle + (modes,), in 1/s; mpmath numbers with ``digits``. One
    mode under the constraint div u = 0 (the projection's zero eigenvalue belongs to no disturbance), two for the
    perturbed system; in general as many as the pencil ``lambda E a = L a`` has finite eigenvalues.

    Raises
    ------
    SceneError : a parameter, a point or a wave outside its range
    PrecisionError : a value beyond the range of float64; with ``rtol``, a growth rate that cannot be told from zero
    """
    if digits is not None:
        from stability.precise import eigenvalues as precise

        return precise(closure, flow, parameters, point, wavenumber, wave_angle, matrix, digits)
    wavenumber, wave_angle = np.broadcast_arrays(np.asarray(wavenumber, float), np.asarray(wave_angle, float))
    check_waves(wavenumber, wave_angle)
    if rtol is not None:
        return _guaranteed(closure, flow, parameters, point, wavenumber, wave_angle, matrix, rtol)
    form = Model(closure, flow).base(parameters, point).form(wave_angle, matrix)
    with np.errstate(all="ignore"):
        found = form.eigenvalues(wavenumber)
    check_range(found, wavenumber, wave_angle)
    return np.stack(spectrum.leading_first(*found) if len(found) == 2 else found, axis=-1)


def _guaranteed(*question: Any) -> np.ndarray:
    from stability.guaranteed import guaranteed

    if not MACHINE_RTOL <= question[-1] < 1:
        raise SceneError(f"rtol = {question[-1]!r} lies outside [{MACHINE_RTOL:g}, 1): float64 cannot hold more digits")
    found, tally = guaranteed(*question)
    if tally.undecided:
        angle, wavenumber = tally.undecided[0]
        raise PrecisionError(
            f"{len(tally.undecided)} growth rates cannot be told from zero with {LAST_BITS} bits, the first at "
            f"wavenumber {wavenumber!r} 1/m, wave_angle {angle!r} deg: zero, for all that can be told; leave it out"
        )
    return found


def tangent_matrix(closure: Any, flow: Any = None, matrix: str = "full") -> "ImmutableMatrix":
    """Return D, D' or M of a closure as a SymPy matrix in the paper's letters; a notebook shows it in LaTeX.

    Parameters
    ----------
    closure : a registered name, ``my_file.py:NAME``, or a `Closure`
    flow : a registered name or a `Flow` whose base state is written out in place of the letters; None keeps them
    matrix : "full" (D: L3.1, P3), "truncated" (D', P7) or "leading" (M, P4)

    Returns
    -------
    2 x 2 SymPy matrix in ``xi_x, xi_y``, the wavevector's components in the flow's local frame. An index after a
    letter's own is a derivative: ``u_y`` is du/dy, ``A_xx_y`` is dA_xx/dy. `Closure.letters` defines the letters.
    """
    if matrix not in MATRICES:
        raise SceneError(unknown_matrix(matrix))
    from stability.symbols import symbol  # SymPy is imported only here
    from stability.tangent import on_flow, tangent

    closure = CLOSURES[closure] if isinstance(closure, str) else closure
    flow = FLOWS[flow] if isinstance(flow, str) else flow
    found = tangent(closure, (symbol("xi_x"), symbol("xi_y")), matrix)
    return found if flow is None else on_flow(closure, flow, found)
