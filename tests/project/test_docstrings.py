'''Public docstrings are numpydoc; no name is a participle, and no docstring begins with a relative clause.

The form, checked by numpydoc's validator and by this file, for all that is reachable as ``ls.X``, ``ls.plot.X``, the
accessor ``Dataset.linksweep``, and their members:

    def speed_limit(scene: Scene, of: str, below: float, threads: int | None = None) -> xr.DataArray:
        """Find the highest speed at which a peak stays below a bound.

        Parameters
        ----------
        scene : Scene
            Scene of any number of designs.
        of : str
            Name of the force or torque.
        below : float
            Bound of the peak's magnitude [N, N m].
        threads : int, default None
            Largest number of threads; None for all cores.

        Returns
        -------
        DataArray
            Speed over the design dims [rad/s].
        """

A summary is one line: verb and object for a function, a noun phrase for a class or property. Each number states its
unit in brackets, [1] where it has none; each default is the one in the signature.
'''

import ast
import dataclasses
import functools
import inspect
import re
from pathlib import Path

import pytest
from numpydoc.docscrape import get_doc_object
from numpydoc.validate import Validator, validate

import linksweep as ls
from linksweep.analysis.design.objective import Objective
from linksweep.base.fields import field_rules
from linksweep.base.validate import UNITS
from linksweep.plot.accessor import Cycle
from linksweep.plot.kit.film import Film

ROOT = Path(__file__).parents[2]

LEFT_OUT = {
    "GL01",  # the summary stands on the line of the opening quotes
    "ES01",  # a summary that says it all needs no more
    "SA01",  # see also: `ls.quantities` and the README lead from one function to the next
}
NO_EXAMPLE = {"EX01"}
"""Left out for members and plots, which the examples of their class, and the README, show at work."""

OF_A_MEMBER = re.compile("GL|SS")
"""Checks of a member that a base class prescribes (a mechanism's rows, a load's rules): its summary."""

VERB = re.compile(
    r"""(Add|Advise|Animate|Append|Apply|Arrange|Assemble|Attach|Balance|Build|Check|Choose|Clear|Collect|Combine
    |Compare|Compile|Compute|Convert|Copy|Count|Create|Cut|Decide|Define|Describe|Differentiate|Divide|Draw|Drop
    |Estimate|Evaluate|Expand|Explain|Extract|Fill|Find|Fit|Format|Gather|Group|Integrate|Interpolate|Invert|Join
    |Keep|Limit|List|Load|Locate|Make|Map|Mark|Measure|Merge|Move|Multiply|Open|Order|Parse|Pick|Place|Plot|Predict
    |Prepare|Print|Project|Raise|Read|Recall|Reduce|Refine|Refuse|Register|Remove|Rename|Render|Repeat|Replace
    |Report|Request|Require|Resolve|Restore|Return|Rotate|Round|Run|Sample|Save|Scale|Scan|Search|Select|Separate
    |Set|Shade|Shift|Show|Solve|Sort|Split|Start|State|Store|Subtract|Sum|Sweep|Take|Trace|Transform|Translate
    |Update|Use|Validate|Verify|Walk|Warn|Wrap|Write|Yield)\b""",
    re.VERBOSE,
)

RIDDLE = re.compile(r"(What|Whether|Which|How|Why|Where|Of|That|Those)\b|The same\b")
"""First words of a clause that hangs on a missing noun."""

PARTICIPLES = {"asked", "found", "given", "said", "shown", "told", "wanted"}

NUMBER_TYPE = re.compile(r"\b(float|array|array_like|ArrayLike|Number|number|numbers|pair)\b")


def classes() -> dict[str, type]:
    """Return the public classes, and those that a public function or Dataset hands out, by name."""
    public = {name: getattr(ls, name) for name in ls.__all__ if inspect.isclass(getattr(ls, name))}
    return public | {"Cycle": Cycle, "Film": Film, "Objective": Objective}


def members(cls: type) -> dict[str, object]:
    """Return the public methods and properties of a class that the package defines."""
    own = {
        name: documented(cls, name)
        for base in reversed(cls.__mro__)
        if base.__module__.startswith("linksweep")
        for name in vars(base)
    }
    kinds = (property, classmethod, staticmethod, functools.cached_property)
    return {
        name: getattr(member, "__func__", member)
        for name, member in own.items()
        if not name.startswith("_") and (inspect.isfunction(member) or isinstance(member, kinds))
    }


def documented(cls: type, name: str) -> object:
    """Return a member, or the one that it overrides if it has no docstring of its own, as `help` does."""
    overrides = [vars(base)[name] for base in cls.__mro__ if name in vars(base)]
    return next((member for member in overrides if member.__doc__), overrides[0])


def prescribed(cls: type, name: str) -> bool:
    """Return whether a base class that is not public prescribes a member."""
    return any(name in vars(base) for base in cls.__mro__[1:] if base not in classes().values())


