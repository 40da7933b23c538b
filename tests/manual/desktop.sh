# Desktop entry, MIME type, AppStream data, list of what is bundled:
# desktop.sh SOURCE BUILD [BUNDLE_METAFILE]
set -u
source=$1
build=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }

if command -v desktop-file-validate >/dev/null; then
  said=$(desktop-file-validate "$build/desktop/hydrodip.desktop" 2>&1) || fail "desktop entry: $said"
fi
if command -v appstreamcli >/dev/null; then
  # The project has no domain yet whose name could be turned round.
  appstreamcli validate --no-net --override=cid-desktopapp-is-not-rdns=info "$build/desktop/hydrodip.metainfo.xml" > "$work/said" 2>&1 ||
    fail "AppStream data: $(cat "$work/said")"
fi
if command -v update-mime-database >/dev/null; then
  mkdir -p "$work/mime/packages"
  cp "$source/packaging/hydrodip.xml" "$work/mime/packages"
  said=$(update-mime-database "$work/mime" 2>&1) || fail "MIME type: $said"
  grep -q '^80:application/x-hydrodip-job+toml:\*.dip.toml' "$work/mime/globs2" ||
    fail "the MIME type has no glob: $(cat "$work/mime/globs2")"
fi
# What esbuild put into the page stands in the list, with the lock file's version.
spdx=$build/share/hydrodip/hydrodip.spdx.json
for lock in "$source"/src/*/*/package-lock.json; do
  for package in $(grep -o '"node_modules/[^"]*": *{' "$lock" | cut -d '"' -f 2); do
    name=${package##*node_modules/}
    if sed -n "\\|\"$package\": {|,/}/p" "$lock" | grep -q '"dev": true'; then
      grep -q "\"node_modules/$name\"" "$source"/src/*/*/package-lock.json || fail "$name: read wrongly"
    else
      grep -q "\"name\": \"$name\"" "$spdx" || fail "$name is bundled and not in $spdx"
    fi
  done
done
! grep -q '"name": "gltf-validator"' "$spdx" || fail 'gltf-validator is not bundled, only tests use it'
if command -v node >/dev/null; then
  node -e '
    const list = JSON.parse(require("fs").readFileSync(process.argv[1]));
    const ids = new Set(["SPDXRef-DOCUMENT", ...list.packages.map((p) => p.SPDXID)]);
    for (const r of list.relationships)
      if (!ids.has(r.spdxElementId) || !ids.has(r.relatedSpdxElement)) throw new Error(JSON.stringify(r));
    if (list.spdxVersion !== "SPDX-2.3" || ids.size !== list.packages.length + 1) throw new Error("ids");
    for (const p of list.packages)
      if (!p.versionInfo || !p.licenseConcluded) throw new Error(p.name);
  ' "$spdx" || fail "$spdx is not sound"
fi
[ "$failures" -eq 0 ] || exit 1
echo 'all passed'
