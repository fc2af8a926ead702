"""Every registered closure has a published benchmark, and the growth exponent stated there is its pencil's."""

import ast
from pathlib import Path

import pytest
from mpmath import mp, mpf

from stability.closures import CLOSURES
from tests.closures.benchmarks import BENCHMARKS
from tests.closures.evaluate import Waves


def test_every_registered_closure_has_a_published_benchmark():
    assert {b.closure for b in BENCHMARKS} == set(CLOSURES)


@pytest.mark.parametrize("benchmark", BENCHMARKS, ids=lambda b: f"{b.closure}, {b.state}")
def test_a_benchmark_names_a_module_that_tests_the_closure(benchmark):
    path = Path(__file__).with_name(f"{benchmark.test}.py")
    texts = {n.value for n in ast.walk(ast.parse(path.read_text())) if isinstance(n, ast.Constant)}
    assert benchmark.closure in texts
    assert benchmark.why.endswith(".") and CLOSURES[benchmark.closure].source


@pytest.mark.parametrize("benchmark", BENCHMARKS, ids=lambda b: f"{b.closure}, {b.state}")
def test_the_growth_exponent_is_the_stated_one(benchmark):
    # The exponent is the slope between q = 1e20 and 1e22 of the fastest wave: an integer but for terms of relative
    # order 1e-20.
    digits = 500 if benchmark.closure == "hyperstress" else 150  # rates of 1e80 stand beside constraints
    waves = Waves(benchmark.closure, benchmark.flow, benchmark.parameters, digits)
    rate, shorter = (
        waves.peak(*benchmark.peak, 0, mpf(10) ** e) if benchmark.peak else waves.worst(0, mpf(10) ** e, count=19)[1]
        for e in (20, 22)
    )
    if benchmark.exponent is None:
        assert rate < 0 and shorter < 0
    else:
        assert rate > 0 and abs(mp.log10(shorter / rate) / 2 - benchmark.exponent) < mpf(10) ** -12
