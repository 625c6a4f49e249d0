"""Print a table of all formats: each runs in a process of its own, whose memory is its own."""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).parents[3] / "src" / "seatlook"
HEAD = "| format | damaged | read | refused | faults | slowest s | peak MB | lines reached |"


def main() -> int:
    """Run formats one after the other; ends with 1 where there are faults."""
    parser = argparse.ArgumentParser(prog="python -m support.fuzz")
    parser.add_argument("formats", nargs="*")
    parser.add_argument("--count", type=int, default=3000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cover", action="store_true", help="count the lines that are reached")
    parser.add_argument("--one", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        print(json.dumps(_one(options)))
        return 0
    from support.fuzz.formats import FORMATS

    faults = 0
    print(HEAD + "\n|" + "---|" * 8)
    for name in options.formats or FORMATS:
        words = [sys.executable, "-m", "support.fuzz", name, "--one", "--count", options.count]
        words += ["--seed", options.seed, *(["--cover"] if options.cover else [])]
        done = subprocess.run(list(map(str, words)), stdout=subprocess.PIPE, check=True)
        row = json.loads(done.stdout.splitlines()[-1])
        faults += len(row["faults"])
        print(
            f"| {name} | {row['count']} | {row['read']} | {row['refused']} | "
            f"{sum(row['faults'].values())} | {row['slowest']:.2f} | {row['peak']:.0f} | "
            f"{row['reached']} |",
            flush=True,
        )
        for fault, number in row["faults"].items():
            print(f"  {number} x {fault}", file=sys.stderr, flush=True)
    return int(bool(faults))


def _one(options: argparse.Namespace) -> dict[str, object]:
    """Run one format here; the lines of its readers are counted from the first import on."""
    coverage = None
    if options.cover:
        import coverage as library

        coverage = library.Coverage(data_file=None, source=[str(SOURCE)], config_file=False)
        coverage.start()
    from support.fuzz.formats import FORMATS
    from support.fuzz.run import fuzz

    (name,) = options.formats
    with tempfile.TemporaryDirectory() as folder:
        outcome = fuzz(name, Path(folder), options.count, seed=options.seed)
    reached = "-"
    if coverage is not None:
        coverage.stop()
        reached = _reached(coverage, FORMATS[name].modules)
    return {
        **{key: getattr(outcome, key) for key in ("count", "read", "refused", "slowest", "faults")},
        "peak": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        "reached": reached,
    }


def _reached(coverage, modules: tuple[str, ...]) -> str:
    """Share of the lines of some modules that ran; a name that ends in / is a whole folder."""
    files = [f for m in modules for f in ([*(SOURCE / m).rglob("*.py")] if m.endswith("/") else
             [SOURCE / f"{m}.py"])]  # fmt: skip
    lines = missing = 0
    for file in files:
        _, statements, _, left, _ = coverage.analysis2(str(file))
        lines += len(statements)
        missing += len(left)
    return f"{100 * (lines - missing) / lines:.0f} %"


if __name__ == "__main__":
    sys.exit(main())
