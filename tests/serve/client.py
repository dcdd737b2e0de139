"""A WebSocket client of `ipos serve` of a hundred lines, so that nothing is needed but Python. Tests are called with the program
as their first word."""
import base64
import json
import os
import socket
import struct
import sys
import tempfile
import time

IPOS = sys.argv.pop(1)
PATIENCE = 100  # s for anything that must come; a loaded machine needs more than an idle one
STATE = tempfile.TemporaryDirectory()  # tokens of these tests are no business of the user's
os.environ["XDG_STATE_HOME"] = STATE.name


class Client:
    """One WebSocket."""

    def __init__(self, port, path, headers=(), host=None, origin=None):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE)
        key = base64.b64encode(os.urandom(16)).decode()
        lines = [f"GET {path} HTTP/1.1", f"Host: {host or f'127.0.0.1:{port}'}", "Upgrade: websocket",
                 "Connection: Upgrade", f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13", *headers]
        if origin:
            lines.append(f"Origin: {origin}")
        self.socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        self.rest = b""
        while b"\r\n\r\n" not in self.rest:
            more = self.socket.recv(65536)
            if not more:
                break
            self.rest += more
        head, _, self.rest = self.rest.partition(b"\r\n\r\n")
        self.status = int(head.split()[1])
        self.id = 0
        self.events = []

    def take(self, count):
        while len(self.rest) < count:
            more = self.socket.recv(65536)
            if not more:
                raise EOFError
            self.rest += more
        taken, self.rest = self.rest[:count], self.rest[count:]
        return taken

    def receive(self):
        """The next message: (opcode, bytes)."""
        first, second = self.take(2)
        length = second & 127
        if length == 126:
            length = struct.unpack(">H", self.take(2))[0]
        elif length == 127:
            length = struct.unpack(">Q", self.take(8))[0]
        data = self.take(length)
        if first & 15 == 9:  # a ping wants its pong, else the server thinks that nobody is there
            self.send(data, opcode=10)
        return first & 15, data

    def send(self, data, opcode=1):
        mask = os.urandom(4)
        length = len(data)
        head = bytes([128 | opcode])
        if length < 126:
            head += bytes([128 | length])
        elif length < 65536:
            head += bytes([128 | 126]) + struct.pack(">H", length)
        else:
            head += bytes([128 | 127]) + struct.pack(">Q", length)
        masked = bytes(b ^ mask[n & 3] for n, b in enumerate(data))
        self.socket.sendall(head + mask + masked)

    def ask(self, **message):
        """The reply, of all its parts; events that come before it are kept."""
        self.id += 1
        message["id"] = self.id
        self.send(json.dumps(message).encode())
        whole = {}
        while True:
            opcode, data = self.receive()
            if opcode == 8:
                raise EOFError
            if opcode != 1:
                continue
            answer = json.loads(data)
            if answer.get("re") != self.id:
                self.events.append(answer)
                continue
            more = answer.pop("more", False)
            for key, value in answer.items():
                whole[key] = whole[key] + value if key in whole and isinstance(value, list) else value
            if not more:
                return whole

    def wait_for(self, event, wanted=lambda _: True):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            opcode, data = self.receive()
            answer = json.loads(data) if opcode == 1 else {}
            if answer.get("event") == event and wanted(answer):
                return answer
        raise TimeoutError(f"no such event: {event}")

    def close(self):
        self.socket.close()
