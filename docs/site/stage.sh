#!/bin/sh
# stage.sh SOURCE MADE OUTPUT: collects the pages of the site in OUTPUT and writes OUTPUT.yml, mkdocs'
# configuration. MADE: where the build has put what it made from the program's tables
# (build/release/share).
set -eu
source=$1
made=$2
output=$3
rm -rf "$output"
mkdir -p "$output/guide" "$output/schemas"
cp "$source"/docs/*.md "$source"/docs/*.png "$source"/docs/*.svg "$output" 2>/dev/null
rm -f "$output/reference.md" # Doxygen's
[ ! -d "$source/docs/paper" ] || cp -r "$source/docs/paper" "$output"
cp -r "$source"/docs/guide/. "$output/guide"
cp "$made"/pages/*.md "$output/guide"
cp "$made"/hydrodip/schemas/*.json "$output/schemas"
cp "$source/packaging/hydrodip.svg" "$output/logo.svg"
cp "$source/docs/site/site.css" "$source/docs/site/site.js" "$output"
cp "$source/CHANGELOG.md" "$output/changelog.md"
# The first page of all is the guides'.
sed 's|](\([a-z]*\.md\)|](guide/\1|g; s|](\.\./|](|g' "$source/docs/guide/index.md" >"$output/index.md"
rm "$output/guide/index.md"
# Links from pages of docs/ to what is not on the site lead to the sources.
sed -i 's|](\.\./examples[^)]*)|](guide/library.md)|g; s|](\.\./HACKING.md)|](guide/library.md)|g' "$output"/*.md

# The navigation: without pages that are not there, and with those of docs/ that it does not name.
named=$(grep -o '[a-z/-]*\.md' "$source/mkdocs.yml")
while IFS= read -r line; do
  page=$(printf '%s\n' "$line" | sed -n 's/^ *- .*: \([a-z/-]*\.md\)$/\1/p')
  if [ -z "$page" ] || [ -f "$output/$page" ]; then printf '%s\n' "$line"; fi
done <"$source/mkdocs.yml" >"$output.yml"
others=$(cd "$output" && ls -- *.md | grep -vxF "$named" || true)
if [ -n "$others" ]; then
  printf '  - More:\n' >>"$output.yml"
  for page in $others; do printf '      - %s\n' "$page" >>"$output.yml"; done
fi
# Relative to the configuration, which lies beside the folder.
sed -i "s|^docs_dir:.*|docs_dir: $(basename "$output")|; s|^site_dir:.*|site_dir: docs|" "$output.yml"
