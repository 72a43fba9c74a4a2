#!/usr/bin/python3
"""drive_screen.py PROGRAM: beside a LinuxCNC with a screen, what its user does: switches on, homes, opens the program, waits
for kerf's leave, starts it, waits for its end, and closes the screen. Writes screen.json:
  load_to_off_s seconds from opening the program until the leave for the one before is gone
  load_to_ok_s  seconds from opening the program to kerf.program-ok; null: it never came
  dry_run_s     seconds until a kerf run of the program was there, or its leave
  findings, time_left_s   the pins when it was loaded
  tab_seen      whether kerf's window can be seen while the program runs, once its tab was clicked (show_tab)
  program_s     that it took; null: it did not come to its end
  restarted_s   seconds from a crash of what is in the tab to kerf.alive again
  edit_to_off_s seconds from a change of the file on the disk until the leave is gone
  ok_again      the leave some seconds later
  errors        LinuxCNC's messages
Pictures: loaded.png, running.png, end.png, crashed.png."""
import json
import os
import signal
import subprocess
import sys
import time

import drive


def pin(name):
    done = subprocess.run(["halcmd", "getp", name], capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else None


def picture(name):
    subprocess.run(["import", "-window", "root", name], check=False)


def pids(pattern):
    done = subprocess.run(["pgrep", "-f", pattern], capture_output=True, text=True, check=False)
    return [int(word) for word in done.stdout.split()]


def since(begin, condition, limit_s):
    return time.monotonic() - begin if drive.wait_until("", condition, limit_s) else None


def is_allowed():
    return pin("kerf.program-ok") == "TRUE"


def is_seen():
    """A window of kerf's is mapped, and all that it lies in."""
    done = subprocess.run(["xdotool", "search", "--onlyvisible", "--class", "kerf"], capture_output=True, check=False)
    return done.stdout.strip() != b""


def show_tab():
    """The tab is brought to the front, as a click would. KERF_TAB_AT are places where its name may stand, "X,Y X,Y": it
    differs by screen, and by the letters that are installed."""
    for place in os.environ.get("KERF_TAB_AT", "").split():
        subprocess.run(["xdotool", "mousemove", *place.split(","), "click", "1"], check=False)
        if drive.wait_until("", is_seen, 1):
            break


def click_through(places):
    """Clicks, each of them with a picture after it: "X,Y X,Y"."""
    for n, place in enumerate(places.split(), 1):
        subprocess.run(["xdotool", "mousemove", *place.split(","), "sleep", "0.3", "click", "1"], check=False)
        time.sleep(1.5)
        picture(f"click{n}.png")


def main():
    program = sys.argv[1]
    own = os.path.join(os.getcwd(), "part.ngc")
    with open(program, encoding="utf-8") as file:
        text = file.read()
    with open(own, "w", encoding="utf-8") as file:
        file.write(text)
    machine = drive.Machine.__new__(drive.Machine)
    result = {"errors": []}
    for _ in range(300):
        try:  # until LinuxCNC has made its status, and its tools
            machine.__init__()
            machine.stat.poll()
            break
        except (drive.linuxcnc.error, SystemError):
            time.sleep(0.2)
    if drive.wait_until("task", machine.task_is_up, 60) and drive.wait_until(
        "kerf", lambda: pin("kerf.alive") == "TRUE", 60
    ):
        time.sleep(2)
        show_tab()
        for _ in range(5):  # a screen that is still starting may switch off again
            machine.switch_on_and_home()
            if machine.poll().task_state == drive.linuxcnc.STATE_ON:
                break
            time.sleep(2)
        machine.errors.clear()
        result["homed"] = drive.wait_until("home", machine.is_homed, 60)
        result["ok_before"] = pin("kerf.program-ok")
        machine.command.mode(drive.linuxcnc.MODE_AUTO)
        machine.command.wait_complete()
        begin = time.monotonic()
        machine.command.program_open(own)
        result["load_to_off_s"] = since(begin, lambda: pin("kerf.program-ok") != "TRUE", 5)
        # It takes a tenth of a second: the leave that only it gives may be seen before it is.
        result["dry_run_s"] = since(begin, lambda: pids("kerf run .*part.ngc") or is_allowed(), 10)
        result["load_to_ok_s"] = since(begin, is_allowed, 30)
        result["findings"] = pin("kerf.findings")
        result["time_left_s"] = pin("kerf.time-left")
        time.sleep(4)
        picture("loaded.png")
        click_through(os.environ.get("KERF_CLICKS", ""))
        begin = time.monotonic()
        machine.command.mode(drive.linuxcnc.MODE_AUTO)  # a screen may have left it
        machine.command.wait_complete()
        machine.command.auto(drive.linuxcnc.AUTO_RUN, 0)
        result["started"] = drive.wait_until("the start", lambda: machine.poll().interp_state != drive.linuxcnc.INTERP_IDLE, 5)
        time.sleep(3)
        show_tab()
        time.sleep(1)
        result["tab_seen"] = is_seen()
        picture("running.png")
        result["program_s"] = since(begin, machine.is_done, 120)
        time.sleep(2)
        picture("end.png")
        with open(own, "a", encoding="utf-8") as file:
            file.write("(changed)\n")
        begin = time.monotonic()
        result["edit_to_off_s"] = since(begin, lambda: pin("kerf.program-ok") != "TRUE", 5)
        time.sleep(4)
        result["ok_again"] = pin("kerf.program-ok")
        guard = min(pids("kerf shadow"), default=0)
        child = subprocess.run(["pgrep", "-P", str(guard)], capture_output=True, text=True, check=False).stdout.split()
        if child:
            os.kill(int(child[0]), signal.SIGSEGV)
            begin = time.monotonic()
            drive.wait_until("the crash", lambda: pin("kerf.alive") != "TRUE", 5)
            result["restarted_s"] = since(begin, lambda: pin("kerf.alive") == "TRUE", 20)
            time.sleep(5)
            picture("crashed.png")
    result["errors"] = machine.errors
    with open("screen.json", "w", encoding="utf-8") as file:
        json.dump(result, file)
    # The screen ends LinuxCNC when it is closed. LinuxCNC's Python module makes SIGTERM a KeyboardInterrupt, which
    # Gmoccapy mostly shows in a dialog that waits to be read.
    screen = [pid for pid in pids("/usr/bin/(axis|gmoccapy|qtvcp)") or pids("qtvcp|gmoccapy|axis") if pid != os.getpid()]
    for number in (signal.SIGTERM, signal.SIGKILL):
        for pid in screen:
            try:
                os.kill(pid, number)
            except ProcessLookupError:
                pass
        if since(time.monotonic(), lambda: not any(os.path.exists(f"/proc/{pid}") for pid in screen), 4) is not None:
            break
    return 0 if result.get("program_s") else 1


if __name__ == "__main__":
    sys.exit(main())
