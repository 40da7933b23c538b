#!/bin/sh
# Artwork on models without UVs, from outside: the commonest job there is, files with several layers,
# pattern film, several parts on a sheet, and what is refused.
. "$(dirname "$0")/common.sh"

# refused FRAGMENT ARGUMENTS...
refused() {
  fragment=$1
  shift
  "$hydrodip" "$@" > refused.out 2> refused.err
  [ $? -eq 2 ] || fail "not refused: $*"
  grep -q "^error: .*$fragment" refused.err || fail "no '$fragment' in: $(cat refused.err)"
  [ ! -e nothing ] || fail "left files behind: $*"
}

# A plate of 40 x 30 x 5 mm as STL: neither UVs nor colours.
cat > plate.py <<'PY'
import itertools, struct
c = [(x, y, z) for z in (0, 5) for y in (0, 30) for x in (0, 40)]
f = [(0,2,3),(0,3,1),(4,5,7),(4,7,6),(0,1,5),(0,5,4),(2,6,7),(2,7,3),(0,4,6),(0,6,2),(1,3,7),(1,7,5)]
with open('plate.stl', 'wb') as out:
    out.write(b'plate'.ljust(80) + struct.pack('<I', len(f)))
    for t in f:
        out.write(struct.pack('<12fH', 0, 0, 0, *itertools.chain(*(c[v] for v in t)), 0))
PY
python3 plate.py || exit 77
cat > logo.svg <<'SVG'
<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 30"><rect width="20" height="30" fill="#f00"/>
<rect x="20" width="20" height="30" fill="#00f"/></svg>
SVG
"$hydrodip" sample box -o samples > /dev/null || fail 'sample box'
cp samples/box.png photo.png

# shellcheck disable=SC2086
"$hydrodip" print plate.stl --art photo.png $quick -o out --json > out.json ||
  fail "an STL and a PNG: $?"
python3 - <<'PY' || fail 'the report does not know the picture'
import hashlib, json
report = json.load(open('out.json'))
roles = {i['role']: i for i in report['inputs']}
assert roles['artwork']['sha256'] == hashlib.sha256(open('photo.png', 'rb').read()).hexdigest()
assert report['parameters']['artwork[1].image']['value'] == 'photo.png'
assert report['colors']['error_mean_ciede2000'] < 5, report['colors']
PY

# From below with +y up, -x is to the right: on the film, seen from above, red is on the right.
# shellcheck disable=SC2086
"$hydrodip" print plate.stl --art logo.svg $quick -o svg --quiet > /dev/null || fail 'an SVG'
if command -v convert > /dev/null; then
  [ "$(convert svg/print.png -format '%[pixel:p{160,113}] %[pixel:p{120,113}]' info: | tr -d ' ')" != '' ] ||
    fail 'print.png cannot be read'
  right=$(convert svg/print.png -crop 1x1+160+113 -depth 8 txt:- | tail -1)
  left=$(convert svg/print.png -crop 1x1+120+113 -depth 8 txt:- | tail -1)
  case $right in *'#FF0000'* | *'#FE0000'* | *'#FF0101'* | *red*) ;; *) fail "right of the film: $right" ;; esac
  case $left in *'#0000FF'* | *'#0000FE'* | *'#0101FF'* | *blue*) ;; *) fail "left of the film: $left" ;; esac
fi

# A layer that lies on the dry side, beside one that does not, and on a model with a picture of its own.
printf '[object]\nfile = "plate.stl"\n[[artwork]]\nimage = "photo.png"\n[[artwork]]\nimage = "logo.svg"
toward = [0, 0, -1]\nup = [0, 1, 0]\nat_mm = [20, 15, 5]\nsize_mm = 20\n' > dry.toml
# shellcheck disable=SC2086
"$hydrodip" print dry.toml $quick -o dry --quiet > dry.txt || fail "a dry layer: $?"
grep -q '^warning: logo.svg: this artwork gets no film' dry.txt || fail "a dry layer is not named: $(cat dry.txt)"
! grep -q 'photo.png: this artwork' dry.txt || fail 'a wet layer is said to be dry'
# shellcheck disable=SC2086
"$hydrodip" print samples/box.obj --art logo.svg --art-toward 0,0,-1 --art-size 10 $quick -o dry --quiet > dry.txt
grep -q '^warning: logo.svg: this artwork gets no film' dry.txt || fail 'a dry layer over a texture is not named'

