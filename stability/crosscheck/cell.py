"""A plane wave in a periodic cell of uniform strain: the time-stepper's own growth rate against that of D.

The cell is seen from a point that moves with the material, as D is: the unknowns are what is added to the uniform
state. The nonlinear equations are solved, of an amplitude so small that they are linear to 1e-8.
"""

from typing import Any

import numpy as np

from stability.crosscheck.theory import PlaneWave, plane_wave, uniform, unit
from stability.model import Base
from stability.timestepper.constraints import Constraints
from stability.timestepper.integrate import Control, start, steps
from stability.timestepper.law import Law
from stability.timestepper.linear import direct
from stability.timestepper.mesh import Mesh, periodic_cell
from stability.timestepper.problem import Background, Problem

# Strain rate of the wave relative to that of the cell, or its velocity relative to the drift, the larger one. What is
# not linear is of this size relative to the wave, and rounding 1e-16 over it.
AMPLITUDE = 1e-8
DURATION = 0.5  # of a run, times the rate of the fastest of the wave and its harmonics
HARMONICS = 16  # of the wave, in which backward Euler makes much of rounding where rate times step nears one

# Of Newton's last correction, relative to the wave's size. The first one solves what is linear, all but 1e-8; later
# ones are rounding: 1e-16/1e-8 of the wave times the cells in it, and more of it where the material drifts.
TOLERANCE = 1e-3


def held_pressure(node: int, value: float = 0.0) -> Constraints:
    """Return the constraint that sets the pressure's level, which the balances of a periodic cell leave open."""
    return Constraints(
        np.array([node]), np.eye(3)[None], np.array([[False, False, True]]), lambda time: np.array([0, 0, value])
    )


def cell_problem(base: Base, mesh: Mesh, initial: np.ndarray, scales: np.ndarray, floor: float = 0.0) -> Problem:
    """Return the problem of a disturbance (n, 3) of a uniform base state in a periodic cell."""
    (_, gradient, _), (pressure, *_) = base.state
    return Problem(
        mesh=mesh,
        law=Law(base.model.closure, base.parameters, floor=floor),
        initial=initial,
        scales=scales,
        constraints=held_pressure(0, float(initial[0, 2])),
        background=Background(np.array(gradient, dtype=float), float(pressure)),
    )


def row_of(wave: PlaneWave, cells: int) -> Mesh:
    """Return one wavelength as a row of cells along the wave."""
    q = float(np.hypot(*wave.wavevector))
    x, y = wave.wavevector / q
    size = np.hypot(x, y)  # one, but for rounding
    return periodic_cell(2 * np.pi / q, cells, (float(x / size), float(y / size)))


def measured(
    base: Base, wave: PlaneWave, mesh: Mesh, number: int, duration: float, scheme: str = "backward_euler"
) -> complex:
    """Return growth rate + i frequency of a wave from a run of a number of equal steps.

    The wave starts as the theory's eigenvector, and its amplitude is measured with the theory's left one: what the
    mesh's own eigenvectors differ, O(h2), then enters as O(h4) only.
    """
    strain = float(base.letters()["N"])
    length = 1 / np.hypot(*wave.wavevector)
    phase = np.exp(1j * mesh.nodes @ wave.wavevector)
    drift = np.array([*base.state[0][0], 0.0], dtype=float)
    size = AMPLITUDE * max(strain * length, np.hypot(*drift[:2]))
    initial = drift + size * (phase[:, None] * wave.field).real
    scales = size * np.abs(wave.field).max() * np.ones(3)
    scales[2] = max(size * abs(wave.field[2]), scales[0] * strain * length)
    problem = cell_problem(base, mesh, initial, 100 * scales)  # an update is limited to half of these
    dt = duration / number
    control = Control(first=dt, largest=dt, smallest=dt / 2, scheme=scheme, tolerance=TOLERANCE / 100)

    def amplitude(q: np.ndarray) -> complex:
        return wave.dual @ ((q - drift) * phase.conj()[:, None]).mean(axis=0) * 2

    *_, (last, _) = steps(problem, start(problem, control), control, [duration], direct())
    turns = wave.eigenvalue.imag * duration  # a frequency is known up to full turns in the time of the run
    ratio = amplitude(last.q) / amplitude(initial) * np.exp(-1j * turns)
    return complex((np.log(ratio) + 1j * turns) / duration)


def cell_growth(
    closure: Any,
    parameters: dict,
    wavenumber: float,
    wave_angle: float,
    cells: int = 32,
    number: int = 16,
    duration: float | None = None,
    drift: float = 0.0,
    scheme: str = "backward_euler",
) -> complex:
    """Return growth rate + i frequency (1/s) that the nonlinear time-stepper gives a plane wave of amplitude 1e-8.

    Parameters
    ----------
    closure, parameters : words of the closure and of the flow "uniform_strain"
    wavenumber, wave_angle : 1/m, degrees from the axis of extension
    cells : in a wavelength
    number, duration : of the time steps, and of them all (s): short against all growth in the cell if it is not given
    drift : speed (m/s) of the material along the streamlines of a simple shear (`theory.uniform`)
    scheme : of the time-stepper
    """
    base = uniform(closure, parameters, drift)
    wave = plane_wave(base, wavenumber * unit(wave_angle))
    if duration is None:
        growing = [plane_wave(base, n * wave.wavevector).eigenvalue.real for n in range(2, HARMONICS + 1)]
        duration = DURATION / max(abs(wave.eigenvalue), *growing)
    return measured(base, wave, row_of(wave, cells), number, duration, scheme)
