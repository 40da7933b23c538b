#!/bin/sh
# hydrodip rig from outside: the sheet, the plan, a guided dip on an emulated stage, Ctrl-C in
# mid-dip, refusals. Usage: sh rig.sh HYDRODIP STAGE_EMULATOR
. "$(dirname "$0")/common.sh"
emulator=$2

start_stage() {
  "$emulator" zaber 5 > port.txt & # near its home, so that it is there soon
  stage=$!
  until [ -s port.txt ]; do sleep 0.1; done
  port=$(cat port.txt)
}
trap 'kill "$stage" 2>/dev/null; rm -rf "$work"' EXIT

write_colored colored.ply
# shellcheck disable=SC2086
"$hydrodip" print colored.ply $quick -o job --quiet > /dev/null || fail "print"

expect 0 'wrote job/run-sheet.pdf' rig sheet job
pdfinfo job/run-sheet.pdf | grep -q 'Pages: *2' || fail "the run sheet has not two pages"
rm -f colored.ply
expect 0 'wrote job/other.pdf' rig sheet job -o job/other.pdf --paper letter

expect 2 'rig sheet' rig
expect 0 'rig guide' rig --help
expect 2 'did you mean' rig shet job
expect 2 'there is no such folder' rig sheet nowhere
expect 2 'job' rig guide
expect 2 'approach' rig stage dance
expect 2 'a jog goes; leave it out' rig stage home --by 5 --port /dev/no-such-port
expect 2 '--port' rig stage status
expect 2 'no-such-port' rig stage status --port /dev/no-such-port
expect 2 'not a serial port' rig stage status --port job/report.json
expect 0 'Nothing was moved' rig stage dip job --dry-run
"$hydrodip" rig stage dip job --dry-run --json --set stage.water_mm=400 > plan.json || fail 'the plan as JSON'
python3 - plan.json << 'PY' || fail "the plan as JSON: $(cat plan.json)"
import json, sys
plan = json.load(open(sys.argv[1]))
assert plan['command'] == 'rig stage' and plan['action'] == 'dip', plan
assert [move['phase'] for move in plan['movements']] == ['approach', 'dip', 'dwell', 'retract']
dip, dwell = plan['movements'][1:3]
assert dip['from_mm'] > 0 > dip['to_mm'] and abs(dip['from_position_mm'] - 400) == dip['from_mm'], dip
assert abs(dip['seconds'] - 60 * (dip['from_mm'] - dip['to_mm']) / dip['mm_per_min']) < 1e-9, dip
assert dwell['mm_per_min'] is None and dwell['from_mm'] == dwell['to_mm'], dwell
PY
expect 3 'beyond the stage' rig stage dip job --dry-run --set stage.travel_mm=750 --set stage.water_mm=749.9
expect 0 'Nothing was moved' rig stage dip job --dry-run --set stage.travel_mm=750 --set stage.water_mm=400

start_stage
expect 0 'not homed' rig stage status --port "$port"
expect 2 'water level' rig stage dip job --port "$port" --yes
expect 130 'nobody answers' rig stage home --port "$port"
expect 0 'not homed' rig stage status --port "$port"

fast='--set process.soak_min_s=0 --set process.activator_g=0 --set process.activator_wait_s=0
      --set process.dwell_s=0 --set stage.clearance_mm=6 --set process.speed_mm_per_min=300
      --set stage.travel_mm_per_min=900 --set process.lift_mm_per_min=900'
# shellcheck disable=SC2086
printf '%s\n' '' '' yes 20 here 28 '' '' 10 '' 10 yes '' yes 28 'all well' |
  "$hydrodip" rig guide job --port "$port" $fast > said.txt 2> asked.txt ||
  fail "the guided dip: $(cat asked.txt)"
grep -q 'trace.csv' said.txt || fail "the guide does not say what it wrote: $(cat said.txt)"
grep -q '"outcome":"done"' job/rig-1/log.jsonl || fail "the log has no end"
grep -q '^dip,' job/rig-1/trace.csv || fail "the trace has no dip"

# Ctrl-C in mid-dip: stopped, said so, exit code 130. Slow enough to catch.
"$hydrodip" rig stage dip job --port "$port" --yes --set process.speed_mm_per_min=20 \
  --set stage.clearance_mm=6 > said.txt 2> asked.txt &
dip=$!
until grep -q '"phase":"dip"' job/rig-2/log.jsonl 2> /dev/null || ! kill -0 "$dip" 2> /dev/null; do sleep 0.1; done
kill -s INT "$dip"
wait "$dip"
code=$?
[ "$code" -eq 130 ] || fail "Ctrl-C: exit code $code: $(cat asked.txt)"
grep -q 'stands still at' asked.txt || fail "Ctrl-C: does not say where: $(cat asked.txt)"
grep -q '"outcome":"cancelled".*"stage_stands_still":true' job/rig-2/log.jsonl ||
  fail "Ctrl-C: the log does not say that the stage stands still"
expect 0 'homed, standing still' rig stage status --port "$port"
finish
