"""Mistakes in a closure: each is refused at once, by one sentence that names the field, the value and what to do."""

import re

import pytest
import sympy
from sympy import Function, I, ImmutableMatrix, Matrix, Piecewise, S, Symbol, acos, cosh, erf, eye, tanh

from stability.closures.base import Closure
from stability.closures.drucker_prager import LETTERS, PERTURBED
from stability.closures.plane_flow import momentum_and_mass, velocity
from stability.errors import SceneError
from stability.parameters import EPSILON, FRICTION_ANGLE, Parameter
from stability.symbols import k, p, symbol, u, v


def changed(**attributes) -> Closure:
    given = {n: getattr(PERTURBED, n) for n in PERTURBED.__dataclass_fields__}
    return Closure(**(given | attributes))


def constant(symbol: str, word: str = "depth") -> dict:
    """Return the parameters with one more, of that symbol."""
    return {"parameters": (*PERTURBED.parameters, Parameter(word, symbol, "m", 0, 1, "constant", "this test"))}


def pressure(factor) -> dict:
    """Return laws whose isotropic stress is multiplied by a factor."""
    return momentum_and_mass(factor * p * eye(2), velocity)


# The mistake, and the one sentence that names field, value, what is allowed and what to do.
MISTAKES = {
    "name": ({"name": 3}, r"^closure: name must be text that is not empty, got 3 \(of type int\)$"),
    "no source": ({"source": ""}, r"^closure: source must be text that is not empty, got"),
    "fields": ({"fields": [u, v]},
               r"fields must be a tuple, got \[u, v\] \(of type list\): give symbols such as stab"),
    "field of text": ({"fields": ("u", v, p)}, r"fields holds u \(of type str\): give symbols such as stability"),
    "vector of three": ({"fields": ((u, v, p),)}, r"the vector \(u, v, p\) of fields has 3 components: give"),
    "plain field": ({"fields": ((u, v), Symbol("p"))},
                    r"p is not the real symbol .* by stability.symbols.symbol\(\"p\"\)$"),
    "E": ({"evolves": (1, 2, 0)}, r"evolves = \(1, 2, 0\) may hold 1 \(evolution\) and 0 \(constraint\) only$"),
    "E of a number": ({"evolves": 1}, r"evolves = 1 may hold 1 "),
    "flux": ({"flux": [[p, 0], [0, p]]},
             r"flux must be a SymPy matrix, got .* \(of type list\): write ImmutableMatrix"),
    "supply": ({"supply": (0, 0, 0)}, r"supply must be a SymPy matrix, got \(0, 0, 0\) \(of type tuple\): write Imm"),
    "parameter of text": ({"parameters": ("nu",)}, r"parameters holds nu \(of type str\): give Parameter\(word, sym"),
    "parameter alone": ({"parameters": EPSILON}, r"parameters must be a tuple, got Parameter.*: give .* \(ONE,\) or"),
    "same word": (constant("nu", "epsilon"), r"two parameters have the word 'epsilon': give each its own$"),
    "same symbol": (constant("epsilon"),
                    r"the parameter epsilon and the parameter depth share the symbol 'epsilon': ch"),
    "symbol of a field": (constant("p"), r"the field p and the parameter depth share the symbol 'p': choose another"),
    "of a gradient": (constant("u_x"), r"the gradient of u and the parameter depth share the symbol 'u_x': choose"),
    "of a hessian": (constant("p_xy"), r"the gradient of p and the parameter depth share the symbol 'p_xy': choose"),
    "of a letter": (constant("mu"), r"the letter mu and the parameter depth share the symbol 'mu': choose another"),
    "of a letter's gradient": (constant("N_x"), r"the gradient of N and the parameter depth share the symbol 'N_x'"),
    "of gravity": (constant("g_y"), r"the body force and the parameter depth share the symbol 'g_y': choose another"),
    "field of gravity": ({"fields": ((u, v), symbol("g"))}, r"the body force and the gradient of g share the symbol"),
    **{
        f"reserved {name}": (constant(name), rf"\['{name}'\] cannot be names in generated code: choose other letters$")
        for name in ("pi", "sin", "sqrt", "state", "parameters", "m", "m_0", "m_0_x", "t0_0", "trace_m1", "L2_00", "")
    },
    "plain symbol": ({"flux": PERTURBED.flux * Symbol("epsilon")},
                     r"epsilon is not the real symbol .*symbols.symbol\(\"epsilon\"\)$"),
    "letters": ({"letters": [k]}, r"letters must be a dict \{symbol: definition\}, got \[k\] \(of type list\)$"),
    "letter of a number": ({"letters": {k: 1.0}, "relations": ()},
                           r"letters must be a dict .* got .* and 1.0 \(of type flo"),
    "letters in reverse": ({"letters": dict(reversed(LETTERS.items()))}, r"mu is defined by N, k: put letters after"),
    "relation": ({"relations": ((p, p),)},
                 r"relations holds \(p, p\) \(of type tuple\): give \(letter, polynomial that"),
    "hyperbolic": (pressure(tanh(p)), r"flux\[0, 0\] holds tanh\(p\) \(of type tanh\), but generated code has powers, "
                   r"pi, sqrt, sin, .* exp, log: write it by exp, as .rewrite\(exp\) does$"),
    "cosh": (pressure(cosh(p)), r"flux\[0, 0\] holds cosh\(p\) .* write it by exp"),
    **{
        str(kink): (pressure(kink), r"flux\[0, 0\] holds .*, which is not smooth, and a wave asks for deriv")
        for kink in (sympy.Abs(p), sympy.Max(p, 0), sympy.Min(p, 0), sympy.sign(p), sympy.Heaviside(p))
    },
    "branches": (pressure(Piecewise((1, p > 1), (2, True))),
                 r"holds Piecewise.* write one closure for each smooth branch"),
    "erf": (pressure(erf(p)),
            r"flux\[0, 0\] holds erf\(p\) \(of type erf\), but generated code has .*: write it by these$"),
    "acos": (pressure(acos(p)), r"holds acos\(p\) .* write it by these$"),
    "undefined": (pressure(Function("f")(p)), r"flux\[0, 0\] holds f\(p\) \(of type f\), but generated code has "),
    "nan": ({"supply": ImmutableMatrix([0, S.NaN, 0])},
            r"supply\[1, 0\] holds nan .*no finite number: look for a divi"),
    "infinity": ({"supply": ImmutableMatrix([S.Infinity * p, 0, 0])},
                 r"supply\[0, 0\] holds oo .*, which is no finite number"),
    "division by zero": ({"supply": ImmutableMatrix([p / S.Zero, 0, 0])}, r"holds zoo .*, which is no finite number"),
    "complex": (pressure(I),
                r"flux\[0, 0\] holds I .*, but laws are real: look for a root or a logarithm of a negative"),
    "function in a letter": ({"letters": LETTERS | {symbol("T"): tanh(p)}}, r"the letter T holds tanh\(p\) "),
}  # fmt: skip


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_refused_in_one_sentence_that_says_what_to_do(mistake):
    attributes, said = MISTAKES[mistake]
    with pytest.raises(SceneError) as caught:
        changed(**attributes)
    (problem,) = caught.value.problems
    assert "\n" not in problem and problem.startswith("closure")
    assert re.search(said, problem), problem


@pytest.mark.parametrize(
    ("values", "said"),
    [
        (
            ("depth", symbol("h"), "m", 0, 1, "depth", "here"),
            "parameter depth: symbol must be text, got h (of type Symbol)",
        ),
        ((3, "h", "m", 0, 1, "depth", "here"), "parameter 3: word must be text, got 3 (of type int)"),
        (("depth", "h", 1, 0, 1, "depth", "here"), "parameter depth: unit must be text, got 1 (of type int)"),
    ],
)
def test_a_record_that_is_not_text_is_refused(values, said):
    with pytest.raises(SceneError) as caught:
        Parameter(*values)
    assert str(caught.value) == f"{said}: a Parameter is (word, symbol, unit, low, high, meaning, source)"


def test_what_was_given_as_lists_is_kept_as_what_cannot_change():
    flux = Matrix(PERTURBED.flux)
    closure = changed(evolves=[True, 1, 0], parameters=[FRICTION_ANGLE, EPSILON], flux=flux)
    flux[0, 0] = 0
    assert closure.evolves == (1, 1, 0) and closure.parameters == PERTURBED.parameters
    assert closure.flux == PERTURBED.flux
