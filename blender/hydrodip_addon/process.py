"""The hydrodip program in the background. Nothing here knows Blender."""

import os
import re
import signal
import subprocess
import threading

_PROGRESS = re.compile(r"([^\d%]+?)(?: +(\d+) %.*)?$")
_ERROR = "error: "


class Job:
    """A run of the program: what it is doing, what came of it."""

    def __init__(self, arguments, folder):
        flags = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP} if os.name == "nt" else {}
        self.activity, self.fraction, self.error = "starting", 0.0, ""
        self.cancelled = False
        self._process = subprocess.Popen(
            arguments, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True, encoding="utf-8", errors="replace", **flags)
        self._said = []
        self._readers = [threading.Thread(target=self._listen, daemon=True),
                         threading.Thread(target=self._collect, daemon=True)]
        for reader in self._readers:
            reader.start()

    def _listen(self):
        for line in self._process.stderr:
            line = line.strip()
            match = _PROGRESS.match(line)
            if line.startswith(_ERROR):
                self.error = line[len(_ERROR) :]
            elif match:
                self.activity = match.group(1).strip()
                self.fraction = float(match.group(2) or 0) / 100

    def _collect(self):
        self._said.append(self._process.stdout.read())

    def poll(self):
        """The exit code, or None while it runs."""
        code = self._process.poll()
        if code is not None:
            for reader in self._readers:
                reader.join()
        return code

    def cancel(self):
        """Asks it to stop; the second time it is stopped."""
        if self._process.poll() is None:
            if self.cancelled:
                self._process.kill()
            elif os.name == "nt":
                self._process.send_signal(signal.CTRL_BREAK_EVENT)
            else:
                self._process.send_signal(signal.SIGINT)
        self.cancelled = True

    @property
    def said(self):
        """What it printed as its result, once it has ended."""
        return "".join(self._said)
