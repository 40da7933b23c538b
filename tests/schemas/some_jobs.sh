# JSON Schemas against the files of a few jobs, one for every kind of report, and the job files of
# examples/. some_jobs.sh HYDRODIP PYTHON SCHEMAS SOURCE
. "$(dirname "$0")/../cli/common.sh"
python=$2
schemas=$3
source=$4

coarse='--set film.elements=300 --set preview.pictures=off' # for what looks for a way to hold it
write_colored colored.ply
write_tetrahedron tetra.obj
"$hydrodip" sample sphere -o . --quiet > sample.txt || fail 'sample'
mkdir printed
# printed KIND ARGUMENT...: what the command prints is of this kind, as its file is.
printed() {
  kind=$1
  shift
  "$hydrodip" "$@" --quiet --json > "printed/$1.$kind.printed.json" || fail "$*"
}
# shellcheck disable=SC2086
{
  printed report print colored.ply $quick -o print
  printed report simulate colored.ply $quick_simulate --set dip.tilt_deg=20 -o simulate
  printed report pattern tetra.obj --tile print/preview.png --tile-mm 9 $quick -o pattern
  printed inspect inspect tetra.obj -o inspect
  printed plan plan colored.ply $quick_simulate $coarse --dips 2 -o plan
  mv printed/print.report.printed.json printed/one.report.printed.json
  mv printed/inspect.inspect.printed.json printed/one.inspect.printed.json
  printf '[[dip]]\ndepth_mm = 5\n' >> plan/plan.toml
  printed inspect inspect plan/plan.toml -o inspect-dips
  sed -i '$d' plan/plan.toml && sed -i '$d' plan/plan.toml
  printed report print plan/plan.toml $quick $coarse -o dips
  printed orient orient colored.ply $quick_simulate -o orient
  printed nest nest colored.ply colored.ply --film a4 --set film.elements=800 --set dip.step_mm=1 --dpi 72 \
    --set preview.width_px=200 -o nest
  python3 -B "$source/tests/cli/film_ply.py" places print/film.ply 1 > places.csv || fail 'film_ply.py'
  printed correction correct print places.csv
}
"$python" "$source/tests/schemas/validate.py" "$schemas" . "$source"/examples/jobs/*.toml
case $? in
  0) ;;
  77) exit 77 ;;
  *) fail 'something is not as its schema says' ;;
esac
[ "$(ls printed | wc -l)" -eq 10 ] || fail "printed: $(ls printed)"
mkdir wrong wrong/print wrong/inspect wrong/new
for wrong in '[film]\nwidth_mm = 9\n' '[film]\nwidht_mm = 100\n' '[[artwork]]\nprojection = "round"\n' \
  '[object]\nrotate_deg = [1, 2]\n' '[[dip]]\ndepth = 3\n' '[[part]]\ncount = 2\n'; do
  # shellcheck disable=SC2059
  printf "$wrong" > "wrong/$(ls wrong | wc -l).toml"
done
sed 's/"concern": "[a-z]*"/"concern": "perhaps"/' print/report.json > wrong/print/report.json
sed '0,/"command"/s//"comand": 1, "command"/' print/report.json > wrong/new/report.json
sed '/"units"/d' inspect/report.json > wrong/inspect/report.json
sed 's/"generator":"hydrodip correct"/"generator":"by hand"/' print/correction.json > wrong/correction.json
"$python" "$source/tests/schemas/validate.py" --refuses "$schemas" wrong/*.* wrong/*/report.json || fail 'something wrong is taken'
rm -r wrong
finish
