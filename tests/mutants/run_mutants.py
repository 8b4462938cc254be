#!/usr/bin/env python3
"""Breaks the code on purpose, one fault at a time, and says which tests notice: mutation testing by a list.

usage: tests/mutants/run_mutants.py [--build build/release] [--list tests/mutants/mutants.json] [--report FILE] [NAME ...]
       tests/mutants/run_mutants.py --check
    NAME: faults of the list; default: all that the report does not have yet
    --check: only whether every fault still fits the code; builds nothing (a test runs this)

Each fault replaces a piece of text in one file of the tree, builds one test program, and runs some of its suites, which
must fail. The file is put back, whatever happens. Exit code 1: a fault went unnoticed, or no longer fits the code.
The list says of each fault: `name`, `file`, `from` (must stand there exactly once), `to`, `target` (test program), and
`filter` (for --gtest_filter). Nothing else may build in this tree meanwhile.
"""
import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def build(args, target):
    return subprocess.run(["cmake", "--build", args.build, "--target", target], cwd=ROOT, capture_output=True, text=True)


def environment(args):
    """As in `make test`: what a broken program left in the cache is not for the next one."""
    cache = os.path.join(os.path.abspath(args.build), "cache-of-mutants")
    shutil.rmtree(cache, ignore_errors=True)
    return dict(os.environ, RUBBLE_CACHE=cache, RUBBLE_THREADS="1")


def failed_tests(args, mutant):
    """The tests that failed, as far as the program got; None: the program could not be run."""
    run = subprocess.run([os.path.join(os.path.abspath(args.build), mutant["target"]), "--gtest_filter=" + mutant["filter"]],
                         cwd=ROOT, capture_output=True, text=True, errors="replace", env=environment(args))
    if "[==========]" not in run.stdout:
        return None
    failed = [line.split()[3].rstrip(",") for line in run.stdout.splitlines() if line.startswith("[  FAILED  ] ")
              and line.endswith(" ms)")]
    if not failed and run.returncode != 0:
        failed = [f"stopped with exit code {run.returncode}"]
    if "[  PASSED  ] 0 tests" in run.stdout and not failed:
        return None
    return failed


def read_source(mutant):
    """The text of its file, and why the fault does not fit it; none: it does."""
    path = os.path.join(ROOT, mutant["file"])
    if not os.path.exists(path):
        return "", f"there is no {mutant['file']}"
    with open(path, encoding="utf-8") as file:
        text = file.read()
    found = text.count(mutant["from"])
    return text, "" if found == 1 else f"`from` stands {found} times in {mutant['file']}, not once: {mutant['from']!r}"


def check_list(mutants):
    faults = [f"{m['name']}: {fault}" for m in mutants for fault in [read_source(m)[1]] if fault]
    if faults:
        sys.exit("tests/mutants/mutants.json does not fit the code; put the same faults into the code as it is now:\n"
                 + "\n".join(faults))


def try_mutant(args, mutant):
    path = os.path.join(ROOT, mutant["file"])
    text, fault = read_source(mutant)
    if fault:
        return "STALE", fault
    try:
        with open(path, "w", encoding="utf-8") as file:
            file.write(text.replace(mutant["from"], mutant["to"]))
        built = build(args, mutant["target"])
        if built.returncode != 0:
            return "STALE", "does not compile: " + (built.stdout + built.stderr)[-400:]
        failed = failed_tests(args, mutant)
    finally:
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    if failed is None:
        return "STALE", f"{mutant['target']} has no test {mutant['filter']}"
    return ("caught", ", ".join(failed)) if failed else ("UNNOTICED", "no test failed")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.path.join(ROOT, "build/release"))
    parser.add_argument("--list", default=os.path.join(ROOT, "tests/mutants/mutants.json"))
    parser.add_argument("--report", help="keeps what was found, one JSON object a line; faults that it has are not tried again")
    parser.add_argument("--check", action="store_true", help="only whether the list fits the code")
    parser.add_argument("names", nargs="*")
    args = parser.parse_args()
    with open(args.list, encoding="utf-8") as file:
        mutants = json.load(file)
    if args.check:
        return check_list(mutants)
    unknown = set(args.names) - {m["name"] for m in mutants}
    if unknown:
        sys.exit(f"no such faults: {', '.join(sorted(unknown))}; the list has: {', '.join(m['name'] for m in mutants)}")
    done = {}
    if args.report and os.path.exists(args.report):
        with open(args.report, encoding="utf-8") as file:
            done = {row["name"]: row for row in map(json.loads, file)}
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that the file is put back
    bad = 0
    for mutant in mutants:
        if args.names and mutant["name"] not in args.names:
            continue
        if not args.names and mutant["name"] in done:
            row = done[mutant["name"]]
        else:
            begin = time.time()
            result, detail = try_mutant(args, mutant)
            row = {"name": mutant["name"], "result": result, "detail": detail, "seconds": round(time.time() - begin)}
            if args.report:
                with open(args.report, "a", encoding="utf-8") as file:
                    file.write(json.dumps(row) + "\n")
        print(f"{row['result']:9} {row['name']}: {row['detail']}", flush=True)
        bad += row["result"] != "caught"
    for target in sorted({m["target"] for m in mutants if not args.names or m["name"] in args.names}):
        build(args, target)  # of the code as it is
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
