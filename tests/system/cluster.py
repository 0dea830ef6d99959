"""A cluster on one machine: Slurm's own daemons, with folders of their own."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import time
import unittest
from pathlib import Path

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue")


def free_port() -> int:
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Slurm:
    """Runs slurmctld and slurmd until stop(); skips the test where they cannot run."""

    def __init__(self, directory: Path) -> None:
        missing = [name for name in PROGRAMS if shutil.which(name) is None]
        if missing:
            raise unittest.SkipTest(f"no Slurm here: {', '.join(missing)} missing (slurm-wlm)")
        if os.getuid() != 0:
            raise unittest.SkipTest("Slurm's daemons need root here")
        self.directory = directory
        self.started: list[subprocess.Popen] = []
        self.munge = Path("/run/munge/munge.socket.2")
        self.own_munge = not self.munge.exists()
        name = socket.gethostname().split(".")[0]
        for folder in ("state", "spool"):
            (directory / folder).mkdir(parents=True)
        self.config = directory / "slurm.conf"
        self.config.write_text(
            f"""ClusterName=limpid
SlurmctldHost={name}(127.0.0.1)
SlurmctldPort={free_port()}
SlurmdPort={free_port()}
SlurmUser=root
AuthType=auth/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MpiDefault=none
StateSaveLocation={directory}/state
SlurmdSpoolDir={directory}/spool
SlurmctldPidFile={directory}/ctld.pid
SlurmdPidFile={directory}/slurmd.pid
SlurmctldLogFile={directory}/ctld.log
SlurmdLogFile={directory}/slurmd.log
SchedulerParameters=sched_interval=1,batch_sched_delay=0
MinJobAge=2
NodeName={name} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes={name} Default=YES MaxTime=INFINITE State=UP
"""
        )
        self.environment = {**os.environ, "SLURM_CONF": str(self.config)}
        try:
            self.start()
        except BaseException:
            self.stop()
            raise

    def start(self) -> None:
        if self.own_munge:
            self.munge.parent.mkdir(parents=True, exist_ok=True)
            shutil.chown(self.munge.parent, "munge", "munge")
            subprocess.run(["runuser", "-u", "munge", "munged"], capture_output=True)
        for program in ("slurmctld", "slurmd"):
            self.started.append(
                subprocess.Popen([program, "-D"], env=self.environment,
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)  # fmt: skip
            )
        deadline = time.monotonic() + 30
        while time.monotonic() < deadline:
            if "idle" in self.said("sinfo", "-h", "-o", "%T"):
                return
            time.sleep(0.2)
        raise unittest.SkipTest("Slurm's daemons did not come up here")

    def said(self, *words: str) -> str:
        done = subprocess.run(words, env=self.environment, capture_output=True, text=True)
        return done.stdout

    def stop(self) -> None:
        self.said("scancel", "-u", "root")
        for process in reversed(self.started):
            process.terminate()
            try:
                process.wait(timeout=10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        if self.own_munge:
            words = ["runuser", "-u", "munge", "--", "munged", "--stop"]
            subprocess.run(words, capture_output=True)
