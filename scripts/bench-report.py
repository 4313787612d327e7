"""Prints what criterion has measured as tables in Markdown: bench-report.py FOLDER [STAMP], the folder that criterion writes to, and a file:
what is older than it is left out. The last column compares the time of one element (of a run, where nothing is counted) with that of
the first line of the same kind: of the same name but for its last part."""

import json
import os
import pathlib
import sys


def in_words(number, units, least):
    """A number to three digits with its unit."""
    for unit, size in units:
        if number >= size:
            return f"{number / size:.3g} {unit}"
    return f"{number:.3g} {least}"


def measured(folder, stamp):
    """Name, nanoseconds, half the width of their 95 % interval as a share, elements; in the order in which they were measured."""
    oldest = os.path.getmtime(stamp) if stamp else 0
    files = [path for path in folder.glob("**/new/benchmark.json") if path.stat().st_mtime >= oldest]
    for path in sorted(files, key=lambda path: path.stat().st_mtime_ns):
        benchmark = json.loads(path.read_text())
        median = json.loads((path.parent / "estimates.json").read_text())["median"]
        time = median["point_estimate"]
        interval = median["confidence_interval"]
        spread = 0.5 * (interval["upper_bound"] - interval["lower_bound"]) / time
        yield benchmark["full_id"], time, spread, (benchmark.get("throughput") or {}).get("Elements")


def main():
    groups = {}
    for name, *values in measured(pathlib.Path(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else None):
        kinds = groups.setdefault(name.split("/")[0], {})
        kinds.setdefault(name.rpartition("/")[0], []).append((name, *values))
    for group, kinds in groups.items():
        print(f"\n## {group}\n\n| benchmark | median | ± | rate, /s | × |\n|---|---:|---:|---:|---:|")
        for rows in kinds.values():
            each = [time / (elements or 1) for _, time, _, elements in rows]
            for (name, time, spread, elements), of_one in zip(rows, each):
                words = in_words(time, [("s", 1e9), ("ms", 1e6), ("µs", 1e3)], "ns")
                rate = in_words(elements / (time * 1e-9), [("G", 1e9), ("M", 1e6), ("k", 1e3)], "") if elements else ""
                print(f"| {name} | {words} | {100 * spread:.0f} % | {rate} | {of_one / each[0]:.2f} |")


main()
