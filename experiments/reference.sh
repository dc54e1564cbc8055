#!/usr/bin/env bash
# reference.sh [NAME...]: runs the experiments NAME.toml of this folder (all that have a page, if
# none is named) and renews their pages under results/reference: summary, figures and totals. The
# name complexity means all experiments of that folder, on one page. What the pages say comes from
# the databases; nothing in them is written by hand.
set -euo pipefail
cd "$(dirname "$0")/.."

names=("$@")
[ ${#names[@]} -gt 0 ] || names=(planners published scaling slicers published_tables low_poly complexity)
experiments/build.sh release routebench_program
program=build/release/bin/routebench
PATH=$PWD/build/release/bin:$PATH  # published_tables.toml and low_poly.toml call the program as a slicer
slicer_metrics=travel_mm,retractions,strokes,print_time_s,stated_time_s,job_cpu_s

# One page of what all experiments on growth claim and measure.
growth_page() {
  local page=results/reference/complexity config name
  rm -rf "$page"
  mkdir -p "$page"
  {
    printf '# How time grows\n\n'
    printf 'Claims of the sources beside what was measured, an experiment each. '
    printf 'Time is that inside plan() or, where layers are cut, of cutting; of the processor, medians of the samples.\n'
    printf 'A claim is about what remains when sizes grow; what every call costs alike makes fits of '
    printf 'finite ranges flatter, so "grows slower" does not contradict an upper bound.\n'
    for config in experiments/complexity/*.toml; do
      name=$(basename "$config" .toml)
      "$program" run "$config" --out "results/complexity/$name" --jobs 1 >/dev/null || [ $? -eq 1 ]
      "$program" plot "results/complexity/$name" --formats png --metrics plan_cpu_ns >/dev/null
      printf '\n## %s\n\n' "$name"
      # The config's first comment says what is swept.
      sed -n '/^#/!q; s/^# \{0,1\}//p' "$config"
      sed -n '/^## Claimed and measured growth/,/^## /p' "results/complexity/$name/plots/summary.md" |
        grep '^|'  | sed '1i\\'
      for figure in "results/complexity/$name/plots"/claims-*.png; do
        [ -e "$figure" ] || continue
        cp "$figure" "$page/$name-$(basename "$figure")"
        printf '\n![%s](%s)\n' "$name" "$name-$(basename "$figure")"
      done
    done
    printf '\n## How it was made\n\n`experiments/reference.sh complexity` ran '
    printf '[experiments/complexity](../../../experiments/complexity) and wrote this page.\n'
  } >"$page/README.md"
  echo "wrote $page/README.md"
}

for name in "${names[@]}"; do
  if [ "$name" = complexity ]; then
    growth_page
    continue
  fi
  "$program" run "experiments/$name.toml" --out "results/$name" || [ $? -eq 1 ]
  options=(--formats png --metrics travel_mm)
  # What slicers do is what ours are measured by.
  [ "$name" != published_tables ] || options=(--formats png --metrics travel_mm,job_wall_s,job_cpu_s)
  [ "$name" != low_poly ] || options=(--formats png --metrics job_wall_s,plan_cpu_ns)
  [ "$name" != slicers ] || options=(--formats png --metrics "$slicer_metrics" --baseline PrusaSlicer)
  "$program" plot "results/$name" "${options[@]}" >/dev/null
  "$program" export "results/$name" >/dev/null

  page=results/reference/$name
  rm -rf "$page"
  mkdir -p "$page"
  for figure in "results/$name/plots"/{outcomes,scatter,scaling,bars-job}*.png; do
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
