# SPDX-License-Identifier: MIT
"""The mutants of a source text, and the text that holds each of them behind a switch."""
import bisect
import collections
import re

from mutation import statements

# Text that may look like an operator or a number but is not code: comments, string and character literals,
# directives.
NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])+\''
                     r'|^[ \t]*#[^\n]*|\bstatic_assert\b[^;]*;|\bvirtual\b[^;{}]* = 0;', re.S | re.M)
# Constructs over several lines, which NO_CODE takes for code from the second line on: directives, raw strings.
LONG = re.compile(r'^[ \t]*#(?:[^\n]*\\\n)+[^\n]*|\bR"(\w*)\(.*?\)\1"', re.S | re.M)
COMPARISONS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "=="}
OTHER = {"+": "-", "-": "+", "+=": "-=", "-=": "+=", "&&": "||", "||": "&&",
         "<<": ">>", ">>": "<<", "<<=": ">>=", ">>=": "<<=",
         "&": "|", "|": "&", "^": "&", "&=": "|=", "|=": "&=", "^=": "&="}


def masks(text):
    """A hexadecimal constant with its lowest bit flipped, and without its highest bit."""
    digits, suffix = re.fullmatch(r"0[xX]([\da-fA-F']+)([uUlLzZ]*)", text).groups()
    value = int(digits.replace("'", ""), 16)
    found = [value ^ 1] + ([value ^ 1 << value.bit_length() - 1] if value > 1 else [])
    return [f"0x{changed:X}{suffix}" for changed in dict.fromkeys(found)]


# Kind, search pattern, and replacements. clang-format puts blanks around binary operators, and none around template
# brackets and signs of numbers.
RULES = [
    ("comparison", re.compile(r"(?<= )(<=|>=|==|!=|<|>)(?=\s)"), lambda text: [COMPARISONS[text]]),
    ("operator", re.compile(r"(?<= )(\+=|-=|\+|-|&&|\|\|)(?=\s)"), lambda text: [OTHER[text]]),
    ("constant", re.compile(r"(?<![\w.'])(?<!\d[eE][-+])\d+(?![\w.'])"),
     lambda text: [str(int(text) + 1)] + ([str(int(text) - 1)] if int(text) else [])),
    ("stall", re.compile(r"!?(?<![\w.>)\]])(?:\w+(?:\[[^][]*\])?(?:\.|->))+can_(?:push|pop)\(\w+\)"),
     lambda text: ["false" if text[0] == "!" else "true"]),
    # Strings are written with <<, which has no valid replacement.
    ("shift", re.compile(r"(?<= )(?<!\" )(<<=|>>=|<<|>>)(?=\s+[^\s\"])"), lambda text: [OTHER[text]]),
    ("bits", re.compile(r"(?<= )(&=|\|=|\^=|&|\||\^)(?=\s)"), lambda text: [OTHER[text]]),
    ("literal", re.compile(r"\b(?:true|false)\b"),
     lambda text: ["false" if text == "true" else "true"]),
    ("hexadecimal", re.compile(r"(?<![\w.'])0[xX][\da-fA-F']+[uUlLzZ]*(?![\w.'])"), masks),
    ("min_max", re.compile(r"\bstd::(?:min|max)(?=[(<])"),
     lambda text: ["std::max" if text == "std::min" else "std::min"]),
]
# Removed statements, found by statements.py; in a function that resets, each is of kind reset.
LEFT_OUT = {"assignment": "statement", "target": "statement", "call": "call", "exit": "exit"}
KINDS = [kind for kind, _, _ in RULES] + [*dict.fromkeys(LEFT_OUT.values()), "reset"]
NAMES = {"<": "Less", "<=": "LessEqual", ">": "Greater", ">=": "GreaterEqual", "==": "Equal",
         "!=": "NotEqual", "+": "Plus", "-": "Minus", "+=": "Add", "-=": "Subtract",
         "<<": "ShiftLeft", ">>": "ShiftRight", "<<=": "ShiftLeftBy", ">>=": "ShiftRightBy",
         "&": "BitAnd", "|": "BitOr", "^": "BitXor", "&=": "BitAndWith", "|=": "BitOrWith",
         "^=": "BitXorWith"}
INFIX = {"<": ">=", "<=": ">=", ">": ">=", "!=": "==", ">>": "<<"}