# A part of a nest is told of as its own print would be.
# shellcheck disable=SC2086
"$hydrodip" nest dry.toml --film 200x200 --set film.elements=800 --set dip.step_mm=1 --dpi 72 -o dry-nest --quiet > dry.txt ||
  fail "a nest with a dry layer: $?"
grep -q '^warning: dry.toml: logo.svg: this artwork gets no film' dry.txt || fail "nest does not name a dry layer: $(cat dry.txt)"
! grep -q 'photo.png: this artwork' dry.txt || fail 'nest calls a wet layer dry'
grep -q 'logo.svg: this artwork gets no film' dry-nest/nest.json || fail 'nor does nest.json'

# Layers in a file beside its pictures, one more by options, and the same bytes from elsewhere.
mkdir jobs
cp logo.svg jobs/
cat > jobs/layers.toml <<'TOML'
[[artwork]]
image = "logo.svg"
projection = "box"
size_mm = 20
repeat = "tile"
through = false

[[artwork]]
text = "No. 7"
text_color = "#ffffff"
at_mm = [20, 15, 0]
toward = [0, 0, 1]
size_mm = [30, 8]
opacity = 0.9
TOML
# shellcheck disable=SC2086
"$hydrodip" print plate.stl --config jobs/layers.toml --art photo.png --art-size 10 --art-turn 30 \
  --art-opacity 0.5 $quick -o layers --quiet --threads 1 > /dev/null || fail 'layers'
(cd jobs && "$hydrodip" print ../plate.stl --config layers.toml --art ../photo.png --art-size 10 \
  --art-turn 30 --art-opacity 0.5 $quick -o ../again --quiet --threads 2 > /dev/null) || fail 'again'
cmp -s layers/print.tif again/print.tif || fail 'other bytes from another folder, or by two threads'

for projection in cylinder sphere box wrap film; do
  # shellcheck disable=SC2086
  "$hydrodip" simulate plate.stl --art photo.png --projection $projection $quick_simulate \
    -o "$projection" --quiet > /dev/null || fail "projection $projection"
done

# Pattern film.
# shellcheck disable=SC2086
"$hydrodip" pattern plate.stl --tile photo.png --tile-mm 15 --keep 20,15,0,5 $quick -o pattern \
  --quiet > pattern.txt || fail "pattern: $?"
grep -q 'pattern at' pattern.txt || fail 'pattern does not say where it lies'
python3 - <<'PY' || fail "pattern's report"
import json
report = json.load(open('pattern/report.json'))
assert report['command'] == 'pattern' and report['title'] == 'plate.stl', report['command']
names = [output['name'] for output in report['outputs']]
assert names[:3] == ['print.pdf', 'print.png', 'print.tif'] and 'gamut.png' in names, names
PY
"$hydrodip" rig sheet pattern --quiet > sheet.txt || fail 'the run sheet of a pattern'
# shellcheck disable=SC2086
"$hydrodip" pattern plate.stl --tile photo.png --tile-mm 15 --set material.tear_stretch=1.01 $quick -o fragile --strict \
  --quiet > fragile.txt
[ $? -eq 4 ] || fail 'pattern --strict of film that tears'
# shellcheck disable=SC2086
"$hydrodip" pattern plate.stl --tile photo.png --tile-mm 15 --compensate --tile-at 0,0 --tile-turn 0 \
  $quick -o flat --quiet > flat.txt || fail "pattern --compensate: $?"
grep -q 'without' flat.txt || fail 'pattern --compensate does not say what it gains'

# Several parts on a sheet.
# shellcheck disable=SC2086
nest='--film 200x200 --set film.elements=800 --set dip.step_mm=1 --dpi 72 --set preview.width_px=200
      --set print.samples=1'
# shellcheck disable=SC2086
"$hydrodip" nest samples/box.obj $nest --set ink.rounds_max=2 -o hasty --quiet > said.txt || fail "nest of two rounds: $?"
grep -q '^warning: box.obj: after 2 rounds' said.txt || fail "which part a warning is of: $(cat said.txt)"
grep -q 'the sheet with 1 piece:' said.txt || fail 'one piece'
# shellcheck disable=SC2086
"$hydrodip" nest samples/box.obj samples/box.obj $nest -o nest --json --quiet > nest.json ||
  fail "nest: $?"
python3 - <<'PY' || fail 'nest.json'
import json
pieces = json.load(open('nest.json'))['pieces']
assert len(pieces) == 2 and pieces[0]['model'] == pieces[1]['model']
def box(p):
    w, h = p['width_mm'], p['height_mm']
    if p['turned']: w, h = h, w
    return p['from_left_mm'], p['from_bottom_mm'], p['from_left_mm'] + w, p['from_bottom_mm'] + h
