#!/bin/sh
# Bad input: exit code 2, one clear sentence on stderr, nothing on stdout, no file left behind.
. "$(dirname "$0")/common.sh"

write_tetrahedron tetra.obj
write_colored colored.ply
mkdir inputs

# refused FRAGMENT ARGUMENTS...: the sentence must contain FRAGMENT.
refused() {
  fragment=$1
  shift
  find . > "$work.before"
  "$hydrodip" "$@" > "$work.out" 2> "$work.err"
  code=$?
  find . > "$work.after"
  [ "$code" -eq 2 ] || fail "exit code $code instead of 2: $*"
  # On a slow machine, progress lines ("loading 100 %") may come before the sentence.
  [ "$(grep -cvE '^[a-z. ]+( +[0-9]+ %.*)?$' "$work.err")" -eq 1 ] ||
    fail "not one line on stderr: $*: $(cat "$work.err")"
  tail -n 1 "$work.err" | grep -q '^error: ' || fail "stderr does not end with 'error: ': $*"
  grep -qF -- "$fragment" "$work.err" || fail "no '$fragment' in: $(cat "$work.err")"
  [ ! -s "$work.out" ] || fail "something on stdout: $*"
  cmp -s "$work.before" "$work.after" || fail "left files behind: $*"
  rm -f "$work.before" "$work.after" "$work.out" "$work.err"
}

# A working directory that has gone.
mkdir gone
(cd gone && rmdir "$work/gone" && "$hydrodip" register --calibrate-camera "$work/inputs/a.png" 2> "$work.err")
code=$?
[ "$code" -eq 2 ] || fail "exit code $code instead of 2 in a folder that has gone"
grep -q '^error: .*check the path' "$work.err" || fail "a folder that has gone: $(cat "$work.err")"

# Files that are no models.
: > inputs/empty.obj
: > inputs/empty.stl
: > inputs/empty.glb
: > inputs/empty.png
: > inputs/empty.ply
for kind in obj stl glb png ply; do
  [ "$kind" = png ] || refused "inputs/empty.$kind" print "inputs/empty.$kind" -o out
done
head -c 5000 "$hydrodip" | tail -c 4096 > inputs/noise.bin
for kind in stl glb gltf ply off 3mf; do
  cp inputs/noise.bin "inputs/noise.$kind"
  refused "inputs/noise.$kind" print "inputs/noise.$kind" -o out
done
refused 'nowhere.obj' print nowhere.obj -o out
refused 'nowhere.obj' inspect nowhere.obj
refused 'inputs' print inputs -o out
refused 'it is a folder' studio --no-browser inputs
refused "unknown kind of model file '.bin'" studio --no-browser inputs/noise.bin

# What is named is a file where a folder is meant, or lacks what a job's folder has.
for command in 'rig sheet' history view 'sweep run' 'sweep collect'; do
  # shellcheck disable=SC2086
  refused 'it is a file, not a folder' $command tetra.obj
  # shellcheck disable=SC2086
  refused 'there is no such folder' $command nowhere
  # shellcheck disable=SC2086
  refused ' in it; name the' $command inputs
done

# What mends a part is in its job file: 'nest' has no options for it.
printf '[object]\nfile = "tetra.obj"\n' > plain.toml
refused 'write one that names the model, and nest that' nest tetra.obj
refused 'under [[artwork]]: put it there' nest plain.toml
rm plain.toml

# A value that was forgotten is not the option behind it.
refused '--output: a value is missing, as --quiet is an option' print tetra.obj --output --quiet
refused '-o: a value is missing, as --json is an option; --output=--json if' print tetra.obj -o --json
refused '--film: a value is missing, as -o is an option' inspect tetra.obj --film -o out
"$hydrodip" sample box --output=--quiet > /dev/null || fail 'a folder named as an option is'
[ -f ./--quiet/box.obj ] || fail 'the folder --quiet is not there'
rm -r ./--quiet

# A file where a command or an option stands.
refused "unknown command 'tetra.obj': name what to do with that file, as in 'hydrodip print tetra.obj'" tetra.obj
cp tetra.obj ./-tetra.obj
refused "for the file of that name write ./-tetra.obj" inspect -tetra.obj
rm ./-tetra.obj
printf 'v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 9\n' > inputs/index.obj
refused 'inputs/index.obj' simulate inputs/index.obj -o out
printf 'v 0 0 0\nv nan 0 0\nv 0 1 1\nf 1 2 3\n' > inputs/nan.obj
refused 'inputs/nan.obj' simulate inputs/nan.obj -o out

