"""The fastest waves in the hopper, seen four ways: by D at a point, by the mesh's symbol, as global mode, in a run.

Local theory takes the flow for uniform along a wave. A global mode and a run know that it is not: so places, lengths
and rates agree roughly, and the differences are told apart by what each of the four leaves out.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from stability.crosscheck.symbol import node_matrix, polar_base
from stability.crosscheck.theory import tangent, unit
from stability.timestepper.integrate import Control, start, steps
from stability.timestepper.linear import direct
from stability.timestepper.ordering import nested_dissection
from stability.timestepper.problem import Problem

ANGLES = np.arange(-90.0, 90.0, 2.0)  # degrees from e_r: a wave and its opposite are one
SCALED = np.geomspace(0.25, 3.0, 36)  # wavenumbers times sqrt(mu epsilon)
MARGIN = 0.03  # of the hopper's length: nodes nearer to its boundary have waves that feel it
SHORTEST = 4.0  # cells in the shortest wave of a mesh that is looked at: shorter ones say nothing about the equations
SAMPLES = 200  # nodes at which the mesh's own waves are looked for
ABOUT = 0.7  # of the largest local growth rate: shifts for the global modes, which grow by less than it
WINDOW = 0.5  # of a wavelength: width of the Gaussian through which a field is looked at
SPAN = 0.3  # of a run: over which its growth is taken


@dataclass(frozen=True)
class Found:
    """The fastest wave as one of the four ways shows it.

    Attributes
    ----------
    r, theta : where (m, degrees)
    wavenumber, wave_angle : 1/m, degrees from the local e_r
    growth, frequency : 1/s, rad/s; NaN where a frequency was not seen
    """

    r: float
    theta: float
    wavenumber: float
    wave_angle: float
    growth: float
    frequency: float = float("nan")


def wavevectors(length: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return wavenumbers (1/m), angles (degrees) and wavevectors of a grid scaled by sqrt(mu epsilon) (m)."""
    q, angle = (a.ravel() for a in np.meshgrid(SCALED / length, ANGLES))
    return q, angle, q[:, None] * np.stack([np.cos(np.radians(angle)), np.sin(np.radians(angle))], axis=1)


def local_wave(closure: Any, flow: Any, parameters: Mapping[str, float], r: float, theta: float = 0.0) -> Found:
    """Return the fastest wave of D at a point."""
    base = polar_base(closure, flow, parameters, r * unit(theta))
    q, angle, _ = wavevectors(float(np.sqrt(base.letters()["mu"] * parameters["epsilon"])))
    values = np.array(base.form(angle).eigenvalues(q))
    mode, wave = np.unravel_index(np.argmax(values.real), values.shape)
    best = values[mode, wave]
    return Found(r, theta, float(q[wave]), float(angle[wave]), float(best.real), float(best.imag))


def largest_local(
    closure: Any, flow: Any, parameters: Mapping[str, float], theta: np.ndarray, count: int = 40
) -> Found:
    """Return the fastest of all local waves at ``count`` radii and the given angles (degrees)."""
    r_0, r_1 = parameters["outlet_radius"], parameters["inlet_radius"]
    radii = np.linspace(r_0, r_1, count + 2)[1:-1]
    found = [local_wave(closure, flow, parameters, float(r), float(t)) for t in np.atleast_1d(theta) for r in radii]
    return max(found, key=lambda wave: wave.growth)


def inner_nodes(problem: Problem) -> np.ndarray:
    """Return the nodes that are not next to a boundary."""
    r, theta = np.hypot(*problem.mesh.nodes.T), np.arctan2(problem.mesh.nodes[:, 1], problem.mesh.nodes[:, 0])
    far = MARGIN * np.ptp(r)
    inside = (r > r.min() + far) & (r < r.max() - far) & (r * (theta.max() - theta) > far) & (r * theta > far)
    return np.flatnonzero(inside)


