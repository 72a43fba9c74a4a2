"""A simulated machine that runs a program, and kerf shadow beside it with --serve."""

import json
import os
import pathlib
import re
import signal
import struct
import subprocess

# Pockets one below the other, for a minute and a half.
PROGRAM = "G21 G90 G17\nT1 M6\nS9000 M3\nG0 X10 Y10 Z5\n" + "".join(
    f"G1 Z-{depth} F400\nG1 X70 F900\nY18\nX10\nY26\nX70\nY34\nX10\nY42\nX70\nG0 Z5\nX10 Y10\n" for depth in range(1, 9)) + "M2\n"


class ServedWatch:
    def __init__(self, kerf, folder, address, for_s):
        (folder / "pockets.ngc").write_text(PROGRAM)
        self.report = folder / "watch.json"
        env = {**os.environ, "LC_ALL": "C.UTF-8", "LANGUAGE": ""}
        self.machine = subprocess.Popen(
            [str(kerf), "machine", "pockets.ngc", "--modbus-tcp", "127.0.0.1:0", "--frame", "workpiece", "--wait-for-reader", "--hold"],
            cwd=folder, env=env, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        port = self.machine.stdout.readline().strip().rsplit(":", 1)[1]
        root = pathlib.Path(__file__).resolve().parent.parent.parent
        config = (root / "configs/kerf_machine.yaml").read_text().replace("1502", port)
        (folder / "machine.yaml").write_text(config)
        self.said = []
        self.shadow = subprocess.Popen(
            [str(kerf), "shadow", "-c", "machine.yaml", "--program", "pockets.ngc", "--stock", "box:0,0,-20:80,60,0", "--tool", "1=flat:8",
             "--no-view", "--for", str(for_s), "--serve", address, "--json", "watch.json"],
            cwd=folder, env=env, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        while True:
            line = self.shadow.stderr.readline()
            if not line:
                raise RuntimeError("no page is served: " + "".join(self.said))
            self.said.append(line)
            if found := re.search(r"http://([^/:]*|\[[^]]*\]):(\d+)/(?:#(\w+))?", line):
                self.port, self.token = int(found[2]), found[3] or ""
                break

    def finish(self):
        """Ends the watch, as Ctrl-C does; the report's section of it."""
        self.shadow.send_signal(signal.SIGINT)
        self.said.append(self.shadow.communicate(timeout=180)[1])
        return json.loads(self.report.read_text())["live"]

    def close(self):
        for process in (self.shadow, self.machine):
            if process.poll() is None:
                process.send_signal(signal.SIGTERM)
            process.wait(timeout=20)


def parts_of(answer):
    """The JSON of an answer of /scene, and its tiles: number -> (corners, indices)."""
    if answer[:4] != b"KRF1":
        raise ValueError("no scene")
    length = struct.unpack_from("<I", answer, 4)[0]
    state = json.loads(answer[8:8 + length])
    tiles, at = {}, 8 + length
    while at < len(answer):
        tile, corners, indices = struct.unpack_from("<III", answer, at)
        tiles[tile] = (corners, indices)
        end = at + 36 + 10 * corners + indices * (4 if corners > 65536 else 2)
        at = end + -end % 4
    return state, tiles
