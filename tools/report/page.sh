#!/usr/bin/env bash
# The report as one page of HTML with all pictures in it, on standard output.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
docs=$here/../../docs

pandoc --from gfm+tex_math_dollars --to html5 --standalone --self-contained --mathml \
    --toc --toc-depth=2 --css "$here/page.css" --lua-filter "$here/links.lua" \
    --resource-path "$docs:$docs/report" --metadata pagetitle="Nephroid: the report" \
    "$docs/report/front.md" "$docs/report.md" "$docs/report/results.md" "$docs/report/discussion.md" \
    "$docs/report/counterparts.md" "$docs/gallery.md" "$docs/journal.md"
