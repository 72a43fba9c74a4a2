#!/usr/bin/python3
"""The DISPLAY of a headless LinuxCNC: homes it, runs one program to its end or a script of several, and exits, which ends
LinuxCNC.

/usr/bin/python3 by its full path: LinuxCNC's modules belong to the system's Python, not to one that comes first in PATH.

Environment:
  KERF_LIVE_PROGRAM   the NC file, with its full path
  KERF_LIVE_RESULT    JSON written at the end: program_s, homed, errors (LinuxCNC's messages)
  KERF_LIVE_READY     shell command to be waited for after homing, before the program starts (optional)
  KERF_LIVE_AT_END    shell command to be waited for while the machine still stands at the program's end (optional)
  KERF_LIVE_LIMIT_S   the program is aborted after this many seconds (300)
  KERF_LIVE_SCRIPT    file with a step a line, in place of the one program (optional). Files lie beside it:
                        run FILE [LINE]      to its end, from this line on
                        abort FILE SECONDS   run, and aborted after so long
                        pause FILE AT FOR    run to its end, held after AT seconds FOR seconds
                        override PERCENT     of the feed
                        mdi TEXT             one block, to its end
                        wait SECONDS
                      A step that is none, or does not come to its end, is the last one
"""
import json
import os
import subprocess
import sys
import time

import linuxcnc

POLL_S = 0.02
STARTUP_LIMIT_S = 60


def wait_until(what, condition, limit_s):
    """Polls, as LinuxCNC has nothing to wait on. False after limit_s."""
    deadline = time.monotonic() + limit_s
    while not condition():
        if time.monotonic() > deadline:
            print("drive.py: gave up waiting for", what, flush=True)
            return False
        time.sleep(POLL_S)
    return True


class Machine:
    def __init__(self):
        self.command = linuxcnc.command()
        self.stat = linuxcnc.stat()
        self.channel = linuxcnc.error_channel()
        self.errors = []

    def poll(self):
        self.stat.poll()
        message = self.channel.poll()
        if message:
            self.errors.append(message[1])
            print("LinuxCNC:", message[1], flush=True)
        return self.stat

    def task_is_up(self):
        # The status is all zero until task has written it the first time.
        try:
            stat = self.poll()
        except linuxcnc.error:
            return False
        return stat.linear_units > 0 and stat.axis_mask != 0 and stat.task_state == linuxcnc.STATE_ESTOP

    def switch_on_and_home(self):
        command = self.command
        for request, value in (
            (command.state, linuxcnc.STATE_ESTOP_RESET),
            (command.state, linuxcnc.STATE_ON),
            (command.mode, linuxcnc.MODE_MANUAL),
            (command.teleop_enable, 0),
            (command.home, -1),
        ):
            request(value)
            command.wait_complete()

    def is_homed(self):
        stat = self.poll()
        return all(stat.homed[: stat.joints]) and stat.inpos

    def start(self, program, line=0):
        command = self.command
        command.mode(linuxcnc.MODE_AUTO)
        command.wait_complete()
        command.program_open(program)
        command.wait_complete()
        command.auto(linuxcnc.AUTO_RUN, line)
        # Right after AUTO_RUN the status still says idle; a refused program stays idle and has left a message.
        begins = lambda: self.poll().interp_state != linuxcnc.INTERP_IDLE or self.errors
        if not wait_until("the start of the program", begins, 5):
            self.errors.append("the program did not start: is this computer too busy?")

    def run(self, program, limit_s, line=0):
        """Seconds that the program took; None if it was cut off."""
        command = self.command
        begin = time.monotonic()
        self.start(program, line)
        while True:
            if not wait_until("the end of the program", self.is_done, limit_s):
                command.abort()
                command.wait_complete()
                return None
            end = time.monotonic()
            # On a busy computer the status of a running program looks like that for a moment.
            time.sleep(0.5)
            if self.is_done():
                return end - begin

    def is_done(self):
        stat = self.poll()
        return (
            stat.interp_state == linuxcnc.INTERP_IDLE
            and stat.exec_state in (linuxcnc.EXEC_DONE, linuxcnc.EXEC_ERROR)
            and stat.inpos
            and stat.queue == 0
        )


    def run_and_abort(self, program, after_s):
        self.start(program)
        time.sleep(after_s)
        self.command.abort()
        self.command.wait_complete()
        return wait_until("the abort", self.is_done, 10)

    def run_and_pause(self, program, at_s, for_s, limit_s):
        self.start(program)
        time.sleep(at_s)
        self.command.auto(linuxcnc.AUTO_PAUSE)
        time.sleep(for_s)
        self.command.auto(linuxcnc.AUTO_RESUME)
        return wait_until("the end of the program", self.is_done, limit_s)

    def mdi(self, text):
        self.command.mode(linuxcnc.MODE_MDI)
        self.command.wait_complete()
        self.command.mdi(text)
        self.command.wait_complete(60)
        return wait_until("the end of the block", self.is_done, 60)

    def step(self, words, folder, limit_s):
        """True: it came to its end."""
        kind, rest = words[0], words[1:]
        if kind == "run":
            line = int(rest[1]) if len(rest) > 1 else 0
            return self.run(os.path.join(folder, rest[0]), limit_s, line) is not None
        if kind == "abort":
            return self.run_and_abort(os.path.join(folder, rest[0]), float(rest[1]))
        if kind == "pause":
            return self.run_and_pause(os.path.join(folder, rest[0]), float(rest[1]), float(rest[2]), limit_s)
        if kind == "override":
            self.command.feedrate(float(rest[0]) / 100)
            self.command.wait_complete()
            return True
        if kind == "mdi":
            return self.mdi(" ".join(rest))
        if kind == "wait":
            time.sleep(float(rest[0]))
            return True
        return False

    def run_script(self, path, limit_s):
        """Seconds that all its steps took; None if one of them failed."""
        begin = time.monotonic()
        with open(path, encoding="utf-8") as file:
            steps = [line.split() for line in file if line.strip() and not line.startswith("#")]
        for words in steps:
            print("drive.py: %.2f s:" % (time.monotonic() - begin), " ".join(words), flush=True)
            if not self.step(words, os.path.dirname(path), limit_s):
                self.errors.append("step failed: " + " ".join(words))
                return None
        return time.monotonic() - begin


def shell(name):
    if os.environ.get(name):
        subprocess.run(os.environ[name], shell=True, check=False)


def main():
    machine = Machine()
    result = {"program_s": None, "homed": False, "errors": machine.errors}
    if wait_until("task", machine.task_is_up, STARTUP_LIMIT_S):
        machine.switch_on_and_home()
        result["homed"] = wait_until("home", machine.is_homed, STARTUP_LIMIT_S)
    if result["homed"]:
        shell("KERF_LIVE_READY")
        limit_s = float(os.environ.get("KERF_LIVE_LIMIT_S", "300"))
        script = os.environ.get("KERF_LIVE_SCRIPT")
        if script:
            result["program_s"] = machine.run_script(script, limit_s)
        else:
            result["program_s"] = machine.run(os.environ["KERF_LIVE_PROGRAM"], limit_s)
        shell("KERF_LIVE_AT_END")
    with open(os.environ["KERF_LIVE_RESULT"], "w", encoding="utf-8") as file:
        json.dump(result, file)
    return 0 if result["program_s"] is not None and not machine.errors else 1


if __name__ == "__main__":
    sys.exit(main())
