#!/usr/bin/env bash
# The report as one page of HTML with all pictures in it, on standard output.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
docs=$here/../../docs
read_as=(--from gfm+tex_math_dollars --to html5 --mathml --lua-filter "$here/links.lua")

# What it begins with stands before the table of contents.
front=$(mktemp)
trap 'rm -f "$front"' EXIT
pandoc "${read_as[@]}" "$docs/report/front.md" >"$front"

pandoc "${read_as[@]}" --standalone --self-contained --toc --toc-depth=2 --css "$here/page.css" \
    --include-before-body "$front" --resource-path "$docs:$docs/report" \
    --metadata pagetitle="Nephroid: the report" --metadata lang=en \
    "$docs/report.md" "$docs/report/default.md" "$docs/report/results.md" \
    "$docs/report/discussion.md" "$docs/report/counterparts.md" "$docs/gallery.md" "$docs/journal.md"
