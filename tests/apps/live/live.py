# SPDX-License-Identifier: Apache-2.0
"""A live server for tests, and what a page says to it."""
import http.client
import json
import os
import signal
import subprocess
import time
import urllib.parse


class Live:
    """`petzval live` while a with statement lasts."""

    def __init__(self, program, *options):
        """options: the scene among them."""
        self.program = program
        self.process = subprocess.Popen([program, "live", *options], stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        if not self.address:
            raise RuntimeError(self.process.stderr.read())
        parts = urllib.parse.urlsplit(self.address)
        self.host, self.port, self.folder = parts.hostname, parts.port, parts.path

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            self.process.communicate(timeout=60)

    def memory_bytes(self):
        with open(f"/proc/{self.process.pid}/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def ask(self, method, path, body=None, **headers):
        """Status, headers and bytes of an answer."""
        connection = http.client.HTTPConnection(self.host, self.port, timeout=60)
        names = {name.replace("_", "-"): value for name, value in headers.items()}
        if body is not None and "Content-Type" not in names:
            names["Content-Type"] = "application/json"
        connection.request(method, self.folder.rstrip("/") + path, body, names)
        answer = connection.getresponse()
        data = answer.read()
        connection.close()
        return answer.status, answer.headers, data


class Page:
    """The stream of events of a page, and its requests."""

    def __init__(self, live, wanted=""):
        self.live = live
        self.connection = http.client.HTTPConnection(live.host, live.port, timeout=120)
        self.connection.request("GET", live.folder.rstrip("/") + f"/api/events?page={wanted}")
        self.stream = self.connection.getresponse()
        self.status_code = self.stream.status
        self.page = self.next("page")["page"] if self.status_code == 200 else None

    def close(self):
        self.stream.close()
        self.connection.close()

    def next(self, name):
        """Data of the next event of that name."""
        kind = None
        while True:
            line = self.stream.readline().decode()
            if not line:
                raise EOFError("the server has ended the stream")
            line = line.rstrip("\n")
            if line.startswith("event: "):
                kind = line[7:]
            elif line.startswith("data: ") and kind == name:
                return json.loads(line[6:])

    def ask(self, version, **fields):
        """Asks for a picture; a field has one text or a list of them."""
        texts = {name.replace("_", "-"): text if isinstance(text, list) else [text] for name, text in fields.items()}
        body = json.dumps({"page": self.page, "version": version, "fields": texts})
        status, _, data = self.live.ask("POST", "/api/request", body)
        return status, json.loads(data)

    def end(self, version):
        """Status of a request that is done or has failed."""
        while True:
            now = self.next("status")
            if now["version"] == version and now["stage"] in ("done", "failed"):
                return now

    def file(self, version, name="picture.exr"):
        return self.live.ask("GET", f"/api/file?page={self.page}&version={version}&name={name}")
