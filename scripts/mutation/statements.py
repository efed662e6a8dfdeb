# SPDX-License-Identifier: MIT
"""Positions of the statements in C++ text, as far as mutants need them. The text must be formatted by clang-format
and have comments and string literals blanked."""
import collections
import re

# `begin` to `end`, without the semicolon. `kind`: assignment, call, exit (break, continue, return; return of a value
# and throw only as the body of an if after which the function continues), or target: one target of `a = b = 0`, with
# its `=`. `reset`: in a function that resets.
Statement = collections.namedtuple("Statement", "kind begin end reset")

CONTROL = re.compile(r"\b(if|for|while|switch)(?: constexpr)?\s*$")
TYPE = re.compile(r"(?:\[\[[^]]*\]\]\s*)*(?:(?:typedef|static|inline|constexpr|const)\s+)*"
                  r"(class|struct|union|enum|namespace|extern)\b")
ATTRIBUTE = re.compile(r"\s*\[\[\w+\]\]")
LABEL = re.compile(r"\s*(?:(?:else|do)\b(?!\s*\{)|(?:case\b(?:[^:;{}]|::)*|default)\s*:(?!:))\s*")
REQUIRES = re.compile(r"\brequires\s*(?:\([^()]*\))?\s*$")
DEFAULT = re.compile(r"\s*(?:(?:public|private|protected):\s*)?"
                     r"(?!static|constexpr|inline|using|friend|typedef)\w[^(){}=;]*(?: =|\{)")
RESETS = re.compile(r"\b(?:reset|clear)\w*\(")

POSTFIX = (r"(?:\+\+|--)?\*?(?:\(\)|(?:::)?\w+)"
           r"(?:::\w+|<[\w:,*& ]+>|(?:\.|->)\w+|\(\)|\[\]|\{\})*")
TARGET = re.compile(POSTFIX + r"\s=\s+")
ASSIGNMENT = re.compile(POSTFIX + r"(?:\s(?:=|[-+*/%&|^]=|<<=|>>=)\s.*|\+\+|--)", re.S)
STEP = re.compile(r"(?:\+\+|--)" + POSTFIX)
CALL = re.compile(POSTFIX + r"(?<=\(\))")
EXIT = re.compile(r"(?:return|break|continue)")
EXIT_OF_IF = re.compile(r"(?:return|throw)\b.*", re.S)
NO_STATEMENT = re.compile(r"(?:return|throw|break|continue|delete|goto|using|typedef|friend|operator|"
                          r"static_cast|static_assert|assert|co_\w+)\b")


class Frame:
    """An open bracket: `(`, or a brace of `code`, of a `class`, an `enum`, a `namespace`, or `init`."""

    def __init__(self, kind, start, reset=False, control="", of_if=False):
        self.kind, self.start, self.reset, self.control = kind, start, reset, control
        self.of_if, self.after_if = of_if, False

    def begin(self, at, after_if=False):
        self.start, self.after_if = at, after_if


def without_template(header):
    """`template <class T> struct A` without the part that could be mistaken for a class."""
    while match := re.match(r"\s*template\s*<", header):
        depth, at = 1, match.end()
        while at < len(header) and depth:
            depth += (header[at] == "<") - (header[at] == ">")
            at += 1
        header = header[at:]
    return header.strip()


def brace(code, at, parent):
    """The kind of scope that the brace at a position opens."""
    before = code[:at].rstrip()
    last, gap = before[-1:], len(before) != at
    if parent.kind in ("namespace", "class", "code"):
        header = without_template(code[parent.start:at])
        if match := TYPE.match(header):
            word = {"union": "class", "struct": "class", "extern": "namespace"}.get(match[1], match[1])
            if word != "class" or not re.search(r"[(=]", re.sub(r"alignas\([^)]*\)", "", header)):
                return word
    if last in ("=", ",", "(", "?", "&", "|") or re.search(r"\breturn$", before):
        return "init"
    if last in ("{", ";", "}"):
        return "init" if parent.kind == "init" else "code"
    if REQUIRES.search(before):
        return "init"
    return "code" if gap or last == ":" else "init"


def flat(code, begin, end):
    """The text outside brackets, and the position of each of its characters."""
    text, places, depth = [], [], 0
    for at in range(begin, end):
        closes = code[at] in ")]}"
        depth -= closes
        if not depth:
            text.append(code[at])
            places.append(at)
        depth += code[at] in "([{"
    return "".join(text), places + [end]


def checked(code, begin, end, frame):
    """The statements in a text that ends with a semicolon: none, one, or the targets of a chained assignment."""
    of_if = frame.of_if or frame.after_if
    while match := LABEL.match(code, begin, end) or ATTRIBUTE.match(code, begin, end):
        begin = match.end()
    begin += len(code[begin:end]) - len(code[begin:end].lstrip())
    end = begin + len(code[begin:end].rstrip())
    text, places = flat(code, begin, end)
    if EXIT.fullmatch(text) or (of_if and EXIT_OF_IF.fullmatch(text)):
        return [Statement("exit", begin, end, frame.reset)]
    if NO_STATEMENT.match(text):
        return []
    targets, at = [], 0
    while match := TARGET.match(text, at):
        targets.append(Statement("target", places[at], places[match.end()], frame.reset))
        at = match.end()
    if len(targets) > 1:
        return targets
    if ASSIGNMENT.fullmatch(text) or STEP.fullmatch(text):
        return [Statement("assignment", begin, end, frame.reset)]
    return [Statement("call", begin, end, frame.reset)] if CALL.fullmatch(text) else []


def scan(code):
    """The statements of functions, and the extents of member initialisers."""
    statements, defaults = [], []
    frames = [Frame("namespace", 0)]
    for match in re.finditer(r"[(){};]", code):
        at, frame = match.start(), frames[-1]
        if match[0] == "(":
            control = CONTROL.search(code, max(0, at - 20), at)
            frames.append(Frame("(", at + 1, frame.reset, control[1] if control else ""))
        elif match[0] == "{":
            kind = brace(code, at, frame)
            reset = frame.reset
            if kind == "code" and frame.kind in ("namespace", "class"):
                reset = bool(RESETS.search(code, frame.start, at))
            of_if = frame.after_if and not ATTRIBUTE.sub("", code[frame.start:at]).strip()
            frames.append(Frame(kind, at + 1, reset, of_if=of_if))
        elif match[0] == ";":
            if frame.kind == "code":
                statements += checked(code, frame.start, at, frame)
            elif frame.kind == "class":
                if DEFAULT.match(code, frame.start, at):
                    defaults.append((frame.start, at))
            if frame.kind != "(":
                frame.begin(at + 1)
        elif len(frames) > 1:
            closed, frame = frames.pop(), frames[-1]
            if closed.control and frame.kind == "code":
                frame.begin(at + 1, closed.control == "if")
            elif closed.kind == frame.kind == "code" and code[at + 1:at + 2] in ("(", ")", ",", ".", ";"):
                pass  # of a lambda inside a statement
            elif closed.kind not in ("(", "init") and frame.kind in ("code", "class", "namespace"):
                frame.begin(at + 1)
    return statements, defaults
