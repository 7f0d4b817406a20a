#!/usr/bin/env python3
"""How methods bear errors that are injected into recordings.

    tests/campaigns/injected_errors.py --data-root=DIR --seed=200 --runs=100 --out=FOLDER

draws combinations of a recording, a kind, a size, a place and the seed of an
error, gives it to `hindsight run --inject`, and holds every method against the
batch of the same recording without it, where what the measurements leave open
is the same. That batch is itself off by what it states: an error is the distance
from it and its own sigma, in the root of squares. FOLDER gets runs.csv, a row a combination and method, and table.md.
Python's standard library only.
"""

import argparse
import csv
import json
import math
import random
import shutil
import statistics
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
RECORDINGS = ["car_rtk", "car_odometer", "drone_path_5", "drone_path_23",
              "drone_path_27", "walk_rtk"]
METHODS = ["batch", "imm_smoother", "robust_batch"]
SIZES_M = [0.3, 1.0, 3.0, 10.0]
# Share of the recording over which the error lasts, and the most of it [s].
LENGTHS = {"pulse": (0.1, 20.0), "step": (1.0, 1e9), "ramp": (0.2, 60.0),
           "multipath": (0.2, 90.0), "spikes": (0.2, 90.0)}
EXTRAS = {"multipath": ",tau=20s", "spikes": ",share=20%"}
PLACES = (0.15, 0.8)  # of the recording, where errors begin
WRONG = 25.0  # mean NEES of the position, of which 3 is right
SAME = 1.01  # ratio of errors below which neither is better
WORSE = 1.05
COLUMNS = ["recording", "error", "kind", "size", "seed", "method", "grade",
           "horizontal_rms", "horizontal_error", "nees"]


def run(options, name, methods, out, *more):
  """Runs the methods on a recording; whether there are results."""
  done = subprocess.run(
      [options.hindsight, "run", SOURCE / "data" / f"{name}.yaml",
       f"--data-root={options.data_root}", f"--methods={','.join(methods)}",
       f"--out={out}", "--threads=1", "--quiet", "--force", *more],
      capture_output=True, text=True)
  if done.returncode not in (0, 1, 3):
    sys.exit(f"run {name} {' '.join(more)}: exit status "
             f"{done.returncode}: {done.stderr}")
  return json.loads((out / "summary.json").read_text())


def times_of(fixes):
  """Times of the fixes that may err [s]."""
  with fixes.open() as file:
    rows = csv.DictReader(line for line in file if not line.startswith("#"))
    return [float(row["t[s]"]) for row in rows if row["status"] == "used"]


def sigma_of(solution):
  """Root mean square of the stated horizontal sigma [m]."""
  with solution.open() as file:
    rows = csv.DictReader(line for line in file if not line.startswith("#"))
    return math.sqrt(statistics.fmean(
        float(row["sd_n[m]"])**2 + float(row["sd_e[m]"])**2
        for row in rows))


def draw(random_numbers, times):
  """A combination: recording, kind, size [m], seed and error as a flag."""
  name = random_numbers.choice(list(times))
  kind = random_numbers.choice(list(LENGTHS))
  size = random_numbers.choice(SIZES_M)
  place = random_numbers.uniform(*PLACES)
  seed = random_numbers.randrange(1, 10**6)
  begin, end = times[name][0], times[name][-1]
  share, most = LENGTHS[kind]
  first = begin + place * (end - begin)
  last = min(end, first + min(most, share * (end - begin)))
  if not any(first + 0.1 < t < last - 0.1 for t in times[name]):
    return draw(random_numbers, times)  # all are withheld
  error = f"position:{kind}={size:g}m,from={first:.1f}s"
  if kind != "step":
    error += f",to={last:.1f}s"
  return {"recording": name, "kind": kind, "size": size, "seed": seed,
          "error": error + EXTRAS.get(kind, "")}


def judge(options, drawn, sigma, out):
  """The rows of a combination, one a method; `sigma` is of the batch without.

  Infinitely far off is a method without a trajectory, and one that has left the
  heights that trajectories are read of.
  """
  summary = run(options, drawn["recording"], options.methods, out,
                f"--inject={drawn['error']}", f"--seed={drawn['seed']}")
  healthy = options.out / f"healthy_{drawn['recording']}" / "batch.csv"
  rows = []
  for method in options.methods:
    result = summary["methods"].get(method, {})
    solution = out / f"{method}.csv"
    row = {**drawn, "method": method, "grade": result.get("grade", "none"),
           "horizontal_rms": float("inf"), "horizontal_error": float("inf"),
           "nees": float("inf")}
    if solution.exists():
      said = subprocess.run(
          [options.hindsight, "evaluate", solution, healthy, "--json"],
          capture_output=True, text=True, check=False)
      if said.returncode != 0 and "expected -20000 to 1e8 m" in said.stderr:
        rows.append(row)
        continue
      said.check_returncode()
      figures = json.loads(said.stdout)
      row["horizontal_rms"] = figures["errors"]["position_horizontal"]["rms"]
      row["horizontal_error"] = math.hypot(row["horizontal_rms"], sigma)
      row["nees"] = figures["nees"]["position"]
    rows.append(row)
  if not options.keep:
    shutil.rmtree(out)
  return rows