# Appearance.
refused 'UVs' print tetra.obj -o out
cp inputs/noise.bin inputs/noise.png
"$hydrodip" sample box -o samples > /dev/null || fail 'sample box'
refused 'inputs/noise.png' print samples/box.obj --texture inputs/noise.png -o out
refused 'inputs/empty.png' print samples/box.obj --texture inputs/empty.png -o out
refused 'nowhere.png' print samples/box.obj --texture nowhere.png -o out
refused 'inputs/noise.png' simulate tetra.obj --film-image inputs/noise.png -o out
refused 'nowhere.png' simulate tetra.obj --film-image nowhere.png -o out
printf 'MM: a letter, and no TIFF' > inputs/letter.png
refused 'not a picture of a kind that is read' simulate tetra.obj --film-image inputs/letter.png -o out
refused 'shape of the' simulate tetra.obj --film-image samples/box.png --film 200x100 -o out

# Too large: by how much.
refused '240 mm long (y), 50 mm more than the 190 mm' simulate tetra.obj --size 240 --film 300x210 -o out
refused '10 mm more than the 10 mm of the bath' simulate tetra.obj --set bath.depth_mm=10 -o out
refused 'more than the 30 mm of the free film' simulate tetra.obj --film 50x50 -o out
refused 'more than' simulate tetra.obj --film 60x60 --set film.shape=disc -o out
refused '150 mm of the bath' simulate tetra.obj --size 400 --film 600x600 \
  --set bath.width_mm=600 --set bath.height_mm=600 -o out
refused '--units' simulate tetra.obj --units m -o out

# Parameters and options.
refused "did you mean 'film.elements'?" simulate tetra.obj --set film.elemnts=800 -o out
refused "did you mean '--size'?" simulate tetra.obj --sise 30 -o out
refused "did you mean 'simulate'?" simulte tetra.obj -o out
refused 'lists them' simulate tetra.obj --zzzzzzzz -o out
refused 'unexpected argument' simulate tetra.obj other.obj -o out
refused 'missing' simulate tetra.obj --size
refused "did you mean 'sphere'?" sample spehre -o out
# One of two values would be passed over; several layers are a matter of files. What scripts set for
# many commands is overridden by what follows.
refused "--output is given twice, as 'out' and 'else'" simulate tetra.obj -o out -o else
refused "as '1' and '2'; give it once" history inputs --run 1 --run 2
refused "'a.png' and 'b.png': options give one layer of artwork; several stand as [[artwork]] tables in a job file" \
  print tetra.obj --art a.png --art b.png -o out
refused 'one layer of artwork' print tetra.obj --art-text a --art-size 3 --art-text b -o out
"$hydrodip" inspect colored.ply --size 20 --size 30 --film a4 --film a3 -o twice -o twice > /dev/null 2> "$work.err" ||
  fail "the last size, and the same folder twice: $(cat "$work.err")"
rm -rf twice "$work.err"
for value in 5 1e9 nan inf many '' 800.5 0x320; do
  refused 'film.elements must be a whole number from 8' simulate tetra.obj \
    --set "film.elements=$value" -o out
done
refused 'object.size_mm' simulate tetra.obj --size -3 -o out
refused 'object.down' simulate tetra.obj --down z -o out
refused 'X,Y,Z' simulate tetra.obj --rotate 1,2 -o out
refused 'object.units' simulate tetra.obj --units km -o out
refused 'dip.depth_mm' simulate tetra.obj --depth deep -o out
refused 'neither letter, a4' simulate tetra.obj --film a9 -o out
refused 'run.threads' simulate tetra.obj --threads -1 -o out
refused 'film.margin_mm' simulate tetra.obj --set film.margin_mm=-1 -o out
refused 'margin' simulate tetra.obj --set film.margin_mm=200 -o out
refused 'NAME=VALUE' simulate tetra.obj --set film.margin_mm -o out

# Configuration files.
printf '[film]\nwidth_mm = = 3\n' > inputs/broken.toml
refused 'inputs/broken.toml:2:' simulate tetra.obj --config inputs/broken.toml -o out
printf '[film]\nwidth_mm = "wide"\n' > inputs/text.toml
refused 'inputs/text.toml:2: film.width_mm' simulate tetra.obj --profile inputs/text.toml -o out
printf '\n\nfilm.wdth_mm = 3\n' > inputs/typo.toml
refused "inputs/typo.toml:3: unknown parameter 'film.wdth_mm'; did you mean 'film.width_mm'?" \
  simulate tetra.obj --config inputs/typo.toml -o out
cp inputs/noise.bin inputs/noise.toml
refused 'inputs/noise.toml' simulate tetra.obj --config inputs/noise.toml -o out
refused 'nowhere.toml' simulate tetra.obj --config nowhere.toml -o out

# Output folders.
refused 'tetra.obj' simulate tetra.obj -o tetra.obj/out
refused 'tetra.obj' print colored.ply -o tetra.obj
refused 'tetra.obj' sample box -o tetra.obj/out

# Instruction sets by hand.
HYDRODIP_SIMD=sse9
export HYDRODIP_SIMD
refused 'HYDRODIP_SIMD=sse9: no instruction set has that name' simulate tetra.obj -o out
unset HYDRODIP_SIMD

# No command at all.
refused 'name a command'
refused 'name the model' print
finish
