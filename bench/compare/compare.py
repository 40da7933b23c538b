#!/usr/bin/env python3
"""Two versions of hydrodip side by side: the same bytes, the same speed? See ./dev bench compare."""

import argparse
import concurrent.futures
import fnmatch
import hashlib
import json
import os
import pathlib
import re
import shutil
import statistics
import struct
import subprocess
import sys
import time

import jobs
import models

HERE = pathlib.Path(__file__).resolve()
# Times and memory, which no two runs share.
UNSTEADY_KEYS = {"seconds", "peak_memory_bytes"}
# Holds times; its data are those of the other files.
UNCOMPARED = {"report.html"}


class Refusal(Exception):
    pass


# ---- programs -------------------------------------------------------------------------------


class Version:
    """A tree, built here, or a folder of build results, taken as it is."""

    def __init__(self, side, folder, benchmarks):
        self.side = side
        path = pathlib.Path(folder).resolve()
        self.build = path if (path / "hydrodip").is_file() else path / "build" / "bench"
        if self.build != path:
            build(path, ["hydrodip"] + (["bench_dip_step"] if benchmarks else []))
        self.program = self.build / "hydrodip"
        self.dip_step = self.build / "bench" / "bench_dip_step"
        self.sum = sha256(self.program.read_bytes())


def build(tree, targets):
    if not (tree / "CMakePresets.json").is_file():
        raise Refusal("%s is neither a tree of hydrodip nor a folder with the program" % tree)
    for command in (["cmake", "--preset", "bench", "--log-level=WARNING"],
                    ["cmake", "--build", "--preset", "bench", "--parallel", str(os.cpu_count()),
                     "--target"] + targets):
        if subprocess.run(command, cwd=tree).returncode != 0:
            raise Refusal("%s could not be built" % tree)


def sha256(data):
    return hashlib.sha256(data).hexdigest()


# ---- models ---------------------------------------------------------------------------------