def by_combination(rows):
  """By recording, error and seed the rows of all methods."""
  all_of = {}
  for row in rows:
    key = (row["recording"], row["error"], row["seed"])
    all_of.setdefault(key, {})[row["method"]] = row
  return list(all_of.values())


def is_batch(case):
  """Whether nothing was found: both start where their own filters say."""
  by_metre = abs(case["robust_batch"]["horizontal_rms"]
                 - case["batch"]["horizontal_rms"])
  return by_metre < 1e-6


def table_row(title, some, methods):
  rest = [m for m in methods if m != "robust_batch"]
  wrong = [c for c in some if c["batch"]["nees"] > WRONG]
  error = "horizontal_error"
  best = [c for c in wrong if all(
      c["robust_batch"][error] < SAME * c[m][error] for m in rest)
          and not is_batch(c)]
  worse = [c for c in some
           if c["robust_batch"][error] > WORSE * c["batch"][error]]
  cells = [title, str(len(some))]
  for m in methods:
    usable = [c for c in some if c[m]["grade"] == "usable"]
    cells.append(", ".join(str(len(s)) for s in (
        [c for c in some if c[m]["nees"] > WRONG], usable,
        [c for c in usable if c[m]["nees"] > WRONG])))
  cells.append(", ".join(
      f"{statistics.median(c[m]['horizontal_rms'] for c in some):.2g}"
      for m in methods))
  cells += [f"{len(best)} of {len(wrong)}", str(len(worse))]
  return "| " + " | ".join(cells) + " |"


def table(rows, methods):
  """Counts by kind of error, in Markdown."""
  all_of = by_combination(rows)
  lines = ["| error | runs | "
           + " | ".join(f"`{m}` wrong, usable, both" for m in methods)
           + " | median RMS [m] | of those in which the batch is wrong "
           "`robust_batch` is best, or within 1 % of it | 5 % worse than "
           "`batch` |",
           "|---" * (5 + len(methods)) + "|"]
  for kind in LENGTHS:
    some = [c for c in all_of if c["batch"]["kind"] == kind]
    if some:
      lines.append(table_row(kind, some, methods))
  lines.append(table_row("all", all_of, methods))
  return "\n".join(lines) + "\n"


def main():
  parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
  parser.add_argument("--data-root", required=True,
                      help="folder in which the recordings lie")
  parser.add_argument("--out", required=True, type=Path)
  parser.add_argument("--seed", type=int, default=1, help="of the draws")
  parser.add_argument("--runs", type=int, default=100)
  parser.add_argument("--jobs", type=int, default=1, help="runs at once")
  parser.add_argument("--keep", action="store_true",
                      help="keep the results of every run")
  parser.add_argument("--recordings", nargs="+", default=RECORDINGS)
  parser.add_argument("--methods", nargs="+", default=METHODS,
                      help="batch and robust_batch have to be among them")
  parser.add_argument("--hindsight",
                      default=SOURCE / "build" / "release" / "hindsight")
  options = parser.parse_args()
  options.out.mkdir(parents=True, exist_ok=True)

  times = {}
  sigmas = {}
  for name in options.recordings:
    healthy = options.out / f"healthy_{name}"
    run(options, name, ["batch"], healthy)
    times[name] = times_of(healthy / "fixes.csv")
    sigmas[name] = sigma_of(healthy / "batch.csv")
  random_numbers = random.Random(options.seed)
  drawn = [draw(random_numbers, times) for _ in range(options.runs)]
  rows = []
  with ThreadPoolExecutor(options.jobs) as pool, \
       (options.out / "runs.csv").open("w", newline="") as file:
    writer = csv.DictWriter(file, COLUMNS)
    writer.writeheader()
    for some in pool.map(
        lambda i: judge(options, drawn[i], sigmas[drawn[i]["recording"]],
                        options.out / f"run_{i}"),
        range(len(drawn))):
      writer.writerows(some)
      file.flush()
      rows += some
  text = table(rows, options.methods)
  (options.out / "table.md").write_text(text)
  print(text, end="")


if __name__ == "__main__":
  main()
