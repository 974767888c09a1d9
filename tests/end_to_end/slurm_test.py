#!/usr/bin/env python3
"""Runs tools/fleet's job array under a real Slurm of one node on this machine, with its own folders and ports: forty
recordings, then the same with the node killed in mid-array. Exit 77: Slurm is not installed, or this is not root.

    slurm_test.py PROGRAM SOURCE_FOLDER
"""

import contextlib
import csv
import json
import math
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from schemas import KeptFolder  # noqa: E402

RECORDINGS = 40
SECONDS_EACH = 20
EACH_TASK = 3  # the last task has one
SOON_S = 240
MODEL = {"schema": "gyrolog-model/1", "rate_hz": 100, "axes": {axis: {"N": 0.01, "bias": 0.1} for axis in "xyz"}}

# Neither munge nor cgroups, which a container need not have; all else as a small cluster has it.
CONFIGURATION = """
ClusterName=gyrolog-test
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/none
CredType=cred/none
SlurmctldPort={controller_port}
SlurmdPort={node_port}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
ReturnToService=2
SlurmdTimeout=10
KillWait=1
SchedulerParameters=batch_sched_delay=0,sched_interval=1
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def run(*command, expect=0, **more):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **more)
    assert done.returncode == expect, f"{command}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done


def until(what, condition, seconds=SOON_S):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, f"not within {seconds} s: {what}"
        time.sleep(0.1)


def free_ports(count):
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]


class Cluster:
    """slurmctld and slurmd, which end with it."""

    def __init__(self, folder, environment):
        self.folder = folder
        for made in ("state", "spool"):
            (folder / made).mkdir(parents=True)
        self.configuration = folder / "slurm.conf"
        controller_port, node_port = free_ports(2)
        self.host = socket.gethostname().split(".")[0]
        self.configuration.write_text(CONFIGURATION.format(host=self.host, folder=folder, controller_port=controller_port,
                                                           node_port=node_port))
        self.environment = {**environment, "SLURM_CONF": str(self.configuration)}
        self.running = {}

    def start(self, program, *options):
        with open(self.folder / f"{program}.out", "ab") as said:
            self.running[program] = subprocess.Popen([program, "-D", *options], stdout=said, stderr=said,
                                                     env=self.environment)

    def is_idle(self):
        done = subprocess.run(["sinfo", "--noheader", "--format=%T"], capture_output=True, text=True, env=self.environment)
        return done.stdout.strip() == "idle"

    def jobs(self, state=""):
        more = [f"--states={state}"] if state else []
        return run("squeue", "--noheader", "--array", "--format=%i", *more, env=self.environment).stdout.split()

    def hurry(self):
        """Slurm lets two minutes pass before it starts a task again; nothing else waits for a time."""
        waiting = run("squeue", "--noheader", "--array", "--states=pending", "--format=%i %r", env=self.environment).stdout
        for line in waiting.splitlines():
            job, reason = line.split(maxsplit=1)
            if reason == "BeginTime":
                run("scontrol", "update", f"JobId={job}", "StartTime=now", env=self.environment)

    def has_ended(self):
        self.hurry()
        return not self.jobs()

    def pull_the_plug(self):
        """The node's daemon and all that it had started are gone at once, as with a machine that loses its power."""
        mark = f"SLURM_CONF={self.configuration}".encode()
        kept = {os.getpid(), self.running["slurmctld"].pid}
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):
                number = int(process.name)
                if number not in kept and mark in (process / "environ").read_bytes().split(b"\0"):
                    os.kill(number, signal.SIGKILL)
        self.running.pop("slurmd").wait()

    def end(self):
        if "slurmd" in self.running:
            self.pull_the_plug()
        for process in self.running.values():
            process.kill()
            process.wait()

    def log(self):
        told = [path for ending in ("log", "out") for path in self.folder.glob(f"*.{ending}")]
        return "\n".join(f"--- {path.name}\n{path.read_text(errors='replace')[-3000:]}" for path in told)


