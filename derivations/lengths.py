"""What the text says of the lengths in its runs: wavelength and direction of the waves, thickness of the jumps."""

from itertools import combinations

import numpy as np

from derivations.judged import SIGMAS, Runs, judge, power
from derivations.verdict import Kind, Verdict
from figures.fronts import mean_length, power_law


def shared(runs: Runs) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return epsilon, and wavelength and mu (windows, epsilon), of the first waves."""
    each = list(runs["first"].values())
    waves = np.array([one["waves"] for one in each])
    return np.array([one["epsilon"] for one in each]), waves[:, :, 0].T, waves[:, :, 3].T


def law(runs: Runs) -> tuple[float, float, str]:
    """Return the exponent of the wavelength over epsilon, its error, and how both are told."""
    epsilon, length, _ = shared(runs)
    means = np.exp(np.log(length).mean(axis=0))
    exponent, error, _ = power_law(epsilon, means)
    each, at = ", ".join(f"{100 * one:.1f}" for one in means), ", ".join(power(e) for e in epsilon)
    return exponent, error, (f"first waves (t = 500ε) {each} cm long at ε = {at} s, geometric means of four windows on "
                             f"the axis: ∝ ε^({exponent:.2f} ± {error:.2f})")  # fmt: skip


def controlled(runs: Runs) -> Verdict:
    """Judge that epsilon sets the wavelength: an exponent beyond its errors, and meshes that agree within theirs.

    Noise is random at every node, so that it differs from mesh to mesh, and with it the waves: their lengths scatter by
    what windows along the axis scatter. Compared are the meshes that are as fine as the paper's or finer.
    """
    exponent, error, said = law(runs)
    by_mesh = sorted((one["elements"], *mean_length(one["waves"])) for one in runs["lengths"])
    meshes = ", ".join(f"{100 * size:.1f} ± {100 * size * e:.1f} cm on {elements}" for elements, size, e in by_mesh)
    fine = [(np.log(size), e) for elements, size, e in by_mesh if elements >= runs["N3"]["elements"]]
    apart = max(abs(a - b) / np.hypot(e, f) for (a, e), (b, f) in combinations(fine, 2))
    set_by_epsilon = exponent > SIGMAS * error
    return judge(
        "runs: wavelength set by ε",
        "on sufficiently fine grids the wavelength of the instability is controlled by the magnitude of ε",
        f"{said}; at ε = 10⁻⁴ s, t = 0.05 s: {meshes} elements, from {runs['N3']['elements']} on at most {apart:.1f} "
        f"standard errors apart; threshold: an exponent beyond {SIGMAS} standard errors, and meshes within {SIGMAS}",
        set_by_epsilon and apart <= SIGMAS,
        f"if finer grids are meant than {runs['N3']['elements']} elements over half the wedge" if set_by_epsilon else
        "the mesh has as large a part in it",
        f"{meshes} elements; ∝ ε^({exponent:.2f} ± {error:.2f})",
        Kind.HOLDS_IF if set_by_epsilon else Kind.FAILS,
    )  # fmt: skip


def root(runs: Runs) -> Verdict:
    """Judge the exponent 1/2 of sqrt(mu epsilon): within two standard errors, and those below 1/4."""
    exponent, error, said = law(runs)
    return judge(
        "runs: wavelength ∝ √ε",
        "√(με) gives a length-scale that appears to be relevant for these features",
        f"{said}; threshold: 1/2 within two standard errors, and these below 1/4",
        abs(exponent - 0.5) <= 2 * error <= 0.25,
        f"an exponent of {exponent:.2f} ± {error:.2f}",
        f"{exponent:.2f} ± {error:.2f}",
    )


def scaled(runs: Runs) -> Verdict:
    """Judge mu xi^2 ~ 1/epsilon. Threshold: a factor of three either way, as "roughly" and "order of" can mean."""
    epsilon, length, mu = shared(runs)
    values = mu * (2 * np.pi / length) ** 2 * epsilon
    each = ", ".join(f"{np.exp(np.log(one).mean()):.2f}" for one in values.T)
    return judge(
        "runs: μ∣ξ∣² ~ 1/ε",
        "the wavenumber of the instabilities roughly satisfies μ∣ξ∣² ~ 1/ε",
        f"με∣ξ∣² of the first waves, with the initial μ there: {each} at ε = {', '.join(power(e) for e in epsilon)} s, "
        f"from {values.min():.2f} to {values.max():.2f} over all windows; threshold: between 1/3 and 3 in the mean",
        bool(np.all(abs(np.log(np.exp(np.log(values).mean(axis=0)))) <= np.log(3))),
        f"μ∣ξ∣² is {np.exp(np.log(values).mean()):.2f}/ε in the mean",
        each,
    )


def oblique(runs: Runs) -> Verdict:
    """Judge the direction. Threshold: 10 degrees, as "approximately"; the wedges of (L5) are 17 degrees wide."""
    waves = np.array([one["waves"] for one in runs["first"].values()])[:, :, 2]
    mean, error = waves.mean(), waves.std(ddof=1) / np.sqrt(waves.size)
    return judge(
        "runs: wavevector at 45°",
        "wavevector at approximately 45° to the directions of principal stress",
        f"{mean:.1f} ± {error:.1f}° from e_r, a principal direction on the axis (first waves, four windows at each "
        "of four ε); the fastest wave of D is at 40°; threshold: 45 ± 10°",
        abs(mean - 45) <= 10,
        "another direction",
        f"{mean:.1f}°",
    )


def grid_dependent(runs: Runs) -> Verdict:
    """Judge that the thickness depends on the mesh: an exponent over cell size beyond its errors, mesh to mesh."""
    cell, thick, error = np.array([(one["cell"], *one["thickness"][:2]) for one in runs["meshes"]]).T
    steps = abs(np.diff(np.log(cell)))
    exponents = np.diff(np.log(thick)) / np.diff(np.log(cell))
    errors = np.hypot(error[1:] / thick[1:], error[:-1] / thick[:-1]) / steps
    dependent = exponents > SIGMAS * errors
    each = ", ".join(f"{1e3 * t:.1f} ± {1e3 * e:.1f} mm on cells of {1e3 * c:.1f} mm"
                     for t, e, c in zip(thick, error, cell, strict=True))  # fmt: skip
    laws = ", then ".join(f"{n:.2f} ± {e:.2f}" for n, e in zip(exponents, errors, strict=True))
    return judge(
        "runs: thickness of jumps",
        "the thickness across which this jump occurs seems to be grid-dependent",
        f"ε = 10⁻⁴ s at t = {runs['meshes'][0]['end']:g} s: {each}; exponent over the cell size {laws} (1: set by the "
        f"mesh, 0: resolved); threshold: above 0 by {SIGMAS} standard errors",
        bool(np.all(dependent)),
        f"up to {runs['meshes'][-2]['elements']} elements over half the wedge: on the next mesh it is nearly the same"
        if dependent[0]
        else "it is resolved",
        f"exponents {laws}",
        Kind.HOLDS_IF if dependent[0] else Kind.FAILS,
    )
