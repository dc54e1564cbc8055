#!/usr/bin/env bash
# reference.sh [NAME...]: runs the experiments NAME.toml of this folder (all that have a page, if
# none is named) and renews their pages under results/reference: summary, figures and totals. What
# the pages say comes from the databases; nothing in them is written by hand.
set -euo pipefail
cd "$(dirname "$0")/.."

names=("$@")
[ ${#names[@]} -gt 0 ] || names=(planners published scaling slicers)
experiments/build.sh release routebench_program
program=build/release/bin/routebench
slicer_metrics=travel_mm,retractions,strokes,print_time_s,stated_time_s,job_cpu_s

for name in "${names[@]}"; do
  "$program" run "experiments/$name.toml" --out "results/$name" || [ $? -eq 1 ]
  options=(--formats png --metrics travel_mm)
  # What slicers do is what ours are measured by.
  [ "$name" != slicers ] || options=(--formats png --metrics "$slicer_metrics" --baseline PrusaSlicer)
  "$program" plot "results/$name" "${options[@]}" >/dev/null
  "$program" export "results/$name" >/dev/null

  page=results/reference/$name
  rm -rf "$page"
  mkdir -p "$page"
  for figure in "results/$name/plots"/{outcomes,scatter,scaling}*.png; do
    [ ! -e "$figure" ] || cp "$figure" "$page/"
  done
  # Totals, without what only this machine knows.
  grep -v ',peak_rss_bytes,' "results/$name/csv/cells.csv" | gzip -9n >"$page/cells.csv.gz"
  {
    cat "results/$name/plots/summary.md"
    if [ "$name" = slicers ]; then
      printf '\n## Totals\n\nEvery cell, by travel: what stands above a contender is better on that model.\n\n'
      sed -e 1d -e 's/^##/###/' "results/$name/plots/table.md"
    fi
    printf '\n## Figures\n'
    for figure in "$page"/*.png; do
      printf '\n![%s](%s)\n' "$(basename "$figure" .png)" "$(basename "$figure")"
    done
    printf '\n## How it was made\n\n'
    printf '`experiments/reference.sh %s` ran [%s.toml](../../../experiments/%s.toml) ' "$name" "$name" "$name"
    printf 'and wrote this page. `cells.csv.gz` has all totals.\n'
  } >"$page/README.md"
  echo "wrote $page/README.md"
done
