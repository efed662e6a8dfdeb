#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The command without OpenImageIO, which is loaded when the first picture needs it: most functions work, the others
give a clear error. Also without the other module and program that are built next to it."""
import glob
import os
import shutil
import unittest

from app_support import DEBURR, CommandTest, engines, png

MODULE = "libdeburr_images.so"


class Images(CommandTest):
    def loaded(self, *arguments):
        """Libraries that the dynamic linker initialised in a run."""
        log = self.path("loaded")
        done = self.run_command(*arguments, env={**os.environ, "LD_DEBUG": "files", "LD_DEBUG_OUTPUT": log})
        self.assertEqual(done.returncode, 0, done.stdout)
        lines = []
        for name in glob.glob(f"{log}.*"):
            with open(name) as file:
                lines += file.read().splitlines()
            os.remove(name)
        return [line.split("calling init:")[1] for line in lines if "calling init:" in line]

    def assert_loads(self, expected, *arguments):
        libraries = self.loaded(*arguments)
        self.assertTrue(any("libstdc++" in name for name in libraries), "the list is not read right")
        for name in (MODULE, "libOpenImageIO.so"):
            self.assertEqual(any(name in library for library in libraries), expected, name)

    def alone(self):
        """A copy of the program without the files next to it."""
        os.mkdir(self.path("bin"))
        return shutil.copy(DEBURR, self.path("bin"))

    def test_library_is_loaded_only_to_read_pictures(self):
        picture = self.write("in.png", png(32, 24))
        self.assert_loads(False, "--version")
        self.assert_loads(False, "params")
        for engine in engines():
            self.assert_loads(False, "run", engine, "--size", "32x24", "--out", self.path(engine))
            self.assertGreater(os.path.getsize(self.path(f"{engine}/after.png")), 50)
        self.assert_loads(True, "run", "morphological", "--in", picture, "--out", self.path("read"))

    def test_copy_without_module_names_what_is_missing(self):
        program = self.alone()
        picture = self.write("in.png", png(32, 24))
        self.expect(0, "run", "morphological", "--size", "32x24", program=program)
        self.expect(5, "run", "morphological", "--in", picture, "--out", self.path("out2"), program=program,
                    says=(MODULE, "next to the program", "cannot open shared object file"))

    def test_copy_with_module_reads_pictures(self):
        program = self.alone()
        shutil.copy(os.path.join(os.path.dirname(DEBURR), MODULE), self.path("bin"))
        picture = self.write("in.png", png(32, 24))
        self.expect(0, "run", "morphological", "--in", picture, program=program)

    def test_copy_names_missing_searches_papers_and_training(self):
        program = self.alone()
        self.write("s.yaml", "engine: texture\nbase: {scene: {width: 16, height: 16}, run.images: false}\n"
                   "axes: {memory.latency: [1, 9, 50, 200], texture.cache.ways: [1, 2, 4]}\n"
                   "objectives: {minimise: [cycles, memory_bits]}\n")
        self.expect(5, "search", "s.yaml", "--population", "8", "--out", self.path("found"), program=program,
                    says=("libdeburr_evolution.so", "next to the program", "libpagmo-dev", "scripts/demo --complete"))
        self.assertFalse(os.path.exists(self.path("found/points")))
        self.expect(5, "papers", "--quick", "--out", self.path("papers"), program=program,
                    says=("deburr_papers", "No such file", "scripts/demo --complete"))
        self.assertFalse(os.path.exists(self.path("papers")))
        picture = self.write("in.png", png(32, 24))
        self.expect(5, "train", "--in", picture, "--truth", picture, "--out", self.path("t.shares"), program=program,
                    says=("deburr_train", "No such file", "scripts/demo --complete"))

    def test_wrong_library_of_that_name_is_rejected(self):
        program = self.alone()
        self.write(f"bin/{MODULE}", "this is no library")
        picture = self.write("in.png", png(32, 24))
        self.expect(5, "run", "morphological", "--in", picture, program=program,
                    says=(MODULE, "next to the program"))


if __name__ == "__main__":
    unittest.main()
