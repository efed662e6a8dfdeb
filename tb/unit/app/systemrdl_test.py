#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What `deburr params --systemrdl` prints is read back, by a reader of the part of SystemRDL 2.0 that it uses, and
says the same as the C header (whose values c_header_test.py holds against the contract).

usage: systemrdl_test.py DEBURR
"""
import re
import subprocess
import sys

TOKEN = re.compile(r'\s+|//[^\n]*|("(?:\\.|[^"\\])*"|\\?\w+(?:\'[hd]\w+)?|@|\+=|[{}\[\];:=])')
ACCESS = {("sw", "rw"): "RW", ("sw", "r"): "RO", ("sw", "w"): "WO", ("onwrite", "woclr"): "W1C"}


def tokens(text):
    at, found = 0, []
    while at < len(text):
        match = TOKEN.match(text, at)
        if not match:
            raise ValueError(f"not SystemRDL: {text[at:at + 40]!r}")
        if match[1]:
            found.append(match[1])
        at = match.end()
    return found


def number(word):
    size, base, digits = re.fullmatch(r"(?:(\d+)'([hd]))?(\w+)", word).groups()
    value = int(digits, {"h": 16, "d": 10, None: 0}[base])
    if size and value >> int(size):
        raise ValueError(f"{word} does not fit")
    return value


class Reader:
    """address map -> register -> offset, access, reset value, fields: name -> high, low, codes."""

    def __init__(self, text):
        self.words = tokens(text)
        self.at = 0

    def take(self, *wanted):
        word = self.words[self.at]
        self.at += 1
        if wanted and word not in wanted:
            raise ValueError(f"{word} instead of {wanted}")
        return word

    def name(self):
        return self.take().removeprefix("\\")

    def property(self):
        if self.words[self.at] == "default":
            self.take()
        key = self.take()
        self.take("=")
        value = self.name()
        self.take(";")
        return key, value

    def file(self):
        maps = {}
        while self.at < len(self.words):
            self.take("addrmap")
            name = self.name()
            maps[name] = self.registers()
            self.take(";")
        return maps

    def registers(self):
        """The body of a map or of a repeated group, whose registers get names with the number 0."""
        found = {}
        self.take("{")
        while self.words[self.at] != "}":
            if self.words[self.at] == "reg":
                self.take()
                register = self.register()
                name = self.name()
                self.take("@")
                found[name] = register | {"offset": number(self.take())}
                self.take(";")
            elif self.words[self.at] == "regfile":
                self.take()
                inner = self.registers()
                name = self.name()
                self.take("[")
                count = number(self.take())
                self.take("]")
                self.take("@")
                base = number(self.take())
                self.take("+=")
                found["repeated"] = {"count": count, "stride": number(self.take())}
                self.take(";")
                found |= {f"{name}0_{key}": value | {"offset": base + value["offset"]} for key, value in inner.items()}
            else:
                self.property()
        self.take("}")
        return found

    def register(self):
        register = {"reset": 0, "fields": {}, "access": set()}
        codes = {}
        self.take("{")
        while self.words[self.at] != "}":
            kind = self.words[self.at]
            if kind == "enum":
                self.take()
                name = self.name()
                codes[name] = self.enumeration()
            elif kind == "field":
                self.take()
                self.field(register, codes)
            else:
                self.property()
        self.take("}")
        return register

    def enumeration(self):
        values = {}
        self.take("{")
        while self.words[self.at] != "}":
            name = self.name()
            self.take("=")
            values[name] = number(self.take())
            self.take(";")
        self.take("}")
        self.take(";")
        return values

    def field(self, register, codes):
        self.take("{")
        properties = []
        while self.words[self.at] != "}":
            properties.append(self.property())
        self.take("}")
        name = self.name()
        self.take("[")
        high = number(self.take())
        self.take(":")
        low = number(self.take())
        self.take("]")
        self.take("=")
        register["reset"] |= number(self.take()) << low
        self.take(";")
        named = dict(properties).get("encode")
        register["fields"][name] = {"mask": (2 << high) - (1 << low), "shift": low, "codes": codes[named] if named else {}}
        register["access"].add([ACCESS[item] for item in properties if item in ACCESS][-1])


def macros(maps):
    """What the C header would define, and the access that its comments tell."""
    values, accesses = {}, {}
    for prefix, registers in maps.items():
        prefix = prefix.upper()
        for name, register in registers.items():
            if name == "repeated":
                values |= {f"{prefix}_COUNT": register["count"], f"{prefix}_STRIDE": register["stride"]}
                continue
            full = f"{prefix}_{name}"
            values[full] = register["offset"]
            accesses[full] = "/".join(sorted(register["access"]))
            if register["reset"]:
                values[f"{full}_RESET"] = register["reset"]
            for field, bits in register["fields"].items():
                if field == "value" and bits["mask"] == 0xFFFFFFFF:
                    continue  # a register of one number, which has no field there
                stem = f"{full}_{field.upper()}"
                values |= {f"{stem}_MASK": bits["mask"], f"{stem}_SHIFT": bits["shift"]}
                values |= {f"{stem}_{code.upper()}": value for code, value in bits["codes"].items()}
    return values, accesses


def header_macros(header):
    values = {name: int(value, 0) for name, value in re.findall(r"^#define (\w+) (\w+)u", header, re.M)}
    accesses = {name: access for access, name in re.findall(r"^/\* (RW|RO|WO|W1C): .*\n#define (\w+) ", header, re.M)}
    return values, accesses


def differences(text, header):
    try:
        read = macros(Reader(text).file())
    except (ValueError, IndexError, KeyError) as error:
        return [f"cannot be read: {error}"]
    return [f"{name}: {mine.get(name)} here, {theirs.get(name)} in the header"
            for mine, theirs in zip(read, header_macros(header)) for name in sorted(set(mine) | set(theirs))
            if mine.get(name) != theirs.get(name)]


def main():
    if len(sys.argv) != 2:
        print(__doc__)
        return 2
    text, header = (subprocess.run([sys.argv[1], "params", option], check=True, capture_output=True, text=True).stdout
                    for option in ("--systemrdl", "--c-header"))
    wrong = differences(text, header)
    if len(header_macros(header)[0]) < 300:
        wrong.append("the header is not all there")
    # Faults that must be seen: an offset, a bit, a reset value, a code, an access, a lost register, a stride.
    for before, after in ((" ID @ 0x000;", " ID @ 0x0FC;"), ("crease[3:2]", "crease[4:3]"), ("32'hDEB00004", "32'hDEB00002"),
                          (" paper = 2'd1;", " paper = 2'd2;"), ("onwrite = woclr;", ""), ("} SIZE @", "} SIZES @"),
                          ("+= 0x80", "+= 0x40"), ("enable[0:0]", "enable[0:0")):
        if before not in text:
            wrong.append(f"nothing is {before!r}")
        elif not differences(text.replace(before, after, 1), header):
            wrong.append(f"{before!r} as {after!r} was not noticed")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