a, b = map(box, pieces)
assert a[2] <= b[0] + 1e-6 or b[2] <= a[0] + 1e-6 or a[3] <= b[1] + 1e-6 or b[3] <= a[1] + 1e-6
assert all(10 <= v <= 190 for v in a + b)
assert all(p['concern'] == 'stop' and 'tears' in p['verdict'] for p in pieces)  # a box that goes under
PY
# A part is dipped as its job says, or not at all: what auto finds is as in any other command.
printf '[object]\nfile = "samples/box.obj"\n[[dip]]\ndepth_mm = 3\n[[dip]]\ndown = "+z"\n' > twice.dip.toml
printf '[object]\nfile = "samples/box.obj"\n[dip]\ndepth_mm = "auto"\n' > found.dip.toml
# shellcheck disable=SC2086
refused 'is of several dips' nest twice.dip.toml $nest -o twice
# shellcheck disable=SC2086
"$hydrodip" nest found.dip.toml $nest -o found --quiet > /dev/null || fail "nest of a depth to be found: $?"
python3 - <<'PY' || fail 'nest takes the whole object where its job says auto'
import json
assert 0 < json.load(open('found/nest.json'))['pieces'][0]['depth_mm'] < 15
PY
# A part's name need not be UTF-8, nor in letters that some font has.
latin1=$(printf 'samples/Gr\366sse.obj') unknown=$(printf 'samples/box \364\217\277\275.obj')
cp samples/box.obj "$latin1"
cp samples/box.obj "$unknown"
# shellcheck disable=SC2086
"$hydrodip" nest "$latin1" "$unknown" $nest -o named --quiet > named.txt ||
  fail "nest of parts whose names no font has: $?"
grep -q "^warning: No font on this machine has .* of a part's name, which stands as 'box ?'" named.txt ||
  fail "nest does not say what it makes of a part's name: $(cat named.txt)"
# One sheet is printed and laid on the water in one way, whatever a part's job says.
for of_sheet in 'print.ink_side = "down"' 'film.swelling_x = 1.1' 'print.scale_x = 1.02' \
  'ink.model = "profile"' 'print.color = "cmyk"'; do
  printf '%s\nobject.file = "samples/box.obj"\n' "$of_sheet" > own.dip.toml
  # shellcheck disable=SC2086
  refused 'holds for the whole sheet' nest own.dip.toml $nest -o own
