#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Checks that every C++ file is formatted as .clang-format says."""
import argparse
import pathlib
import shutil
import subprocess
import sys


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("root", type=pathlib.Path, help="the checkout")
    root = parser.parse_args().root
    formatter = shutil.which("clang-format")
    if not formatter:
        print("skipped: clang-format is not installed")
        return
    check = [formatter, "--dry-run", "-Werror", f"--style=file:{root / '.clang-format'}"]
    planted = subprocess.run(check, input="int  x ;\n", capture_output=True, text=True, check=False)
    if planted.returncode == 0:
        sys.exit("the planted fault was not caught")
    files = [str(path) for layer in ("spec", "golden", "rtl_model", "tb")
             for path in sorted((root / layer).rglob("*")) if path.suffix in {".h", ".cpp"}]
    sys.exit(subprocess.run([*check, *files], check=False).returncode)


if __name__ == "__main__":
    main()
