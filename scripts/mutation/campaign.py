# SPDX-License-Identifier: MIT
"""Many mutants of many files: which of them, in which order, and what became of them."""
import collections
import hashlib
import json
import os
import pathlib
import random
import re
import shlex
import subprocess
import threading

import yaml

from mutation.check import Verdict, threads
from mutation.mutants import shown
from mutation.tree import Problem, digest

LEFT = Verdict("left", "")
PROFILE = ("conf", "partition", "time", "memory", "cpus", "tasks", "options", "setup")


def sample(mutants, count, seed):
    """The places of the mutants that are chosen, in the order of the choice."""
    places = list(range(len(mutants)))
    random.Random(seed).shuffle(places)
    return places[:count] if count else places


def drawn(mutants, count, each, seed, left=frozenset()):
    """(file, place) of `count` of all mutants (0: all) that are not `left` out, drawn at random over all
    files, in the order of the draw, and then of as many more as every file needs to have `each`. The
    number by which a mutant stands in the draw depends on nothing but the mutant and the seed, so that a
    larger sample begins with a smaller one."""
    def number(file, mutant):
        text = f"{seed} {file} {mutant.begin} {mutant.kind} {mutant.text}"
        return hashlib.sha256(text.encode()).digest()

    order = sorted((number(file, mutant), file, place) for file, all_of in mutants.items()
                   for place, mutant in enumerate(all_of) if (file, place) not in left)
    order = [(file, place) for _, file, place in order]
    chosen, rest = (order[:count], order[count:]) if count else (order, [])
    of_file = collections.Counter(file for file, _ in chosen)
    for file, place in rest:
        if of_file[file] < each:
            of_file[file] += 1
            chosen.append((file, place))
    return chosen


class Campaign:
    """Results are lines of JSON in `work`/results, a file for each who writes: what is there is not
    done again, and a file that has changed begins anew. If `switched`, what needs a build is left out,
    and others are drawn in its place."""

    def __init__(self, tree, checker, count, each, seed, say, switched=False):
        self.tree, self.checker, self.say = tree, checker, say
        self.left = frozenset(
            (file, place) for file, all_of in tree.mutants.items() for place in range(len(all_of))
            if switched and checker.needs_a_build(file, place))
        self.chosen = drawn(tree.mutants, count, each, seed, self.left)
        self.lock = threading.Lock()

    def key(self, file, place):
        mutant = self.tree.mutants[file][place]
        return (str(file), digest(self.tree.sources[file]), mutant.begin, mutant.kind, mutant.text)

    def explained(self, explanations):
        """The mutants that (file, line before, line after) of the explanations name."""
        files = {file for file, _, _ in explanations}
        return [(file, place) for file, all_of in self.tree.mutants.items() if str(file) in files
                for place, mutant in enumerate(all_of)
                if (str(file), *shown(self.tree.sources[file], mutant)[1:]) in explanations]

    def run(self, jobs, again, explained=(), name="local", part=0, parts=1):
        """Checks what has no verdict yet, or if `again` survived and is not `explained`: behind
        switches first, then, unless this is one of several parts, one by one what must be compiled.
        `part` of `parts` of them all. What is explained is checked whether it was drawn or not, since
        an explanation is of a survivor."""
        drawn_ones = set(self.chosen)
        self.chosen += [item for item in self.explained(explained) if item not in drawn_ones]
        known = read_results(self.tree.work)
        done = {key_of(entry) for entry in known if entry["verdict"] != "left" and
                (not again or entry["verdict"] != "survived"
                 or (entry["file"], entry["was"], entry["is"]) in explained)}
        wanted = [item for n, item in enumerate(self.chosen)
                  if n % parts == part and self.key(*item) not in done]
        folder = self.tree.work / "results"
        folder.mkdir(exist_ok=True)
        if self.left and part == 0:
            self.tell_what_is_left(folder / "left.jsonl")
        later = []
        with (folder / f"{name}.jsonl").open("a+", encoding="utf-8") as out:
            # The last line may be half of one, of a writer that was killed.
            if out.tell():
                out.write("\n")
            def checked(number, item):
                verdict = None if self.checker.needs_a_build(*item) else self.checker.by_switch(*item)
                if verdict is None:
                    later.append(item)
                else:
                    self.put(out, item, verdict, "switch")
                if number % 200 == 0:
                    self.say(f"{number} of {len(wanted)} mutants")

            with threads(jobs) as pool:
                for future in [pool.submit(checked, *pair) for pair in enumerate(wanted)]:
                    future.result()
            # A header costs a build of nearly everything.
            later.sort(key=lambda item: (item[0].suffix == ".h", wanted.index(item)))
            for number, item in enumerate(later if parts == 1 else ()):
                self.put(out, item, self.checker.alone(*item), "alone")
                self.say(f"{number + 1} of {len(later)} mutants compiled alone")

    def tell_what_is_left(self, path):
        """In the place of what was left before: tests that are new may run it."""
        own = {str(file) for file in self.tree.mutants}
        others = [line for line in lines_of(path) if line["file"] not in own]
        with path.open("w", encoding="utf-8") as out:
            out.writelines(json.dumps(line) + "\n" for line in others)
            for item in sorted(self.left):
                self.put(out, item, LEFT, "")

    def put(self, out, item, verdict, way):
        file, place = item
        line, before, after = shown(self.tree.sources[file], self.tree.mutants[file][place])
        keys = dict(zip(("file", "hash", "begin", "kind", "text"), self.key(file, place)))
        with self.lock:
            out.write(json.dumps({**keys, "line": line, "was": before, "is": after, "way": way,
                                  "budget": self.checker.budget,
                                  **verdict._asdict()}) + "\n")
            out.flush()


