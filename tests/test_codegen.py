"""Generated modules: the same numbers in every arithmetic, and a cache that is never trusted."""

import ast
import multiprocessing
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mpmath import mpf
from sympy import E, eye, tanh

from stability import codegen, eigenvalues
from stability.arithmetic import multiprecision
from stability.closures import CLOSURES
from stability.closures.checks import RESERVED, names
from stability.closures.plane_flow import momentum_and_mass, velocity
from stability.errors import SceneError
from stability.flows import FLOWS
from stability.model import Model
from stability.symbols import p, symbol
from tests.states import PAPER, base_of, random_jet


@pytest.fixture
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("STABILITY_CACHE", str(tmp_path))
    codegen.namespace.cache_clear()
    yield tmp_path
    codegen.namespace.cache_clear()


def only_file(folder):
    (path,) = folder.iterdir()
    return path


@pytest.mark.parametrize("name", PAPER)
def test_numpy_and_mpmath_run_the_same_expressions(name):
    rng = np.random.default_rng(5)
    for _ in range(20):
        jet = random_jet(name, rng)
        rough = base_of(name, jet, 0.6, 1e-3).form(30.0).coefficients
        fine = base_of(name, jet, 0.6, 1e-3, multiprecision(60)).form(multiprecision(60).number(30)).coefficients
        for part, series in rough.items():
            scale = max(abs(c) for c in fine[part].values())
            for n, c in series.items():
                # a few hundred roundings against the largest coefficient of the part
                assert abs(mpf(float(c)) - fine[part][n]) <= 1e-12 * scale


def test_a_second_load_reads_the_cache(cache, monkeypatch):
    codegen.load(CLOSURES, "perturbed")
    codegen.namespace.cache_clear()
    monkeypatch.setattr(codegen, "generate", lambda entry: pytest.fail("derived again in spite of the cache"))
    assert codegen.load(CLOSURES, "perturbed")["NAME"] == "perturbed"


@pytest.mark.parametrize("damage", ["truncated", "altered", "stale", "empty", "binary"])
def test_a_damaged_cache_file_is_rebuilt(cache, damage):
    codegen.load(FLOWS, "uniform_strain")
    path = only_file(cache)
    good = path.read_bytes()
    bad = {
        "truncated": good[:-10],
        "altered": good.replace(b"strain_rate", b"strain_rote", 1),
        "stale": good.replace(good[:40], b"# signature " + b"0" * 28, 1),
        "empty": b"",
        "binary": b"\xff\xfe\x00" * 100,
    }[damage]
    assert bad != good
    path.write_bytes(bad)
    codegen.namespace.cache_clear()
    assert codegen.load(FLOWS, "uniform_strain")["NAME"] == "uniform_strain"
    assert only_file(cache).read_bytes() == good


def test_the_signature_follows_the_text_of_the_sources(monkeypatch):
    place = CLOSURES.place("perturbed")
    before = codegen.signature.__wrapped__(place)
    monkeypatch.setattr(codegen, "version", lambda name: "0.0")
    assert codegen.signature.__wrapped__(place) != before
    assert codegen.signature.__wrapped__(FLOWS.place("uniform_strain")) != codegen.signature.__wrapped__(place)


@pytest.mark.parametrize("registry", [CLOSURES, FLOWS])
def test_the_signature_covers_every_module_that_deriving_imports(registry):
    script = "import sys\nfrom stability import emit\nfrom importlib import import_module\n"
    for name in registry:
        place = registry.place(name)
        run = script + f"import_module({place.split(':')[0]!r})\nprint(*[m.__file__ for n, m in sys.modules.items() "
        run += "if n.startswith('stability.') and m.__file__], sep='\\n')"
        said = subprocess.run([sys.executable, "-c", run], capture_output=True, text=True, check=True).stdout
        assert {Path(p) for p in said.splitlines()} <= set(codegen.sources(place))


def race(folder, results):
    import os

    os.environ["STABILITY_CACHE"] = folder
    results.put(codegen.load(FLOWS, "uniform_strain")["NAME"])


def test_two_processes_may_race_for_the_cache(cache):
    context = multiprocessing.get_context("spawn")
    results = context.Queue()
    racers = [context.Process(target=race, args=(str(cache), results)) for _ in range(2)]
    for racer in racers:
        racer.start()
    assert [results.get(timeout=120) for _ in racers] == ["uniform_strain"] * 2
    for racer in racers:
        racer.join()
    assert codegen.opened(only_file(cache).read_text(), codegen.signature(FLOWS.place("uniform_strain")))