def subjects() -> dict[str, tuple[object, str]]:
    """Return everything public by name, with its kind."""
    named = {name: (getattr(ls, name), "function") for name in ls.__all__ if inspect.isfunction(getattr(ls, name))}
    named |= {f"plot.{name}": (getattr(ls.plot, name), "plot") for name in ls.plot.__all__}
    for label, cls in classes().items():
        named[label] = (cls, "warning" if issubclass(cls, Warning) else "class")
        for name, member in members(cls).items():
            kind = "member" if inspect.isfunction(member) else "property"
            named[f"{label}.{name}"] = (member, "prescribed" if prescribed(cls, name) else kind)
    return named


SUBJECTS = subjects()


def problems(name: str) -> list[str]:
    """Return the problems of the docstring of a public thing."""
    thing, kind = SUBJECTS[name]
    doc = Validator(get_doc_object(thing))
    if not doc.raw_doc:
        return ["GL08 has no docstring"]
    report = [f"{code} {text}" for code, text in numpydoc_errors(thing, kind)]
    report += summary_problems(doc.summary, kind)
    if kind in ("function", "plot", "class", "member"):
        report += parameter_problems(thing, doc)
    return report


def numpydoc_errors(thing: object, kind: str) -> list[tuple[str, str]]:
    doc = functools.partial(Validator, get_doc_object(thing))
    errors = validate("", validator_cls=lambda obj_name: doc())["errors"]
    left_out = LEFT_OUT | (set() if kind in ("function", "class") else NO_EXAMPLE)
    return [
        (code, text)
        for code, text in errors
        if code not in left_out and (kind != "prescribed" or OF_A_MEMBER.match(code))
    ]


def summary_problems(summary: str, kind: str) -> list[str]:
    if kind in ("function", "plot", "member") and not VERB.match(summary):
        return ["summary begins with no verb: see VERB"]
    return ["summary begins with a riddle: see RIDDLE"] if RIDDLE.match(summary) else []


def parameter_problems(thing: object, doc: Validator) -> list[str]:
    """Return the parameters whose default, or unit, is not stated."""
    signature = inspect.signature(thing).parameters
    rules = field_rules(thing) if dataclasses.is_dataclass(thing) else {}
    report = []
    for name, (type_line, lines) in doc.doc_parameters.items():
        if name in signature:
            report += default_problems(name, type_line, signature[name].default)
        report += unit_problems(name, type_line, " ".join(lines), rules[name].kind if name in rules else None)
    return report


def default_problems(name: str, type_line: str, default: object) -> list[str]:
    _, word, stated = type_line.partition("default ")
    if default is inspect.Parameter.empty:
        return [f"{name}: states a default, and has none"] if word else []
    if not word:
        return [f"{name}: its type line ends with no 'default {default!r}'"]
    if not isinstance(default, int | float | str | tuple | None):
        return []
    return [] if same_literal(stated, default) else [f"{name}: states default {stated}, has {default!r}"]


def same_literal(text: str, value: object) -> bool:
    try:
        return text == repr(value) or bool(ast.literal_eval(text) == value)
    except (ValueError, SyntaxError):
        return False


def unit_problems(name: str, type_line: str, text: str, kind: str | None) -> list[str]:
    """Return a problem where a number has no unit, or a dataclass's field another one than its rule."""
    units = [plain_unit(unit) for bracket in re.findall(r"\[([^\]]*)\]", text) for unit in bracket.split(",")]
    if kind and plain_unit(UNITS[kind]) not in units:
        return [f"{name}: its unit [{UNITS[kind]}] is not stated"]
    return [f"{name}: states no [unit]"] if not units and NUMBER_TYPE.search(type_line) else []


def plain_unit(text: str) -> str:
    """Return a unit with exponents as UDUNITS writes them, and a blank for each product."""
    return text.strip().replace("^", "").replace("²", "2").replace("³", "3").replace("⁴", "4").replace("·", " ")


@pytest.mark.parametrize("name", sorted(SUBJECTS))
def test_docstring(name):
    """Each public docstring is of the form above."""
    assert problems(name) == []


def rooms(*tops: str) -> dict[str, list[Path]]:
    """Return the files of each folder, and of each file, that lies directly in one of the top folders."""
    entries = [entry for top in tops for entry in sorted((ROOT / top).iterdir())]
    files = {entry: [entry] if entry.is_file() else sorted(entry.rglob("*.py")) for entry in entries}
    return {str(entry.relative_to(ROOT)): paths for entry, paths in files.items() if paths and paths[0].suffix == ".py"}


ROOMS = rooms("linksweep", "tests", "benchmarks")


def defined_name(node: ast.AST) -> str:
    """Return the name that a node binds: of a variable, attribute, parameter, function or import."""
    match node:
        case ast.Name(id=name, ctx=ast.Store()) | ast.Attribute(attr=name, ctx=ast.Store()) | ast.arg(arg=name):
            return name
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
            return name
        case ast.alias(name=name, asname=asname):
            return asname or name
    return ""


DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef)


@pytest.mark.parametrize("room", ROOMS)
def test_words(room):
    """No name is a participle, and no docstring begins with a riddle."""
    nodes = [node for path in ROOMS[room] for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))]
    names = {defined_name(node) for node in nodes}
    docs = [doc for node in nodes if isinstance(node, DOCUMENTED) and (doc := ast.get_docstring(node))]
    assert {name for name in names if name.strip("_") in PARTICIPLES} == set()
    assert [doc for doc in docs if RIDDLE.match(doc)] == []
