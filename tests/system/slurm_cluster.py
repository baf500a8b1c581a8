"""A Slurm of one node on this machine, without systemd: munged, slurmctld and slurmd in a temporary folder.

Needs Debian's slurm-wlm and munge; install() gets them where it may. All daemons are this process's children and are
ended by it.
"""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import tempfile
import time

PACKAGES = ["slurm-wlm", "munge"]
PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol"]
LIMIT_S = 120
os.environ["PATH"] += ":/usr/sbin:/sbin"

CONF = """
ClusterName=fatmc
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
SchedulerParameters=sched_min_interval=100000,batch_sched_delay=0
ReturnToService=2
MpiDefault=none
KillWait=2
NodeName={host} NodeAddr=127.0.0.1 CPUs=4 RealMemory=500 State=UNKNOWN
PartitionName=test Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def missing():
    return [program for program in PROGRAMS if shutil.which(program) is None]


def install():
    """Why there can be no Slurm here; None when there is one."""
    if os.geteuid() != 0:
        return "Slurm's daemons want root"
    if not missing():
        return None
    if shutil.which("apt-get") is None:
        return "no Slurm here, and no apt-get to get it"
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    for command in (["apt-get", "update", "-qq"],
                    ["apt-get", "-o", "DPkg::Lock::Timeout=300", "install", "-y", "-qq", "--no-install-recommends", *PACKAGES]):
        done = subprocess.run(command, env=environment, capture_output=True, text=True)
        if done.returncode != 0:
            return f"{' '.join(command)} failed: {done.stderr.strip()[-300:]}"
    return f"programs missing after the installation: {missing()}" if missing() else None


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def until(condition, what, limit_s=LIMIT_S):
    """Polls; the limit is there to end a broken run, not to measure one."""
    end = time.monotonic() + limit_s
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.02)
    raise AssertionError(f"waited in vain until {what}")


class Cluster:
    def __init__(self):
        self.temporary = tempfile.TemporaryDirectory(prefix="fatmc_slurm_")
        self.folder = pathlib.Path(self.temporary.name)
        self.host = socket.gethostname().split(".")[0]
        self.daemons = {}
        for name in ("state", "spool"):
            (self.folder / name).mkdir(mode=0o700)
        (self.folder / "munge.key").write_bytes(os.urandom(1024))
        os.chmod(self.folder / "munge.key", 0o400)
        (self.folder / "slurm.conf").write_text(CONF.format(
            host=self.host, folder=self.folder, controller_port=free_port(), node_port=free_port()))
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf")}

    def start(self):
        munge = self.folder / "munge"
        self.daemon("munged", "--foreground", "--force", f"--key-file={munge}.key", f"--socket={munge}.socket",
                    f"--pid-file={munge}.pid", f"--log-file={munge}.log", f"--seed-file={munge}.seed")
        until(lambda: (self.folder / "munge.socket").exists(), "munged listens")
        self.start_controller()
        self.daemon("slurmd", "-D", "-N", self.host)
        until(lambda: "idle" in self.ask("sinfo", "--noheader", "--format=%T"), f"the node is idle\n{self.logs()}")

    def start_controller(self):
        self.daemon("slurmctld", "-D")
        until(lambda: "UP" in self.ask("scontrol", "ping"), f"slurmctld answers\n{self.logs()}")

    def kill_controller(self):
        self.daemons["slurmctld"].send_signal(signal.SIGKILL)
        self.daemons.pop("slurmctld").wait()

    def remember_jobs(self):
        """Waits until the running jobs of now are in slurmctld's state files, which it writes every few seconds."""
        # A file with the name of a job may be of the time when it was pending; one with this comment is not.
        marks = {job: f"running {job}" for job in self.jobs("RUNNING")}
        for job, mark in marks.items():
            self.ask("scontrol", "update", f"jobid={job}", f"comment={mark}")
        state = self.folder / "state" / "job_state"
        until(lambda: state.exists() and all(mark.encode() in state.read_bytes() for mark in marks.values()),
              "jobs are saved")

    def forget_jobs(self):
        """What is left of a controller whose disk is lost."""
        shutil.rmtree(self.folder / "state")
        (self.folder / "state").mkdir(mode=0o700)

    def processes(self, name):
        """Of this cluster's jobs."""
        own = f"{self.folder}".encode()
        found = []
        for line in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
            try:
                command = line.read_bytes()
            except OSError:
                continue
            if name.encode() in command and own in command:
                found.append(int(line.parent.name))
        return found

    def daemon(self, program, *arguments):
        with open(self.folder / f"{program}.out", "ab") as out:
            self.daemons[program] = subprocess.Popen([program, *arguments], env=self.environment, cwd=self.folder,
                                                     stdout=out, stderr=out, stdin=subprocess.DEVNULL)

    def ask(self, *command):
        """Standard output; empty when the command fails."""
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=LIMIT_S)
        return done.stdout if done.returncode == 0 else ""

    def jobs(self, state=None):
        lines = [line.split() for line in self.ask("squeue", "--noheader", "--array", "--format=%i %T").splitlines()]
        return [job for job, its in lines if state is None or its == state]

    def logs(self):
        return "\n".join(f"{path.name}: {path.read_text(errors='replace')[-1500:]}"
                         for path in sorted(self.folder.glob("*.log")) + sorted(self.folder.glob("*.out")))

    def stop(self):
        if "slurmctld" in self.daemons:
            subprocess.run(["scancel", "--user=root"], env=self.environment, capture_output=True, timeout=LIMIT_S)
            try:
                until(lambda: not self.jobs(), "jobs are gone", 30)
            except AssertionError:
                pass
        for name in ("slurmd", "slurmctld", "munged"):
            process = self.daemons.pop(name, None)
            if process is None:
                continue
            process.terminate()
            try:
                process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        self.temporary.cleanup()
