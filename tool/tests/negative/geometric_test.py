#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Bad input and injected faults of `deburr run geometric`: each has its exit code and a message that names the error;
unusual but legal meshes pass. See --help of unittest."""
import os
import resource
import unittest

from app_support import CommandTest, png

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"


class Base(CommandTest):
    def run_engine(self, code, *arguments, says=(), **options):
        return self.expect(code, "run", "geometric", "--out", self.path("out"), *arguments, says=says, **options)


class Meshes(Base):
    """Mesh files and scenes."""

    def mesh(self, code, name, content, *arguments, says=()):
        return self.run_engine(code, "--in", self.write(name, content), "--size", "32x32", *arguments, says=says)

    def test_rejects_image_as_mesh(self):
        self.run_engine(2, "--in", self.write("frame.png", png(8, 8)), says=["frame.png", "an image has no edges"])
        self.run_engine(2, "--in", self.path("missing.png"), says="an image has no edges")
        self.assertFalse(os.path.exists(self.path("out")))

    def test_unknown_scene_suggests_similar_name(self):
        self.run_engine(2, "--scene", "wheel", says=["wheel", "wheelcover"])

    def test_rejects_invalid_files(self):
        self.run_engine(5, "--in", self.path("missing.obj"), says="missing.obj")
        self.mesh(5, "empty.obj", "", says="empty.obj")
        self.mesh(5, "points.obj", "v 0 0 0\nv 1 0 0\n", says=["points.obj", "no triangles"])
        self.mesh(5, "nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", says="nan.obj")

    def test_rejects_mesh_without_edges(self):
        self.mesh(2, "line.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 1\nf 3 3 3\n",
                  says=["line", "has no edges", "none of its 2 faces has an area"])

    def test_rejects_scene_that_draws_nothing(self):
        away = ("--set", "scene.eye=0,0,3", "--set", "scene.target=0,0,9")
        self.mesh(2, "square.obj", SQUARE, *away, says=["square", "draws nothing", "scene.eye", "32 x 32"])
        self.run_engine(2, "--scene", "cube", *away, says="draws nothing")
        self.assertFalse(os.path.exists(self.path("out")))

    def test_notes_that_every_edge_is_dropped(self):
        inside = ("--scene", "cube", "--size", "64x48", "--set", "scene.eye=0,0,0", "--set",
                  "scene.target=0.6,0.3,-1", "--set", "scene.fov=1.6")
        note = "all 26 edges were dropped (26 turned away from the eye): nothing was smoothed"
        self.run_engine(0, *inside, "--set", "geometric.cull=back", says=["PASS", note])
        self.assertIn(note, self.notes())
        self.assertIn("set geometric.cull = none", self.notes())
        self.run_engine(0, *inside, "--set", "geometric.cull=none", says="PASS")
        self.assertNotIn("edges were dropped", self.notes())
        self.assertGreater(self.result()["work"]["edge_classifier_kept_edges"], 6)

    def test_accepts_one_triangle(self):
        self.mesh(0, "one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "--set", "scene.eye=0,0,2", says="PASS")
        self.assertEqual(self.result()["work"]["edge_classifier_boundary_edges"], 3)

    def test_awkward_meshes_are_noted(self):
        fin = SQUARE + "v 0 0 1\nf 1 3 5\n"
        self.mesh(0, "fin.obj", fin, says="PASS")
        self.assertIn("1 edges belong to three faces or more: drawn as boundaries", self.notes())
        self.mesh(0, "turned.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 4 3\n", says="PASS")
        self.assertIn("1 edges belong to two faces that pass them in the same direction", self.notes())
        self.mesh(0, "thin.obj", SQUARE + "f 1 2 2\n", says="PASS")
        self.assertIn("1 faces have no area", self.notes())

    def test_accepts_camera_inside_the_mesh(self):
        """Edges behind the eye are clipped or dropped."""
        self.run_engine(0, "--scene", "terrain", "--size", "64x48", "--set", "scene.eye=0,0.1,0", "--set",
                        "scene.target=0.3,0.1,-1", says="PASS")
        self.assertGreater(self.result()["work"]["line_setup_outside_edges"], 0)

    def test_accepts_one_pixel(self):
        self.run_engine(0, "--scene", "cube", "--size", "1x1", says="PASS")
        self.run_engine(0, "--scene", "cube", "--size", "1x100", says="PASS")


class Configuration(Base):
    """Rejected because it cannot be built, or has no effect."""
    SMALL = ("--scene", "cube", "--size", "48x32")

    def rejected(self, says, *given, scene=SMALL):
        self.run_engine(2, *scene, *(word for each in given for word in ("--set", each)), says=says)
        self.assertFalse(os.path.exists(self.path("out")))

    def test_rejects_frames_and_meshes_larger_than_the_build(self):
        self.rejected(["65 x 32", "64 pixels", "line_pixels"], "geometric.line_pixels=64",
                     scene=("--scene", "cube", "--size", "65x32"))
        self.rejected(["touched words", "the build has 16"], "geometric.touched_words=16",
                     scene=("--scene", "cube", "--size", "48x65"))
        self.rejected(["16128 faces", "8192", "face_limit"], "geometric.face_limit=8192", scene=("--scene", "sphere"))

    def test_too_many_faces_are_rejected_before_rendering(self):
        """The reference of this frame takes many minutes; the rejection takes seconds of processor time."""
        for engine, smoothing in (("geometric", ()), ("frame", ("--smoothing", "geometric"))):
            size = "4096x4096" if engine == "geometric" else "64x64"
            command = ("run", engine, *smoothing, "--scene", "sphere", "--size", size, "--truth", "--out", self.path("out"))
            self.expect(2, *command, "--set", "geometric.face_limit=8192",
                        says="the mesh 'sphere' has 16128 faces, the hardware has facing bits for 8192: raise the "
                             "limit (--set geometric.face_limit=16384) or simplify the mesh",
                        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (40, 40)))
        wide = ("--scene", "cube", "--size", "4096x4096", "--truth")
        self.run_engine(2, *wide, "--set", "geometric.line_pixels=2048", says="raise line_pixels",
                        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (40, 40)))
        self.run_engine(0, "--scene", "sphere", "--size", "64x48", "--set", "geometric.face_limit=16384")

    def test_rejects_parameters_without_effect(self):
        self.rejected(["reciprocal_table", "no effect", "pipelined = false"], "geometric.reciprocal_table=4")
        self.rejected(["dividers", "no effect"], "geometric.dividers=2")
        self.rejected(["crease", "no effect", "select = all"], "geometric.select=all", "geometric.crease=paper")
        self.run_engine(2, *self.SMALL, "--preset", "gpaa", "--set", "geometric.crease=shading", says="select = all")
        self.rejected(["face_limit", "no effect"], "geometric.select=all", "geometric.face_limit=8192")
        self.rejected(["cull", "no effect", "select = all"], "geometric.select=all", "geometric.cull=none")
        self.rejected(["crease_depth", "no effect"], "geometric.select=all", "geometric.crease_depth=4")
        self.rejected(["face_limit", "no effect", "select = mesh"], "geometric.select=mesh", "geometric.face_limit=8192")
        self.rejected(["cull", "no effect", "select = mesh"], "geometric.select=mesh", "geometric.cull=none")
        self.rejected(["crease_depth", "no effect", "crease = off"], "geometric.crease=off", "geometric.crease_depth=4")
        self.rejected(["crease_depth", "no effect"], "geometric.depth_test=off", "geometric.crease_depth=4")
        for test in ("own", "off"):
            self.rejected(["combine", "no effect", "outermost equals max"], "geometric.combine=outermost",
                         f"geometric.depth_test={test}")
        self.rejected(["depth_bias", "no effect"], "geometric.depth_test=off", "geometric.depth_bias=4")
        self.rejected(["depth_lines", "no effect"], "geometric.depth_test=off", "geometric.depth_lines=64")
        self.rejected(["scene.reference_samples", "no effect", "--truth"], "scene.reference_samples=4")
        self.rejected(["memory.error_bytes", "no effect"], "memory.error_bytes=64")
        self.rejected(["memory.interleave_bytes", "no effect"], "memory.interleave_bytes=256")

    def test_rejects_configurations_that_cannot_be_built(self):
        self.rejected(["face_limit = 8193", "512"], "geometric.face_limit=8193")
        self.rejected(["fills = 64", "memory.outstanding"], "geometric.fills=64", "geometric.memory.outstanding=32")
        self.rejected(["geometric.walkers", "one of 1, 2, 4"], "geometric.walkers=3")
        self.rejected(["1..24"], "geometric.depth_bias=25")
        self.rejected(["0..24"], "geometric.crease_depth=25")
        self.rejected(["memory.latency = 20000", "run.watchdog_cycles"], "memory.latency=20000")

    def test_build_notes_are_printed(self):
        self.run_engine(0, *self.SMALL, "--set", "geometric.latency_fifo=32", says="latency_fifo = 32 is below")

    def test_every_preset_passes(self):
        for preset, lines in (("gpaa", 18), ("gpaa-optimised", 9), ("deburr", 12)):  # also lines of back faces
            self.run_engine(0, *self.SMALL, "--preset", preset, says="PASS")
            self.assertEqual(self.result()["work"]["line_setup_lines"], lines, preset)

    def test_show_config_checks_like_a_run(self):
        for arguments in (("--set", "scene.eye=0,0,3", "--set", "scene.target=0,0,9"), ("--fault", "gremlin"),
                          ("--set", "geometric.touched_words=16", "--set", "geometric.line_pixels=64", "--size",
                           "65x65")):
            self.expect_as_shown("geometric", *arguments)

    def test_rejects_memory_slower_than_watchdog(self):
        self.run_engine(2, "--set", "memory.latency=20000", says="memory.latency = 20000")

    def test_show_config_prints_the_preset(self):
        done = self.run_command("run", "geometric", "--preset", "gpaa", "--show-config")
        self.assertEqual(done.returncode, 0, done.stderr)
        file = self.write("run.yaml", done.stdout)
        self.run_engine(0, *self.SMALL, "--config", file, says="PASS")
        self.run_engine(0, *self.SMALL, "--config", file, "--preset", "deburr", says="PASS")
        self.assertEqual(self.result()["work"]["line_setup_lines"], 12)

    def test_order_of_edges_changes_only_traffic(self):
        """Any order of edges gives the same picture, and the seed of the order changes nothing else; traffic differs."""
        def picture(*arguments):
            self.run_engine(0, "--scene", "canopy", "--size", "96x64", *arguments, says="PASS")
            with open(self.path("out/after.png"), "rb") as file:
                return file.read(), self.result()["work"]["vertex_fetch_misses"]

        table, misses = picture()
        shuffled, more = picture("--set", "scene.edge_order=shuffled")
        again, others = picture("--set", "scene.edge_order=shuffled", "--seed", "2")
        self.assertTrue(table == shuffled == again)
        self.assertEqual(len({misses, more, others}), 3)

    def test_wave_holds_the_link(self):
        self.run_engine(0, *self.SMALL, "--trace", "geometric.candidates", "--trace-to", "600", says="PASS")
        with open(self.path("out/trace.vcd")) as file:
            waves = file.read()
        for name in ("block_x", "coverage", "forward"):
            self.assertIn(name, waves)
        self.run_engine(2, *self.SMALL, "--trace", "geometric.nothing*", says=["nothing*", "geometric.line_setup"])

    def test_leaves_the_expected_pictures(self):
        self.run_engine(0, *self.SMALL, "--truth", "--set", "scene.reference_samples=4", says=["PASS", "supersampled-16"])
        pictures = {name for name in os.listdir(self.path("out")) if name.endswith(".png")}
        self.assertEqual(pictures, {f"{name}.png" for name in (
            "before", "after", "golden", "difference", "reference", "error", "change", "weights", "classes")})
        self.assertGreater(self.result()["quality"]["psnr_silhouette_db"],
                           self.result()["quality"]["psnr_silhouette_before_db"])

    def test_max_cycles_ends_the_run(self):
        self.run_engine(3, *self.SMALL, "--max-cycles", "300", says=["not done after 300 cycles", "of 18 edges"])
        self.run_engine(0, *self.SMALL, "--set", "scene.count=2")
        cycles = self.result()["cycles"]
        self.run_engine(3, *self.SMALL, "--set", "scene.count=2", "--max-cycles", str(cycles - 1),
                        says="of 36 edges")


class Faults(Base):
    SMALL = ("--scene", "wheelcover", "--size", "96x96", "--set", "run.watchdog_cycles=2000")

    def fault(self, name, checked, unchecked, *arguments, says="", board=None):
        for links, code in (("true", checked), ("false", unchecked)):
            self.run_engine(code, *(arguments or self.SMALL), "--fault", name, "--set", f"run.check_links={links}",
                            says=says)
            result = self.result()
            self.assertEqual(result["verdict"], "fail")
            self.assertTrue(os.path.exists(self.path("out/report.html")), "failed runs have a report")
            if code == 1:
                self.assertGreater(result["checks"]["mismatches"] + result["checks"]["traffic_mismatches"], 0)
                self.assertIn(board, {line["check"] for line in result["first_mismatches"]}, name)
        return result

    def test_passes_without_a_fault(self):
        self.run_engine(0, *self.SMALL, says="PASS")

    def test_catches_wrong_facing(self):
        self.fault("wrong-facing", 1, 1, board="status registers")

    def test_catches_wrong_reciprocals(self):
        self.fault("wrong-slope", 1, 1, *self.SMALL, "--set", "geometric.pipelined=false", "--set",
                   "geometric.reciprocal_table=11", board="lines")

    def test_catches_wrong_configuration(self):
        area = (*self.SMALL, "--set", "geometric.coverage=area")
        for cull in ("none", "back"):
            self.fault("wrong-cull", 1, 1, *self.SMALL, "--set", f"geometric.cull={cull}", board="status registers")
        self.fault("wrong-class", 3, 1, board="lines")
        self.fault("wrong-area", 1, 1, *area, board="candidates")
        self.fault("wrong-second", 3, 1, *area, board="candidates")
        self.fault("wrong-nearer", 1, 1, *self.SMALL, "--set", "geometric.combine=outermost", board="blocks")

    def test_catches_wrong_lines_and_groups(self):
        for name in ("drop-line", "duplicate-line", "drop-group", "duplicate-group", "wrong-direction"):
            with self.subTest(name):
                result = self.fault(name, 3, 1, board="candidates")
                if name.startswith("duplicate"):  # the larger of two equal weights
                    self.assertNotIn("pixels", {line["check"] for line in result["first_mismatches"]})

    def test_catches_stale_depth(self):
        self.fault("stale-depth", 3, 1, board="candidates")

    def test_catches_wrong_pairs(self):
        split = (*self.SMALL, "--set", "geometric.records=split")
        self.fault("wrong-pair", 3, 1, *split, board="lines")
        self.fault("stale-pair", 3, 1, *split, board="lines")

    def test_catches_wrong_screen(self):
        self.fault("wrong-screen", 3, 1, *self.SMALL, "--set", "geometric.coarse_lines=4", board="memory lines")

    def test_catches_wrong_caches(self):
        result = self.fault("wrong-replacement", 1, 1, board="memory lines")
        cycles = [int(line["where"].split()[1]) for line in result["first_mismatches"]
                  if line["check"] == "memory lines"]
        self.assertLess(cycles[0], cycles[-1], "each as it went by")
        self.assertEqual(result["scoreboards"]["pixels"]["mismatches"], 0, "the picture stays")

    def test_catches_wrong_kept_lines_and_blocks(self):
        kept, buffered = ("--set", "geometric.colour_lines=2"), ("--set", "geometric.write_buffer=4")
        for name, choice in (("wrong-kept", kept), ("wrong-buffer", (*buffered, "--set", "geometric.weight_blocks=16"))):
            result = self.fault(name, 1, 1, *self.SMALL, *choice, board="memory lines")
            self.assertEqual(result["scoreboards"]["pixels"]["mismatches"], 0, "the picture stays")
        self.fault("stale-kept", 3, 1, *self.SMALL, *kept, board="blocks")

    def test_catches_wrong_originals(self):
        dense = ("--scene", "wheelcover", "--size", "400x200", "--set", "geometric.select=all", "--set",
                 "memory.latency=1")
        self.fault("stale-neighbour", 3, 1, *dense, board="blocks")

    def test_catches_wrong_blocks(self):
        self.fault("double-blend", 3, 1, board="blocks")
        self.fault("flip-weight", 3, 1, board="blocks")

    def test_catches_memory_faults(self):
        self.fault("duplicate-fetch", 3, 3)
        self.fault("memory-error", 3, 3, says="memory answered 1 lines with an error")
        self.fault("lost-response", 4, 4, says="no link has moved")
        self.fault("stuck-ready", 4, 4, says=["no link has moved", "geometric.touched_blocks"])

    def test_memory_errors_by_address_are_predicted(self):
        """Errors in one line of each region, in each whole region, and in all regions."""
        canopy = ("--scene", "canopy", "--size", "64x64", "--set", "geometric.weight_blocks=16")
        pages = {"faces": 1, "edges": 9, "vertices": 4, "depth": 4, "weights": 4, "colour": 4, "copy": 4}
        for preset in ("deburr", "gpaa-optimised"):
            page = 0
            for region, count in pages.items():
                if region == "copy" and preset == "deburr":
                    continue
                self.failing(4096 * page, 4096 * count, *canopy, "--preset", preset)
                if region not in ("depth", "weights", "colour"):  # where any line may stay unused
                    self.failing(4096 * page, 1, *canopy, "--preset", preset)
                page += count
            self.failing(0, 4096 * page, *canopy, "--preset", preset)

    def test_memory_errors_with_optimised_traffic_are_predicted(self):
        """Faces that shift the pairs of all later edges, pairs of both arrays, coarse depth."""
        canopy = ("--scene", "canopy", "--size", "64x64", "--set", "geometric.weight_blocks=16",
                  "--set", "geometric.records=split", "--set", "geometric.coarse_lines=4")
        for page, count in ((1, 1), (21, 3), (23, 1), (24, 1), (21, 4)):
            self.failing(4096 * page, 4096 * count, *canopy)

    def failing(self, address, count, *arguments):
        self.run_engine(3, *arguments, "--set", f"memory.error_address={address}", "--set",
                        f"memory.error_bytes={count}", says="with an error")
        checks = self.result()["checks"]
        self.assertEqual((checks["mismatches"], checks["traffic_mismatches"]), (0, 0), (address, count, arguments))

    def test_faults_in_absent_hardware_are_rejected(self):
        for name, arguments, needs in (
                ("wrong-facing", ("--preset", "gpaa"), "select = edges"),
                ("wrong-slope", (), "reciprocal_table of at least 1"),
                ("wrong-cull", ("--preset", "gpaa"), "select = edges"),
                ("wrong-area", ("--set", "geometric.coverage=distance"), "coverage = area"),
                ("wrong-second", ("--set", "geometric.coverage=distance"), "coverage = area"),
                ("wrong-nearer", ("--set", "geometric.combine=max"), "combine = outermost"),
                ("stale-depth", ("--set", "geometric.depth_test=off"), "depth_test = own, farther"),
                ("wrong-screen", (), "coarse_lines of at least 4"),
                ("wrong-pair", ("--set", "geometric.records=joined"), "records = split"),
                ("stale-pair", ("--set", "geometric.records=joined"), "records = split"),
                ("wrong-kept", ("--set", "geometric.colour_lines=0"), "colour_lines of at least 1"),
                ("stale-kept", ("--set", "geometric.colour_lines=0"), "colour_lines of at least 1"),
                ("wrong-buffer", ("--set", "geometric.write_buffer=0"), "write_buffer of at least 1"),
                ("stale-neighbour", ("--preset", "gpaa"), "frame_copy = false")):
            self.run_engine(2, *self.SMALL, *arguments, "--fault", name, says=[name, "needs", needs])

    def test_catches_fault_on_any_link(self):
        self.run_engine(1, *self.SMALL, "--fault", "flip:geometric.weights:10:coverage.0.5", says="mismatch")
        self.run_engine(3, *self.SMALL, "--fault", "drop:geometric.weights:100000", says="never reached")
        self.run_engine(2, *self.SMALL, "--fault", "gremlin", says=["gremlin", "stale-neighbour"])


class Registers(Base):
    """Each checked status register can fail the run by itself."""
    CHECKED = ["id", "control", "status", "size", "config", "edge-count", "vertex-count", "face-count", "edge-base",
                 "vertex-base", "face-base", "depth-base", "colour-base", "weight-base", "copy-base", "rejection", "edges",
                 "boundary-edges", "silhouette-edges", "back-edges", "crease-edges", "flat-edges", "invalid-edges",
                 "kept-edges", "outside-edges", "degenerate-edges", "empty-edges", "lines", "columns", "groups",
                 "candidates", "passed", "blocks", "blended-pixels", "memory-errors", "frame-cycles", "edge-cycles",
                 "resolve-cycles", "boundary-count", "pair-base", "other-pair-base", "coarse-base"]

    def test_each_register_is_checked(self):
        self.miscount("geometric", self.CHECKED)

    def test_each_figure_is_checked(self):
        self.wrong_figures("geometric", 27, ["memory_port_reads", "lines_read_edges"])


class Fields(Base):
    """Hardware decodes a configuration field as a different value than software wrote."""

    def test_each_field_is_decoded(self):
        small, gpaa = ("--size", "96x64"), ("--size", "48x32", "--preset", "gpaa")
        runs = {f"config-{field}": small for field in ("select", "crease", "depth-test", "combine", "depth-bias", "mark",
                                                      "layout", "frame-copy", "coverage", "cull", "crease-depth",
                                                      "linear-light")}
        # Copying to an address without room for a copy ends in a memory error.
        self.misdecode("geometric", {**runs, "config-frame-copy": gpaa})
        self.decode_as_built("geometric")


class Blind(Base):
    """A scoreboard that compares nothing fails the run, even if everything else is right."""
    BOARDS = ("lines", "candidates", "blocks", "pixels", "memory-lines", "status-registers", "figures")

    def test_each_scoreboard_must_compare(self):
        boards = {f"blind-{board}" for board in self.BOARDS}
        self.assertEqual(self.known("geometric"), boards)
        needed = {board: self.blind("geometric", board) for board in boards}
        self.assertEqual((needed["blind-pixels"], needed["blind-status-registers"]), (32 * 32, 42))
        work, memory = self.result()["work"], self.result()["memory"]
        self.assertEqual(needed["blind-lines"], work["line_setup_lines"])
        self.assertEqual(needed["blind-candidates"], work["coverage_unit_candidates"])
        self.assertEqual(needed["blind-blocks"], work["resolver_blocks"])
        self.assertEqual(needed["blind-memory-lines"], memory["lines_filled"] + work["memory_port_writes"])


if __name__ == "__main__":
    unittest.main()
