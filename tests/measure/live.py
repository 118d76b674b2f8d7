#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Time from a change to the rough picture of `petzval live`, as a page sees it: live.py PROGRAM SCENE..."""
import pathlib
import statistics
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "apps/live"))
from live import Live, Page  # noqa: E402

LENSES = (None, "takumar-50mm-f1.2", "canon-14mm-f2.8-asph", "petzval-portrait-100mm-f3.6")
CHANGES = 21
WAITS_S = (0.02, 0.6)  # into the preparation of the picture before, and into the picture


def time_of(page, version, fields):
    """Seconds until a rough picture is there."""
    start = time.monotonic()
    page.ask(version, **fields)
    while True:
        now = page.next("status")
        if now["version"] == version and now["stage"] == "failed":
            sys.exit(now["error"])
        if now["version"] == version and now["stage"] == "rough":
            page.live.ask("GET", f"/api/picture?page={page.page}")
            return time.monotonic() - start


for scene in sys.argv[2:]:
    for lens in LENSES:
        with Live(sys.argv[1], scene) as live:
            page = Page(live)
            times_ms = []
            for version in range(1, CHANGES + 1):
                fields = {"size": "640x360", "orbit": str(3 * version)} | ({"lens": lens} if lens else {})
                times_ms.append(1000 * time_of(page, version, fields))
                time.sleep(WAITS_S[version % 2])
            page.close()
        first, *rest = times_ms
        print(f"{pathlib.Path(scene).name} {lens or 'as in the scene'}: first {first:.0f} ms; then median "
              f"{statistics.median(rest):.0f} ms, worst {max(rest):.0f} ms", flush=True)