def test_a_cache_that_cannot_be_written_is_no_obstacle(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("STABILITY_CACHE", str(tmp_path / "file" / "folder"))
    codegen.namespace.cache_clear()
    assert codegen.load(FLOWS, "uniform_strain")["NAME"] == "uniform_strain"
    codegen.namespace.cache_clear()


def own(**changes):
    return replace(CLOSURES["rigid_plastic"], name="own", **changes)


def test_equal_objects_are_derived_once_and_other_ones_again(cache, monkeypatch):
    assert Model(own(), "uniform_strain").modes == 1
    codegen.namespace.cache_clear()
    with monkeypatch.context() as patched:
        patched.setattr(codegen, "generate", lambda *_: pytest.fail("derived again in spite of the cache"))
        assert Model(own(), "uniform_strain").modes == 1
        assert codegen.load(CLOSURES, own())["NAME"] == "own"
    twice = own(flux=2 * CLOSURES["rigid_plastic"].flux)
    assert codegen.signature(twice) != codegen.signature(own()) == codegen.signature(own())
    assert codegen.signature(own(title="another")) != codegen.signature(own()), "titles stand in the module too"


def test_the_name_of_an_object_names_no_other_file(cache):
    codegen.load(CLOSURES, replace(own(), name="../of my/own"), codegen.RECORDS)
    assert only_file(cache).name.startswith("records_closure____of_my_own_")


def test_an_object_that_cannot_be_derived_says_why_in_one_sentence(cache):
    weightless = own(**momentum_and_mass(0 * eye(2), velocity))
    with pytest.raises(SceneError, match=r"^own cannot be derived: closure own: its balance laws do not determine"):
        codegen.load(CLOSURES, weightless)


def assigned(text: str) -> set[str]:
    """Return the arguments and variables of every function inside ``build``."""
    (build,) = (node for node in ast.parse(text).body if isinstance(node, ast.FunctionDef))
    nodes = [n for f in build.body if isinstance(f, ast.FunctionDef) for n in ast.walk(f)]
    stored = {n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
    return stored | {n.arg for n in nodes if isinstance(n, ast.arg)}


@pytest.mark.parametrize("name", CLOSURES)
def test_what_generated_code_calls_its_own_is_refused_as_a_symbol(name):
    closure = CLOSURES[name]
    found = assigned(codegen.generate(closure))
    assert len(found) > 50  # or the names were not found
    # In a module for the time-stepper the arrays q and g are unpacked before any symbol of a closure is assigned.
    found |= assigned(codegen.generate(closure, codegen.POINTWISE)) - {"q", "g"}
    assert {n for n in found - {n for n, _ in names(closure)} if not RESERVED.fullmatch(n)} == set()


def test_a_function_that_no_arithmetic_has_is_refused_in_a_flow_too(cache):
    flow = FLOWS["uniform_strain"]
    swirl = replace(flow, name="swirl", fields={**flow.fields, p: tanh(1 + symbol("x"))})
    with pytest.raises(SceneError, match=r"^tanh\(1\) cannot be computed: generated code has powers, pi, sqrt"):
        codegen.load(FLOWS, swirl)


def test_eulers_number_is_the_same_in_floats_digits_and_bounds(cache):
    question = own(flux=E * CLOSURES["viscous"].flux, parameters=CLOSURES["viscous"].parameters, relations=())
    wave = (
        "uniform_strain",
        {"friction_angle": 34, "kinematic_viscosity": 0.5, "delta": 0, "strain_rate": 1, "pressure": 1},
    )
    rough, fine, sure = (
        eigenvalues(question, *wave, {}, 3.0, 20.0, **how) for how in ({}, {"digits": 30}, {"rtol": 1e-12})
    )
    assert abs(complex(fine[0]) - rough[0]) < 1e-13 * abs(rough[0])  # some hundred roundings
    assert abs(complex(fine[0]) - sure[0]) < 1e-12 * abs(rough[0])


@pytest.mark.parametrize("registry", [CLOSURES, FLOWS])
def test_records_are_those_of_the_derived_module_and_take_milliseconds(registry, cache, monkeypatch):
    name = "perturbed" if registry is CLOSURES else "uniform_strain"
    whole = codegen.load(registry, name)
    monkeypatch.setattr("stability.emit.source", lambda entry: pytest.fail("derived"))
    for entry in registry:
        records = codegen.load(registry, entry, codegen.RECORDS)
        assert records["NAME"] == entry and "build" not in records
    records = codegen.load(registry, name, codegen.RECORDS)
    names = [n for n in records if n.isupper()]
    assert {"TITLE", "SOURCE", "PARAMETERS", "FIELDS"} <= set(names)
    assert {n: records[n] for n in names} == {n: whole[n] for n in names}


def test_deriving_both_closures_on_the_hopper_flow_takes_seconds(cache):
    # Stated as under 5 s of a quiet machine; a slower or busier one gets four times that before this fails.
    start = time.process_time()
    for name in PAPER:
        Model(name, "radial_hopper")._functions  # noqa: B018
    assert time.process_time() - start < 20
