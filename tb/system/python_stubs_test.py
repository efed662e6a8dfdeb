#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Type stubs of the Python module: made from the module and from the parameters that the command declares, compared
with those in python/deburr. With --write they are written; with --mypy a program that uses them, and one that misuses
them, is shown to mypy.

usage: python_stubs_test.py MODULES SOURCE [--write | --mypy]"""
import inspect
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import textwrap
import types

MODULES, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
sys.dont_write_bytecode = True
sys.path.insert(0, str(MODULES))

import deburr  # noqa: E402
from deburr import _program, _run, _sweep, golden, ideal  # noqa: E402
from deburr._declared import argument  # noqa: E402

HEAD = '''# SPDX-License-Identifier: MIT
# Made by tb/system/python_stubs_test.py --write; do not edit.
import typing

import numpy
import numpy.typing

from deburr._figures import Figures

_Array = numpy.typing.NDArray[typing.Any]
'''
# What is given as text on a command line, a file or a picture.
TEXT = "str | _Path | _Array"


def annotation(row):
    """The type of a parameter, by its default and its range."""
    default, words = row["default"], row["range"].split(" | ")
    if isinstance(default, bool):
        return "bool"
    if isinstance(default, int):
        return "int"
    if isinstance(default, float):
        return "float"
    if len(words) > 1 and not {"name", "file", "glob"} & set(words):
        if all(word.isdigit() for word in words):
            return "int"
        return f"typing.Literal[{', '.join(repr(word) for word in [*words, *row.get('aliases', [])])}]"
    return TEXT


def options_of(row, by_name):
    """The type of a short option."""
    if len(row["parameters"]) == 2:
        return "str | tuple[int, int]"
    kind = annotation(by_name[row["parameters"][0]])
    return kind


def wrapped(head, arguments, tail):
    """A function, its arguments a line each."""
    return head + "(\n" + "".join(f"    {one},\n" for one in arguments) + f") -> {tail}: ...\n"


class Part:
    """An engine's part of deburr.golden: what it offers, and what it says of types that are no arrays."""

    def __init__(self, module):
        self.module = module
        self.values = [(name, getattr(module, name)) for name in module.__all__]

    def type_of(self, *names, default="_Array"):
        """Of `Class.name`, `function` or `function.parameter`."""
        return self.module.TYPES.get(".".join(names), default)

    def function(self, value, *owner, rows=None, name=None):
        """With its declared parameters, a line each; without any, on one line."""
        name, rows = name or value.__name__, rows or getattr(value, "__declared__", None)
        by_name = {argument(row["name"]): row for row in rows or []}
        arguments = []
        for parameter in inspect.signature(value).parameters.values():
            row = by_name.get(parameter.name) if parameter.annotation is not inspect.Parameter.empty else None
            keywords = parameter.kind is inspect.Parameter.VAR_KEYWORD
            if keywords and rows:
                continue
            if parameter.kind is inspect.Parameter.KEYWORD_ONLY and "*" not in arguments:
                arguments.append("*")
            # A name with a point in front is that of any function's parameter.
            kind = annotation(row) if row else self.type_of(*owner, name, parameter.name,
                                                            default=self.type_of("", parameter.name))
            given = "" if parameter.default is inspect.Parameter.empty else " = ..."
            arguments.append(parameter.name if parameter.name == "self"
                             else f"{'**' if keywords else ''}{parameter.name}: {kind}{given}")
        if rows and not hasattr(value, "__declared__"):
            arguments += ["*", *(f"{one}: {annotation(row)} = ..." for one, row in by_name.items())]
        result = self.type_of(*owner, name, default="None")
        if rows:
            return wrapped(f"def {name}", arguments, result)
        return f"def {name}({', '.join(arguments)}) -> {result}: ...\n"

    def kind(self, name, value):
        """A class: its properties, and its own functions. One that takes parameters takes those that another declares."""
        rows = next((one.__declared__ for one in vars(value).values() if hasattr(one, "__declared__")), None)
        text = f"class {name}:\n"
        of_python = value.__module__ == golden.__name__
        for member, one in vars(value).items() if of_python else sorted(vars(value).items()):
            if isinstance(one, property):
                text += f"    @property\n    def {member}(self) -> {self.type_of(name, member)}: ...\n"
            elif of_python and isinstance(one, types.FunctionType) and (member == "__init__" or not member.startswith("_")):
                takes = rows if "parameters" in inspect.signature(one).parameters else None
                text += textwrap.indent(self.function(one, name, rows=takes, name=member), "    ")
        return text + "\n"

    def text(self):
        constants, kinds, functions = "", "", ""
        for name, value in self.values:
            if isinstance(value, type):
                kinds += self.kind(name, value)
            elif callable(value):
                functions += self.function(value) + ("\n" if hasattr(value, "__declared__") else "")
            else:
                constants += f"{name}: {'tuple[str, ...]' if isinstance(value, tuple) else 'numpy.dtype[numpy.void]'}\n"
        return f"{constants}\n{kinds}{functions}".strip("\n") + "\n"


