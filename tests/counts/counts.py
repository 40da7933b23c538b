#!/usr/bin/env python3
"""How many instructions five small jobs take: fails where one takes over 5 % more than recorded.

    counts.py PROGRAM            compares with counts.json
    counts.py PROGRAM --write    records: for changes that are meant to cost that much

Counted by valgrind, on one thread, so that neither the machine's speed nor its load matters. The compiler does: counts
are kept for the one named in counts.json, and others are skipped (exit code 77).
"""

import concurrent.futures
import json
import math
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

RECORD = pathlib.Path(__file__).with_name("counts.json")
MOST_MORE = 0.05
SKIPPED = 77

SMALL = ["--film", "80x80", "--depth", "5", "--threads", "1", "--quiet"]
for name, value in {"film.elements": 600, "dip.step_mm": 1, "dip.air_cells": 500,
                    "material.tear_stretch": 0, "preview.texture_px": 64,
                    "preview.pictures": "off"}.items():
    SMALL += ["--set", "%s=%s" % (name, value)]

JOBS = {
    "load": ["inspect", "ball.obj", "--set", "preview.pictures=off"],
    "dip": ["simulate", "ball.obj", *SMALL, "--set", "film.elements=2000", "--set",
            "dip.step_mm=0.25"],
    "ink rounds": ["print", "ball.obj", *SMALL, "--set", "print.dpi=50", "--set",
                   "ink.rounds_max=2"],
    "film image and sheet": ["print", "ball.obj", *SMALL, "--set", "print.dpi=120", "--set",
                             "ink.rounds_max=1"],
    "film image given": ["simulate", "ball.obj", *SMALL, "--film-image", "ball.png"],
}


def write_model(folder):
    """A ball of radius 12 mm, and a picture on it."""
    across, up = 24, 12
    lines = ["mtllib ball.mtl", "usemtl ball"]
    for j in range(up + 1):
        for i in range(across + 1):
            a, b = 2 * math.pi * i / across, math.pi * j / up
            lines.append("v %.5f %.5f %.5f" % (12 * math.sin(b) * math.cos(a),
                                               12 * math.sin(b) * math.sin(a), -12 * math.cos(b)))
            lines.append("vt %.5f %.5f" % (i / across, j / up))
    for j in range(up):
        for i in range(across):
            n = j * (across + 1) + i + 1
            corners = (n, n + 1, n + across + 2, n + across + 1)
            lines.append("f " + " ".join("%d/%d" % (c, c) for c in corners))
    (folder / "ball.obj").write_text("\n".join(lines) + "\n")
    (folder / "ball.mtl").write_text("newmtl ball\nmap_Kd ball.png\n")
    side = 64
    rows = b"".join(b"\0" + bytes((x * 4, y * 4, (x ^ y) * 4)[c] for x in range(side) for c in range(3))
                    for y in range(side))
    chunk = lambda kind, data: (struct.pack(">I", len(data)) + kind + data +
                                struct.pack(">I", zlib.crc32(kind + data)))
    (folder / "ball.png").write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0)) +
        chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def instructions(program, folder, name, arguments):
    out = [] if arguments[0] == "inspect" else ["-o", name]
    run = subprocess.run(
        ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null",
         program, *arguments, *out], cwd=folder, capture_output=True, text=True)
    found = re.search(r"I +refs: +([\d,]+)", run.stderr)
    if run.returncode != 0 or not found:
        sys.exit("%s: exit code %d\n%s" % (name, run.returncode, run.stderr))
    return int(found[1].replace(",", ""))


def compiler_of(program):
    """As the program's own comment section says."""
    found = re.search(rb"GCC: \([^)]*\) ([\d.]+)", pathlib.Path(program).read_bytes())
    return "GCC " + found[1].decode() if found else "another"


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    recorded = json.loads(RECORD.read_text()) if RECORD.is_file() else {}
    write = "--write" in sys.argv[2:]
    compiler = compiler_of(program)
    if not shutil.which("valgrind") or (not write and recorded.get("compiler") != compiler):
        print("skipped: counts are for valgrind and", recorded.get("compiler"))
        return SKIPPED
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_model(folder)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            runs = {job: pool.submit(instructions, program, folder, job, arguments)
                    for job, arguments in JOBS.items()}
            counts = {job: run.result() for job, run in runs.items()}
    more = 0
    for job, count in counts.items():
        before = recorded.get("instructions", {}).get(job, count)
        share = count / before - 1
        more += share > MOST_MORE
        print("%-22s %6.0f million instructions, %+.1f %%" % (job, count / 1e6, 100 * share))
    if write:
        RECORD.write_text(json.dumps({"compiler": compiler, "instructions": counts}, indent=2) + "\n")
        return 0
    if more:
        print("%d of %d jobs take over %.0f %% more instructions than tests/counts/counts.json says; if that is "
              "meant, record it: tests/counts/counts.py PROGRAM --write" %
              (more, len(counts), 100 * MOST_MORE))
    return 1 if more else 0


if __name__ == "__main__":
    sys.exit(main())
