"""The compiled path against the symbolic pencil, for every closure.

`stability.eigenvalues` turns the base state into the frame of the wave, so this also shows that each closure is
frame-indifferent; the pencil is evaluated in the frame of the flow.
"""

import pytest

import stability as st
from tests.closures.benchmarks import BENCHMARKS
from tests.closures.evaluate import Waves


@pytest.mark.slow  # derives and compiles every closure
@pytest.mark.parametrize("benchmark", BENCHMARKS, ids=lambda b: f"{b.closure}, {b.state}")
@pytest.mark.parametrize("angle", ["33", "-71"])
def test_compiled_eigenvalues_are_those_of_the_symbolic_pencil(benchmark, angle):
    numbers = {word: float(value) for word, value in benchmark.parameters.items()}
    found = st.eigenvalues(benchmark.closure, benchmark.flow, numbers, {}, 50.0, float(angle))
    expected = list(Waves(benchmark.closure, benchmark.flow, numbers).eigenvalues(angle, q=50))
    assert len(found) == len(expected)
    # Conjugates come in either order. Roundings are relative to the largest rate: QZ is backward stable, no more.
    scale = max(abs(z) for z in expected)
    for value in found:
        nearest = min(expected, key=lambda z: abs(z - complex(value)))
        expected.remove(nearest)
        assert abs(nearest - complex(value)) < 1e-12 * scale
