"""A client of kerf mcp: lines of JSON-RPC 2.0 as the specification of the Model Context Protocol has them
(https://modelcontextprotocol.io/specification/2025-06-18/basic/transports#stdio).
"""

import json
import os
import select
import subprocess
import time

PATIENCE_S = 90


class Client:
    def __init__(self, kerf, *words, folder, version="2025-06-18", environment=None):
        self.process = subprocess.Popen([kerf, "mcp", *words], cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, env={**os.environ, "LC_ALL": "C", **(environment or {})})
        self.unread = b""
        self.asked = 0
        if version:
            self.hello = self.ask("initialize", {"protocolVersion": version, "capabilities": {},
                                                 "clientInfo": {"name": "test", "version": "1"}})
            self.tell("notifications/initialized")

    def write(self, data):
        self.process.stdin.write(data if isinstance(data, bytes) else data.encode())
        self.process.stdin.flush()

    def send(self, message):
        self.write(json.dumps(message) + "\n")

    def tell(self, method, params=None):
        self.send({"jsonrpc": "2.0", "method": method, **({"params": params} if params is not None else {})})

    def begin(self, method, params=None):
        self.asked += 1
        self.send({"jsonrpc": "2.0", "id": self.asked, "method": method,
                   **({"params": params} if params is not None else {})})
        return self.asked

    def read(self, patience_s=PATIENCE_S):
        """The next message; None: there is none in that time, or the end of all."""
        end = time.monotonic() + patience_s
        while b"\n" not in self.unread:
            ready, _, _ = select.select([self.process.stdout], [], [], max(0.0, end - time.monotonic()))
            piece = os.read(self.process.stdout.fileno(), 1 << 16) if ready else b""
            if not piece:
                return None
            self.unread += piece
        line, self.unread = self.unread.split(b"\n", 1)
        message = json.loads(line.decode("utf-8"))
        assert message["jsonrpc"] == "2.0", message
        return message

    def ask(self, method, params=None):
        number = self.begin(method, params)
        message = self.read()
        assert message is not None, f"{method} is not answered"
        assert message["id"] == number, (message, number)
        return message

    def call(self, name, **arguments):
        """(is it a fault, its content)"""
        result = self.ask("tools/call", {"name": name, "arguments": arguments})["result"]
        return result["isError"], result["content"][0]

    def json(self, name, **arguments):
        is_fault, content = self.call(name, **arguments)
        assert not is_fault, content
        return json.loads(content["text"])

    def fault(self, name, **arguments):
        is_fault, content = self.call(name, **arguments)
        assert is_fault, content
        return content["text"]

    def children(self):
        task = f"/proc/{self.process.pid}/task/{self.process.pid}/children"
        with open(task, encoding="ascii") as file:
            return [int(word) for word in file.read().split()]

    def close(self):
        """Its end, as a client begins it: (exit code, what came on stdout after what was read, stderr)."""
        self.process.stdin.close()
        return self.wait()

    def wait(self):
        left = self.unread + self.process.stdout.read()
        said = self.process.stderr.read()
        return self.process.wait(timeout=PATIENCE_S), left, said
