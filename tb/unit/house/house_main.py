# SPDX-License-Identifier: MIT
"""Main function of the tests of house rules."""
import argparse
import pathlib
import sys


def house_main(doc, missed, check):
    """Exits with an error if injected faults were missed, or if `check` finds a violation in the checkout."""
    parser = argparse.ArgumentParser(description=doc.splitlines()[0])
    parser.add_argument("root", type=pathlib.Path, help="the checkout")
    found = [*(f"injected fault missed, or reported without a fault: {fault}" for fault in missed),
             *check(parser.parse_args().root)]
    for complaint in found:
        print(complaint)
    sys.exit(1 if found else 0)
