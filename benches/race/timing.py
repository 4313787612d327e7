"""Wall and processor time of whole processes."""
import dataclasses
import os
import resource
import subprocess
import sys
import time


@dataclasses.dataclass
class Time:
    wall: float
    processor: float


def timed(command, **environment):
    """Runs a command to its end; ends the program with what it said last if it fails."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    result = subprocess.run([str(part) for part in command], capture_output=True, text=True, env={**os.environ, **environment})
    wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{(result.stdout + result.stderr)[-2000:]}")
    processor = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Time(wall, processor)