def largest_on_mesh(problem: Problem, closure: Any, flow: Any, parameters: Mapping[str, float]) -> Found:
    """Return the fastest wave of the discrete symbol at any of some nodes of a mesh, in the problem's initial state."""
    blocks, nodes = problem.jacobian_blocks(problem.initial), inner_nodes(problem)
    found = []
    for node in nodes[:: max(1, nodes.size // SAMPLES)]:
        x, y = problem.mesh.nodes[node]
        base = polar_base(closure, flow, parameters, problem.mesh.nodes[node])
        q, angle, xi = wavevectors(float(np.sqrt(base.letters()["mu"] * parameters["epsilon"])))
        held = q * np.sqrt(problem.volume[node]) < 2 * np.pi / SHORTEST
        q, angle, xi = q[held], angle[held], xi[held]
        values = np.linalg.eigvals(tangent(node_matrix(problem, blocks, node, xi), problem.law.evolves))
        wave, mode = np.unravel_index(np.argmax(values.real), values.shape)
        best, place = values[wave, mode], (float(np.hypot(x, y)), float(np.degrees(np.arctan2(y, x))))
        found.append(Found(*place, float(q[wave]), float(angle[wave]), float(best.real), float(best.imag)))
    return max(found, key=lambda wave: wave.growth)


def seen(problem: Problem, field: np.ndarray, length: float) -> tuple[float, float, float, float]:
    """Return place and wave (r, theta, wavenumber, wave_angle) of the strongest wave in a velocity field.

    Parameters
    ----------
    field : (n, 3), real or complex; its velocities are looked at
    length : sqrt(mu epsilon) (m), which sets the range of wavenumbers and the window
    """
    nodes, velocity = problem.mesh.nodes, field[:, :2] * problem.volume[:, None]
    energy = (abs(field[:, :2]) ** 2).sum(axis=1) * problem.volume
    width = WINDOW * 2 * np.pi * length  # of the wave with wavenumber 1/length
    candidates = np.argsort(-energy)[:SAMPLES]
    near = np.exp(-(((nodes[candidates, None] - nodes) / width) ** 2).sum(axis=-1))
    centre = nodes[candidates[np.argmax(near @ energy)]]
    r, theta = float(np.hypot(*centre)), float(np.degrees(np.arctan2(centre[1], centre[0])))
    q, angle, xi = wavevectors(length)
    c, s = centre / r
    xi = xi @ np.array([[c, s], [-s, c]])  # from the local frame
    offset = nodes - centre
    window = np.exp(-((offset / width) ** 2).sum(axis=1) / 2)
    inside = window > 1e-4
    spectrum = np.zeros(q.size)
    for sign in (1, -1) if np.iscomplexobj(field) else (1,):
        phase = np.exp(-1j * sign * xi @ offset[inside].T)
        amplitude = phase @ (window[inside, None] * velocity[inside])
        spectrum = np.maximum(spectrum, (abs(amplitude) ** 2).sum(axis=1))
    best = int(np.argmax(spectrum))
    return r, theta, float(q[best]), float(angle[best])


@dataclass(frozen=True, eq=False)
class Pair:
    """Two runs, of which one began with noise.

    Attributes
    ----------
    time : (steps,) in s
    size : (steps,) root mean square difference of the velocities (m/s)
    difference : (n, 3) the last difference of the fields
    """

    time: np.ndarray
    size: np.ndarray
    difference: np.ndarray


def pair_of_runs(problem: Problem, noise: np.ndarray, duration: float, dt: float) -> Pair:
    """Return the difference that noise (n, 3) in the initial state makes: waves on the flow as it develops."""
    control = Control(first=dt, largest=dt, smallest=dt / 64)
    stops = [float(t) for t in np.arange(1, round(duration / dt) + 1) * dt]
    order = nested_dissection(problem.mesh.logical, problem.mesh.elements)

    def fields(initial: np.ndarray) -> Any:
        begun = replace(problem, initial=initial)
        for state, _ in steps(begun, start(begun, control), control, stops, direct(order)):
            if state.time in stops:
                yield state.q

    size, difference = [], noise
    for clean, noisy in zip(fields(problem.initial), fields(problem.initial + noise), strict=True):
        difference = noisy - clean
        weight = problem.volume / problem.volume.sum()
        size.append(float(np.sqrt(weight @ (difference[:, :2] ** 2).sum(axis=1))))
    return Pair(np.array(stops), np.array(size), difference)


def growth_of(pair: Pair) -> float:
    """Return the largest growth rate (1/s) of the difference over any part of the runs of a given length.

    Before, it is still rid of what decays; after, both runs have bands, which do not grow.
    """
    length = max(2, round(SPAN * pair.time.size))
    parts = [slice(i, i + length) for i in range(pair.time.size - length + 1)]
    return max(float(np.polyfit(pair.time[p], np.log(pair.size[p]), 1)[0]) for p in parts)
