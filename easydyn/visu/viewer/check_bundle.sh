#!/bin/bash
# Rebuilds the viewer from the pinned packages and compares it with the committed bundle. Needs node and npm.
set -euo pipefail
cd "$(dirname "$0")"
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
npm ci --no-audit --no-fund --loglevel=error
node build.mjs --out "$out"
for file in viewer.js viewer.css; do
  cmp "$out/$file" "dist/$file" || { echo "viewer/dist/$file is not what the sources give: npm run build" >&2; exit 1; }
done
echo "viewer/dist is what the sources give"
