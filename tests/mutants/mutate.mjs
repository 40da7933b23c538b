// Small mistakes that a person could make, put into a copy of the sources all at once, each behind
// a number that HYDRODIP_MUTANT picks: one build, then the tests that could notice, once per
// mistake. Usage: node mutate.mjs [FOLDER...]; see HACKING.md.
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { cpus } from "node:os";
import { dirname, join } from "node:path";

const here = import.meta.dirname ?? dirname(new URL(import.meta.url).pathname);
const root = join(here, "..", "..");
const work = join(root, "build", "mutants");
const tree = join(work, "tree");
const build = join(work, "build");

// ---- the list ----

// FOLDER.txt: lines "tests: NAME..." and "file: PATH" hold until the next such line; a mutant is
// "= what it means", "- as it is" and "+ as it would be" (each may go on on further such lines), and
// perhaps "! why nobody could notice". "As it is" is a whole expression, or a whole statement with its
// semicolon; where that alone is not to be found once, "before @@it@@ after". How it is broken into
// lines does not matter.
function readList(folder) {
  const mutants = [];
  let tests = [], file = "", mutant = null;
  readFileSync(join(here, `${folder}.txt`), "utf8").split("\n").forEach((line, n) => {
    const value = line.slice(2).trim();
    if (line.startsWith("tests: ")) tests = line.slice(7).trim().split(/\s+/);
    else if (line.startsWith("file: ")) file = line.slice(6).trim();
    else if (line.startsWith("= ")) {
      mutant = { folder, tests, file, line: n + 1, meaning: value, before: "", after: "", argued: "" };
      mutants.push(mutant);
    } else if (line.startsWith("-")) mutant.before += (mutant.before && "\n") + value;
    else if (line.startsWith("+")) mutant.after += (mutant.after && "\n") + value;
    else if (line.startsWith("! ")) mutant.argued += (mutant.argued && " ") + value;
    else if (line.trim() && !line.startsWith("#"))
      throw new Error(`${folder}.txt:${n + 1}: neither tests, file, =, -, +, ! nor #`);
  });
  return mutants;
}

// Stays the same when others come and go, so that little has to be built again.
function numberOf(text) {
  let hash = 2166136261;
  for (const c of text) hash = Math.imul(hash ^ c.codePointAt(0), 16777619) >>> 0;
  return 1 + (hash % 2147483646);
}

// ---- the copy ----

// Finds a piece of source however it is broken into lines.
function pattern(source) {
  const tokens = source.match(/[A-Za-z_0-9.]+|"(?:[^"\\]|\\.)*"|\S/g);
  return new RegExp(tokens.map((t) => t.replace(/[.*+?^${}()|[\]\\]/g, "\\$&")).join("\\s*"), "g");
}

function isStatement(piece) { return /[;}]\s*$/.test(piece); }

// Whether what comes behind this is a statement, not the end of one.
function beginsStatement(source) { return /(?:[;{}):]|\belse|\/\/.*|\*\/)\s*$/.test(source); }

// Begins with no keyword, and has no comma outside brackets.
function isExpression(piece) {
  if (/^\s*(if|for|while|return|else)\b/.test(piece)) return false;
  let depth = 0;
  for (const c of piece.replace(/"(?:[^"\\]|\\.)*"/g, "")) {
    if ("([{".includes(c)) ++depth;
    if (")]}".includes(c)) --depth;
    if (c === "," && depth === 0) return false;
  }
  return true;
}

