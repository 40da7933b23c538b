"""throughput.py TURNS WAY...: part of throughput.sh; in a folder with sweep.toml."""

import json
import os
import resource
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

HYDRODIP = os.environ["HYDRODIP"]
DRAFT = ["--quality", "draft", "--set", "preview.pictures=off", "--set", "plan.suggest=off", "--threads", "1", "--quiet"]


def call(*command, **more):
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **more)


def by_loop(folder):
    with open(f"{folder}/sweep.json") as manifest:
        runs = json.load(manifest)["runs"]

    def one(run):
        values = [word for name, value in run["values"].items() for word in ("--set", f"{name}={value}")]
        call(HYDRODIP, "simulate", "colored.ply", *DRAFT, *values, "-o", f"{folder}/runs/{run['id']}")

    with ThreadPoolExecutor(2) as two:
        list(two.map(one, runs))


def by_sweep(folder):
    call(HYDRODIP, "sweep", "run", folder, "--threads", "2", "--quiet")


def by_parallel(folder):
    call(f"{folder}/parallel.sh", env={**os.environ, "PARALLEL": "-j2"})


def by_slurm(folder):
    call("sbatch", f"{folder}/slurm.sh")
    while True:
        asked = subprocess.run(["squeue", "-h"], capture_output=True, text=True)
        if asked.returncode == 0 and not asked.stdout:
            return
        time.sleep(0.1)


def cpu_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


turns, ways = int(sys.argv[1]), sys.argv[2:]
measured = {way: [] for way in ways}
for turn in range(turns):
    for way in ways:
        call(HYDRODIP, "sweep", "plan", "sweep.toml", "-o", "s", "--no-trial", "--quiet")
        os.makedirs("s/runs", exist_ok=True)
        with open("s/sweep.json") as manifest:
            runs = len(json.load(manifest)["runs"])
        begun, used = time.perf_counter(), cpu_seconds()
        globals()[f"by_{way}"]("s")
        measured[way].append((time.perf_counter() - begun, cpu_seconds() - used))
        done = len(os.listdir("s/runs"))
        assert done == runs, (way, done)
        if way != "loop":
            said = subprocess.run([HYDRODIP, "sweep", "collect", "s"], capture_output=True, text=True).stdout
            assert said.startswith(f"{runs} runs: {runs} done, 0 failed, 0 missing"), said
        shutil.rmtree("s")
        print(f"turn {turn + 1}, {runs} runs, {way}: {measured[way][-1][0]:.1f} s, CPU {measured[way][-1][1]:.2f} s", flush=True)
for way in ways:
    wall, cpu = (sorted(each)[len(each) // 2] for each in zip(*measured[way]))
    ratios = sorted(mine[0] / loop[0] for mine, loop in zip(measured[way], measured["loop"]))
    spent = "its nodes' CPU time is not seen" if way == "slurm" else f"{cpu:.1f} s of CPU"
    print(f"{way:9} {wall:6.1f} s, {ratios[len(ratios) // 2]:.3f} of the loop ({ratios[0]:.3f} to {ratios[-1]:.3f}); {spent}")
