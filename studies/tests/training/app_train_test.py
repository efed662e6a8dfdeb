#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""`deburr train`: a run loads the trained file and gains from it; unusable input is rejected by name, and then no file
is written. See --help of unittest.
"""
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../tool/tests/negative"))
from app_support import DEBURR, CommandTest, png  # noqa: E402


class Base(CommandTest):
    QUICK = ("--batches", "60")

    def rendered(self, name, *arguments, size="192x144"):
        """A scene without and with supersampling, as written by a run."""
        self.expect(0, "run", "morphological", "--size", size, "--check", "none", "--quiet", "--out", self.path(name),
                    *arguments)
        return self.path(f"{name}/before.png"), self.path(f"{name}/reference.png")

    def train(self, code, frame, reference, *arguments, says=(), out="title.weights"):
        return self.expect(code, "train", "--in", frame, "--truth", reference, "--out", self.path(out), *arguments,
                           says=says)

    def nothing_written(self, name="title.weights"):
        self.assertFalse(os.path.exists(self.path(name)))


class Trains(Base):
    """Trained files, and runs with them."""

    def test_textured_frame_gains_on_kept_back_half(self):
        frame, reference = self.rendered("tunnel", "--scene", "tunnel", size="384x288")
        done = self.train(0, frame, reference, "--batches", "200",
                          says=["validation: ", "right half: edges ", "RESULT: PASS train: +"])
        with open(self.path("title.weights")) as file:
            self.assertEqual(file.readline(), "deburr-weights 1\n")
        said = json.loads(self.run_command("train", "--in", frame, "--truth", reference, "--out", self.path("again"),
                                           "--batches", "200", "--json").stdout)
        self.assertGreater(said["training"]["gain_db"], 0.5)
        self.assertEqual(said["outcome"].split(" in ")[0].split(": ")[1], done.stdout.split("train: ")[1].split(" in ")[0])
        kept = said["training"]["kept_back"]
        self.assertEqual([picture["name"] for picture in kept], [f"{frame}, right half"])
        self.assertAlmostEqual(kept[0]["edges_trained_db"] - kept[0]["edges_shipped_db"], said["training"]["gain_db"])
        with open(self.path("title.weights")) as first, open(self.path("again")) as second:
            self.assertEqual(first.read(), second.read())

        # Golden and hardware agree on the weights, and the run shows the reported gain.
        quality = {}
        for name, more in (("shipped", ()), ("title", ("--shares", self.path("title.weights")))):
            self.expect(0, "run", "morphological", "--in", frame, "--truth", reference, "--out", self.path("out"), *more)
            quality[name] = self.result()["quality"]["psnr_edge_db"]
        self.assertGreater(quality["title"], quality["shipped"] + 0.5)

    def test_several_frames_and_overwriting_own_file(self):
        for i in range(4):
            frame, reference = self.rendered(f"run{i}", "--scene", "tunnel", "--seed", str(i + 1))
            for folder, file in (("plain", frame), ("smooth", reference)):
                os.makedirs(self.path(folder), exist_ok=True)
                shutil.copy(file, self.path(f"{folder}/f{i}.png"))
        given = (self.path("plain/*.png"), self.path("smooth/*.png"))
        done = self.train(0, *given, *self.QUICK)
        for i, kept in enumerate((False, True, False, True)):
            self.assertEqual(f"validation: {self.path('plain')}/f{i}.png" in done.stdout.replace("\n", " "), kept)
        with open(self.path("title.weights")) as file:
            text = file.read()
        for i, trained_on in enumerate((True, False, True, False)):
            self.assertEqual(f"# trained on {self.path('plain')}/f{i}.png\n" in text, trained_on)
        self.train(0, *given, *self.QUICK)  # overwrites it

    def test_no_file_without_gain(self):
        frame, reference = self.rendered("road", "--scene", "road")
        self.train(1, frame, reference, *self.QUICK, says=["RESULT: FAIL no gain: -", "no weights were written",
                                                       "expected at least +0.05"])
        self.nothing_written()
        said = json.loads(self.run_command("train", "--in", frame, "--truth", reference, "--out", self.path("x"), "--json",
                                           *self.QUICK).stdout)
        self.assertEqual(said["exit_code"], 1)
        self.assertLess(said["training"]["gain_db"], 0.05)
        self.nothing_written("x")

    def test_lines_that_must_not_change_count_as_gain(self):
        """Lines one pixel thick, equal in both pictures, and one edge that the reference smooths."""
        def picture(name, beside_edge):
            def code(y):
                if y == 69:
                    return beside_edge
                return 255 * ((y > 69) != (y % 12 == 8))
            return self.write(name, b"P6 192 144 255\n" + b"".join(bytes([code(y)]) * 3 * 192 for y in range(144)))
        frame, reference = picture("frame.ppm", 0), picture("reference.ppm", 60)
        self.train(0, frame, reference, "--batches", "100")
        said = json.loads(self.run_command("train", "--in", frame, "--truth", reference, "--out", self.path("again"),
                                           "--batches", "100", "--json").stdout)["training"]
        self.assertLess(said["gain_db"], 0)  # on the edge
        self.assertGreater(said["frame_gain_db"], 3)

    def test_interrupt_writes_no_file(self):
        frame, reference = self.rendered("tunnel", "--scene", "tunnel")
        process = subprocess.Popen([DEBURR, "train", "--in", frame, "--truth", reference, "--out", self.path("title.weights"),
                                    "--batches", "100000"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertIn("training", process.stderr.readline())  # after some seconds
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertIn("RESULT: INTERRUPTED train: no weights were written", out)
        self.nothing_written()

    def checkers(self, name, side, codes):
        """Cells of 5 x 3 pixels, dark and bright."""
        rows = [b"".join(bytes([code]) * 15 for code in (codes if even else codes[::-1])) * (side // 10 + 1)
                for even in (True, False)]
        picture = b"".join(rows[y // 3 % 2][:3 * side] for y in range(side))
        return self.write(name, b"P6 %d %d 255\n" % (side, side) + picture)

    def test_interrupt_during_measurement_writes_no_file(self):
        """Trains one batch on a small picture; the large kept-back picture is then measured for seconds."""
        pairs = [";".join(self.checkers(f"{what}{side}.ppm", side, codes) for side in (64, 1536))
                 for what, codes in (("plain", (20, 230)), ("smooth", (30, 220)))]
        wait = 0.5
        while True:  # a fast machine has finished by then
            process = subprocess.Popen([DEBURR, "train", "--in", pairs[0], "--truth", pairs[1], "--out",
                                        self.path("title.weights"), "--batches", "1"], stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE, text=True)
            self.wait_until_caught(process)
            time.sleep(wait)
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=120)
            if process.returncode != 1 or wait < 0.07:
                break
            wait /= 2
        self.assertEqual(process.returncode, 130, out + err)
        self.assertIn("RESULT: INTERRUPTED train: no weights were written", out)
        self.assertNotIn("validation: ", out)
        self.nothing_written()

    def wait_until_caught(self, process):
        """Waits until it handles SIGINT."""
        while process.poll() is None:
            with open(f"/proc/{process.pid}/status") as status:
                caught = next(line for line in status if line.startswith("SigCgt:"))
            if int(caught.split()[1], 16) >> (signal.SIGINT - 1) & 1:
                return
            time.sleep(0.01)
        self.fail(process.communicate())


class Rejects(Base):
    """Invalid input."""

    def setUp(self):
        super().setUp()
        self.frame, self.reference = self.rendered("tunnel", "--scene", "tunnel", size="96x64")

    def test_rejects_invalid_options(self):
        self.expect(2, "train", "--truth", self.reference, "--out", "x", says="--in is required")
        self.expect(2, "train", "--in", self.frame, "--out", "x", says="--truth is required")
        self.expect(2, "train", "--in", self.frame, "--truth", self.reference, says="--out is required")
        self.train(2, self.frame, self.reference, "--batches", "0", says="--batches")
        self.train(2, self.frame, self.reference, "--seed", "x", says="--seed")
        self.train(2, self.frame, self.reference, "--frobnicate", says="unknown option '--frobnicate'")

    def test_rejects_invalid_pictures(self):
        self.train(5, self.path("missing.png"), self.reference, says="missing.png")
        self.train(5, self.frame, self.path("missing.png"), says="missing.png")
        self.train(5, self.write("text.png", b"no picture"), self.reference, says="text.png")
        self.train(2, self.path("no*.png"), self.reference, says="no*.png")
        self.train(2, f"{self.frame};{self.frame}", self.reference, says=["names 2 frames and --truth 1"])
        self.train(2, self.frame, self.write("small.png", png(48, 40)), says=["96 x 64", "48 x 40"])
        self.train(2, self.write("tiny.png", png(31, 31)), self.write("tiny2.png", png(31, 31)), says="at least 64")
        self.train(2, self.frame, self.frame, says="equals its reference within 2 codes")
        self.nothing_written()

    def test_rejects_invalid_output(self):
        self.train(2, self.frame, self.reference, out="tunnel/before.png", says="is also an input")
        self.write("mine.txt", "a letter\n")
        self.train(2, self.frame, self.reference, out="mine.txt", says=["mine.txt", "is not a file of weights"])
        with open(self.path("mine.txt")) as file:
            self.assertEqual(file.read(), "a letter\n")
        self.train(5, self.frame, self.reference, out="nowhere/x", says="does not exist")
        self.train(5, self.frame, self.reference, out="tunnel", says="it is a folder")

    def test_unwritable_output_fails_before_training(self):
        done = self.expect(5, "train", "--in", self.frame, "--truth", self.reference, "--out", "/proc/title.weights",
                           says="cannot create a file in the folder of '/proc/title.weights'")
        self.assertNotIn("validation: ", done.stdout)

    def test_full_disk_keeps_the_old_file(self):
        self.rendered("gains", "--scene", "tunnel", size="384x288")
        self.train(0, self.path("gains/before.png"), self.path("gains/reference.png"), "--batches", "200")
        with open(self.path("title.weights")) as file:
            before = file.read()
        for size in (0, 1000, 4096):
            done = self.expect(5, "train", "--in", self.frame, "--truth", self.reference, "--out", self.path("title.weights"),
                               says="File too large",
                               preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))
            self.assertNotIn("validation: ", done.stdout)
            with open(self.path("title.weights")) as file:
                self.assertEqual(file.read(), before)
        self.assertEqual([name for name in os.listdir(self.directory) if name.endswith(".tmp")], [])

    def test_run_rejects_invalid_weights_file(self):
        run = ("run", "morphological", "--in", self.frame, "--out", self.path("out"))
        self.expect(5, *run, "--shares", self.path("missing"), says="missing")
        self.expect(5, *run, "--shares", self.write("spoilt", "deburr-weights 1\ncodes 1024\n1 2 x\n"),
                    says=["spoilt", "line 3", "got 'x'"])
        self.expect(2, *run, "--preset", "mlaa", "--shares", self.path("spoilt"), says=["frame.weights", "analytic"])


if __name__ == "__main__":
    unittest.main()
