"""Generated modules: the same numbers in every arithmetic, and a cache that is never trusted."""

import multiprocessing
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from mpmath import mpf

from stability import codegen
from stability.arithmetic import multiprecision
from stability.closures import CLOSURES
from stability.closures.drucker_prager import PERTURBED
from stability.flows import FLOWS
from stability.model import Model
from tests.states import base_of, random_jet


@pytest.fixture
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("STABILITY_CACHE", str(tmp_path))
    codegen.load.cache_clear()
    yield tmp_path
    codegen.load.cache_clear()


def only_file(folder):
    (path,) = folder.iterdir()
    return path


@pytest.mark.parametrize("name", CLOSURES)
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
    codegen.load.cache_clear()
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
    codegen.load.cache_clear()
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
    codegen.load.cache_clear()
    assert codegen.load(FLOWS, "uniform_strain")["NAME"] == "uniform_strain"
    codegen.load.cache_clear()


def test_a_closure_that_is_not_registered_is_compiled_in_memory(cache):
    assert Model(PERTURBED, "uniform_strain").modes == 2
    assert not any("closure" in p.name for p in cache.iterdir())


def test_deriving_both_closures_on_the_hopper_flow_takes_seconds(cache):
    # Stated as under 5 s of a quiet machine; a slower or busier one gets four times that before this fails.
    start = time.process_time()
    for name in CLOSURES:
        Model(name, "radial_hopper")._functions  # noqa: B018
    assert time.process_time() - start < 20
