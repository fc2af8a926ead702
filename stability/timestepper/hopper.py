"""The wedge hopper: the paper's section "Numerical solutions" as a discrete problem."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from stability import codegen
from stability.arithmetic import NUMPY
from stability.flows import FLOWS
from stability.model import Model
from stability.parameters import to_si
from stability.timestepper import constraints
from stability.timestepper.law import Law
from stability.timestepper.mesh import Mesh, hopper_mesh
from stability.timestepper.problem import Problem
from stability.timestepper.volumes import control_volumes

# Of g r_0: what closures such as mu(I), whose stress has a root or a quotient of p, see on the arcs, where p = 0.
LEAST_PRESSURE = 1e-4


def hopper_problem(
    closure: Any, flow: Any, parameters: Mapping[str, float], mesh: Mesh | Mapping[str, Any], floor: float = 0.05
) -> Problem:
    """Return the flow through a wedge hopper, to start from a radial flow.

    Parameters
    ----------
    closure : name of a closure with the fields (u, v, p)
    flow : "radial_hopper" or "radial_hopper_compatible", the initial state (appendix)
    parameters : words of closure and flow, SI units, angles in degrees
    mesh : a `Mesh`, or the options of `hopper_mesh` that do not follow from the parameters
    floor : least ||V|| that the rheology sees (1/s)

    Notes
    -----
    Walls slide under Coulomb friction (I6), the arcs carry no stress. On the half wedge the axis is a line of symmetry.
    A closure whose stress exists for p > 0 only sees at least `LEAST_PRESSURE`.
    """
    model = Model(closure, flow)
    middle = {"r": (parameters["outlet_radius"] + parameters["inlet_radius"]) / 2, "theta": 0.0}
    model.base(parameters, middle)  # refuses what is missing, out of range or contradictory
    si = to_si(model.parameters, parameters)
    if not isinstance(mesh, Mesh):
        geometry = (si["outlet_radius"], si["inlet_radius"], si["wedge_angle"])
        mesh = hopper_mesh(*geometry, **mesh)
    speed = np.sqrt(si["gravity"] * si["outlet_radius"])
    law = Law(closure, si, (-si["gravity"], 0.0), floor, LEAST_PRESSURE * speed**2)
    initial = radial_state(flow, si, mesh)
    return Problem(
        mesh=mesh,
        law=law,
        initial=initial,
        scales=np.array([speed, speed, speed**2]),
        constraints=constraints.hopper(mesh),
        wall_friction=float(np.tan(si["wall_friction_angle"])),
        smoothing=None if law.pressure_diffuses else smoothing(law, mesh, initial),
    )


def smoothing(law: Law, mesh: Mesh, q: np.ndarray) -> np.ndarray:
    """Return the time scale (elements,) of the pressure smoothing that an incompressible closure needs on a mesh.

    Velocity and pressure sit at the same nodes, and a pressure that alternates from node to node does no work on such
    velocities: Schneider and Raw's velocities at faces damp it by an amount of order h^2/mu. Here the mass flux gets
    -h^2/(2 mu) grad p, of the same order, with one mu = p/||V|| for the whole mesh. It vanishes with the mesh, so the
    scheme is consistent; and it is epsilon = h^2/(2 mu) in (P1.1), so that the mesh regularises what the equations
    leave ill-posed, and bands come out a few cells wide on every mesh. That is the grid dependence that the paper saw.
    """
    volumes = control_volumes(mesh.corners)
    corner = q.T[:, mesh.elements.T]
    norm = law.strain_rate_norm(volumes.part.gradients(corner))
    return volumes.volume.sum(axis=0) * np.median(norm) / np.median(corner[2]) / 2


def radial_state(flow: Any, si: Mapping[str, float], mesh: Mesh) -> np.ndarray:
    """Return u, v, p (n, 3) of a radial flow at the nodes, Cartesian; zero pressure on the arcs up to rounding."""
    r, theta = np.hypot(*mesh.nodes.T), np.arctan2(mesh.nodes[:, 1], mesh.nodes[:, 0])
    jets = codegen.load(FLOWS, flow)["build"](NUMPY)["state"]({"r": r, "theta": theta}, si)
    (u_r, *_), (u_theta, *_), (p, *_) = jets["u"], jets["v"], jets["p"]
    c, s = np.cos(theta), np.sin(theta)
    return np.stack([u_r * c - u_theta * s, u_r * s + u_theta * c, np.broadcast_to(p, r.shape)], axis=1)
