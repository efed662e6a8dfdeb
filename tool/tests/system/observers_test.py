#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Recordings of a run over time and over the picture: intervals that add up to the result, a timeline that obeys the
rules of the Trace Event format and matches the intervals, maps that add up to the counters.

usage: observers_test.py DEBURR [CLASS]"""
import array
import copy
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../tb/engines"))
from engine_list import trials  # noqa: E402

DEBURR = "deburr"
# By name: an engine, and the options for its run.
ENGINES = {name: (engine, *options)
           for engine, watched in trials("watched").items() for name, options in watched.items()}


def run(out, *arguments, code=0):
    done = subprocess.run([DEBURR, "run", *arguments, "--quiet", "--no-images", "--out", out], text=True,
                          capture_output=True, check=False)
    if done.returncode != code:
        raise AssertionError(f"{arguments}: {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def load(out, name="result.json"):
    with open(os.path.join(out, name), encoding="utf-8") as file:
        return json.load(file)


def flat(node, key=""):
    """All lists below a node, by their dotted keys."""
    if isinstance(node, list):
        yield key, node
        return
    for name, value in node.items():
        yield from flat(value, f"{key}.{name}" if key else name)


def at(node, key):
    for part in key.split("."):
        node = node[part]
    return node


class Intervals(unittest.TestCase):
    def check(self, intervals, result):
        """Every sum over intervals equals the result."""
        series = dict(flat(intervals["series"]))
        self.assertGreater(len(series), 10)  # an engine with one unit has as many
        for key, values in series.items():
            self.assertEqual(len(values), len(intervals["cycles"]), key)
            if not key.startswith("ports.") and not key.endswith(".most"):
                self.assertEqual(sum(values), at(result, key), key)
        for name, unit in intervals["series"]["units"].items():
            lists = [values for _, values in flat(unit)]
            self.assertEqual([sum(each) for each in zip(*lists)], intervals["cycles"], name)
        for end, begin in zip(map(sum, zip(intervals["from"], intervals["cycles"])), intervals["from"][1:]):
            self.assertEqual(end, begin)

    def test_intervals_of_every_engine_add_up(self):
        for name, arguments in ENGINES.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as out:
                run(out, *arguments, "--windows", "300", "--stalls", "0.1")
                intervals, result = load(out, "intervals.json"), load(out)
                self.assertGreater(len(intervals["from"]), 5)
                self.check(intervals, result)
                self.assertEqual(sum(intervals["cycles"]), result["cycles"])
                work = intervals["series"]["work"]
                for kind in ("read", "written"):
                    ports = [sum(values) for key, values in work.items() if key.endswith(f"memory_port_bytes_{kind}")]
                    self.assertEqual(sum(ports), result["memory"][f"bytes_{kind}"])
                for rate in intervals["throughput"]:
                    self.assertGreater(sum(at(intervals["series"], rate["key"])), 0)
                    if rate["bound"]:
                        for count, cycles in zip(at(intervals["series"], rate["key"]), intervals["cycles"]):
                            # A beat held in a FIFO may arrive in the next interval.
                            self.assertLessEqual(count, (cycles + 1) * rate["bound"] * 1.001)

    def test_links_have_histograms(self):
        with tempfile.TemporaryDirectory() as out:
            run(out, *ENGINES["texture"], "--windows", "300")
            result = load(out)
            fifo = result["links"]["latency_fifo_entries"]
            self.assertEqual(fifo["most"], result["memories"]["latency_fifo_entries"]["high_water"])
            for name, link in result["links"].items():
                with self.subTest(name):
                    self.assertEqual(len(link["histogram"]), link["depth"] + 1)
                    self.assertEqual(sum(link["histogram"]), result["cycles"])
                    self.assertEqual(sum(i * n for i, n in enumerate(link["histogram"])), link["occupancy"])
                    self.assertAlmostEqual(link["mean"], link["occupancy"] / result["cycles"])
                    self.assertAlmostEqual(link["full_percent"], 100 * link["histogram"][-1] / result["cycles"])

    def test_intervals_change_nothing_and_are_off_by_default(self):
        with tempfile.TemporaryDirectory() as out:
            plain, watched = os.path.join(out, "plain"), os.path.join(out, "watched")
            run(plain, *ENGINES["texture"])
            run(watched, *ENGINES["texture"], "--windows", "100", "--maps", "--timeline")
            for name in ("intervals.json", "timeline.json", "map_samples.png", "map_samples.pfm"):
                self.assertFalse(os.path.exists(os.path.join(plain, name)), name)
                self.assertTrue(os.path.exists(os.path.join(watched, name)), name)
            before, after = load(plain), load(watched)
            for key in ("cycles", "units", "work", "latency", "memory", "verdict"):
                self.assertEqual(before[key], after[key], key)
            self.assertNotIn("links", before)
            # The next run removes files that it does not write.
            run(watched, *ENGINES["texture"])
            for name in ("intervals.json", "timeline.json", "map_samples.png", "map_samples.pfm"):
                self.assertFalse(os.path.exists(os.path.join(watched, name)), name)

    def test_long_run_limits_the_number_of_intervals(self):
        with tempfile.TemporaryDirectory() as out:
            run(out, *ENGINES["texture"], "--windows", "1", "--check", "none")
            intervals, result = load(out, "intervals.json"), load(out)
            self.assertLess(len(intervals["from"]), 1024)
            self.assertGreater(len(intervals["from"]), 500)
            self.assertEqual(intervals["interval_cycles"] & intervals["interval_cycles"] - 1, 0)
            self.check(intervals, result)

    def test_lost_interval_is_detected(self):
        for name, arguments in ENGINES.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as out:
                said = run(out, *arguments, "--windows", "300", "--fault", "lose-window", code=3)
                self.assertIn("intervals: units.", said)
                self.assertIn("interval 2", said)
                with self.assertRaises(AssertionError):
                    self.check(load(out, "intervals.json"), load(out))
        with tempfile.TemporaryDirectory() as out:
            self.assertIn("needs run.interval_cycles", run(out, *ENGINES["texture"], "--fault", "lose-window", code=2))


# ---- the Trace Event format ---------------------------------------------------------------------

KEYS = {"X": {"name", "cat", "ts", "dur"}, "b": {"name", "cat", "id", "ts"}, "e": {"name", "cat", "id", "ts"},
        "M": {"name", "args"}, "C": {"name", "cat", "ts", "args"}}


def problems(trace):
    """Violations of the rules of the format."""
    if not isinstance(trace, dict) or not isinstance(trace.get("traceEvents"), list):
        return ["no list of traceEvents"]
    found, last, busy, open_events, named, seen, counted = [], 0, {}, {}, set(), set(), {}
    for number, event in enumerate(trace["traceEvents"]):
        kind = event.get("ph")
        if kind not in KEYS:
            found.append(f"event {number}: ph {kind!r}")
            continue
        missing = (KEYS[kind] | {"pid", "tid"}) - set(event)
        if missing:
            found.append(f"event {number}: no {sorted(missing)}")
            continue
        track = event["pid"], event["tid"]
        if kind == "M":
            if event["name"] == "thread_name":
                named.add(track)
                if not event["args"].get("name"):
                    found.append(f"event {number}: a thread without a name")
            continue
        if not isinstance(event["ts"], (int, float)) or event["ts"] < last:
            found.append(f"event {number}: ts {event['ts']} after {last}")
            continue
        last = event["ts"]
        if kind == "X":
            if not event["dur"] > 0:
                found.append(f"event {number}: dur {event['dur']}")
            if event["ts"] < busy.get(track, 0):
                found.append(f"event {number}: overlaps the slice before on its track")
            busy[track] = event["ts"] + event["dur"]
            if track not in named:
                found.append(f"event {number}: a track without a thread_name")
        elif kind == "C":
            values = event["args"].values()
            if not values or not all(isinstance(v, int) and v >= 0 for v in values):
                found.append(f"event {number}: counts {list(values)}")
            elif event["args"] == counted.get(event["name"]):
                found.append(f"event {number}: {event['name']} has not changed")
            counted[event["name"]] = event["args"]
        else:
            key = event["cat"], event["id"], event["name"]
            if kind == "b":
                if key in seen:
                    found.append(f"event {number}: id {key} begins a second time")
                seen.add(key)
                open_events[key] = event["ts"]
            elif open_events.pop(key, None) is None:
                found.append(f"event {number}: end of {key}, which has not begun")
    return found + [f"{key} does not end" for key in open_events]


class Timeline(unittest.TestCase):
    FROM, TO, WINDOW = 604, 1804, 300

    def trace(self, out, *arguments):
        run(out, *arguments, "--windows", str(self.WINDOW), "--stalls", "0.05", "--timeline", "--timeline-from",
            str(self.FROM), "--timeline-to", str(self.TO))
        return load(out, "timeline.json"), load(out, "intervals.json")

    def test_timeline_obeys_rules_and_matches_intervals(self):
        for name, arguments in ENGINES.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as out:
                trace, intervals = self.trace(out, *arguments)
                self.assertEqual(problems(trace), [])
                inside = [i for i, at in enumerate(intervals["from"]) if self.FROM <= at < self.TO]
                self.assertEqual(intervals["from"][inside[0]], self.FROM)
                self.assertEqual(len(inside), (self.TO - self.FROM) // self.WINDOW)
                events = trace["traceEvents"]
                tracks = {e["tid"]: e["args"]["name"] for e in events if e["name"] == "thread_name"}
                cycles = {}
                for event in events:
                    if event["ph"] == "X":
                        key = tracks[event["tid"]], event["cat"], event["name"]
                        cycles[key] = cycles.get(key, 0) + event["dur"]
                expected = {}
                for unit, activities in intervals["series"]["units"].items():
                    for cause, values in [("busy", activities["busy"]), *activities.get("stalls", {}).items()]:
                        count = sum(values[i] for i in inside)
                        if count:
                            expected[unit, "busy" if cause == "busy" else "stall", cause] = count
                self.assertEqual(cycles, expected)
                self.assertTrue(expected)
                begun = {}
                flights = {port: 0 for port in intervals["series"].get("ports", {})}
                for event in events:
                    if event["ph"] == "b":
                        begun[event["id"]] = event["ts"]
                    elif event["ph"] == "e":
                        flights[event["cat"]] += event["ts"] - begun[event["id"]]
                for port, series in intervals["series"].get("ports", {}).items():
                    self.assertEqual(flights[port], sum(series["outstanding"][i] for i in inside), port)
                if intervals["series"].get("ports"):
                    self.assertTrue(begun)
                self.check_levels(events, intervals["series"], inside, load(out)["links"])

    def check_levels(self, events, series, inside, links):
        """A counter per FIFO and port, whose area matches the intervals."""
        areas, at = {}, {}
        for event in [e for e in events if e["ph"] == "C"] + [None]:
            for name, (since, value) in at.items() if event is None else [(event["name"], at.get(event["name"], (0, 0)))]:
                areas[name] = areas.get(name, 0) + value * ((self.TO if event is None else event["ts"]) - since)
            if event is not None:
                at[event["name"]] = event["ts"], next(iter(event["args"].values()))
        expected = {f"{name}, of {link['depth']}": series["links"][name]["occupancy"]
                    for name, link in links.items() if link["depth"] > 2}
        expected.update({f"{name}, in flight": port["outstanding"] for name, port in series.get("ports", {}).items()})
        self.assertTrue(links)
        self.assertEqual(areas, {name: sum(values[i] for i in inside) for name, values in expected.items()})

    def test_checker_finds_violations(self):
        with tempfile.TemporaryDirectory() as out:
            good, _ = self.trace(out, *ENGINES["texture"])
        self.assertEqual(problems(good), [])

        def first(trace, kind):
            return next(i for i, e in enumerate(trace["traceEvents"]) if e["ph"] == kind)

        def drop(kind):
            return lambda t: t["traceEvents"].pop(first(t, kind))

        def change(kind, key, value):
            return lambda t: t["traceEvents"][first(t, kind)].update({key: value})

        def lack(kind, key):
            return lambda t: t["traceEvents"][first(t, kind)].pop(key)

        def backwards(trace):
            trace["traceEvents"].append(dict(trace["traceEvents"][first(trace, "X")]))

        def twice(trace):
            events = trace["traceEvents"]
            events.insert(first(trace, "b"), dict(events[first(trace, "b")]))

        def unnamed(trace):
            trace["traceEvents"] = [e for e in trace["traceEvents"] if e["name"] != "thread_name"]

        for name, fault in {"end without begin": drop("b"), "begin without end": drop("e"),
                            "overlap": change("X", "dur", 10 ** 6), "no length": change("X", "dur", 0),
                            "unknown phase": change("X", "ph", "Q"), "no time": lack("X", "ts"),
                            "no id": lack("b", "id"), "no process": lack("e", "pid"), "backwards": backwards,
                            "begins twice": twice, "unnamed tracks": unnamed,
                            "a count below nothing": change("C", "args", {"beats": -1}),
                            "a counter without a name": lack("C", "name"),
                            "a counter that stays": lambda t: t["traceEvents"].insert(
                                first(t, "C"), dict(t["traceEvents"][first(t, "C")])),
                            "no events": lambda t: t.pop("traceEvents")}.items():
            with self.subTest(name):
                bad = copy.deepcopy(good)
                fault(bad)
                self.assertTrue(problems(bad))

    def test_rejects_empty_and_too_long_timelines(self):
        with tempfile.TemporaryDirectory() as out:
            for arguments, says in ((("--timeline", "--timeline-from", "9", "--timeline-to", "9"), "leave no cycle"),
                                    (("--timeline", "--timeline-to", "100001"), "at most 100000"),
                                    (("--timeline", "--timeline-from", "9000000", "--timeline-to", "9000001"),
                                     "the timeline is empty"),
                                    (("--timeline-from", "1"), "it needs run.timeline")):
                self.assertIn(says, run(out, *ENGINES["texture"], *arguments, code=2))


# ---- maps ---------------------------------------------------------------------------------------

def values(out, name):
    with open(os.path.join(out, f"map_{name}.pfm"), "rb") as file:
        assert file.readline() == b"Pf\n"
        width, height = map(int, file.readline().split())
        assert file.readline() == b"-1.0\n"
        pixels = array.array("f")
        pixels.frombytes(file.read())
    assert len(pixels) == width * height
    return width, height, pixels


class MapSums(unittest.TestCase):
    def sums(self, out):
        """By map: sum of its values, and number of pixels above zero."""
        result = load(out)
        found = {}
        for name, figures in result["maps"].items():
            width, height, pixels = values(out, name)
            self.assertEqual((width, height), (96, 64))
            there = [v for v in pixels if not math.isnan(v)]
            self.assertEqual(len(there), figures["pixels"])
            self.assertAlmostEqual(max(there), figures["max"], delta=1e-5 * max(1, figures["max"]))
            self.assertAlmostEqual(sum(there), figures["sum"], delta=1e-5 * max(1, figures["sum"]))
            self.assertGreater(figures["max"], figures["min"], f"{name} is the same everywhere")
            found[name] = sum(there), sum(v > 0 for v in there)
        return found, result["work"]


class Maps(MapSums):
    def test_texture_maps_match_counters(self):
        with tempfile.TemporaryDirectory() as out:
            run(out, *ENGINES["texture"], "--maps")
            maps, work = self.sums(out)
            self.assertEqual(maps["samples"][0], work["sample_walker_samples"])
            self.assertEqual(maps["misses"][0], work["tag_stage_misses"])
            self.assertEqual(maps["latency"][1], work["fragments"])
            result = load(out)
            latency = result["maps"]["latency"]
            self.assertEqual((latency["min"], latency["max"]), (result["latency"]["min"], result["latency"]["max"]))
            fractions = sum(v % 1 != 0 for v in values(out, "level")[2] if not math.isnan(v))
            self.assertEqual(fractions, work["level_unit_two_levels"])

    def test_morphological_maps_match_counters(self):
        for more in ((), ("--lanes", "4"), ("--preset", "mlaa")):
            with self.subTest(more), tempfile.TemporaryDirectory() as out:
                run(out, *ENGINES["morphological"], *more, "--maps")
                result = load(out)
                found, work = self.sums(out) if "mlaa" not in more else (None, result["work"])
                edges = [v > 0 for v in values(out, "edges")[2]]
                self.assertEqual(sum(edges), work["edge_detector_edge_pixels"])
                self.assertEqual(edges, [v > 0 for v in values(out, "run_length")[2]])
                if found:
                    self.assertAlmostEqual(found["steps"][0], work["endpoint_predictor_h_steps"] + work["endpoint_predictor_v_steps"],
                                           delta=1e-3)


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        DEBURR = os.path.abspath(sys.argv.pop(1))
    unittest.main()
