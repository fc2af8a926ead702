"""The order in which a direct solver should eliminate the nodes of a mesh.

Rejected: minimum degree on A + A' (SuperLU's own, in need of no geometry): 1.4 times the time. Separators from the
lattice alone: a column of the turned squares does not separate, since elements reach over it.
"""

import numpy as np

LEAF = 12  # nodes: below, the parts are dense anyway


def nested_dissection(logical: np.ndarray, elements: np.ndarray) -> np.ndarray:
    """Return the nodes in an order of elimination that keeps the factors of a mesh's matrix sparse.

    The nodes are halved along their longer side; those of the upper half that share an element with the lower half are
    the separator, which comes last. It separates by construction, periodic meshes included.

    Parameters
    ----------
    logical : int array (n, 2). Places of the nodes on a lattice.
    elements : int array (m, k). Node numbers.

    Returns
    -------
    int array (n,), a permutation.
    """
    side = np.zeros(len(logical), dtype=np.int8)  # within the part at hand; 0 is elsewhere, or a separator

    def ordered(nodes: np.ndarray, elements: np.ndarray) -> list[np.ndarray]:
        extent = np.ptp(logical[nodes], axis=0) if nodes.size else np.zeros(2)
        if nodes.size <= LEAF or not extent.any():
            return [nodes]
        place = logical[nodes, np.argmax(extent)]
        low = place < max(np.median(place), place.min() + 1)
        side[nodes] = np.where(low, 1, 2)
        of_element = side[elements]
        across = elements[(of_element == 1).any(axis=1) & (of_element == 2).any(axis=1)]
        side[across[side[across] == 2]] = 0
        of_element, of_node = side[elements], side[nodes]
        halves = [(nodes[of_node == k], elements[(of_element == k).any(axis=1)]) for k in (1, 2)]
        side[nodes] = 0
        return [*ordered(*halves[0]), *ordered(*halves[1]), nodes[of_node == 0]]

    return np.concatenate(ordered(np.arange(len(logical)), elements))
