"""Runs hostile scripts, one per line of a file, under a limit of memory, and checks the actual memory of the process.

    hostile.py PROGRAM FILE [STEP [FIRST]]

Runs every STEP-th script (default 1), beginning with number FIRST (default 1). A script passes if it ends with status 0 or 5, and its peak of
resident memory is at most 32 MiB above the limit. Prints a line for each one that does not pass. The exit status is 0 if all pass.
"""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

LIMIT, SLACK = 64, 32  # MiB
SECONDS = 2


def peak_of(program, script):
    """The exit status, and the peak of resident memory in MiB."""
    command = [program, "eval", f"--max-memory={LIMIT}M", f"--max-time={SECONDS}", script]
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    return os.waitstatus_to_exitcode(status), usage.ru_maxrss / 1024


def main():
    program, file = sys.argv[1:3]
    step, first = (int(word) for word in (sys.argv[3:] + ["1", "1"])[:2])
    with open(file) as lines:
        scripts = lines.read().splitlines()[first - 1::step]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(lambda script: peak_of(program, script), scripts))
    failed = [(script, *result) for script, result in zip(scripts, results)
              if result[0] not in (0, 5) or result[1] > LIMIT + SLACK]
    for script, status, peak in failed:
        print(f"status {status}, {peak:.0f} MiB: {script}")
    return 1 if failed or not scripts else 0


if __name__ == "__main__":
    sys.exit(main())
