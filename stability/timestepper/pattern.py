"""The sparsity of the Jacobian, found once: from the elements' blocks to a matrix in three passes over arrays."""

from functools import cached_property

import numpy as np
from scipy.sparse import csr_array


def gathered(index: np.ndarray, values: np.ndarray, size: int) -> np.ndarray:
    """Return the sums of values with equal index; the order of summation is that of the array, always."""
    if np.iscomplexobj(values):  # the complex step of the tests
        return np.bincount(index, values.real, size) + 1j * np.bincount(index, values.imag, size)
    return np.bincount(index, values, size)


class Pattern:
    """Blocks of the Jacobian of elements (elements, 4) on n nodes with c unknowns each, node by node."""

    def __init__(self, elements: np.ndarray, n: int, c: int):
        self.n, self.c = n, c
        corner = elements.T
        key = (corner[:, None, :] * n + corner[None, :, :]).ravel()  # (row corner, column corner, element)
        # A node without elements keeps a diagonal block, so that the matrix has its row.
        found, position = np.unique(np.concatenate([np.arange(n) * (n + 1), key]), return_inverse=True)
        self.row, self.column = found // n, found % n
        self.diagonal, self.position = position[:n], position[n:]
        self.first = np.searchsorted(self.row, np.arange(n + 1))

    @cached_property
    def _places(self) -> np.ndarray:
        """Where entry (i, j) of each block stands in the data of a CSR matrix."""
        count = np.diff(self.first)[self.row]
        within = np.arange(len(self.row)) - self.first[self.row]
        i, j = np.arange(self.c)[:, None, None], np.arange(self.c)[None, :, None]
        return self.c**2 * self.first[self.row] + i * self.c * count + self.c * within + j

    @cached_property
    def _structure(self) -> tuple[np.ndarray, np.ndarray]:
        """The column indices and the row pointers of the CSR matrix."""
        columns = np.empty(self._places.size, dtype=np.int32)
        columns[self._places] = self.c * self.column + np.arange(self.c)[None, :, None]
        pointers = np.concatenate([[0], np.cumsum(np.repeat(self.c * np.diff(self.first), self.c))])
        return columns, pointers.astype(np.int32)

    def of_corner(self, corner: int) -> np.ndarray:
        """Return which blocks (4, elements) the balance at a corner of each element has with its four corners."""
        return self.position.reshape(4, 4, -1)[corner]

    def blocks(self, local: np.ndarray) -> np.ndarray:
        """Return (c, c, blocks) from the elements' contributions (c, c, 4, 4, elements)."""
        size = len(self.row)
        return np.array([[gathered(self.position, entry.ravel(), size) for entry in row] for row in local])

    def matrix(self, blocks: np.ndarray) -> csr_array:
        """Return the (c n, c n) matrix of blocks (c, c, blocks)."""
        data = np.empty(self._places.size)
        data[self._places] = blocks
        return csr_array((data, *self._structure), shape=(self.c * self.n,) * 2)
