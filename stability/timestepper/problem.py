"""The discrete problem: control-volume balances on a mesh and their exact Jacobian.

``E m dq/dt + R(q) = 0`` at every node, with m the size of its control volume and R what flows out through its faces
less what is supplied inside. Fluxes, supplies and moduli are the closure's (`law`), taken at the middles of faces and
parts; rows at boundaries are replaced by `constraints`.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from scipy.sparse import csr_array

from stability.timestepper.compiled import Loops, pays
from stability.timestepper.constraints import NONE, Constraints, boundary_nodes
from stability.timestepper.law import Law
from stability.timestepper.mesh import Mesh
from stability.timestepper.pattern import Pattern, gathered
from stability.timestepper.volumes import Volumes, control_volumes
from stability.timestepper.walls import MOMENTUM, Wall, coulomb_walls

FIELDS = 3  # u, v, p

# The growth rate of a band is a small difference of large stresses. Gradients that differ from face to face of an
# element make waves oblique to the mesh too stiff by a few per cent of those: at epsilon = 1e-4 on 8,000 polar elements
# (half wedge) the fastest wave grew at 89 1/s with full weight and at 117 with a tenth, against 136 of the continuum.
# With no weight at all the hourglass, which the centre does not see, would be free.
FACE_WEIGHT = 0.1


@dataclass(frozen=True, eq=False)
class Background:
    """A uniform state about which the unknowns of a periodic cell are counted, seen from a point that moves with it.

    Attributes
    ----------
    gradient : (2, 2) velocity gradient d u_i/d x_j (1/s)
    pressure : average stress over density (m2/s2)
    """

    gradient: np.ndarray
    pressure: float


@dataclass(frozen=True, eq=False)
class Problem:
    """A closure on a mesh with its boundary conditions.

    Attributes
    ----------
    mesh, law, constraints : where, what, and what is prescribed
    initial : (n, 3) the initial u, v (m/s) and p (m2/s2) at the nodes
    scales : typical u, v and p: what an error is relative to
    wall_friction : tan phi_w on the boundary "wall" (I6)
    background : of a periodic cell
    source : (n, 3) added to the balances at a time (s), per unit of volume
    face_weight : share of a face's own gradient in the gradient there, the rest being that of its element's centre
    smoothing : (elements,) s; takes the place of epsilon where the closure's mass flux does not see the pressure
    compiled : whether numba takes the place of NumPy in the loops over elements; None leaves it to `compiled.pays`
    """

    mesh: Mesh
    law: Law
    initial: np.ndarray
    scales: np.ndarray = field(default_factory=lambda: np.ones(FIELDS))
    constraints: Constraints = NONE
    wall_friction: float = 0.0
    background: Background | None = None
    source: Callable[[float], Any] | None = None
    face_weight: float = FACE_WEIGHT
    smoothing: np.ndarray | None = None
    compiled: bool | None = None

    @cached_property
    def volumes(self) -> Volumes:
        """Faces and parts of the elements."""
        return control_volumes(self.mesh.corners, self.face_weight)

    @cached_property
    def pattern(self) -> Pattern:
        """The sparsity of the Jacobian."""
        return Pattern(self.mesh.elements, len(self.mesh.nodes), FIELDS)

    @cached_property
    def volume(self) -> np.ndarray:
        """The size of each control volume (n,), in m2."""
        return gathered(self.mesh.elements.T.ravel(), self.volumes.volume.ravel(), len(self.mesh.nodes))

    @cached_property
    def mass(self) -> np.ndarray:
        """E m, (n, 3): the lumped mass, zero in rows without a time derivative."""
        return self.volume[:, None] * np.array(self.law.evolves, dtype=float)

    @cached_property
    def supply_slope(self) -> np.ndarray:
        """The gradients that supplies see.

        What flows in through the inlet has the velocity that it has there: no gradient is advected in. Central
        differences would take it from the inside, against the flow, which is unstable where the inlet meets the wall.
        """
        if "inlet" not in self.mesh.boundaries:
            return self.volumes.part.slope
        still = np.isin(self.mesh.elements.T, boundary_nodes(self.mesh, "inlet"))
        return np.where(still[None, :, None, :], 0, self.volumes.part.slope)

    @cached_property
    def _walls(self) -> list[Wall]:
        if not (self.wall_friction and "wall" in self.mesh.boundaries):
            return []
        return coulomb_walls(self.mesh.corners, self.mesh.boundaries["wall"], self.wall_friction)

    @cached_property
    def _loops(self) -> Loops | None:
        wanted = pays(len(self.mesh.elements)) if self.compiled is None else self.compiled
        return Loops.of(self) if wanted and not self.law.bounds_pressure else None  # the loops know no least pressure

    def _corner(self, q: np.ndarray) -> np.ndarray:
        return np.take(q.T, self.mesh.elements.T, axis=1)  # (3, 4, elements), that order in memory too

    def state(self, q: np.ndarray, g: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the full state, with that of the background."""
        if self.background is None:
            return q, g
        q, g = q.copy(), g.copy()
        q[2] += self.background.pressure
        g[:, :2] += np.reshape(np.transpose(self.background.gradient), (2, 2, *(1,) * (g.ndim - 2)))
        return q, g

    def at_faces(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the state (3, 4, elements) and its gradients (2, 3, 4, elements) at the faces of all elements."""
        return self._at_faces(self._corner(q))

    def _at_faces(self, corner: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        face = self.volumes.face
        return self.state(face.values(corner), face.gradients(corner))

    def _at_parts(self, corner: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return self.state(corner, np.einsum("bsjm,cjm->bcsm", self.supply_slope, corner))

    def balance(self, q: np.ndarray, time: float = 0.0) -> np.ndarray:
        """Return R(q), (n, 3): outflow less supply of every control volume, no constraint applied."""
        found = self._balance(q) if self._loops is None or np.iscomplexobj(q) else self._loops.balance(q)
        for wall in self._walls:
            nodes = self.mesh.elements[wall.edge.elements]
            taken_up = wall.outflow(self.law, self.state, np.take(q.T, nodes.T, axis=1))
            found[nodes[:, wall.edge.corner], :MOMENTUM] += taken_up.T  # no node twice
        return found if self.source is None else found - self.source(time) * self.volume[:, None]

    def _balance(self, q: np.ndarray) -> np.ndarray:
        """Return R(q) but for walls and source, in whole-array passes."""
        corner = self._corner(q)
        local = np.zeros_like(corner)
        q_face, g_face = self._at_faces(corner)
        fluxes = self.law.flux(q_face, g_face, self.volumes.area)
        if self.smoothing is not None:
            fluxes[2,] = fluxes[2,] - self.smoothing * (self.volumes.area * g_face[:, 2]).sum(axis=0)
        for (i,), flux in fluxes.items():
            local[i] += flux - np.roll(flux, 1, axis=0)  # leaves corner s, enters corner s + 1
        for (i,), supply in self.law.supply(*self._at_parts(corner)).items():
            local[i] -= supply * self.volumes.volume
        node = self.mesh.elements.T.ravel()
        return np.stack([gathered(node, row.ravel(), len(q)) for row in local], axis=1)

    def jacobian_blocks(self, q: np.ndarray) -> np.ndarray:
        """Return dR/dq as blocks (3, 3, blocks) of `pattern`, exact, no constraint applied."""
        found = self._blocks(q) if self._loops is None else self._loops.blocks(q)
        for wall in self._walls:
            corner = np.take(q.T, self.mesh.elements[wall.edge.elements].T, axis=1)
            slope = wall.derivative(self.law, self.state, corner)  # (2, 3, 4, edges)
            for c, place in enumerate(self.pattern.of_corner(wall.edge.corner)[:, wall.edge.elements]):
                found[:MOMENTUM, :, place] += slope[:, :, c]  # no block twice
        return found

    def _blocks(self, q: np.ndarray) -> np.ndarray:
        """Return dR/dq but for walls, in whole-array passes."""
        corner = self._corner(q)
        face, area, volume = self.volumes.face, self.volumes.area, self.volumes.volume
        local = np.zeros((FIELDS, FIELDS, 4, 4, corner.shape[-1]))  # row, column, corner of row, of column, element
        by_q, *by_g = self.law.flux_moduli(*self._at_faces(corner), area)
        if self.smoothing is not None:
            for b in (0, 1):
                by_g[b][2, 2] = by_g[b].get((2, 2), 0) - self.smoothing * area[b]
        for i, j in {*by_q, *by_g[0], *by_g[1]}:
            weighted = (
                (entries[i, j], slope) for entries, slope in zip(by_g, face.slope, strict=True) if (i, j) in entries
            )
            flux = sum(np.asarray(modulus)[:, None] * slope for modulus, slope in weighted)
            if (i, j) in by_q:
                flux = flux + by_q[i, j][:, None] * face.shape[:, :, None]
            local[i, j] += flux  # leaves corner s, enters corner s + 1
            local[i, j, 1:] -= flux[:-1]
            local[i, j, 0] -= flux[-1]
        by_q, *by_g = self.law.supply_moduli(*self._at_parts(corner))
        own = np.arange(4)
        for (i, j), modulus in by_q.items():
            local[i, j, own, own] -= modulus * volume
        for slope, entries in zip(self.supply_slope, by_g, strict=True):
            for (i, j), modulus in entries.items():
                local[i, j] -= (modulus * volume)[:, None] * slope
        return self.pattern.blocks(local)

    def equations(self, q: np.ndarray, rate: np.ndarray, time: float) -> np.ndarray:
        """Return the rows (n, 3) that Newton's method brings to zero, for a rate of change dq/dt (n, 3)."""
        return self.constraints.rows(self.mass * rate + self.balance(q, time), q, time)

    def matrix(self, q: np.ndarray, coefficient: float = 0.0) -> csr_array:
        """Return the Jacobian (3 n, 3 n) of `equations`, where d rate/dq = coefficient (1/s)."""
        blocks = self.jacobian_blocks(q)
        for i in range(FIELDS):
            blocks[i, i, self.pattern.diagonal] += coefficient * self.mass[:, i]
        return self.pattern.matrix(self.constraints.blocks(blocks, self.pattern))

    def velocity_gradient(self, q: np.ndarray) -> np.ndarray:
        """Return d u_i/d x_j at the nodes, (n, 2, 2): the mean over the control volume."""
        corner = self._corner(q)
        _, g = self.state(corner, self.volumes.part.gradients(corner))
        node, n = self.mesh.elements.T.ravel(), len(q)
        sums = [[gathered(node, (g[j, i] * self.volumes.volume).ravel(), n) for j in (0, 1)] for i in (0, 1)]
        return np.moveaxis(np.array(sums) / self.volume, -1, 0)