def key_of(entry):
    return tuple(entry[name] for name in ("file", "hash", "begin", "kind", "text"))


def lines_of(path):
    """Every whole line."""
    for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else ():
        try:
            yield json.loads(line)
        except ValueError:  # its writer was killed
            continue


def read_results(work):
    """Of every writer; what a test has killed once is killed, and what has a verdict was not left out."""
    found = {}
    for path in sorted((work / "results").glob("*.jsonl")):
        for entry in lines_of(path):
            before = found.get(key_of(entry), LEFT._asdict())["verdict"]
            if before == "left" or before != "killed" and entry["verdict"] != "left":
                found[key_of(entry)] = entry
    return list(found.values())


def read_profile(path):
    try:
        profile = yaml.safe_load(path.read_text(encoding="utf-8")) or {}
    except (OSError, yaml.YAMLError) as error:
        raise Problem(f"{path}: {error}") from error
    if not isinstance(profile, dict) or set(profile) - set(PROFILE):
        raise Problem(f"{path}: known keys are {', '.join(PROFILE)}")
    return profile


def submit(profile, work, command):
    """A job array, each task of which checks its share; the number of the job."""
    cpus, tasks = int(profile.get("cpus", 1)), int(profile.get("tasks", 16))
    folder = work / "slurm"
    folder.mkdir(exist_ok=True)
    options = ["--job-name=deburr-mutants", f"--array=0-{tasks - 1}", "--ntasks=1",
               f"--cpus-per-task={cpus}", "--requeue", "--open-mode=append",
               f"--output={folder}/task_%a.log"]
    options += [f"--{name}={profile[key]}" for key, name in
                (("partition", "partition"), ("time", "time"), ("memory", "mem"))
                if key in profile]
    options += profile.get("options", [])
    words = " ".join(shlex.quote(str(word)) for word in command)
    script = "\n".join(["#!/bin/sh"] + [f"#SBATCH {option}" for option in options]
                       + profile.get("setup", [])
                       + [f"exec {words} --jobs {cpus} --part $SLURM_ARRAY_TASK_ID/{tasks}", ""])
    (folder / "submit.sh").write_text(script, encoding="utf-8")
    environment = dict(os.environ)
    if "conf" in profile:
        environment["SLURM_CONF"] = profile["conf"]
    try:
        done = subprocess.run(["sbatch", "--parsable", folder / "submit.sh"], env=environment,
                              capture_output=True, text=True, check=False, timeout=60)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise Problem(f"sbatch: {error}") from error
    if done.returncode:
        raise Problem(f"sbatch rejects: {done.stderr.strip()}")
    return done.stdout.strip().partition(";")[0]