def golden_stub():
    return HEAD + "".join("\n" + Part(module).text() for module in golden._PARTS)


def ideal_stub():
    """Of the signatures that pybind11 writes into docstrings."""
    def line(name, doc):
        words = re.match(rf"{name}\((.*)\) -> (.*)$", doc.splitlines()[0])
        changed = [re.sub(r"deburr\._golden\.ideal\.", "", re.sub(r": object\b", ": _Array", re.sub(r" = [^,]*$", " = ...", one)))
                   for one in words[1].split(", ")]
        changed = [one.replace("Optional[float]", "float | None").replace("self: TextureImage", "self") for one in changed]
        return f"def {name}({', '.join(changed)}) -> {words[2].replace('numpy.ndarray', '_Array')}: ...\n"

    text = HEAD.replace("from deburr._figures import Figures\n\n", "")
    text += "\nFOOTPRINT: numpy.dtype[numpy.void]\nSCREEN_LINE: numpy.dtype[numpy.void]\n\nclass TextureImage:\n"
    text += "    " + line("__init__", ideal.TextureImage.__init__.__doc__)
    for name, value in sorted(vars(ideal.TextureImage).items()):
        if isinstance(value, property):
            text += f"    @property\n    def {name}(self) -> int: ...\n"
    text += "\n"
    for name in ideal.__all__:
        value = getattr(ideal, name)
        if isinstance(value, types.BuiltinFunctionType):
            text += line(name, value.__doc__)
    return text


def package_stub():
    text = HEAD.replace("import typing\n", "import os\nimport pathlib\nimport typing\n")
    text += '''_Path = os.PathLike[str]

from deburr import golden as golden, ideal as ideal

__version__: str

class RunError(RuntimeError):
    code: int
    result: Run | None

class _Arrays(typing.Protocol):
    def keys(self) -> typing.Iterable[str]: ...
    def __iter__(self) -> typing.Iterator[str]: ...
    def __len__(self) -> int: ...
    def __contains__(self, name: object) -> bool: ...
    def __getitem__(self, name: str) -> _Array: ...

class Run(Figures):
    directory: pathlib.Path
    meaning: dict[str, dict[str, str]]
    windows: Figures
    maps: _Arrays
    pictures: _Arrays
    def explain(self, key: str) -> str: ...

def engines() -> list[str]: ...
def parameters(engine: str) -> list[dict[str, typing.Any]]: ...

'''
    own_run = ["out: str | _Path | None = ...", "config: str | _Path | None = ...", "progress: bool = ..."]
    sweep = list(inspect.signature(_sweep.sweep).parameters)
    kinds = {"axes": "dict[str, typing.Any] | None", "metrics": "list[str] | dict[str, str] | None",
             "minimise": "str | list[str] | None", "maximise": "str | list[str] | None",
             "for_each": "str | list[str] | None", "constraints": "list[str] | None",
             "sample": "str | dict[str, int] | None", "refused": "typing.Literal['error', 'skip'] | None",
             "out": "str | _Path | None", "jobs": "int | None", "progress": "bool"}
    own_sweep = [f"{name}: {kinds[name]} = ..." for name in sweep[2:-1]]
    for engine in deburr.engines():
        rows = {row["name"]: row for row in deburr.parameters(engine)}
        arguments = {argument(name): annotation(row) for name, row in rows.items()}
        for row in _program.options(engine):
            arguments[argument(row["option"])] = options_of(row, rows)
        given = [f"{name}: {kind} = ..." for name, kind in arguments.items()]
        name = f"engine: typing.Literal[{engine!r}]"
        text += "@typing.overload\n" + wrapped("def run", [name, "*", *own_run, *given], "Run")
        text += "@typing.overload\n" + wrapped(
            "def sweep", [name.replace("engine", "what"), f"axes: {kinds['axes']} = ...", "*", *own_sweep, *given], "typing.Any")
        text += "\n"
    text += "@typing.overload\n" + wrapped("def sweep", ["what: str | _Path", "*", *own_sweep[-3:]], "typing.Any")
    # Overloads of one name stand together.
    blocks = re.split(r"(?m)^(?=@typing\.overload)", text)
    head, functions = blocks[0], blocks[1:]
    runs = [one.rstrip() + "\n" for one in functions if "def run" in one]
    sweeps = [one.rstrip() + "\n" for one in functions if "def sweep" in one]
    return head + "".join(runs) + "\n" + "".join(sweeps)


