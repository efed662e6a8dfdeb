#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Sweeps and a regression on a Slurm cluster of two nodes that this test starts and stops on this machine: an array,
a killed task, a killed node, resume, and errors. Needs root, Debian's slurm-wlm and munge; no systemd.

usage: slurm_test.py DEBURR"""
import glob
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import regress_test
import sweep_test

PROGRAMS = ("munged", "mungekey", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol")
POINTS = 16
SWEEP = """
engine: texture
base:
  scene: {source: tunnel, width: 160, height: 160}
  run.images: false
axes:
  texture.cache.bytes: [1024, 2048, 4096, 8192]
  texture.cache.ways: [1, 2]
  memory.latency: [50, 100]
chunk: 2
"""
PORT = 17000 + os.getpid() % 900 * 10


class Cluster:
    """munged, slurmctld and two slurmd, in the foreground, in their own directory."""

    def __init__(self, directory):
        self.directory = directory
        self.conf = os.path.join(directory, "slurm.conf")
        self.processes = {}
        socket = os.path.join(directory, "munge.socket")
        key = os.path.join(directory, "munge.key")
        for name in ("state", "spool_n1", "spool_n2"):
            os.mkdir(os.path.join(directory, name))
        os.chmod(directory, 0o755)
        with open(self.conf, "w") as file:
            file.write(f"""ClusterName=test
