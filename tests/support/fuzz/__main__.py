"""Print a table of all formats: each runs in a process of its own, whose memory is its own."""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

from support.fuzz.reach import readers_lines

SOURCE = Path(__file__).parents[3] / "src" / "seatlook"
HEAD = "| format | damaged | read | refused | faults | slowest s | peak MB | CPU s |"


def main() -> int:
    """Run formats one after the other; ends with 1 where there are faults."""
    parser = argparse.ArgumentParser(prog="python -m support.fuzz")
    parser.add_argument("formats", nargs="*")
    parser.add_argument("--count", type=int, default=3000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cover", action="store_true", help="count the lines that are reached")
    parser.add_argument("--missing", action="store_true", help="list the lines that are not")
    parser.add_argument("--one", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        print(json.dumps(_one(options)))
        return 0
    from support.fuzz.formats import FORMATS

    faults, run = 0, defaultdict[str, set[int]](set)
    names = options.formats or list(FORMATS)
    print(HEAD + "\n|" + "---|" * 8)
    for name in names:
        words = [sys.executable, "-m", "support.fuzz", name, "--one", "--count", options.count]
        words += ["--seed", options.seed, *(["--cover"] if options.cover else [])]
        done = subprocess.run(list(map(str, words)), stdout=subprocess.PIPE, check=True)
        row = json.loads(done.stdout.splitlines()[-1])
        faults += len(row["faults"])
        print(
            f"| {name} | {row['count']} | {row['read']} | {row['refused']} | "
            f"{sum(row['faults'].values())} | {row['slowest']:.2f} | {row['peak']:.0f} | "
            f"{row['cpu']:.0f} |",
            flush=True,
        )
        for fault, number in row["faults"].items():
            print(f"  {number} x {fault}", file=sys.stderr, flush=True)
        for file, lines in row["run"].items():
            run[file] |= set(lines)
    if options.cover:
        _print_reached({FORMATS[name].reader for name in names}, run, missing=options.missing)
    return int(bool(faults))


def _one(options: argparse.Namespace) -> dict[str, object]:
    """Run one format here; the lines of its reader are counted from the first import on."""
    coverage = None
    if options.cover:
        import coverage as library

        coverage = library.Coverage(data_file=None, source=[str(SOURCE)], config_file=False)
        coverage.start()
    from support.fuzz.run import fuzz

    (name,) = options.formats
    with tempfile.TemporaryDirectory() as folder:
        outcome = fuzz(name, Path(folder), options.count, seed=options.seed)
    run: dict[str, list[int]] = {}
    if coverage is not None:
        coverage.stop()
        data = coverage.get_data()
        run = {file: data.lines(file) or [] for file in data.measured_files()}
    used = resource.getrusage(resource.RUSAGE_SELF)
    return {
        **{key: getattr(outcome, key) for key in ("count", "read", "refused", "slowest", "faults")},
        "peak": used.ru_maxrss / 1024,
        "cpu": used.ru_utime,
        "run": run,
    }


def _print_reached(names: set[str], run: dict[str, set[int]], *, missing: bool) -> None:
    """Print the share of the lines of each reader that ran, in whichever of its formats."""
    from coverage.python import PythonParser

    from support.fuzz.readers import READERS

    print("\n| reader | lines | reached |\n|---|---|---|")
    for name, reader in READERS.items():
        if name not in names:
            continue
        files = [
            file
            for module in reader.modules
            for file in (
                sorted((SOURCE / module).rglob("*.py"))
                if module.endswith("/")
                else [SOURCE / f"{module}.py"]
            )
        ]
        count, left = 0, []
        for file, own in readers_lines(files, reader.entries).items():
            parser = PythonParser(filename=str(file), exclude=r"#\s*pragma: no cover")
            parser.parse_source()
            lines = parser.statements & own
            not_run = parser.translate_lines(lines) - parser.translate_lines(
                run.get(str(file), set())
            )
            count += len(lines)
            left += [f"{file.relative_to(SOURCE)}:{line}" for line in sorted(not_run)]
        print(f"| {name} | {count} | {100 * (count - len(left)) / count:.1f} % |", flush=True)
        if missing:
            print("\n".join(f"  {place}" for place in left), file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