def make_recordings(program, folder):
    """One is torn, one is not there, one never rests."""
    model = folder / "model.json"
    model.write_text(json.dumps(MODEL))
    recordings = [folder / f"unit {number:02}.csv" for number in range(RECORDINGS)]
    for seed, recording in enumerate(recordings):
        run(program, "simulate", model, "-o", recording, "--duration", f"{SECONDS_EACH}s", "--seed", seed)
    torn, absent, restless = (recordings[index] for index in (7, 18, 29))
    whole = folder / "whole.pcapng"
    run(program, "capture", "--device", "sim:rate=100,seed=7", "--duration", f"{SECONDS_EACH}s", "-o", whole)
    torn.unlink()
    torn = torn.with_suffix(".pcapng")
    torn.write_bytes(whole.read_bytes()[:-whole.stat().st_size // 3])
    recordings[7] = torn
    absent.unlink()
    # Swings, a chirp and a ramp: nowhere two like seconds.
    rows = (f"{i / 100:.2f},{30 * math.sin(i / 9) * (1 + math.sin(i / 130)):.4f},{25 * math.cos(i * i / 9000):.4f},"
            f"{2e-4 * i * i:.4f}" for i in range(100 * SECONDS_EACH))
    restless.write_text("t_s,gx_dps,gy_dps,gz_dps\n" + "\n".join(rows) + "\n")
    listed = folder / "list.txt"
    listed.write_text("".join(f"{recording}\n" for recording in recordings))
    return recordings, listed, {str(absent), str(restless)}


def comparable(path):
    """The lines, in order, without what each took."""
    return sorted(re.sub(rb',"seconds":[-+.e0-9]+', b"", line) for line in path.read_bytes().splitlines())


def judge(out, recordings, failed, serial):
    with open(out / "table.csv", newline="") as table:
        rows = list(csv.DictReader(table))
    assert {row["file"] for row in rows} == {str(recording) for recording in recordings}
    wrong = {row["file"]: row["error"] for row in rows if row["error"]}
    assert set(wrong) == failed, wrong
    assert comparable(out / "lines.jsonl") == serial, "the lines are not those of a serial run"
    assert not list((out / "lines").glob("*.part")), "half an answer was left"


def main():
    program, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    for needed in ("slurmctld", "slurmd", "sbatch"):
        if shutil.which(needed, path=os.environ["PATH"] + ":/usr/sbin") is None:
            print(f"skipped: needs {needed} (Debian's slurmctld, slurmd and slurm-client)")
            sys.exit(77)
    if os.geteuid() != 0:
        print("skipped: Slurm's daemons want to be root")
        sys.exit(77)
    with KeptFolder() as name:
        folder = pathlib.Path(name)
        # Slow enough that not all tasks are done when the plug is pulled; and held, so that it is pulled while one runs.
        slow, hold, held = folder / "slow gyrolog", folder / "hold", folder / "held"
        slow.write_text(f"""#!/bin/sh
[ "$1" = table ] || sleep 1
while [ -e "{hold}" ]; do : > "{held}"; sleep 0.1; done
exec "{program}" "$@"
""")
        slow.chmod(0o755)
        environment = {**os.environ, "PATH": os.environ["PATH"] + ":/usr/sbin", "HOME": name, "GYROLOG": str(program)}
        recordings, listed, failed = make_recordings(program, folder)
        command = ["analyze", "--still", "auto"]
        run(program, *command[:1], "--jsonl", folder / "serial.jsonl", *recordings, *command[1:], expect=1)
        serial = comparable(folder / "serial.jsonl")
        assert len(serial) == RECORDINGS

        cluster = Cluster(folder / "slurm", environment)
        try:
            cluster.start("slurmctld", "-c")
            cluster.start("slurmd")
            until("the node is idle", cluster.is_idle, 60)

            def submit(out, gyrolog):
                run(source / "tools/fleet/slurm_submit", out, listed, EACH_TASK, *command,
                    env={**cluster.environment, "GYROLOG": str(gyrolog)})

            began = time.monotonic()
            submit(folder / "out", program)
            until("all tasks have ended", cluster.has_ended)
            judge(folder / "out", recordings, failed, serial)
            print(f"an array of {-(-RECORDINGS // EACH_TASK)} tasks: {time.monotonic() - began:.0f} s")

            began = time.monotonic()
            out = folder / "out of a node that dies"
            submit(out, slow)
            until("some tasks are done and some are not", lambda: len(list((out / "lines").glob("*.jsonl"))) >= 3)
            hold.touch()
            until("a task is held", held.exists)
            done = {path.name: path.stat().st_mtime_ns for path in (out / "lines").glob("*.jsonl")}
            cut = cluster.jobs("running")
            cluster.pull_the_plug()
            hold.unlink()
            assert cut, "no task was running: this test tests nothing"
            assert len(done) < -(-RECORDINGS // EACH_TASK), "nothing was left to do: this test tests nothing"
            cluster.start("slurmd")
            until("all tasks have ended", cluster.has_ended)
            judge(out, recordings, failed, serial)
            for name_of_lines, written_ns in done.items():
                assert (out / "lines" / name_of_lines).stat().st_mtime_ns == written_ns, "done twice"
            log = (folder / "slurm/slurmctld.log").read_text()
            assert "equeue" in log, f"no task was queued again: {cut} were cut"
            print(f"the node died with {cut} running and {len(done)} tasks done: all the same "
                  f"{time.monotonic() - began:.0f} s later")
        except BaseException:
            print(cluster.log())
            raise
        finally:
            cluster.end()


if __name__ == "__main__":
    main()