SlurmctldHost=localhost(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={socket}
CredType=cred/munge
SlurmctldPort={PORT}
SlurmctldPidFile={directory}/slurmctld.pid
SlurmdPidFile={directory}/slurmd_%n.pid
StateSaveLocation={directory}/state
SlurmdSpoolDir={directory}/spool_%n
SlurmctldLogFile={directory}/slurmctld.log
SlurmdLogFile={directory}/slurmd_%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=1
ReturnToService=1
SlurmdTimeout=10
KillWait=2
MinJobAge=300
JobAcctGatherType=jobacct_gather/none
NodeName=n1 NodeHostname=localhost NodeAddr=127.0.0.1 Port={PORT + 1} CPUs=1
NodeName=n2 NodeHostname=localhost NodeAddr=127.0.0.1 Port={PORT + 2} CPUs=1
PartitionName=test Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
""")
        subprocess.run(["mungekey", "--create", "--keyfile", key], check=True)
        self.start("munged", "--foreground", "--force", "--key-file", key, "--socket", socket,
                   "--pid-file", f"{directory}/munged.pid", "--seed-file", f"{directory}/munged.seed",
                   "--log-file", f"{directory}/munged.log")
        self.wait_for(lambda: os.path.exists(socket), "munged")
        self.start("slurmctld", "-D", "-f", self.conf)
        for node in ("n1", "n2"):
            self.start_node(node)
        self.wait_for(lambda: self.ask("sinfo", "-h", "-o", "%T %D").strip() == "idle 2", "nodes")

    def start(self, name, *arguments, label=None):
        self.processes[label or name] = subprocess.Popen(
            [name, *arguments], env=self.environment(), stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL, start_new_session=True)

    def start_node(self, node):
        self.start("slurmd", "-D", "-N", node, "-f", self.conf, label=node)

    def kill_node(self, node):
        """Like a power failure: kills the daemon and its tasks."""
        self.processes[node].kill()
        self.processes[node].wait()
        for name in os.listdir("/proc"):
            if not name.isdigit():
                continue
            try:
                with open(f"/proc/{name}/environ", "rb") as file:
                    environment = file.read().split(b"\0")
                if (f"SLURMD_NODENAME={node}".encode() in environment
                        and f"SLURM_CONF={self.conf}".encode() in environment):
                    os.kill(int(name), signal.SIGKILL)
            except (FileNotFoundError, ProcessLookupError, PermissionError):
                pass

    def environment(self):
        return dict(os.environ, SLURM_CONF=self.conf)

    def ask(self, *command):
        return subprocess.run(command, env=self.environment(), text=True, capture_output=True,
                              timeout=60).stdout

    def wait_for(self, condition, what, seconds=90):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                logs = ""
                for log in glob.glob(self.directory + "/*.log"):
                    with open(log) as file:
                        logs += f"--- {log}\n" + "".join(file.readlines()[-15:])
                raise AssertionError(f"waited {seconds} s for {what}\n{logs}")
            time.sleep(0.1)

    def stop(self):
        subprocess.run(["scancel", "--state=PENDING"], env=self.environment(), timeout=60)
        for process in reversed(list(self.processes.values())):
            process.terminate()
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def setUpModule():
    scratch = tempfile.TemporaryDirectory(prefix="deburr_slurm_")
    unittest.addModuleCleanup(scratch.cleanup)
    OnCluster.scratch = scratch.name
    OnCluster.cluster = Cluster(scratch.name)
    unittest.addModuleCleanup(OnCluster.cluster.stop)


class OnCluster:
    """Common part of the tests of one cluster; subclasses have `write` and `directory`."""

    def profile(self, **more):
        settings = {"conf": self.cluster.conf, "partition": "test", "time": '"00:10:00"', "cpus": 1,
                    "tasks": 4, **more}
        self.write("profile.yaml", "".join(f"{k}: {v}\n" for k, v in settings.items()))

    def wait_until_over(self, job):
        self.cluster.wait_for(lambda: not self.cluster.ask("squeue", "-h", "-j", job).strip(),
                              f"job {job}", 240)


class Slurm(OnCluster, unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.mkdtemp(dir=self.scratch)
        self.write("sweep.yaml", SWEEP)
        self.profile()

    def write(self, name, text):
        with open(os.path.join(self.directory, name), "w") as file:
            file.write(text)

    def sweep(self, *arguments, code=0):
        done = subprocess.run([DEBURR, "sweep", "sweep.yaml", *arguments], cwd=self.directory,
                              text=True, capture_output=True, timeout=300)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def submit(self, *arguments):
        text = self.sweep("run", "--slurm", "profile.yaml", *arguments)
        return text.split(" of job ")[1].split(";")[0]

    def done(self):
        return int(self.sweep("status").split("done")[1].split()[0])

    def results(self):
        return sweep_test.results_in(self.directory)

    def check_complete(self, kept):
        """All results exist, earlier results were not run again, and they equal those of a local run."""
        after = self.results()
        self.assertEqual(len(after), POINTS)
        self.assertEqual({name: after[name] for name in kept}, kept)
        self.sweep("run", "--out", "local")
        for path in glob.glob(os.path.join(self.directory, "local/points/*/*/result.json")):
            with open(path) as file:
                content = json.load(file)
            del content["host"]
            self.assertEqual(content, after[os.path.basename(os.path.dirname(path))][1])

    def test_array_runs_all_points(self):
        job = self.submit()
        self.assertIn(f"job {job}", self.sweep("status"))
        self.assertIn(f"job {job} still has", self.sweep("run", code=5))
        self.wait_until_over(job)
        self.assertEqual(self.done(), POINTS)
        self.check_complete({})
        self.assertIn("(0 in this run)", self.sweep("run", "--slurm", "profile.yaml"))

    def test_killed_task_is_reported_and_resumed(self):
        job = self.submit()
        self.cluster.wait_for(lambda: self.done() >= 1, "a point")
        self.cluster.ask("scancel", "--signal=KILL", "--full", f"{job}_0")
        self.cluster.ask("scancel", f"{job}_3")
        self.wait_until_over(job)
        kept = self.results()
        self.assertLess(len(kept), POINTS)
        self.wait_until_over(self.submit())
        self.check_complete(kept)

    def test_killed_node_requeues_its_points(self):
        job = self.submit()
        self.cluster.wait_for(lambda: self.done() >= 1, "a point")
        self.cluster.kill_node("n2")
        kept = self.results()
        self.cluster.wait_for(lambda: "down" in self.cluster.ask("sinfo", "-h", "-n", "n2", "-o", "%T"),
                              "the node to be missed")
        self.cluster.start_node("n2")
        self.cluster.ask("scontrol", "update", "NodeName=n2", "State=RESUME")
        # Its tasks are queued again, after a delay chosen by Slurm.
        for row in self.cluster.ask("squeue", "-h", "-r", "-j", job, "-t", "PD", "-o", "%i").split():
            self.cluster.ask("scontrol", "update", f"JobId={row}", "StartTime=now")
        self.wait_until_over(job)
        if len(self.results()) < POINTS:
            self.wait_until_over(self.submit())
        self.check_complete(kept)

    def test_killed_controller_loses_nothing(self):
        """Tasks continue without it; once it is back, nothing was lost or is run again."""
        self.profile(tasks=2)
        job = self.submit()
        self.cluster.wait_for(lambda: self.done() > 0, "a first point")
        self.cluster.processes["slurmctld"].kill()
        self.cluster.processes["slurmctld"].wait()
        kept = self.results()
        self.assertLess(len(kept), POINTS)
        self.assertIn("Slurm's controller does not answer", self.sweep("status", code=5))
        self.cluster.start("slurmctld", "-D", "-f", self.cluster.conf)
        self.cluster.wait_for(lambda: "UP" in self.cluster.ask("scontrol", "ping"), "the controller")
        self.wait_until_over(job)
        if len(self.results()) < POINTS:
            self.wait_until_over(self.submit())
        self.check_complete(kept)

    def test_held_and_drained_jobs_are_reported(self):
        self.profile(options="[--hold]")
        job = self.submit()
        self.cluster.ask("scontrol", "update", "NodeName=n1", "State=DRAIN", "Reason=test")
        text = self.sweep("status")
        self.assertIn("4 tasks queued, 0 running", text)
        self.assertIn(f"scontrol release {job}", text)
        self.assertIn("node n1 is drained: scontrol update NodeName=n1 State=RESUME", text)
        self.cluster.ask("scontrol", "update", "NodeName=n1", "State=RESUME")
        self.cluster.ask("scontrol", "release", job)
        self.wait_until_over(job)
        self.check_complete({})

    def test_search_equals_local_search(self):
        """Each generation is a job that the search waits for; it requests the same points as a local search."""
        self.write("sweep.yaml", SWEEP.replace("160", "32") +
                   "objectives: {minimise: [cycles, memory_bits]}\n")
        search = [DEBURR, "search", "sweep.yaml", "--runs", "12", "--population", "8"]
        asked = []
        for more in (["--slurm", "profile.yaml"], ["--out", "local"]):
            done = subprocess.run(search + more, cwd=self.directory, text=True, capture_output=True,
                                  timeout=300)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertIn("12 points, 12 done (12 in this run)", done.stdout)
            out = more[1] if more[0] == "--out" else "out"
            with open(os.path.join(self.directory, out, "searches/sweep/points.jsonl")) as file:
                asked.append(file.read())
        self.assertEqual(*asked)

    def test_rejects_wrong_profile(self):
        def rejected(*says, code=2, **settings):
            self.profile(**settings)
            text = self.sweep("run", "--slurm", "profile.yaml", code=code)
            for word in says:
                self.assertIn(word, text)

        rejected("profile.yaml:6: unknown key 'partitions': did you mean 'partition'?", partitions="test")
        rejected("profile.yaml:4: 'cpus' = 'many' must be a number", cpus="many")
        rejected("profile.yaml:5: 'tasks' = '0' is outside 1..1000", tasks=0)
        rejected("profile.yaml:6: 'setup' must be a list of lines, got a single value", setup="make")
        rejected("sbatch rejects", "nowhere", partition="nowhere")
        begin = time.monotonic()
        rejected("Slurm configuration '/nonexistent/slurm.conf' not found", code=5,
                conf="/nonexistent/slurm.conf")
        self.assertLess(time.monotonic() - begin, 10, "clients hang for a minute")

    def test_unreachable_controller_is_reported(self):
        with open(self.cluster.conf) as file:
            other = file.read().replace(f"SlurmctldPort={PORT}", f"SlurmctldPort={PORT + 9}")
        self.write("other.conf", other)
        self.profile(conf=os.path.join(self.directory, "other.conf"))
        self.assertIn("Slurm's controller does not answer",
                      self.sweep("run", "--slurm", "profile.yaml", code=5))


class Regress(OnCluster, regress_test.RegressTest):
    def test_fault_is_found_on_nodes(self):
        """Only runs of a killed task are submitted again; signatures, waves and the page equal those of a run on this
        machine."""
        self.write("plans/small.yaml",
                   regress_test.TESTPLAN.replace("seeds: 3", "seeds: 40", 1) + regress_test.FAULT)
        self.profile(tasks=2)
        job = self.submit()
        self.assertIn(f"job {job}", self.regress("status"))
        self.cluster.wait_for(self.inodes, "a first run")
        self.cluster.ask("scancel", f"{job}_1")
        self.wait_until_over(job)
        before = self.inodes()
        out = self.regress("collect", code=3)
        self.assertNotIn(" 0 missing", out)
        self.wait_until_over(self.submit())
        after = self.inodes()
        self.assertEqual({path: after[path] for path in before}, before, "what was there stayed")
        self.assertIn("83 passed, 3 failed in 2 signatures, 0 missing",
                      self.regress("collect", code=1))
        self.check_fault(83)
        on_nodes, after = self.collected(), self.inodes()
        self.regress("-j2", "--out", "local", code=1)
        self.assertEqual(self.points(), self.points(out="local"))
        here = self.collected(out="local")
        for part in ("coverage", "features"):
            self.assertEqual(on_nodes[part], here[part])
        self.regress("run", "--slurm", "profile.yaml", code=1)
        self.assertEqual(self.inodes(), after, "nothing is left to submit")

    def submit(self):
        out = self.regress("run", "--slurm", "profile.yaml")
        return out.split(" of job ")[1].split(";")[0]


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        sys.exit(0 if len(sys.argv) >= 2 else 2)
    missing = [name for name in PROGRAMS if not shutil.which(name)]
    if missing or os.geteuid() != 0:
        print(f"skipped: {'needs root' if not missing else 'not installed (scripts/install slurm): ' + ', '.join(missing)}")
        sys.exit(0)
    DEBURR = regress_test.DEBURR = os.path.abspath(sys.argv.pop(1))
    SOURCE = os.path.abspath(os.path.join(os.path.dirname(__file__), "../../.."))
    unittest.main()
