#!/usr/bin/python3
"""The DISPLAY of a headless LinuxCNC lathe: homes it, and records each servo period of some programs, run one after the other.

Environment:
  KERF_LIVE_PROGRAM   a file that names programs, a path a line
  KERF_LIVE_RESULT    JSON written at the end: errors (LinuxCNC's messages)
NAME.samples gets what halsampler writes; the machine stands at X0 Z0 when a program begins.
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import time

import linuxcnc
from drive import Machine, STARTUP_LIMIT_S, wait_until

LIMIT_S = 240


def enable_sampler(on):
    subprocess.run(["halcmd", "setp", "sampler.0.enable", str(on)], check=True)


def measure(machine, program):
    machine.command.mode(linuxcnc.MODE_MDI)
    machine.command.wait_complete()
    machine.command.mdi("G90 G94 G97 G8 G49 G0 X0 Z0 M5")
    machine.command.wait_complete(LIMIT_S)
    machine.command.mdi("M61 Q0")
    machine.command.wait_complete(LIMIT_S)
    time.sleep(1)  # the spindle stands
    samples = pathlib.Path(program.stem + ".samples")
    with subprocess.Popen(["halsampler", "-t", "-c", "0", str(samples)]) as sampler:
        wait_until("halsampler", samples.exists, 5)
        enable_sampler(1)
        machine.run(str(program), LIMIT_S)
        enable_sampler(0)
        time.sleep(0.5)  # halsampler looks ten times a second
        sampler.send_signal(signal.SIGTERM)


def main():
    machine = Machine()
    result = {"errors": machine.errors}
    homed = wait_until("task", machine.task_is_up, STARTUP_LIMIT_S)
    if homed:
        machine.switch_on_and_home()
        homed = wait_until("home", machine.is_homed, STARTUP_LIMIT_S)
    if homed:
        for line in pathlib.Path(os.environ["KERF_LIVE_PROGRAM"]).read_text().splitlines():
            measure(machine, pathlib.Path(line))
            if machine.errors:
                machine.errors.append("in: " + line)
                break
    else:
        machine.errors.append("not homed")
    pathlib.Path(os.environ["KERF_LIVE_RESULT"]).write_text(json.dumps(result))
    return 1 if machine.errors else 0


if __name__ == "__main__":
    sys.exit(main())