done
# shellcheck disable=SC2086
refused 'share a rectangular sheet' nest samples/box.obj $nest --set film.shape=disc -o disc
# What is printed mirrored is measured as it is printed.
# shellcheck disable=SC2086
"$hydrodip" nest samples/box.obj ${nest#--film 200x200} --film 300x200 --set print.ink_side=down -o mirrored --quiet > /dev/null ||
  fail 'a mirrored nest'
grep -q 'printed mirrored' mirrored/nest.html || fail 'a mirrored nest does not say so'
python3 - <<'PY' || fail 'the places on a mirrored sheet'
import json, re
piece = json.load(open('mirrored/nest.json'))['pieces'][0]
wide = piece['height_mm'] if piece['turned'] else piece['width_mm']
told = float(re.search(r'box.obj<td>(\d+) mm', open('mirrored/nest.html').read()).group(1))
assert abs(300 - piece['from_left_mm'] - wide - told) < 1, (piece, told)
PY
# What is to be printed lies where air stays: the reason is told.
python3 - > bell.obj <<'PY'
def ring(r, z):
    return [(-r, -r, z), (r, -r, z), (r, r, z), (-r, r, z)]
for corner in ring(20, 0) + ring(17, 0) + ring(20, 30) + ring(17, 27):
    print('v', *corner)
for k in range(4):
    n = (k + 1) % 4
    for quad in ((k, k + 4, n + 4, n), (k, n, n + 8, k + 8), (k + 4, k + 12, n + 12, n + 4)):
        print('f', *(corner + 1 for corner in quad))
print('f 9 10 11 12\nf 13 16 15 14')
PY
refused 'trapped air keeps' print bell.obj --art-text 7 --art-size 12 --depth 10 --film 120x120 --dpi 72 \
  --set film.elements=3000 --set dip.step_mm=1 -o bell
# A larger sheet gives each part more film around it, up to what helps.
for side in 300 600 900; do
  # shellcheck disable=SC2086
  "$hydrodip" nest samples/box.obj samples/box.obj ${nest#--film 200x200} --film ${side}x$side -o roomy --json --quiet > roomy-$side.json ||
    fail "nest on $side mm: $?"
done
python3 - <<'PY' || fail 'nest shares out the film'
import json
width, *more = [json.load(open(name))['pieces'][0]['width_mm']
                for name in ('nest.json', 'roomy-300.json', 'roomy-600.json', 'roomy-900.json')]
assert width < more[0] <= more[1] == more[2], (width, more)
PY
# What is not to be dipped is said where one looks: terminal, exit code, files.
printf 'object.file = "samples/box.obj"\ndip.depth_mm = 2\n' > flat.dip.toml
# shellcheck disable=SC2086
"$hydrodip" nest samples/box.obj flat.dip.toml ${nest#--film 200x200} --film 300x300 --strict -o torn --quiet > torn.txt
[ $? -eq 4 ] || fail 'nest --strict of a box that goes under'
grep -q 'box.obj: Do not dip it like this' torn.txt || fail 'nest says nothing of a part that tears'
grep -q 'class="stop"' torn/nest.html || fail 'nor does its run sheet'
pdftotext torn/print.pdf - | grep -q '^DO NOT DIP 1$' || fail 'nor does its sheet, of that piece alone'

# A draft's sheet is to be looked at.
# shellcheck disable=SC2086
"$hydrodip" print plate.stl --art photo.png --quality draft --dpi 72 -o draft --quiet > draft.txt || fail 'a draft'
grep -q '^warning: This is a draft' draft.txt || fail 'a draft does not say that it is one'
grep -q '^photo.png: no place is said, so it lies on the side that enters the water first (--art-toward 0,0,1); that or --art-at lays' \
  draft.txt || fail 'nobody is told where a picture lies that was told no place'
# shellcheck disable=SC2086
"$hydrodip" simulate plate.stl --art photo.png --art-toward 0,0,1 $quick_simulate -o placed --quiet > placed.txt || fail 'placed'
! grep -q 'no place is said' placed.txt || fail 'a place that was said is told'
pdftotext draft/print.pdf - | grep -q DRAFT || fail 'nor does its sheet'
"$hydrodip" nest flat.dip.toml --film 200x200 --quality draft --dpi 72 -o drafts --quiet > drafts.txt || fail 'a nest of drafts'
pdftotext drafts/print.pdf - | grep -q DRAFT || fail 'nor does a sheet of several'


# Profiles count: Display P3 and CMYK come out as Little CMS's own tool has them.
inks=/usr/share/color/icc/ghostscript/default_cmyk.icc
p3=/usr/share/color/argyll/ref/DisplayP3.icm
# shown IMAGE: the colour in the middle of the film image.
shown() {
  # shellcheck disable=SC2086
  "$hydrodip" print plate.stl --art "$1" $quick --set preview.pictures=off -o shown --quiet \
    > /dev/null || fail "print with $1"
  convert shown/print.png -crop 1x1+141+113 -depth 8 txt:- | tail -1 |
    sed 's/^[^(]*(\([0-9]*\),\([0-9]*\),\([0-9]*\).*/\1 \2 \3/'
}
# like COLOR VALUES PROFILE
like() {
  printf '%s\n' "$2" | transicc -i "$3" -o '*sRGB' -t 1 -n 2> /dev/null |
    awk -v shown="$1" '{ split(shown, s); for (k = 1; k <= 3; ++k) if (s[k] - $k > 1.5 || $k - s[k] > 1.5) exit 1
      if (NF < 3) exit 1; found = 1 } END { exit !found }' || fail "$2 by $3 came out as $1"
}
if command -v transicc > /dev/null && command -v convert > /dev/null && [ -e "$inks" ] && [ -e "$p3" ]; then
  convert -size 64x48 'xc:cmyk(60%,30%,20%,5%)' -quality 100 -profile "$inks" cmyk.jpg
  like "$(shown cmyk.jpg)" '60 30 20 5' "$inks"
  convert -size 64x48 'xc:cmyk(10%,80%,60%,15%)' -depth 8 -profile "$inks" -compress LZW cmyk.tif
  like "$(shown cmyk.tif)" '10 80 60 15' "$inks"
  convert -size 64x48 'xc:rgb(180,120,90)' -profile "$p3" p3.png
  like "$(shown p3.png)" '180 120 90' "$p3"
fi

# Text: its fonts are named and hashed; another font than was asked for is said; a machine without any
# cannot set it. So is a drawing that has text.
# shellcheck disable=SC2086
"$hydrodip" simulate plate.stl --art-text 'No. 7' --art-font 'No Such Font' $quick_simulate \
  --set preview.pictures=off -o text --json > text.json || fail "a text: $?"
grep -q "'No Such Font' is not installed; .* is taken instead" text.json || fail 'the other font is not said'
python3 - <<'PY' || fail 'the report does not know the font'
import hashlib, json
report = json.load(open('text.json'))
fonts = [i for i in report['inputs'] if i['role'] == 'font']
assert len(fonts) == 1 and fonts[0]['sha256'] == hashlib.sha256(open(fonts[0]['path'], 'rb').read()).hexdigest()
assert 'set in ' in report['figures']['artwork_1'], report['figures']
PY
echo '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 30"><text y="20">A</text></svg>' > text.svg
# shellcheck disable=SC2086
"$hydrodip" simulate plate.stl --art text.svg $quick_simulate --set preview.pictures=off -o text-svg \
  > text.txt || fail "an SVG with text: $?"
grep -q 'convert it to paths' text.txt || fail "an SVG with text: $(cat text.txt)"
printf '<?xml version="1.0"?>\n<fontconfig><cachedir>%s</cachedir></fontconfig>\n' "$PWD/cache" > none.conf
for art in '--art-text=A' '--art=text.svg'; do
  FONTCONFIG_FILE=$PWD/none.conf "$hydrodip" simulate plate.stl "$art" -o nothing > /dev/null 2> none.err
  [ $? -eq 2 ] || fail "$art without fonts: $?"
  grep -q '^error: .*no fonts are installed' none.err || fail "$art without fonts: $(cat none.err)"
done

head -c 300 photo.png > broken.png
echo '<svg xmlns="http://www.w3.org/2000/svg"><rect' > broken.svg
refused 'TGA or SVG file' print plate.stl --art plate.stl -o nothing
refused 'nowhere.png' print plate.stl --art nowhere.png -o nothing
refused 'broken.png.*PNG' print plate.stl --art broken.png --projection uv -o nothing
refused 'broken.svg.*SVG' print plate.stl --art broken.svg -o nothing
refused 'no texture coordinates' print plate.stl --art photo.png --projection uv -o nothing
refused 'nearest at 40.0,15.0,2.0' print plate.stl --art photo.png --art-at 90,15,2 -o nothing
refused 'hits nothing' print plate.stl --art photo.png --art-at 90,15,2 --art-toward 0,0,1 \
  --art-size 10 -o nothing
# Thinner than a pixel at 72 dpi, and between two rows of them; with or without several sheets.
python3 - <<'PY' || exit 77
import struct, zlib
def chunk(kind, data):
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
with open('line.png', 'wb') as out:
    out.write(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', 400, 1, 8, 2, 0, 0, 0)) +
              chunk(b'IDAT', zlib.compress(b'\0' + b'\xc8\0\0' * 400)) + chunk(b'IEND', b''))
PY
for dips in 1 2; do
  # shellcheck disable=SC2086
  refused 'blank.*line.png: it is laid 40 x 0.1 mm, thinner than .*--art-size W,H' print plate.stl \
    --art line.png --art-at 20,15.2,0 --art-size 40 --dips $dips $quick -o nothing --quiet
done
# Flat as it is held: however deep was asked for, it only touches the film.
printf 'v 0 0 0\nv 40 0 0\nv 40 30 0\nv 0 30 0\nf 1 2 3 4\n' > flat.obj
# shellcheck disable=SC2086
refused 'blank.*flat as it is held.*the depth of 5 mm was cut.*[Tt]ilt' print flat.obj --art photo.png --down +z \
  --depth 5 $quick -o nothing --quiet
refused 'needs artwork' print plate.stl --art-size 10 -o nothing
refused 'size_mm must be W or W,H' print plate.stl --art photo.png --art-size 10,0 -o nothing
refused 'projection must be one of planar' print plate.stl --art photo.png --projection flat -o nothing
refused "did you mean 'turn_deg'" print plate.stl --art photo.png --set 'artwork[1].turn_dg=3' -o nothing
refused 'put a picture on it with --art' print plate.stl -o nothing
refused 'true width' pattern plate.stl --tile photo.png -o nothing
refused 'the spot is away' pattern plate.stl --tile photo.png --tile-mm 20 --keep 90,0,0 -o nothing
refused 'holds 1 of the 3 parts' nest samples/box.obj samples/box.obj samples/box.obj \
  --film 100x100 -o nothing

finish
