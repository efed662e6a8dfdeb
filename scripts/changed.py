# SPDX-License-Identifier: MIT
"""Files that differ from the branch that a clone is made of, or from the upstream branch."""
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent


def git(*words):
    """None if git fails or is absent."""
    try:
        done = subprocess.run(["git", "-C", ROOT, *words], capture_output=True, text=True, check=False)
    except OSError:
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def changed():
    """Files that differ; None without history. In the branch itself the list is empty, unless DEBURR_CHANGED_HOURS
    gives the number of hours before the last commit whose commits count."""
    base = git("merge-base", "HEAD", "origin/HEAD") or git("merge-base", "HEAD", "@{upstream}")
    hours = os.environ.get("DEBURR_CHANGED_HOURS")
    if hours and base in (None, git("rev-parse", "HEAD")):
        since = int(git("show", "-s", "--format=%ct", "HEAD") or 0) - 3600 * int(hours)
        base = git("rev-list", "-1", f"--before={since}", "HEAD")
    if not base:
        return None
    names = (git("diff", "--name-only", "--no-renames", "--relative", "-z", base) +
             git("ls-files", "--others", "--exclude-standard", "-z"))
    return {ROOT / name for name in names.split("\0") if name}
