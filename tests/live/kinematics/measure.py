#!/usr/bin/python3
"""The DISPLAY of a headless LinuxCNC: homes it, and measures how many servo periods each of some programs moves for.

Environment:
  KERF_LIVE_PROGRAM   NC programs, one after the other, each after a line "% NAME"
  KERF_LIVE_RESULT    JSON written at the end: times ({NAME: seconds of motion}), errors (LinuxCNC's messages)
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

SERVO_S = 0.001
LIMIT_S = 120


def moving_periods(samples):
    """Servo periods between the first and the last in which a joint was sent elsewhere."""
    rows = [line.split()[1:] for line in samples.read_text().splitlines() if "overrun" not in line]
    changed = [i for i in range(1, len(rows)) if rows[i] != rows[i - 1]]
    return changed[-1] - changed[0] + 1 if changed else 0


def enable_sampler(on):
    subprocess.run(["halcmd", "setp", "sampler.0.enable", str(on)], check=True)


def measure(machine, name, text):
    program = pathlib.Path(name + ".ngc")
    program.write_text(text)
    machine.command.mode(linuxcnc.MODE_MDI)
    machine.command.wait_complete()
    machine.command.mdi("G90 G94 G0 X0 Y0 Z0 A0 C0")
    machine.command.wait_complete(LIMIT_S)
    samples = pathlib.Path(name + ".samples")
    with subprocess.Popen(["halsampler", "-t", "-c", "0", str(samples)]) as sampler:
        wait_until("halsampler", samples.exists, 5)
        enable_sampler(1)
        machine.run(str(program.resolve()), LIMIT_S)
        enable_sampler(0)
        time.sleep(0.2)  # halsampler looks ten times a second
        sampler.send_signal(signal.SIGTERM)
    return moving_periods(samples) * SERVO_S


def main():
    machine = Machine()
    result = {"times": {}, "errors": machine.errors}
    homed = wait_until("task", machine.task_is_up, STARTUP_LIMIT_S)
    if homed:
        machine.switch_on_and_home()
        homed = wait_until("home", machine.is_homed, STARTUP_LIMIT_S)
    if homed:
        for part in pathlib.Path(os.environ["KERF_LIVE_PROGRAM"]).read_text().split("% ")[1:]:
            name, text = part.split("\n", 1)
            result["times"][name] = measure(machine, name, text)
            if machine.errors:
                machine.errors.append("in: " + name)
                break
    else:
        machine.errors.append("not homed")
    pathlib.Path(os.environ["KERF_LIVE_RESULT"]).write_text(json.dumps(result))
    return 1 if machine.errors else 0


if __name__ == "__main__":
    sys.exit(main())