def prepare_models(folder, old, spot):
    """Whatever the jobs read; from the old program where a program has to make it."""
    shutil.rmtree(folder, ignore_errors=True)
    for name in ("samples", "formats", "scans"):
        (folder / name).mkdir(parents=True)
    models.write_models(folder / "formats")
    jobs.write_settings(folder)
    for name in ("sphere", "pyramid", "ellipsoid", "mask", "box"):
        made = subprocess.run([old.program, "sample", name, "-o", folder / "samples", "--quiet"],
                              stdout=subprocess.DEVNULL)
        if made.returncode != 0:
            raise Refusal("the old program does not make the sample " + name)
    made = subprocess.run([old.program, "calibrate", "synth", "sphere", "-o", folder / "scans",
                           "--quiet", "--film", "110x110", "--set", "film.elements=1000", "--set",
                           "dip.step_mm=1", "--set", "material.ink_stiffness_ratio=30", "--noise",
                           "0.03"], stdout=subprocess.DEVNULL)
    if made.returncode != 0:
        raise Refusal("the old program does not make synthetic scans")
    if spot:
        shutil.copytree(spot, folder / "spot")
    digest = hashlib.sha256()
    for file in sorted(f for f in folder.rglob("*") if f.is_file()):
        digest.update(str(file.relative_to(folder)).encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()


def enter(folder, model_folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "models").symlink_to(model_folder)


# ---- files ----------------------------------------------------------------------------------


def steady(value):
    """Without what no two runs share."""
    if isinstance(value, dict):
        return {k: steady(v) for k, v in value.items() if k not in UNSTEADY_KEYS}
    if isinstance(value, list):
        return [steady(v) for v in value]
    return value


def content(name, data):
    """What of a file has to be equal: parsed JSON without times, else the bytes."""
    if name.endswith(".json") or "stdout" in name:
        try:
            return steady(json.loads(data))
        except ValueError:
            return data
    if name.endswith(".jsonl"):
        return b"\n".join(sorted(data.splitlines()))  # in whichever order threads came to an end
    return data


def hash_of(value):
    return sha256(value if isinstance(value, bytes) else json.dumps(value, sort_keys=True).encode())


class Differences:
    """Between two JSON values; keys that only the new one has are no difference but listed."""

    def __init__(self, old, new):
        self.added = []
        self.found = []
        self.compare("", old, new)

    def compare(self, where, old, new):
        if isinstance(old, dict) and isinstance(new, dict):
            for key in old:
                if key in new:
                    self.compare(where + "." + key, old[key], new[key])
                else:
                    self.found.append("%s.%s is gone" % (where, key))
            self.added += [where + "." + key for key in new if key not in old]
        elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
            for n, (one, other) in enumerate(zip(old, new)):
                self.compare("%s[%d]" % (where, n), one, other)
        elif old != new or type(old) is not type(new):
            self.found.append("%s: %s -> %s" % (where, shown(old), shown(new)))


def shown(value):
    text = json.dumps(value)
    return text if len(text) <= 60 else text[:57] + "..."


def film_vertices(data):
    """Vertices of a film.ply: x y z u v state area_ratio stretch."""
    header, _, body = data.partition(b"end_header\n")
    count = next(int(line.split()[2]) for line in header.splitlines()
                 if line.startswith(b"element vertex"))
    return list(struct.iter_unpack("<5fB2f", body[:29 * count]))


def film_difference(old, new):
    try:
        pairs = list(zip(film_vertices(old), film_vertices(new), strict=True))
    except (ValueError, StopIteration, struct.error):
        return "another number of vertices"
    moved = [max(abs(a[k] - b[k]) for k in range(3)) for a, b in pairs]
    states = sum(a[5] != b[5] for a, b in pairs)
    return "%d of %d vertices moved, by %.3g mm at most; %d states differ" % (
        sum(m > 0 for m in moved), len(pairs), max(moved), states)


# ---- hashes ---------------------------------------------------------------------------------


def run_job(version, name, commands, folder, model_folder, model_sum):
    """Runs a job, or takes what this very program has already made of it."""
    runner = sha256(HERE.read_bytes())
    key = sha256(json.dumps([runner, version.sum, model_sum, commands]).encode())
    stamp = folder / "key"
    if stamp.is_file() and stamp.read_text() == key:
        return
    enter(folder, model_folder)
    for n, command in enumerate(commands, start=1):
        done = subprocess.run([version.program] + command, cwd=folder, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE)
        (folder / ("stdout-%d" % n)).write_bytes(done.stdout)
        with open(folder / "exit-codes", "a") as codes:
            codes.write("%d\n" % done.returncode)
        if done.returncode != 0:
            (folder / "stderr").write_bytes(done.stderr)
            break
    stamp.write_text(key)


def files_of(folder):
    return {str(file.relative_to(folder)): file
            for file in sorted(folder.rglob("*"))
            if file.is_file() and file.name != "key" and file.name not in UNCOMPARED and
            "models" not in file.relative_to(folder).parts}


def compare_job(name, old, new):
    """Rows (file, old hash, new hash, verdict, notes) for all files of a job."""
    rows = []
    files, others = files_of(old), files_of(new)
    for file in sorted(files.keys() | others.keys()):
        if file not in others or file not in files:
            side = "old" if file in files else "new"
            rows.append((file, "-" if side == "new" else "there", "-" if side == "old" else "there",
                         "NO", ["only the %s program writes it" % side]))
            continue
        one = content(file, files[file].read_bytes())
        other = content(file, others[file].read_bytes())
        verdict, notes = "yes", []
        if isinstance(one, bytes) or isinstance(other, bytes):
            if one != other:
                verdict = "NO"
                if file.endswith("film.ply"):
                    notes.append(film_difference(one, other))
        else:
            differences = Differences(one, other)
            notes = ["new: " + key for key in differences.added]
            if differences.found:
                verdict = "NO"
                notes = differences.found + notes
        fault = explanation(name, file)
        if verdict == "NO" and fault:
            verdict = "explained"
            notes.insert(0, fault)
        rows.append((file, hash_of(one)[:12], hash_of(other)[:12], verdict, notes))
    return rows


def explanation(job, file):
    for (jobs_named, files_named), fault in jobs.EXPLAINED.items():
        if fnmatch.fnmatch(job, jobs_named) and fnmatch.fnmatch(file, files_named):
            return fault
    return None


def compare_hashes(old, new, options, work, model_folder, model_sum):
    chosen = {name: commands
              for name, commands in jobs.compared_jobs(bool(options.spot)).items()
              if fnmatch.fnmatch(name, options.only)}
    with concurrent.futures.ThreadPoolExecutor(options.parallel) as pool:
        runs = {}
        for name, commands in chosen.items():
            runs[name] = [pool.submit(run_job, v, name, commands, work / v.side / name, model_folder,
                                      model_sum) for v in (old, new)]
        table, unequal, explained, files, failures = [], 0, 0, 0, 0
        for name in chosen:
            for run in runs[name]:
                run.result()
            rows = compare_job(name, work / old.side / name, work / new.side / name)
            codes = (work / old.side / name / "exit-codes").read_text().split()
            failed = "" if set(codes) == {"0"} else ", FAILED with exit code %s" % codes[-1]
            failures += failed != ""
            bad = [row for row in rows if row[3] == "NO"]
            print("%-20s %2d files, %s%s" %
                  (name, len(rows), "all equal" if not bad else "%d DIFFER" % len(bad), failed),
                  flush=True)
            for file, _, _, verdict, notes in rows:
                if verdict != "yes":
                    print("    %s: %s" % (file, verdict))
                for note in notes[:options.notes]:
                    print("        " + note)
                if len(notes) > options.notes:
                    print("        and %d more" % (len(notes) - options.notes))
            files += len(rows)
            unequal += len(bad)
            explained += sum(row[3] == "explained" for row in rows)
            table += [(name,) + row[:4] for row in rows]
    lines = ["| job | file | old | new | equal |", "|---|---|---|---|---|"]
    lines += ["| %s |" % " | ".join(row) for row in table]
    (work / "hashes.md").write_text("\n".join(lines) + "\n")
    print("%d jobs, %d files: %d differ, %d explained; %d jobs failed; the table is %s" %
          (len(chosen), files, unequal, explained, failures, work / "hashes.md"))
    return unequal == 0


# ---- times ----------------------------------------------------------------------------------


def timed(command, folder, log):
    """Seconds of all threads together, seconds by the clock, and MB at most."""
    start = time.monotonic()
    with open(log, "wb") as output:
        process = subprocess.Popen(command, cwd=folder, stdout=output, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise Refusal("%s: exit code %d, see %s" % (" ".join(map(str, command)), process.returncode,
                                                    log))
    return usage.ru_utime + usage.ru_stime, time.monotonic() - start, usage.ru_maxrss / 1024


def dip_step_figures(text):
    """What bench_dip_step says, by name, in ms."""
    figures = {}
    for line in text.splitlines():
        whole = re.match(r"dip_step_40k: ours ([\d.]+) ms, direct ([\d.]+) ms", line)
        growth = re.match(r" +(\d+) +([\d.]+) +[\d.]+$", line)
        hard = re.match(r" +squares of +([\d.]+) mm: ([\d.]+) against", line)
        if whole:
            figures["step, 40k triangles"] = float(whole[1])
            figures["the same, direct solver"] = float(whole[2])
        elif growth:
            figures["step, %s triangles" % growth[1]] = float(growth[2])
        elif hard:
            figures["step, hard ink, squares of %s mm" % hard[1]] = float(hard[2])
    return figures


def ratios(olds, news):
    """Columns of a table: medians, and the median and limits of new over old, turn by turn."""
    of_turns = [new / old for old, new in zip(olds, news)]
    return ["%.3g" % statistics.median(olds), "%.3g" % statistics.median(news),
            "%.3f (%.2f to %.2f)" % (statistics.median(of_turns), min(of_turns), max(of_turns))]


def take_turns(old, new, turns, run):
    """Results of run(version), turn by turn, so that a slow minute of the machine meets both."""
    results = {old.side: [], new.side: []}
    for turn in range(turns):
        for version in (old, new) if turn % 2 == 0 else (new, old):
            results[version.side].append(run(version))
    return results[old.side], results[new.side]


def compare_times(old, new, options, work, model_folder):
    chosen = {name: command for name, command in jobs.timed_jobs(bool(options.spot)).items()
              if fnmatch.fnmatch(name, options.only)}
    folder = work / "times"
    print("\nload %.1f on %d cores, %d busy processes beside; medians of %d turns" %
          (os.getloadavg()[0], os.cpu_count(), options.busy, options.turns))
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"])
            for _ in range(options.busy)]
    try:
        if chosen:
            print("| job | old, CPU s | new, CPU s | new/old (turn by turn) | old, wall s | new, wall s |"
                  " new/old | old, MB | new, MB | new/old |\n|---|---|---|---|---|---|---|---|---|---|")
        for name, command in chosen.items():

            def run(version):
                enter(folder, model_folder)
                return timed([version.program] + command, folder, work / "times.log")

            olds, news = take_turns(old, new, options.turns, run)
            cells = sum((ratios([o[k] for o in olds], [n[k] for n in news]) for k in (0, 1, 2)), [])
            print("| %s | %s |" % (name, " | ".join(cells)), flush=True)

        unbuilt = [str(v.build) for v in (old, new) if not v.dip_step.is_file()]
        if unbuilt:
            print("\nbench_dip_step is left out: it is not in %s" % " and ".join(unbuilt))
        elif fnmatch.fnmatch("bench_dip_step", options.only):

            def figures(version):
                log = work / ("bench_dip_step-%s.log" % version.side)
                # The direct solver beside busy processes takes hours.
                timed([version.dip_step] + (["growth"] if options.busy else []), work, log)
                return dip_step_figures(log.read_text())

            olds, news = take_turns(old, new, options.turns, figures)
            print("\n| bench_dip_step | old, wall ms | new, wall ms | new/old (turn by turn) |\n"
                  "|---|---|---|---|")
            for name in olds[0]:
                if name in news[0]:
                    cells = ratios([o[name] for o in olds], [n[name] for n in news])
                    print("| %s | %s |" % (name, " | ".join(cells)))
    finally:
        for process in busy:
            process.kill()
            process.wait()


# ---- command line ---------------------------------------------------------------------------


def read_options():
    parser = argparse.ArgumentParser(prog="./dev bench compare", description=__doc__)
    parser.add_argument("old", metavar="OLD", help="tree, built here, or folder with the program")
    parser.add_argument("new", metavar="NEW", nargs="?", default=HERE.parents[2],
                        help="the same (default: this tree)")
    parser.add_argument("--hashes", action="store_true", help="compare files only")
    parser.add_argument("--times", action="store_true", help="compare times only")
    parser.add_argument("--spot", metavar="DIR", default=os.environ.get("HYDRODIP_SPOT"),
                        help="folder of Keenan Crane's model Spot: spot.obj and spot_texture.png "
                             "(default: $HYDRODIP_SPOT; else without it)")
    parser.add_argument("--only", metavar="PATTERN", default="*", help="only these jobs, as in 'spot*'")
    parser.add_argument("--work", metavar="DIR", default="out/compare",
                        help="where results go and are kept (default: out/compare)")
    parser.add_argument("--parallel", metavar="N", type=int, default=os.cpu_count(),
                        help="jobs at once while comparing files (default: all cores)")
    parser.add_argument("--notes", metavar="N", type=int, default=8,
                        help="differences told per file (default: 8)")
    parser.add_argument("--turns", metavar="N", type=int, default=5,
                        help="runs of each program while timing (default: 5)")
    parser.add_argument("--busy", metavar="N", type=int, default=0,
                        help="busy processes beside the timed ones (default: none)")
    return parser.parse_args()


def main():
    options = read_options()
    both = options.hashes == options.times
    old, new = (Version(side, folder, both or options.times)
                for side, folder in (("old", options.old), ("new", options.new)))
    work = pathlib.Path(options.work).resolve()
    model_folder = work / "models"
    model_sum = prepare_models(model_folder, old, options.spot)
    equal = True
    if both or options.hashes:
        equal = compare_hashes(old, new, options, work, model_folder, model_sum)
    if both or options.times:
        compare_times(old, new, options, work, model_folder)
    return 0 if equal else 1


try:
    sys.exit(main())
except Refusal as refusal:
    print("compare: %s" % refusal, file=sys.stderr)
    sys.exit(2)
