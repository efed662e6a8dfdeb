#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What the program says keeps to the words of the glossary, as the pages do (index_test.py): sentences in the literals
of the sources (messages, help, meanings of parameters, datasheets), messages and help of the scripts and of the Python
module, and the names of the tests; and names in the code. Names of keys and values, set in quotes or alone in a literal, are as they are.

usage: words_test.py SOURCE"""
import ast
import pathlib
import re
import sys
import tempfile

sys.dont_write_bytecode = True
from index_test import not_used  # noqa: E402

CODE = ("rtl_model", "golden", "spec", "python", "tb", "examples")
SCRIPTS = (*CODE, "scripts")
WITH_FAULTS = ("index_test.py", "words_test.py")  # of this test and its neighbour: faults on purpose
# A comment, a literal as it is, a literal, a character.
TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|R"(?P<mark>\w*)\((?P<raw>.*?)\)(?P=mark)"|"(?P<text>(?:[^"\\\n]|\\.)*)"'
                   r"|'(?:[^'\\\n]|\\.)'", re.S)
QUOTED = re.compile(r"`[^`]*`|(?<!\w)'[^']*'")
TEST = re.compile(r"\bTEST(?:_F|_P)?\(\w+,\s*(\w+)\)")
# The key of a sweep's file, and a wire of the twins.
KEY = re.compile(r"\brefused: |\bbehind == ")
# Names that stay: of keys and registers; of what is behind in a queue; look-ups, as counters call them.
NAME = re.compile(r"[A-Za-z_]\w*")
KEY_NAMES = {"refused", "kRefused", "kStatusRefused"}
NOT_OF_NAMES = {"behind", "lookup"}
# In depth a surface is behind another one, or behind the eye.
DEPTH = re.compile(r"\b(?:lies?|wholly) behind\b|\bbehind the eye\b", re.I)


def literals(text):
    """Line and text of each literal; those that follow one another are one."""
    begin, end, joined = 0, 0, None
    for token in TOKEN.finditer(text):
        part = token["raw"] if token["raw"] is not None else token["text"]
        if part is None:
            continue
        if joined is not None and not text[end:token.start()].strip():
            joined += part
        else:
            if joined is not None:
                yield text.count("\n", 0, begin) + 1, joined
            begin, joined = token.start(), part
        end = token.end()
    if joined is not None:
        yield text.count("\n", 0, begin) + 1, joined


def parts(name):
    """The words of a name."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", name.replace("_", " ")).split()


def names_with(text, words):
    """Line and name of what has one of the words in it, in the code of C++."""
    code = TOKEN.sub(lambda found: "\n" * found[0].count("\n"), text)
    for number, line in enumerate(code.split("\n"), 1):
        for name in NAME.findall(line):
            if name not in KEY_NAMES and words & {part.lower() for part in parts(name)}:
                yield number, name


def of_cpp(text):
    yield from literals(text)
    for found in TEST.finditer(text):
        yield text.count("\n", 0, found.start()) + 1, " ".join(parts(found[1]))


def of_python(text, module):
    """Its help, messages and names of tests; of the module for users every docstring."""
    tree = ast.parse(text)
    inner = {id(node.body[0].value) for node in ast.walk(tree)
             if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and ast.get_docstring(node)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and (module or id(node) not in inner):
            yield node.lineno, node.value
        elif isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
            yield node.lineno, node.name.removeprefix("test_").replace("_", " ")


def said(root):
    """Where, and a text."""
    for path in sorted(path for folder in SCRIPTS for path in (root / folder).rglob("*")
                       if path.is_file() and path.name not in WITH_FAULTS):
        where = path.relative_to(root).as_posix()
        if path.suffix in (".cpp", ".h", ".c", ".sv") and not where.startswith("scripts/"):
            found = of_cpp(path.read_text(encoding="utf-8"))
        elif path.suffix == ".py" or not path.suffix and path.read_bytes().startswith(b"#!/usr/bin/python3"):
            found = of_python(path.read_text(encoding="utf-8"), where.startswith("python/"))
        else:
            continue
        for line, text in found:
            if " " in text.strip():
                yield f"{where}:{line}", text


def problems(root):
    words = {word.lower(): but for word, but in not_used(root / "docs").items()}
    pattern = re.compile(rf"(?<![\w/-])({'|'.join(map(re.escape, words))})(?![\w/-])", re.I)
    for where, text in said(root):
        plain = KEY.sub("", DEPTH.sub("", QUOTED.sub("", text.replace("\\n", "\n"))))
        for found in pattern.findall(plain):
            yield f"{where}: '{found}' is not used: {words[found.lower()]}"

    in_names = words.keys() - NOT_OF_NAMES
    for path in sorted(path for folder in CODE for ending in ("cpp", "h") for path in (root / folder).rglob(f"*.{ending}")):
        for line, name in names_with(path.read_text(encoding="utf-8"), in_names):
            yield f"{path.relative_to(root).as_posix()}:{line}: the name {name} has a word that is not used"


def faults_that_are_not_found():
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name in ("docs/explanation", "tb", "scripts", "python"):
            (root / name).mkdir(parents=True)
        (root / "docs/explanation/glossary.md").write_text(
            "## Words that are not used\n\n| not | but |\n|---|---|\n| judge, refused | check |\n| behind | after |\n", encoding="utf-8")
        for name, text, count in (
                ("tb/a.cpp", 'say("it was "\n    "refused");', 1), ("tb/a.cpp", "// it was refused\n/* and judge */ f(\"refused\");", 0),
                ("tb/a.cpp", "say(\"leave out what is rejected with 'refused: skip'\");", 0),
                ("tb/a.cpp", 'say("the line behind it"); say("what lies behind the eye");', 1),
                ("tb/a.cpp", "TEST(Frame, LeavesNothingBehind) {\n  f('\"');\n}\nTEST_P(Frame, IsJudged) {}", 1),
                ("tb/a.h", "// It may judge.\nvoid judge_all(int refused, Refused behind);\nint kRefused = 1;", 2),
                ("scripts/a", '#!/usr/bin/python3\n"""We judge."""\ndef f():\n    """Judge it."""\n    print("it was refused")\n', 2),
                ("python/a.py", 'def f():\n    """Judge it."""\n', 1), ("tb/a.py", "def test_it_is_refused(self):\n    pass\n", 1)):
            path = root / name
            path.write_text(text, encoding="utf-8")
            if len(list(problems(root))) != count:
                yield f"planted fault: {name}: {text}: {list(problems(root))}"
            path.unlink()


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    found = [*faults_that_are_not_found(), *problems(pathlib.Path(sys.argv[1]).resolve())]
    for problem in found:
        print(problem)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
