#!/usr/bin/python3
"""The DISPLAY of a headless LinuxCNC: homes it, and writes down where joints and axes stand after each step of a list.

/usr/bin/python3 by its full path: LinuxCNC's modules belong to the system's Python, not to one that comes first in PATH.

Environment:
  KERF_LIVE_PROGRAM   the list: one MDI command a line; "switch N" puts kinematics N in force, "record NAME" writes down
                      where the machine stands
  KERF_LIVE_RESULT    JSON written at the end: positions (a list of {name, axes, joints}), errors (LinuxCNC's messages)
"""
import json
import os
import subprocess
import sys
import time

import linuxcnc
from drive import Machine, STARTUP_LIMIT_S, wait_until

STEP_LIMIT_S = 30


def stand(machine):
    # The joints' interpolation comes to rest some cycles after the planner: the same figures again and again.
    seen = []

    def stands():
        stat = machine.poll()
        seen.append((stat.position, stat.joint_position))
        return stat.inpos and stat.queue == 0 and seen[-4:].count(seen[-1]) == 4

    wait_until("standstill", stands, STEP_LIMIT_S)


def record(machine, name):
    stat = machine.stat
    joints = list(stat.joint_position[: stat.joints])
    return {"name": name, "axes": list(stat.position), "joints": joints}


def mdi(machine, step):
    machine.command.mdi(step)
    machine.command.wait_complete(STEP_LIMIT_S)
    stand(machine)


def switch(machine, kinematics):
    def in_force():
        said = subprocess.run(["halcmd", "getp", "motion.switchkins-type"], capture_output=True, text=True, check=False)
        return float(said.stdout or -1) == float(kinematics)

    # On a busy computer a command is lost now and then.
    for _ in range(5):
        mdi(machine, "M68 E3 Q" + kinematics)
        if wait_until("kinematics " + kinematics, in_force, 2):
            break
    time.sleep(0.1)  # some servo periods: motion looks at the pin, and moves nothing
    stand(machine)
    mdi(machine, "M66 E0 L0")  # the interpreter asks where the machine is


def run(machine, steps, result):
    machine.command.mode(linuxcnc.MODE_MDI)
    machine.command.wait_complete()
    for step in steps:
        words = step.split()
        if not words or words[0].startswith("#"):
            continue
        if words[0] == "record":
            result["positions"].append(record(machine, words[1]))
        elif words[0] == "switch":
            switch(machine, words[1])
        else:
            mdi(machine, step)
        if machine.errors:
            machine.errors.append("at: " + step)
            return


def main():
    machine = Machine()
    result = {"positions": [], "errors": machine.errors}
    homed = wait_until("task", machine.task_is_up, STARTUP_LIMIT_S)
    if homed:
        machine.switch_on_and_home()
        homed = wait_until("home", machine.is_homed, STARTUP_LIMIT_S)
    if homed:
        with open(os.environ["KERF_LIVE_PROGRAM"], encoding="utf-8") as file:
            run(machine, file.read().splitlines(), result)
    else:
        machine.errors.append("not homed")
    with open(os.environ["KERF_LIVE_RESULT"], "w", encoding="utf-8") as file:
        json.dump(result, file)
    return 1 if machine.errors else 0


if __name__ == "__main__":
    sys.exit(main())
