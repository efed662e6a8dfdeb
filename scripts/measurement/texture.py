# SPDX-License-Identifier: MIT
"""Tables of docs/filtering_conformance.md and of the texture unit's page that tests print."""
import re

from measurement.sources import absent, recipe

FAULTS = "tb/oracle/filtering_faults_test"
ANISOTROPY = "tb/oracle/anisotropy_test"
MESA = "tb/oracle/mesa_test"
ERRORS = re.compile(r"RMS to the supersampled plane at .*: ([\d. ]+)")
# The faults of the criterion's test, as the page names them.
FAULT_NAMES = {
    "five_bit_weights": "5-bit weights, rounded",
    "five_bit_truncated_weights": "5-bit weights, truncated",
    "three_bit_weights": "3-bit weights, rounded",
    "three_bit_truncated_weights": "3-bit weights, truncated",
    "half_texel_shift": "half a texel off, linear",
    "nearest_half_texel_shift": "half a texel off, nearest",
    "wrong_wrap": "wrong wrap",
    "neighbour_past_edge": "right neighbour of the last column clamped",
    "truncated_index": "texel index truncated towards 0",
    "truncated_level": "`*_MIPMAP_NEAREST` takes ⌊l⌋",
    "two_bit_level_fraction": "2-bit level fraction",
    "level_too_low": "l 1/8 too low",
    "level_too_high": "l 3/4 too high",
    "swapped_levels": "levels' weights exchanged",
    "swapped_axes": "u and v fractions exchanged",
    "late_magnification": "magnification switch at l = 1/2",
    "unreplicated_channels": "narrow channels widened with zeros",
    "encoded_srgb": "sRGB not decoded",
    "truncated_colour": "result truncated to 8 bits",
}


@recipe("criterion-faults", long=True)
def criterion_faults(f):
    found, fault = {}, None
    for line in f.test(FAULTS, "Criterion/*").splitlines():
        run = re.match(r"\[ RUN +\] .*/(\w+)", line)
        said = re.match(r"(\d+) of \d+ cases are not high, largest deviation ([\d.]+), verdict (\w+)",
                        line)
        if run:
            fault = run[1]
        elif said:
            found[fault] = [said[3], said[1], said[2]]
    for fault, name in FAULT_NAMES.items():
        yield [name] + found[fault]


def errors(f, test):
    """What the test prints of each rule: RMS at 1 x, 2 x, .. 16 x."""
    return [[f"{float(n):.1f}" for n in found[1].split()]
            for found in map(ERRORS.match, f.test(ANISOTROPY, test).splitlines()) if found]


@recipe("anisotropy")
def anisotropy(f):
    plain = errors(f, "Anisotropy.AliasingFallsWithoutMipLevels")
    # Footprints and logarithms in their order, with floor, ceil and any; the first is the paper's.
    mipped = errors(f, "Anisotropy.ErrorFallsWithMipLevelsForEveryRule")
    yield ["`LINEAR`, no mip levels (aliasing alone)"] + plain[0]
    yield ["`NEAREST`, no mip levels"] + plain[1]
    yield ["`LINEAR_MIPMAP_LINEAR`"] + mipped[0]
    yield ["the same, `count = ceil`"] + mipped[1]


def mesa(f):
    """What the tests of Mesa print, by test; None where Mesa is absent."""
    if not (f.build / MESA).exists():
        return None
    lines, test = {}, None
    for line in f.test(MESA, "*Mesa*").splitlines():
        run = re.match(r"\[ RUN +\] (\S+)", line)
        if run:
            test = run[1]
        elif "Mesa is absent" in line:
            return None
        elif test:
            lines.setdefault(test, []).append(line)
    return lines


def of_test(lines, name):
    return next(text for test, text in lines.items() if name in test)


@recipe("mesa-agreement", long=True)
def mesa_agreement(f):
    lines = mesa(f)
    if lines is None:
        yield from map(absent, ("`NEAREST`, all formats, wraps, sizes, within 1 of 255", "`LINEAR`",
                                "Mesa under the criterion: without level blend",
                                "Mesa under the criterion: `*_MIPMAP_LINEAR`"))
        return
    drivers = ("llvmpipe", "softpipe")

    def least(filter_name, driver):
        shares = [float(found[1]) for found in
                  (re.match(rf"{filter_name}, \w+: ([\d.]+) %", line)
                   for line in of_test(lines, f"NearestAndLinearAgreeToOneStep/{driver}")) if found]
        return f"{min(shares):.4f} %"
    for filter_name, name in (("nearest", "`NEAREST`, all formats, wraps, sizes, within 1 of 255"),
                              ("linear", "`LINEAR`")):
        yield [name] + [least(filter_name, driver) for driver in drivers] + ["98 %"]

    def worst(driver, blended):
        found = [re.match(r"(\w+): (\w+), largest deviation ([\d.]+)", line)
                 for line in of_test(lines, f"PassesTheFilteringCriterion/{driver}")]
        judged = [(("high", "low", "FAIL").index(m[2]), float(m[3]), m[2]) for m in found
                  if m and m[1].endswith("mipmap_linear") == blended]
        verdict = max(judged)[2]
        return f"{verdict} ({max(j[1] for j in judged):.2f})"
    for blended, name in ((False, "without level blend"), (True, "`*_MIPMAP_LINEAR`")):
        yield ([f"Mesa under the criterion: {name}"] +
               [worst(driver, blended) for driver in drivers] + [""])


@recipe("mesa-mip-modes", long=True)
def mesa_mip_modes(f):
    lines = mesa(f)
    modes = ("nearest_mipmap_nearest", "linear_mipmap_nearest", "nearest_mipmap_linear",
             "linear_mipmap_linear")
    for mode in modes:
        if lines is None:
            yield absent(f"`{mode.upper()}`")
            continue
        cells = []
        for rules in ("exact, exact", "half, segments", "half, mitchell"):
            found = {m[1]: m[2] for m in (
                re.match(rf"{mode}, (\w+), {rules}: ([\d.]+) dB", line)
                for line in of_test(lines, "MipModesAgree")) if m}
            cells.append(f"{found['quads']} / {found['plane']}")
        yield [f"`{mode.upper()}`"] + cells + ["35"]


@recipe("mesa-anisotropy", long=True)
def mesa_anisotropy(f):
    lines = mesa(f)
    rules = ("paper's rules", "`exact`, `ceil`", "softpipe")
    for pattern, name in (("checker", "checkerboard"), ("noise", "noise")):
        rows = [re.findall(r"([\d.]+) \(", line) for line in
                (of_test(lines, "AnisotropyFallsAsSoftpipesDoes") if lines else ())
                if line.startswith(pattern)]
        for i, rule in enumerate(rules):
            yield ([f"{name}, {rule}"] + [f"{float(row[i]):.1f}" for row in rows] if rows
                   else absent(f"{name}, {rule}"))
