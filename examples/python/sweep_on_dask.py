#!/usr/bin/env python3
"""Does a sweep's runs on Dask's workers: sweep_on_dask.py DIR [SCHEDULER_ADDRESS]

DIR is what `hydrodip sweep plan` made, on a file system that all workers see. Without a scheduler's
address the workers are on this machine. HYDRODIP names the program if it is not on the path. Dask
gives the part of a worker that died to another one, and runs that are done are not done again.
"""
import json
import os
import subprocess
import sys

from dask.distributed import Client, as_completed


def do_part(folder, part, parts):
    """One part of the sweep, on the worker's machine: what `sweep run` says of it."""
    command = [os.environ.get("HYDRODIP", "hydrodip"), "sweep", "run", folder,
               "--shard", f"{part}/{parts}", "--threads", "1", "--quiet", "--json"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip())
    return json.loads(done.stdout)


def main(folder, address=None):
    folder = os.path.abspath(folder)
    with open(os.path.join(folder, "sweep.json")) as manifest:
        runs = len(json.load(manifest)["runs"])
    with Client(address) as client:
        workers = max(1, len(client.scheduler_info()["workers"]))
        parts = min(runs, 8 * workers)  # small enough that a lost worker costs little
        futures = [client.submit(do_part, folder, part, parts, pure=False)
                   for part in range(1, parts + 1)]
        finished = 0
        for future in as_completed(futures):
            future.result()
            finished += 1
            print(f"{finished} of {parts} parts", file=sys.stderr)
    # Whose worker died in the middle of a run is looked at once more.
    program = os.environ.get("HYDRODIP", "hydrodip")
    subprocess.run([program, "sweep", "run", folder, "--quiet"], check=True)
    subprocess.run([program, "sweep", "collect", folder], check=True)


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
