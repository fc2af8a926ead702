"""What a march will be, before it runs: its mesh, whether that resolves the waves, and about how long it takes."""

import json
from dataclasses import asdict, dataclass
from math import log, pi, sqrt

import numpy as np

from stability.closures import CLOSURES
from stability.codegen import load
from stability.model import Model
from stability.parameters import to_si
from stability.timestepper.march import March
from stability.timestepper.mesh import Mesh, hopper_mesh

# The fastest-growing wave of the full D at (1 m, 0) of the paper's hopper has |xi| = 1.15/sqrt(mu epsilon): 79 and 178
# per m at epsilon = 1e-4 and 2e-5 s.
FASTEST = 1.15
CELLS = 10  # in a wavelength: with fewer the discrete growth misses that of the continuum by more than 12 %
ALONG = 200  # radii at which the base state is looked at
GROWTH = 1.3  # of a step after an easy one

# Seconds of a march, and of one time step of it, on one core of a 2.5 GHz machine: rough, for choosing a mesh.
COST = {
    "start": 0.5,  # mesh, pattern, ordering, result
    "seconds": 0.1,  # at so many elements, on the base state
    "elements": 4000,
    "power": 1.3,  # how it grows with the number of elements
    "banded": 2.5,  # times that, once there are bands: more iterations, more factors
    "bdf2": 1.0,
    "backward_euler": 1.0,
    "direct": 1.0,
    "iterative": 10.0,  # a solve costs several factorisations (benchmarks)
    "default": 4.0,
}


@dataclass(frozen=True)
class Forecast:
    """What will be marched. ``wavelength`` (m) is that of the first waves, and None where none is known."""

    mesh: str
    elements: int
    unknowns: int
    time: str
    steps: int
    predicted_seconds: float
    wavelength: float | None
    cells_per_wavelength: float | None
    reasons: tuple[str, ...]
    warnings: tuple[str, ...]

    @property
    def text(self) -> str:
        """The forecast as JSON."""
        return json.dumps(asdict(self))

    def rows(self, digits: int | None = None) -> list[tuple[str, str]]:
        """Return the rows of an explanation."""
        return [
            ("mesh", self.mesh),
            ("unknowns", f"{self.unknowns}"),
            ("time", self.time),
            ("cost", f"{self.predicted_seconds:.2g} s, some {self.steps} steps"),
        ]


def forecast(asked: March) -> Forecast:
    """Return what a march will be; the base state is looked at, nothing is stepped."""
    si = to_si(Model(asked.closure, asked.flow).parameters, asked.parameters)
    mesh = hopper_mesh(si["outlet_radius"], si["inlet_radius"], si["wedge_angle"], **asked.mesh)
    reasons, warnings, wave = waves(asked, mesh)
    elements = len(mesh.elements)
    steps, seconds = cost(asked, elements)
    radii, angles = mesh.grid.shape if mesh.grid is not None else (0, 0)
    options = asked.words["mesh"]
    kind, domain = options["kind"], "half the wedge" if options["half"] else "the whole wedge"
    end, count = asked.snapshots[-1], len(asked.snapshots)
    scheme = {"backward_euler": "backward Euler", "bdf2": "BDF2"}[asked.scheme]
    return Forecast(
        mesh=f"{kind}, {elements} elements over {domain}: {radii - 1} along the radius, {angles - 1} across",
        elements=elements,
        unknowns=mesh.nodes.shape[0] * 3,
        time=f"to {end:g} s, {count} snapshots; {scheme}, steps of {asked.first:g} to {asked.largest:g} s",
        steps=steps,
        predicted_seconds=seconds,
        wavelength=wave[0],
        cells_per_wavelength=wave[1],
        reasons=(
            *reasons,
            f"floor: ||V|| below {asked.floor:g} 1/s is bounded in the rheology; the result counts the cells",
            f"cost: {COST['seconds']:g} s for a step at {COST['elements']} elements, which grows with their number to "
            f"the power {COST['power']:g}, and {COST['banded']:g} times that once there are bands",
        ),
        warnings=tuple(warnings),
    )


def waves(asked: March, mesh: Mesh) -> tuple[list[str], list[str], tuple[float | None, float | None]]:
    """Return reasons, warnings, and the wavelength of the first waves (m) with the cells in it."""
    closure = load(CLOSURES, asked.closure)
    if "epsilon" not in {record.word for record in closure["PARAMETERS"]}:
        said = "has no time scale epsilon: where nothing else limits the growth of short waves, the mesh does"
        return ["waves: no wavelength is predicted without epsilon"], [f"{closure['NAME']} {said}"], (None, None)
    epsilon = asked.parameters["epsilon"]
    r, viscosity = largest_viscosity(asked)
    if viscosity is None:
        return ["waves: the closure has no letter mu, so that no wavelength is predicted"], [], (None, None)
    wavelength = 2 * pi * sqrt(viscosity * epsilon) / FASTEST
    cell = cell_size(mesh, r)
    number = wavelength / cell
    told = (
        f"waves: the first are expected where mu is largest, {viscosity:.3g} m2/s at r = {r:.3g} m on the axis, of "
        f"2 pi sqrt(mu epsilon)/{FASTEST:g} = {wavelength:.3g} m: {number:.1f} cells of {cell:.2g} m"
    )
    if number >= CELLS:
        return [told], [], (wavelength, number)
    # Cells in a wavelength go with the square root of their number.
    enough = len(mesh.elements) * (CELLS / number) ** 2
    few = (
        f"{number:.1f} cells in a wavelength are too few, {CELLS} resolve it: the waves will be those of the mesh; "
        f"{enough:.2g} elements would do"
    )
    return [told], [few], (wavelength, number)


def largest_viscosity(asked: March) -> tuple[float, float | None]:
    """Return the radius (m) on the axis where mu is largest, and mu there (m2/s), None where there is no mu."""
    ends = asked.parameters["outlet_radius"], asked.parameters["inlet_radius"]
    r = np.linspace(*ends, ALONG + 2)[1:-1]
    letters = Model(asked.closure, asked.flow).base(asked.parameters, {"r": r, "theta": 0 * r}).letters()
    if "mu" not in letters:
        return float(r[0]), None
    mu = np.broadcast_to(letters["mu"], r.shape)
    return float(r[mu.argmax()]), float(mu.max())


def cell_size(mesh: Mesh, r: float) -> float:
    """Return the square root of the area (m) of the element nearest to a point of the axis."""
    nearest = np.argmin(np.hypot(*(mesh.corners.mean(axis=1) - (r, 0)).T))
    x, y = mesh.corners[nearest].T
    return sqrt(abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2)


def cost(asked: March, elements: int) -> tuple[int, float]:
    """Return about how many steps a march takes, and about how many seconds."""
    end = asked.snapshots[-1]
    ramp = min(end, (asked.largest - asked.first) / (GROWTH - 1))  # steps that grow are a geometric series
    steps = round(log(1 + ramp * (GROWTH - 1) / asked.first) / log(GROWTH) + (end - ramp) / asked.largest)
    steps = max(steps, len(asked.snapshots), 1)
    each = COST["seconds"] * (elements / COST["elements"]) ** COST["power"] * COST["banded"]
    return steps, COST["start"] + steps * each * COST[asked.scheme] * COST[asked.solver]