# Initial values of members are skipped: most are overwritten before they are read, so their mutants are not faults.
# Reset values are mutated in the reset function. `constant` is matched line by line to keep the mutants of old
# records; the other kinds use statements.scan().
DEFAULTS = re.compile(r"^ {2}(?: {2})?(?!static|const|return|using|for|if)[\w:<>,* ]+? \w+(?: = \d+)?"
                      r"(?:,\s+\w+(?: = \d+)?)*;", re.M)
HEADER = re.compile(r"^#(?:ifndef \w+_H|pragma once)", re.M)

Mutant = collections.namedtuple("Mutant", "kind begin end text")


def code_of(source):
    """The source with blanks for everything that is not code, and quotes for string and character literals."""
    return NO_CODE.sub(lambda m: re.sub(r"[^\n]", '"' if m.group()[0] in "\"'" else " ", m.group()),
                       source)


def for_statements(source, code):
    """The code with blanks for the remaining parts that are not code."""
    pieces, at = [], 0
    for match in LONG.finditer(source):
        pieces += [code[at:match.start()], re.sub(r"[^\n]", " ", match.group())]
        at = match.end()
    return "".join(pieces + [code[at:]])


def mutants_of(source):
    """Every mutant of a source text, in order."""
    code = code_of(source)
    unread = {at for m in (DEFAULTS.finditer(code) if HEADER.search(source) else ())
              for at in range(m.start(), m.end())}
    parts, defaults = statements.scan(for_statements(source, code))
    unset = {at for begin, end in defaults for at in range(begin, end)}
    not_read = {"constant": unread, "literal": unset, "hexadecimal": unset}
    found = [Mutant(kind, m.start(), m.end(), text) for kind, pattern, variants in RULES
             for m in pattern.finditer(code) if m.start() not in not_read.get(kind, ())
             for text in variants(m.group())]
    found += [Mutant("reset" if part.reset else LEFT_OUT[part.kind], part.begin, part.end, "")
              for part in parts]
    # The two mutants of a constant are consecutive, plus one first: switch.h relies on this.
    return sorted(found, key=lambda m: (m.begin, m.kind, -int(m.text) if m.text.isdigit() else 0))


def operands(code, begin, end):
    """The extents of the operands of `&&` or `||` between two positions. They stay the operands after the operator is
    exchanged: the first one of `a && b && c` gives `(a || b) && c`."""
    ends = {"||", "?", ",", ";", "="} | ({"&&"} if code[begin:end] == "&&" else set())

    def token(at):
        if code[at:at + 2] in ("&&", "||"):
            return code[at:at + 2]
        if code[at] == ":":
            return "" if ":" in (code[at - 1], code[at + 1]) else ";"
        if code[at] == "=":
            return "" if code[at - 1] in "=<>!" or code[at + 1] == "=" else "="
        return code[at]

    depth, at = 0, end
    while at < len(code) - 1 and (depth or code[at] not in ")]}" and token(at) not in ends):
        depth += (code[at] in "([{") - (code[at] in ")]}")
        at += 1
    right = end + len(code[end:at]) - len(code[end:at].lstrip()), end + len(code[end:at].rstrip())
    # To the left, `&&` includes operands already joined by another `&&`.
    ends.discard("&&")
    if code[begin:end] == "||":
        ends.discard("||")
    depth, at = 0, begin
    while at > 1 and (depth or code[at - 1] not in "([{" and token(at - 1) not in ends
                      and code[at - 2:at] not in ends and not code[max(0, at - 6):at] == "return"
                      and not re.match(r"}\s*\n", code[at - 1:begin])):
        depth += (code[at - 1] in ")]}") - (code[at - 1] in "([{")
        at -= 1
    text = code[at:begin]
    return (at + len(text) - len(text.lstrip()), at + len(text.rstrip())), right


