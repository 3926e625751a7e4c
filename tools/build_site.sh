#!/bin/bash
# Builds the documentation site from the pages into build/site and checks its links.
# usage: tools/build_site.sh          needs python3 with venv, and PyPI the first time
set -euo pipefail
cd "$(dirname "$0")/.."
tools=build/site_tools work=build/site_work
if ! cmp -s docs/requirements.txt "$tools/requirements.txt"; then
    python3 -m venv --clear "$tools"
    "$tools/bin/pip" install --quiet --disable-pip-version-check -r docs/requirements.txt
    cp docs/requirements.txt "$tools/"
fi
python3 tools/draw_benchmarks.py
mkdir -p "$work"
python3 tools/stage_site.py stage "$work"
NO_MKDOCS_2_WARNING=1 "$tools/bin/mkdocs" build --quiet --clean --config-file "$work/mkdocs.yml"
"$tools/bin/python" tools/stage_site.py equations "$work"
python3 tools/stage_site.py check "$work"
rm -rf build/site
mv "$work/site" build/site
echo "build/site/index.html; search needs a server: python3 -m http.server -d build/site"