// What it declares would be gone behind the choice between it and its mutant.
function declares(statement) { return /^\s*(const|constexpr|auto|std::[\w:]+(<[^;=(]*>)?&?)\s+[\w:<>,&* ]*?\w+\s*(=|\{|\()/.test(statement); }

// Where in a source a mutant's piece is; nothing if it is not found, or not once.
function placeOf(source, mutant) {
  const [first, middle, last] = mutant.before.includes("@@") ? mutant.before.split("@@") : ["", mutant.before, ""];
  const found = [...source.matchAll(pattern(first + middle + last))];
  if (found.length !== 1) return null;
  let from = found[0].index;
  if (first.trim()) from += pattern(first).exec(source.slice(from))[0].length;
  from += /^\s*/.exec(source.slice(from))[0].length;
  if (isStatement(middle) ? !beginsStatement(source.slice(0, from)) || declares(middle) : !isExpression(middle)) return null;
  const rest = pattern(middle).exec(source.slice(from));
  return rest && rest.index === 0 ? { from, to: from + rest[0].length, mutant } : null;
}

// The source from..to with the edits that lie in it; edits of one piece, or of a piece of a piece,
// stand inside each other.
function edited(source, from, to, edits) {
  const outer = edits.filter((e) => !edits.some((o) => o.from <= e.from && o.to >= e.to && o.to - o.from > e.to - e.from))
    .sort((a, b) => a.from - b.from);
  let text = "", at = from;
  for (let n = 0; n < outer.length;) {
    const { from: begin, to: end } = outer[n];
    const inside = edits.filter((e) => e.from >= begin && e.to <= end && e.to - e.from < end - begin);
    let piece = edited(source, begin, end, inside);
    for (; n < outer.length && outer[n].from === begin && outer[n].to === end; ++n) {
      const { number, after } = outer[n].mutant;
      piece = isStatement(piece) ? `if (hydrodip_mutant == ${number}) { ${after} } else { ${piece} }`
                          : `(hydrodip_mutant == ${number} ? (${after}) : (${piece}))`;
    }
    text += changeable(source, at, begin) + piece;
    at = end;
  }
  return text + source.slice(at, to);
}

// What stands before a piece: a constant that is picked when the program starts is none for the
// compiler.
function changeable(source, at, begin) {
  const line = Math.max(at, source.lastIndexOf(";", begin), source.lastIndexOf("\n\n", begin), source.lastIndexOf("{\n", begin));
  return source.slice(at, line) + source.slice(line, begin).replace(/(static |inline )?constexpr /, (_, kind) =>
    kind === "static " ? "static inline const " : kind ? "inline const " : "const ");
}

const picker = `#pragma once
#include <cstdlib>
inline const int hydrodip_mutant = std::getenv("HYDRODIP_MUTANT") ? std::atoi(std::getenv("HYDRODIP_MUTANT")) : 0;
`;

function writeIfNew(path, content) {
  if (existsSync(path) && readFileSync(path).equals(Buffer.from(content))) return;
  mkdirSync(dirname(path), { recursive: true });
  writeFileSync(path, content);
}

function findPlaces(mutants) {
  for (const mutant of mutants) {
    const path = join(root, mutant.file);
    mutant.place = existsSync(path) ? placeOf(readFileSync(path, "utf8"), mutant) : null;
  }
}

// Leaves files that are already right alone, so that the next build is short.
function makeCopy(mutants) {
  const list = execFileSync("git", ["ls-files", "-co", "--exclude-standard"], { cwd: root, encoding: "utf8" });
  const files = new Set(list.split("\n").filter((f) => f && existsSync(join(root, f))));
  const edits = new Map();  // per file
  for (const { file, place } of mutants)
    if (place) edits.set(file, [...(edits.get(file) ?? []), place]);
  for (const file of files) {
    const content = readFileSync(join(root, file));
    const source = edits.has(file) ? content.toString() : "";
    writeIfNew(join(tree, file), edits.has(file)
      ? `#include "base/mutant.h"\n${edited(source, 0, source.length, edits.get(file))}` : content);
  }
  writeIfNew(join(tree, "src/base/mutant.h"), picker);
  if (!existsSync(tree)) return;
  const old = execFileSync("find", ["src", "tests", "apps", "-type", "f"], { cwd: tree, encoding: "utf8" });
  for (const file of old.split("\n"))
    if (file && !files.has(file) && file !== "src/base/mutant.h") rmSync(join(tree, file));
}

function buildTests(names) {
  const run = (args) => {
    const { status } = spawnSync("cmake", args, { stdio: "inherit", cwd: root });
    if (status !== 0) process.exit(2);
  };
  run(["-S", tree, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DHYDRODIP_WERROR=OFF",
       `-DHYDRODIP_NPM_DIR=${join(root, "build", "npm")}`, "--log-level=WARNING"]);
  run(["--build", build, "--parallel", `${cpus().length}`, "--target", ...names.map((n) => `test_${n}`)]);
}

// ---- the tests ----

// Runs a test program; how it ended, and after how many seconds.
function runTests(name, filter, number, limit_s, slot) {
  return new Promise((resolve) => {
    const start = process.hrtime.bigint();
    const folder = join(work, `temporary-${slot}`);
    mkdirSync(folder, { recursive: true });
    const child = spawn(join(build, "tests", `test_${name}`), [`--gtest_filter=${filter}`, "--gtest_fail_fast"], {
      env: { ...process.env, HYDRODIP_MUTANT: `${number}`, TMPDIR: folder, TEST_TMPDIR: folder, GTEST_BRIEF: "1" },
      stdio: ["ignore", "pipe", "ignore"], cwd: folder });
    let said = "", late = false;
    child.stdout.on("data", (data) => { said = (said + data).slice(-100000); });
    const timer = setTimeout(() => { late = true; child.kill("SIGKILL"); }, 1000 * limit_s);
    child.on("close", (code) => {
      clearTimeout(timer);
      const failed = /\[  FAILED  \] (\S+?)(,| \(|\n)/.exec(said);
      resolve({ passed: code === 0 && !late, seconds: Number(process.hrtime.bigint() - start) / 1e9,
                by: late ? `${name}: no end` : failed ? `${name}.${failed[1]}` : `${name}: crash` });
    });
  });
}

// Quick tests first, and slow ones only where those see nothing.
const filters = ["-*Slow*:*/mask*:*.Mask*:RunSheet*", "*Slow*:RunSheet*"];

async function inParallel(items, work) {
  let next = 0;
  await Promise.all(cpus().map(async (_, slot) => {
    while (next < items.length) await work(items[next++], slot);
  }));
}

async function judge(mutants, names) {
  const limits = new Map();
  for (const name of names)
    for (const filter of filters) {
      const sound = await runTests(name, filter, 0, 1800, 0);
      if (!sound.passed) {
        console.error(`mutate: ${sound.by} fails without any mutant`);
        process.exit(2);
      }
      limits.set(name + filter, 20 + 10 * sound.seconds);
    }
  let done = 0;
  await inParallel(mutants, async (mutant, slot) => {
    for (const filter of filters)
      for (const name of mutant.tests) {
        if (mutant.by) break;
        const run = await runTests(name, filter, mutant.number, limits.get(name + filter), slot);
        if (!run.passed) mutant.by = run.by;
      }
    const verdict = mutant.by ? `noticed by ${mutant.by}` : mutant.argued ? "unnoticed, as argued" : "NOT NOTICED";
    console.log(`${++done}/${mutants.length} ${mutant.folder}.txt:${mutant.line} ${mutant.meaning} ${verdict}`);
  });
}

// ---- the table ----

const kLeastShare = 0.95;
const kAllOf = ["rig", "sheet"];

function report(folders, mutants) {
  let good = true;
  console.log("\nfolder      mutants  noticed  equivalent  share");
  const row = (name, list) => {
    const argued = list.filter((m) => m.argued && !m.by).length;
    const counted = list.length - argued, noticed = list.filter((m) => m.by).length;
    const share = counted > 0 ? noticed / counted : 1;
    console.log(`${name.padEnd(12)}${`${list.length}`.padStart(6)}${`${noticed}`.padStart(9)}` +
                `${`${argued}`.padStart(12)}${`${(100 * share).toFixed(1)} %`.padStart(9)}`);
    return share;
  };
  for (const folder of folders)
    if (row(folder, mutants.filter((m) => m.folder === folder)) < 1 && kAllOf.includes(folder)) good = false;
  if (row("all", mutants) < kLeastShare) good = false;
  for (const mutant of mutants)
    if (!mutant.by && !mutant.argued)
      console.log(`not noticed: ${mutant.folder}.txt:${mutant.line} ${mutant.file}: ${mutant.meaning}`);
  return good;
}

const all = readdirSync(here).filter((f) => f.endsWith(".txt")).map((f) => f.slice(0, -4)).sort();
const folders = process.argv.length > 2 ? process.argv.slice(2) : all;
for (const folder of folders)
  if (!all.includes(folder)) {
    console.error(`mutate: there are no mutants of '${folder}'; there are: ${all.join(" ")}`);
    process.exit(2);
  }
// All of them go into the copy, whichever are asked for, so that it need not be built again.
const everything = all.flatMap(readList);
for (const mutant of everything) mutant.number = numberOf(`${mutant.file} ${mutant.before} ${mutant.after}`);
findPlaces(everything);
const mutants = everything.filter((m) => folders.includes(m.folder));
const stale = mutants.filter((m) => !m.place);
for (const mutant of stale)
  console.log(`no longer fits: ${mutant.folder}.txt:${mutant.line} ${mutant.file}: ${mutant.before}`);
// HYDRODIP_MUTATE=check: only whether they still fit; =run: with the programs that are built already.
const only = process.env.HYDRODIP_MUTATE;
if (only === "check") process.exit(stale.length > 0 ? 1 : 0);
makeCopy(everything);
const fitting = mutants.filter((m) => m.place);
const names = [...new Set(fitting.flatMap((m) => m.tests))];
if (only !== "run") buildTests(names);
await judge(fitting, names);
process.exit(report(folders, fitting) && stale.length === 0 ? 0 : 1);