def schema_of(source, first, dropped=frozenset(), plain=None):
    """The source with its mutants behind the switches `first`, `first` + 1, ... except those whose indices in the
    list of mutants are in `dropped`. The mutant `plain` is inserted without a switch. Line numbers do not change."""
    code = code_of(source)
    mutants = mutants_of(source)
    # (position, closing before opening text at the same position, outer before inner or reverse, text)
    inserts, replaced = [], {}

    def enclose(begin, end, level, before, after):
        inserts.append((begin, 1, -end, level, before))
        inserts.append((end, 0, -begin, -level, after))

    for place, mutant in enumerate(mutants):
        if plain is not None and place != plain and (
                mutants[plain].begin <= mutant.begin < mutants[plain].end):
            continue  # it is inside removed text, or overlaps another mutant
        number, was = first + place, source[mutant.begin:mutant.end]
        switch = f"::deburr_mutant::on<{number}>()"
        if plain == place:
            replaced[mutant.begin] = (mutant.end, mutant.text)
            if was in ("&", "|", "^"):  # which have different precedence
                replaced[mutant.begin] = (mutant.end, f"{was} ::deburr_mutant::{NAMES[was]}"
                                          f"<::deburr_mutant::kAlone>{{}} {was}")
            if was in ("&&", "||"):
                left, right = operands(code, mutant.begin, mutant.end)
                enclose(left[0], right[1], 1, "(", ")")
                for operand in (left, right):
                    enclose(*operand, 0, "(", ")")
        elif place in dropped:
            continue
        elif mutant.kind == "constant":
            if mutant.begin not in replaced and int(mutant.text) > int(was):
                replaced[mutant.begin] = (mutant.end,
                                          f"::deburr_mutant::constant<{number}>({was})")
        elif mutant.kind == "hexadecimal":
            before = replaced.get(mutant.begin, (0, f"({was})"))[1]
            replaced[mutant.begin] = (mutant.end, f"({switch} ? {mutant.text} : {before[1:]}")
        elif mutant.kind == "literal":
            replaced[mutant.begin] = (mutant.end, f"({was} != {switch})")
        elif mutant.kind == "min_max":
            replaced[mutant.begin] = (mutant.end, f"::deburr_mutant::Extreme<{number}>::{was[5:]}")
        elif not mutant.text and was.rstrip() != was:  # `a = ` of `a = b = 0`
            enclose(mutant.begin, mutant.begin + len(was.rstrip()[:-1].rstrip()), 0,
                    f"::deburr_mutant::kept<{number}>(", ")")
        elif not mutant.text:
            # With its own else, so that it does not capture the else of an enclosing if.
            inserts.append((mutant.begin, 1, -mutant.end, -1, f"if ({switch}) {{}} else "))
        elif mutant.kind == "stall":
            if plain is None or not mutant.begin <= mutants[plain].begin < mutant.end:
                enclose(mutant.begin, mutant.end, 2,
                        f"(!{switch} && " if was[0] == "!" else f"({switch} || ", ")")
        elif was in ("&&", "||"):
            left, right = operands(code, mutant.begin, mutant.end)
            enclose(left[0], right[1], 1, "((", f") != {switch})")
            for operand in (left, right):
                enclose(*operand, 0, "(!!(", f") != {switch})")
        else:
            infix = INFIX.get(was, was)
            replaced[mutant.begin] = (
                mutant.end, f"{infix} ::deburr_mutant::{NAMES[was]}<{number}>{{}} {infix}")
    inserts += [(begin, 2, 0, 0, text) for begin, (_, text) in replaced.items()]
    pieces, at = [], 0
    for position, kind, _, _, text in sorted(inserts):
        pieces += [source[at:position], text]
        at = replaced[position][0] if kind == 2 else max(at, position)
    return "".join(pieces + [source[at:]])


def lines_of(source):
    """The line numbers of each mutant's switch code, in the order of mutants_of."""
    code = code_of(source)
    starts = [0] + [m.end() for m in re.finditer("\n", source)]
    number = lambda position: bisect.bisect_right(starts, position)
    found = []
    for mutant in mutants_of(source):
        positions = [mutant.begin]
        if mutant.text in ("&&", "||"):
            positions += [p for extent in operands(code, mutant.begin, mutant.end) for p in extent]
        found.append({number(position) for position in positions})
    return found


def shown(source, mutant):
    """Number of the changed line, and its text before and after."""
    begin = source.rfind("\n", 0, mutant.begin) + 1
    end = source.find("\n", mutant.end)
    line = source[begin:end if end >= 0 else None]
    after = source[begin:mutant.begin] + mutant.text + source[mutant.end:begin + len(line)]
    # For a statement over several lines, the first line is shown.
    return source.count("\n", 0, begin) + 1, line.strip(), after.strip() or ";"
