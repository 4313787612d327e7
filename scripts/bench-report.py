"""Prints what criterion has measured as a table in Markdown: bench-report.py FOLDER, the folder that criterion writes to."""

import json
import pathlib
import sys


def time_in_words(nanoseconds):
    """A time to three digits with its unit."""
    for unit, size in [("s", 1e9), ("ms", 1e6), ("µs", 1e3)]:
        if nanoseconds >= size:
            return f"{nanoseconds / size:.3g} {unit}"
    return f"{nanoseconds:.3g} ns"


def rate_in_words(rate):
    """A rate to three digits."""
    for unit, size in [("G", 1e9), ("M", 1e6), ("k", 1e3)]:
        if rate >= size:
            return f"{rate / size:.3g} {unit}/s"
    return f"{rate:.3g} /s"


def rows(folder):
    for path in sorted(folder.glob("**/new/benchmark.json")):
        benchmark = json.loads(path.read_text())
        median = json.loads((path.parent / "estimates.json").read_text())["median"]
        time = median["point_estimate"]
        interval = median["confidence_interval"]
        spread = 0.5 * (interval["upper_bound"] - interval["lower_bound"]) / time
        elements = (benchmark.get("throughput") or {}).get("Elements")
        rate = rate_in_words(elements / (time * 1e-9)) if elements else ""
        yield benchmark["full_id"], time_in_words(time), f"± {100 * spread:.0f} %", rate


def main():
    print("| benchmark | median | | rate |\n|---|---|---|---|")
    for row in rows(pathlib.Path(sys.argv[1])):
        print("| " + " | ".join(row) + " |")


main()
