#!/bin/sh
# Printer calibration as docs/colour.md describes it, with Argyll's fakeread in place of a person
# with an instrument: chart, reading, profile, a job that uses the profile, files that carry it.
. "$(dirname "$0")/common.sh"

for tool in targen printtarg fakeread colprof; do
  command -v "$tool" > /dev/null || { echo "needs Argyll's $tool: skipped"; exit 77; }
done
write_colored colored.ply

# The printer that fakeread plays: the profile that hydrodip embeds when it has no other.
# shellcheck disable=SC2086
"$hydrodip" print colored.ply $quick --set ink.rounds_max=1 -o first > /dev/null || fail 'first print'
extracticc first/print.tif printer.icc > /dev/null 2>&1 || fail 'print.tif carries no profile'

targen -d4 -l300 -e4 -s9 -g9 -m3 -f0 film > targen.txt || fail 'targen'
printtarg -t150 -pA4 -ii1 film > printtarg.txt || fail 'printtarg'
[ -s film.tif ] || fail 'printtarg made no chart'
fakeread printer.icc film > fakeread.txt || fail 'fakeread'
colprof -ql -kz -l300 -D film-printer film > colprof.txt || fail 'colprof'
[ -s film.icc ] || fail 'colprof made no profile'

# shellcheck disable=SC2086
"$hydrodip" print colored.ply $quick --set ink.rounds_max=1 --printer-profile film.icc \
  --set print.color=cmyk -o out > /dev/null || fail 'print --printer-profile'
extracticc out/print.tif embedded.icc > /dev/null 2>&1 || fail 'no profile in print.tif'
cmp film.icc embedded.icc || fail 'print.tif carries another profile'
grep -q 'film-printer' out/report.json || fail 'the report does not name the profile'
cmp -s first/print.tif out/print.tif && fail 'the profile changes nothing'
grep -q OutputIntent out/print.pdf || fail 'print.pdf has no output intent'

# An RGB printer's profile: print.pdf carries it, and there are no inks to send to a RIP.
targen -d3 -e4 -s9 -g9 -m3 -f0 rgb > rgb-targen.txt || fail 'targen -d3'
printtarg -t150 -pA4 -ii1 rgb > rgb-printtarg.txt || fail 'printtarg of RGB'
fakeread /usr/share/color/argyll/ref/sRGB.icm rgb > rgb-fakeread.txt || fail 'fakeread of RGB'
colprof -ql -D rgb-printer rgb > rgb-colprof.txt || fail 'colprof of RGB'
# shellcheck disable=SC2086
"$hydrodip" print colored.ply $quick --set ink.rounds_max=1 --printer-profile rgb.icc -o rgb-out \
  > /dev/null || fail 'print with an RGB profile'
pdfimages -list rgb-out/print.pdf | awk 'NR == 3' | grep -q ' icc  *3 ' ||
  fail "print.pdf's image has no RGB profile: $(pdfimages -list rgb-out/print.pdf)"
cmp -s first/print.pdf rgb-out/print.pdf && fail 'the RGB profile changes nothing'
"$hydrodip" print colored.ply --printer-profile rgb.icc --set print.color=cmyk -o refused \
  2> rgb-refused.txt
[ $? -eq 2 ] || fail 'an RGB profile for CMYK'
[ "$(wc -l < rgb-refused.txt)" -eq 1 ] || fail "not one sentence: $(cat rgb-refused.txt)"

# What is no printer's profile is refused in one sentence.
"$hydrodip" print colored.ply --printer-profile colored.ply -o refused 2> refused.txt
[ $? -eq 2 ] || fail 'a model as profile'
[ "$(wc -l < refused.txt)" -eq 1 ] || fail "not one sentence: $(cat refused.txt)"
[ ! -e refused ] || fail 'something was left behind'

finish
