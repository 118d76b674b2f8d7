# SPDX-License-Identifier: Apache-2.0
"""The programs that bench.py and until.py compare: how each is started, and what CPU time it takes."""
import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
# Blender and the modules of its Python belong to the python3 of the system.
ENVIRONMENT = dict(os.environ, PATH="/usr/bin:/bin")


def run(command, good=(0,)):
    """Runs the command: its user and system time in s, and what it printed. Another exit status than the good ones
    ends the program."""
    with tempfile.TemporaryFile() as printed:
        process = subprocess.Popen(command, env=ENVIRONMENT, stdin=subprocess.DEVNULL, stdout=printed,
                                   stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        printed.seek(0)
        text = printed.read().decode(errors="replace")
    if process.returncode not in good:
        sys.exit("exit status %d of %s:\n%s" % (process.returncode, " ".join(command), text[-2000:]))
    return usage.ru_utime + usage.ru_stime, text


class Petzval:
    """Petzval with its defaults; the bounces, size and filter are the bench's."""

    def __init__(self, path):
        self.path = os.path.abspath(path)
        self.name = "petzval"
        if not os.path.exists(self.path):
            sys.exit("no %s: build it, or give the path of another program" % self.path)
        with open(self.path, "rb") as file:  # two builds of one version are not the same
            self.version = "sha256 " + hashlib.sha256(file.read()).hexdigest()[:16]

    def render(self, a, row, scene, samples, seed, output):
        """Renders to the file; returns the CPU time from start to end, s."""
        command = [self.path, "render", scene, "--size", a.size, "--spp", str(samples), "--method", "filter=box",
                   "--threads", str(a.threads), "--seed", str(seed), "--quiet", "-o", output,
                   # Cycles counts what comes after the first surface.
                   "--method", "max-depth=%d" % (a.bounces + 1), "--fov", str(row.vfov_deg),
                   "--look-at=" + ",".join(map(str, [*row.eye, *row.target])), *row.petzval]
        command += ["--env", row.sky] if row.sky else []
        if row.lens_radius:
            command += ["--lens", "thin", "--method", "lens-radius=%s" % row.lens_radius, "--focus", "%gm" % row.focus]
        else:
            command += ["--lens", "pinhole"]
        return run(command, good=(0, 5))[0]  # 5: a noise that it was asked for is not surely reached everywhere


class Blender:
    """One Blender, by cycles.py."""

    def __init__(self, path, pattern):
        found = shutil.which(path, path="/usr/bin:/bin") or shutil.which(path)
        if not found:
            raise FileNotFoundError(path)
        self.path, self.pattern = os.path.abspath(found), pattern
        text = run([self.path, "--version"])[1]
        self.version = next((line.strip() for line in text.splitlines() if line.startswith("Blender ")), "Blender")
        self.name = ".".join(self.version.split()[1].split(".")[:2]) if " " in self.version else path
        self.name = "Blender " + self.name + (" " + pattern if pattern else "")

    def render(self, a, row, scene, samples, seed, output, noise_threshold=None):
        """Renders to the file; returns the CPU time from start to end, s. With a threshold the samples are the most
        that a pixel gets."""
        width, height = map(int, a.size.split("x"))
        wanted = {"scene": scene, "output": output, "width": width, "height": height, "samples": samples,
                  "seed": seed, "threads": a.threads, "bounces": a.bounces, "fov_deg": row.vfov_deg,
                  "look_at": [*row.eye, *row.target], "environment": row.sky, "lens_radius_m": row.lens_radius,
                  "focus_m": row.focus, "pattern": self.pattern, "noise_threshold": noise_threshold}
        cpu_s, text = run([self.path, "-b", "--factory-startup", "-noaudio", "-P", os.path.join(HERE, "cycles.py"),
                           "--", json.dumps(wanted)])
        if "CYCLES done" not in text:
            sys.exit("%s did not finish %s:\n%s" % (self.name, row.name, text[-2000:]))
        return cpu_s