def stubs():
    return {"golden.pyi": golden_stub(), "ideal.pyi": ideal_stub(), "__init__.pyi": package_stub()}


GOOD = """import numpy
import deburr
from deburr import golden, ideal

frame = numpy.zeros((4, 4, 4), dtype=numpy.uint8)
smooth = golden.morphological(frame, preset="smaa", detail=True)
pixels = ideal.fxaa(smooth.pixels, threshold=0.1)
run = deburr.run("texture", scene="plane", size=(64, 64), memory_latency=200, texture_cache_bytes=4096, maps=True)
print(run.cycles, run.maps["misses"].max(), run.pictures["after"].shape, smooth.work.edge_pixels)
table = deburr.sweep("texture", {"texture_cache_bytes": [4096]}, scene="plane", metrics=["cycles"], jobs=2)
unit = golden.TextureUnit(cache_bytes=4096)
unit.load(golden.mip_levels(frame), format="rgba8")
colours = unit.filter(golden.quads_of(numpy.zeros((4, 4)), numpy.zeros((4, 4))))
"""
PLANTED = ('golden.morphological(frame, preset="mlab")', "golden.morphological(frame, stepps=3)",
           'deburr.run("texture", memory_latncy=3)', 'deburr.run("textur", scene="plane")',
           'deburr.run("texture", texture_cache_bytes="many")', "ideal.fxaa(frame, treshold=1)", "smooth.pixel",
           "unit.set(cash_bytes=3)")


def mypy_finds(text):
    """Lines of a program that mypy complains of."""
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "program.py").write_text(text, encoding="utf-8")
        done = subprocess.run(["mypy", "--strict", "--python-executable", "/usr/bin/python3", "--cache-dir", folder,
                               "program.py"], cwd=folder, text=True, capture_output=True, check=False,
                              env={"PATH": "/usr/bin:/bin", "MYPYPATH": str(MODULES), "HOME": folder})
    if done.returncode not in (0, 1):
        sys.exit(done.stdout + done.stderr)
    ours = [line for line in done.stdout.splitlines() if ": error" in line and not line.startswith("program.py:")]
    if ours:
        sys.exit("mypy complains of the module itself:\n" + "\n".join(ours))
    return done.stdout, {int(line) for line in re.findall(r"^program\.py:(\d+): error", done.stdout, re.M)}


def main():
    made = stubs()
    folder = SOURCE / "python/deburr"
    if "--write" in sys.argv:
        for name, text in made.items():
            (folder / name).write_text(text, encoding="utf-8")
        return
    wrong = [name for name, text in made.items()
             if not (folder / name).exists() or (folder / name).read_text(encoding="utf-8") != text]
    if wrong:
        sys.exit(f"{', '.join(wrong)} in python/deburr is not as it is made: tb/system/python_stubs_test.py {MODULES} "
                 f"{SOURCE} --write")
    for module in (deburr, golden, ideal):
        name = "__init__.pyi" if module is deburr else module.__name__.split(".")[1] + ".pyi"
        missing = [one for one in module.__all__ if not re.search(rf"\b{one}\b", made[name])]
        if missing:
            sys.exit(f"{name} has no {', '.join(missing)}")
    if "--mypy" not in sys.argv:
        return
    if not shutil.which("mypy", path="/usr/bin"):
        print("skipped: mypy is not installed")
        return
    lines = GOOD.count("\n")
    text = GOOD + "".join(f"{line}\n" for line in PLANTED)
    said, found = mypy_finds(text)
    expected = set(range(lines + 1, lines + 1 + len(PLANTED)))
    if found != expected:
        sys.exit(f"mypy finds lines {sorted(found)}, not {sorted(expected)}:\n{said}")


if __name__ == "__main__":
    main()
