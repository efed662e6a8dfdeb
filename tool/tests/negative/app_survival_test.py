#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A directory of results stays consistent: runs killed at any moment, parallel runs, full disks. See --help.
DEBURR_KILLS sets the number of kills per run (20)."""
import json
import os
import random
import resource
import signal
import subprocess
import time
import unittest

from app_support import DEBURR, CommandTest, trials

DRAFT = ".deburr_run"
ENGINES = trials("killed")
WAVES = ("--trace", "*", "--trace-to", "400")


class Survival(CommandTest):
    def command(self, engine, *arguments):
        return ["run", engine, *ENGINES[engine], "--out", self.path("out"), *arguments]

    def long_run(self, *arguments):
        """A run that has the directory and takes a long time."""
        process = subprocess.Popen(
            [DEBURR, "run", "texture", "--size", "2048x2048", "--out", self.path("out"), *arguments],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        self.wait_for(f"out/{DRAFT}/claim.json", process)
        return process

    def wait_for(self, name, process):
        """Waits until the file is not empty."""
        while not os.path.exists(self.path(name)) or os.path.getsize(self.path(name)) == 0:
            self.assertIsNone(process.poll())
            time.sleep(0.01)

    def contents(self):
        """Name, inode and content of every file: a file that was written again differs."""
        found = {}
        for folder, _, names in os.walk(self.path("out")):
            for name in names:
                path = os.path.join(folder, name)
                with open(path, "rb") as file:
                    found[os.path.relpath(path, self.path("out"))] = (
                        os.stat(path).st_ino, file.read())
        return found

    def results(self):
        return {name: entry for name, entry in self.contents().items()
                if not name.startswith(DRAFT)}

    def manifest(self):
        with open(self.path("out/manifest.json")) as file:
            return json.load(file)

    def assert_whole(self, verdict="pass"):
        """Exactly the files named in the manifest exist, and every picture of the report."""
        with open(self.path("out/result.json")) as file:
            self.assertEqual(json.load(file)["verdict"], verdict)
        manifest = self.manifest()
        self.assertEqual(sorted(os.listdir(self.path("out"))),
                         sorted(manifest["files"] + ["manifest.json"]))
        for image in manifest["images"]:
            self.assertIn(image["file"], manifest["files"])


class Killed(Survival):
    """kill -9 at random moments: the same command works again, and nothing of the killed run remains."""

    def kill_often(self, engine, *arguments):
        command = [DEBURR, *self.command(engine, *arguments)]
        begin = time.monotonic()
        self.expect(0, *command[1:])
        seconds = time.monotonic() - begin
        expected = sorted(os.listdir(self.path("out")))
        chance = random.Random(engine + str(arguments))
        died = 0
        for attempt in range(int(os.environ.get("DEBURR_KILLS", "20"))):
            before = self.results()
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            try:
                process.wait(chance.uniform(0, 1.1 * seconds))
            except subprocess.TimeoutExpired:
                process.kill()
            code = process.wait()
            self.assertIn(code, (0, -signal.SIGKILL))
            died += code != 0
            # While a result.json exists, everything in its folder is from the same run.
            now = self.results()
            if "result.json" in now and now["result.json"] == before.get("result.json"):
                self.assertEqual(now, before, attempt)
        self.assertGreater(died, 0)
        self.expect(0, *command[1:], says="PASS")
        self.assert_whole()
        self.assertEqual(sorted(os.listdir(self.path("out"))), expected)

    def test_wave_of_killed_run_is_removed(self):
        process = self.long_run(*WAVES)
        self.wait_for(f"out/{DRAFT}/trace.vcd", process)
        process.kill()
        process.wait()
        self.assertEqual(os.listdir(self.path("out")), [DRAFT], "nothing passes for a result")
        self.expect(0, *self.command("texture"))
        self.assertFalse(os.path.exists(self.path("out/trace.vcd")))
        self.assert_whole()


for each in ENGINES:
    setattr(Killed, f"test_{each}", lambda self, engine=each: self.kill_often(engine))
    setattr(Killed, f"test_{each}_with_waves", lambda self, engine=each: self.kill_often(engine, *WAVES))


class SideBySide(Survival):
    """Several runs into one directory: one result, and the others are told which run has it."""

    def race(self, number, *arguments):
        processes = [subprocess.Popen(
            [DEBURR, *self.command("texture", "--seed", str(seed), *arguments)], text=True,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE) for seed in range(1, number + 1)]
        ended = [(process, *process.communicate(timeout=300)) for process in processes]
        return [(process.returncode, process.pid, out, err) for process, out, err in ended]

    def rejected(self, number):
        ended = self.race(number)
        passed = [pid for code, pid, _, _ in ended if code == 0]
        self.assertGreater(len(passed), 0)
        pids = {pid for _, pid, _, _ in ended}
        for code, _, out, err in ended:
            if code == 0:
                continue
            self.assertEqual(code, 5, out + err)
            self.assertIn("used by another run, process ", err)
            self.assertIn("--wait", err)
            self.assertIn(int(err.split("process ")[1].split()[0]), pids)
        self.assert_whole()
        return len(ended) - len(passed)

    def test_one_of_two_runs_gets_the_directory(self):
        self.rejected(2)

    def test_one_of_four_runs_gets_the_directory(self):
        self.rejected(4)

    def test_one_of_eight_runs_gets_the_directory(self):
        self.rejected(8)

    def test_second_run_is_rejected_with_owner(self):
        first = self.long_run()
        with open(self.path(f"out/{DRAFT}/claim.json")) as file:
            holder = json.load(file)
        self.assertEqual((holder["state"], holder["process"]), ("running", first.pid))
        self.assertEqual(holder["host"], os.uname().nodename)
        self.expect(5, *self.command("texture"),
                    says=[f"process {first.pid} on {holder['host']}", "--wait"])
        self.expect(5, "papers", "--quick", "--out", self.path("out"), says="used by another run")
        first.kill()
        first.wait()
        self.expect(0, *self.command("texture"))
        self.assert_whole()

    def test_waiting_runs_all_finish(self):
        ended = self.race(4, "--wait")
        self.assertEqual([code for code, *_ in ended], [0] * 4, ended)
        self.assert_whole()

    def test_ctrl_c_ends_waiting(self):
        self.long_run()
        second = subprocess.Popen([DEBURR, *self.command("texture", "--wait")], text=True,
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.assertIn("waiting for", second.stderr.readline())
        second.send_signal(signal.SIGINT)
        out, err = second.communicate(timeout=60)
        self.assertEqual(second.returncode, 130, out + err)


class FullDisk(Survival):
    """Whatever does not fit, the earlier result stays complete."""

    def limited(self, size):
        return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    def test_earlier_result_stays_at_ten_size_limits(self):
        for engine in ENGINES:
            for waves in ((), WAVES):
                self.expect(0, *self.command(engine, *waves))
                before = self.contents()
                largest = max(len(content) for _, content in before.values())
                for step in range(10):
                    size = largest * step // 10
                    done = self.expect(5, *self.command(engine, *waves, "--seed", "7"),
                                       preexec_fn=self.limited(size))
                    self.assertIn("File too large", done.stderr)
                    self.assertEqual(self.contents(), before, f"{engine} {waves} {size}")
                self.assert_whole()

    def test_earlier_result_stays_on_full_file_system(self):
        """A file system that is too small, if the kernel allows it."""
        mount = f"mount -t tmpfs -o size=4m none {self.path('disk')}"
        os.mkdir(self.path("disk"))
        if subprocess.run(["unshare", "-rm", "sh", "-c", mount], capture_output=True).returncode:
            self.skipTest("no user namespaces here")
        run = f"{DEBURR} run texture --size 64x64 --out {self.path('disk')}/out"
        sums = f"cd {self.path('disk')}/out && find . -type f | sort | xargs sha256sum"
        fill = f"head -c $free /dev/zero > {self.path('disk')}/ballast"
        script = (f"{mount} && {run} >/dev/null || exit 9; before=$({sums}); "
                  "used=$(du -sb " + self.path("disk") + "/out | cut -f1); "
                  "for step in 0 1 2 3 4 5 6 7 8 9; do "
                  f"free=$((4194304 - used - 16384 - used * step / 12)); {fill}; "
                  f"{run} --seed 7 >/dev/null 2>{self.path('log')}; code=$?; "
                  f"rm {self.path('disk')}/ballast; "
                  f"[ $code = 5 ] && [ \"$before\" = \"$({sums})\" ] && "
                  f"grep -q 'No space left' {self.path('log')} || "
                  f"{{ echo step $step code $code; cat {self.path('log')}; exit 1; }}; "
                  "done")
        done = subprocess.run(["unshare", "-rm", "sh", "-c", script], capture_output=True,
                              text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


class Papers(Survival):
    """`papers` keeps finished results."""

    def start(self, **options):
        return subprocess.Popen([DEBURR, "papers", "--quick", "--size", "64", "--out",
                                 self.path("out")], text=True, stderr=subprocess.PIPE,
                                stdout=subprocess.PIPE, **options)

    def assert_kept(self, *ids):
        with open(self.path("out/papers.json")) as file:
            self.assertEqual([paper["id"] for paper in json.load(file)["papers"]], list(ids))
        self.assertEqual(sorted(os.listdir(self.path("out"))),
                         sorted(self.manifest()["files"] + ["manifest.json"]))

    def test_interrupted_before_first_result_leaves_nothing(self):
        process = self.start()
        self.wait_for(f"out/{DRAFT}/claim.json", process)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 130, out + err)
        self.assertIn("no paper was finished", out)
        self.assertFalse(os.path.exists(self.path("out")))

    def test_interrupted_after_first_result_keeps_it(self):
        """Unless the second one was faster, which is also possible."""
        process = self.start()
        line = process.stdout.readline()
        self.assertIn("== 000", line)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
        self.assertIn(process.returncode, (0, 130), out + err)
        self.assert_kept(*(["000"] if process.returncode == 130 else ["000", "004"]))

    def test_closed_pipe_ends_the_command(self):
        process = self.start()
        process.stdout.close()
        with process.stderr:
            err = process.stderr.read()
        self.assertEqual(process.wait(120), 5, err)
        self.assertIn("standard output", err)
        self.assert_kept("000")


if __name__ == "__main__":
    unittest.main()
