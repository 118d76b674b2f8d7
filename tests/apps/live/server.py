#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The server of `petzval live`, asked as a page asks and as nobody should: server.py PROGRAM SCENE"""
import gzip
import json
import pathlib
import shlex
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest

from live import Live, Page

PROGRAM, SCENE = sys.argv[1], sys.argv[2]
SMALL = {"size": "48x32", "spp": "4"}


class Server(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.live = Live(PROGRAM, SCENE, "--fstop", "2", "--threads", "2")

    @classmethod
    def tearDownClass(cls):
        cls.live.__exit__()

    def ask(self, *what, **headers):
        return self.live.ask(*what, **headers)

    def test_the_page_and_what_it_needs_are_there_and_nothing_else_is(self):
        for path, kind in {"/": "text/html", "/main.js": "text/javascript", "/live.css": "text/css",
                           "/api/facts": "application/json",
                           "/api/lens.svg?name=takumar-50mm-f1.2": "image/svg+xml"}.items():
            status, headers, data = self.ask("GET", path)
            self.assertEqual(status, 200, path)
            self.assertTrue(headers["Content-Type"].startswith(kind), path)
            self.assertIn("default-src 'none'", headers["Content-Security-Policy"])
            self.assertGreater(len(data), 100)
        for path in ("/../CMakeLists.txt", "/..%2f..%2fCMakeLists.txt", "/etc/passwd", "//etc/passwd", "/live.css/..",
                     "/api/lens.svg?name=../../etc/passwd", "/api/lens.svg", "/api", "/%00"):
            self.assertIn(self.ask("GET", path)[0], (400, 404), path)

    def test_nothing_of_other_sites_is_loaded(self):
        for name in ("/", "/main.js", "/live.css", "/api.js", "/controls.js", "/finder.js", "/pose.js", "/state.js"):
            text = self.ask("GET", name)[2].decode()
            self.assertNotIn("https://", text)
            self.assertNotIn("innerHTML", text, "names of files would become markup")

    def test_other_pages_are_refused(self):
        for headers in ({"Host": "example.com"}, {"Origin": "http://example.com"}, {"Sec-Fetch-Site": "cross-site"}):
            self.assertEqual(self.ask("GET", "/api/facts", **headers)[0], 403, headers)
            self.assertEqual(self.ask("GET", "/api/events", **headers)[0], 403, headers)
        self.assertEqual(self.ask("POST", "/api/request", "{}", Content_Type="text/plain")[0], 403)

    def test_the_command_line_gives_the_bytes_that_are_saved(self):
        page = Page(self.live)
        _, answer = page.ask(1, fstop="4", lens="takumar-50mm-f1.2", focus="24,16", **SMALL)
        self.assertIn("--fstop 4", answer["command"])
        end = page.end(1)
        self.assertEqual(end["stage"], "done", end)
        self.assertGreater(end["camera"]["focus_m"], 0)
        # The distance that was found is the focus.
        _, answer = page.ask(2, fstop="4", lens="takumar-50mm-f1.2", focus=f"{end['camera']['focus_m']}m",
                             pose=end["camera"]["pose"], **SMALL)
        self.assertEqual(page.end(2)["stage"], "done")
        for name in ("picture.exr", "picture.png"):
            status, headers, data = page.file(2, name)
            self.assertEqual(status, 200)
            self.assertEqual(headers["Content-Disposition"], "attachment")
            with tempfile.TemporaryDirectory() as folder:
                words = shlex.split(answer["command"])
                self.assertEqual(words[0], "petzval")
                words[0] = PROGRAM
                words[words.index("picture.exr")] = f"{folder}/{name}"
                subprocess.run(words + ["--quiet"], check=True)
                self.assertEqual(data, pathlib.Path(folder, name).read_bytes(), name)
        status, headers, data = self.ask("GET", f"/api/picture?page={page.page}")
        self.assertEqual((status, headers["X-Size"], len(data)), (200, "48x32", 48 * 32 * 4))
        page.close()

    def test_the_scene_is_told_once_it_is_loaded(self):
        page = Page(self.live)
        page.ask(1, **SMALL)
        self.assertEqual(set(page.next("scene")), {"animations", "cameras", "variants"})
        page.close()

    def test_faults_are_told_with_the_field(self):
        page = Page(self.live)
        for fields, field in (({"fstop": "wide"}, "⟨fstop⟩"), ({"size": "0x0"}, "⟨size⟩"), ({"nonsense": "1"}, "⟨nonsense⟩"),
                              ({"output": "a.exr"}, "⟨output⟩"), ({"env": "/etc/passwd"}, "/etc/passwd")):
            status, answer = page.ask(1, **fields)
            self.assertEqual((status, answer["field"]), (400, field), answer)
        for size in ("100000x100000", "65536x65536"):
            status, answer = page.ask(3, size=size)
            if status == 200:
                self.assertEqual(page.end(3)["stage"], "failed")
        page.ask(4, camera="no such camera", **SMALL)
        self.assertIn("no such camera", page.end(4)["error"])
        page.ask(5, **SMALL)
        self.assertEqual(page.end(5)["stage"], "done")
        page.close()

    def test_the_camera_of_the_file_keeps_its_lens_where_it_stands_elsewhere(self):
        page = Page(self.live)
        page.ask(1, **SMALL)
        first = page.end(1)["camera"]
        page.ask(2, camera=first["camera"], pose=first["pose"], **SMALL)
        again = page.end(2)["camera"]
        self.assertGreater(first["yfov_deg"], 0)
        self.assertEqual({**again, "camera": first["camera"]}, first)
        page.close()

    def test_a_sky_that_changes_is_read_anew(self):
        with tempfile.TemporaryDirectory() as folder:
            scene, sky = pathlib.Path(folder, "scene.glb"), pathlib.Path(folder, "sky.exr")
            scene.write_bytes(pathlib.Path(SCENE).read_bytes())
            subprocess.run([PROGRAM, "render", SCENE, "--size", "32x16", "--spp", "1", "--quiet", "-o", sky], check=True)
            with Live(PROGRAM, str(scene)) as live:
                page = Page(live)
                page.ask(1, env=str(sky), **SMALL)
                self.assertEqual(page.end(1)["stage"], "done")
                subprocess.run([PROGRAM, "render", SCENE, "--size", "32x16", "--spp", "2", "--quiet", "-o", sky],
                               check=True)
                page.ask(2, env=str(sky), exposure="1", **SMALL)
                end = page.end(2)
                self.assertTrue(any("changed" in notice for notice in end["notices"]), end)
                page.close()

    def test_a_lens_that_passes_no_light_is_told(self):
        page = Page(self.live)
        page.ask(1, lens="takumar-50mm-f1.2", fstop="1000000", **SMALL)
        end = page.end(1)
        self.assertTrue(end["stage"] == "failed" and end["error"] or end["stage"] == "done", end)
        page.close()

    def test_what_is_no_request_is_refused(self):
        for body in ("", "{", "[]", "null", '{"page": 1}', '{"page": "x", "version": -1, "fields": {}}',
                     '{"page": "x", "version": 1, "fields": {"fstop": "2"}}', "[" * 50000,
                     '{"page": "x", "version": 1, "fields": {}}'):
            self.assertEqual(self.ask("POST", "/api/request", body)[0], 400, body[:40])
        self.assertEqual(self.ask("POST", "/api/request", "x" * 70000)[0], 413)
        bomb = gzip.compress(b"[" * 10**7)
        self.assertEqual(self.ask("POST", "/api/request", bomb, Content_Encoding="gzip")[0], 403)
        self.assertEqual(self.ask("POST", "/api/request", iter([b"[" * 1000] * 1000))[0], 403)
        page = Page(self.live)
        for fields in ({"fstop": None}, {"fstop": []}, {"fstop": [2]}, {"fstop": {}}):
            body = json.dumps({"page": page.page, "version": 1, "fields": fields})
            status, _, data = self.ask("POST", "/api/request", body)
            self.assertEqual((status, json.loads(data)["field"]), (400, "⟨fstop⟩"))
        page.close()
        self.assertEqual(self.ask("GET", "/api/picture?page=none")[0], 400)
        self.assertEqual(self.ask("GET", "/" + "a" * 20000)[0], 414)

    def test_requests_that_are_cut_off_harm_nobody(self):
        for text in (b"GET", b"GET / HTTP/1.1\r\nHost", b"POST /api/request HTTP/1.1\r\nContent-Length: 5000\r\n\r\n{",
                     b"\0" * 100, b"GET / HTTP/9.9\r\n\r\n"):
            with socket.create_connection((self.live.host, self.live.port)) as connection:
                connection.sendall(text)
        self.assertEqual(self.ask("GET", "/")[0], 200)

    def test_clients_that_stop_halfway_lose_their_place(self):
        stopped = []
        for text in (b"", b"GET / HTTP/1.1\r\nHost", b"POST /api/request HTTP/1.1\r\nHost: " +
                     f"{self.live.host}:{self.live.port}".encode() +
                     b"\r\nContent-Type: application/json\r\nContent-Length: 5000\r\n\r\n{") * 20:
            connection = socket.create_connection((self.live.host, self.live.port))
            connection.sendall(text)
            stopped.append(connection)
        self.assertEqual(self.ask("GET", "/")[0], 200)  # waits for one of 40 places, then is answered
        for connection in stopped:
            connection.settimeout(60)
            while connection.recv(4096):  # until the server has closed it
                pass
            connection.close()

    def test_names_of_files_stay_inside_the_folder(self):
        page = Page(self.live)
        page.ask(1, **SMALL)
        page.end(1)
        for name in ("../x.exr", "/tmp/x.exr", "x.txt", "", "a%2fb.exr"):
            self.assertEqual(page.file(1, name)[0], 400, name)
        self.assertEqual(page.file(2)[0], 400, "another version")
        page.close()

    def test_so_many_pages_and_no_more(self):
        time.sleep(1)  # those of other tests are gone
        pages = [Page(self.live) for _ in range(6)]
        self.assertEqual([page.status_code for page in pages], [200] * 5 + [503])
        for page in pages:
            page.close()
        deadline = time.monotonic() + 20  # the server learns of it by its next word
        while (page := Page(self.live)).status_code != 200:
            page.close()
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.2)
        page.close()

    def test_a_page_that_comes_back_finds_its_picture(self):
        page = Page(self.live)
        page.ask(1, size="320x180", spp="1000")
        while (now := page.next("status"))["samples"] < 4:
            pass
        page.close()
        time.sleep(1)
        again = Page(self.live, page.page)
        self.assertEqual(again.page, page.page)
        again.ask(2, size="320x180", spp="1000")
        stages = []
        while (now := again.next("status"))["version"] < 2 or now["stage"] != "growing":
            stages.append(now["stage"])
        self.assertGreaterEqual(now["samples"], 4)
        self.assertNotIn("rough", stages[1:])
        again.close()

    def test_hundreds_of_moves_neither_leak_nor_fall_behind(self):
        page = Page(self.live)
        latest = [None]

        def listen():
            while True:
                now = page.next("status")
                latest[0] = now
                if now["version"] == 600 and now["stage"] == "done":
                    return

        listener = threading.Thread(target=listen)
        listener.start()
        half = 0
        for version in range(1, 601):
            page.ask(version, orbit=str(version), **SMALL)
            if version == 300:
                half = self.live.memory_bytes()
        listener.join(timeout=60)
        self.assertFalse(listener.is_alive(), latest[0])
        self.assertLess(self.live.memory_bytes() - half, 30e6)
        page.close()


class Start(unittest.TestCase):
    def test_a_port_that_is_taken(self):
        with Live(PROGRAM, SCENE) as live:
            done = subprocess.run([PROGRAM, "live", SCENE, "--port", str(live.port)], capture_output=True, text=True,
                                  check=False, timeout=60)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn("--port", done.stderr)

    def test_no_scene(self):
        done = subprocess.run([PROGRAM, "live", "none.glb"], capture_output=True, text=True, check=False, timeout=60)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("none.glb", done.stderr)

    def test_the_page_to_learn_from(self):
        with Live(PROGRAM, "--learn", "--threads", "2") as live:
            text = live.ask("GET", "/")[2].decode()
            self.assertIn("learn.js", text)
            for name in ("/learn.js", "/plots.js", "/live.css"):
                self.assertEqual(live.ask("GET", name)[0], 200)
                self.assertNotIn("https://", live.ask("GET", name)[2].decode())
            self.assertEqual(live.ask("GET", "/learn.html")[0], 404)

            def lesson(name, **fields):
                texts = {one.replace("_", "-"): [text] for one, text in fields.items()}
                status, _, data = live.ask("POST", "/api/lesson", json.dumps({"lesson": name, "fields": texts}))
                return status, json.loads(data)
            takumar = {"lens": "takumar-50mm-f1.2", "fstop": "2", "focus": "1m"}
            status, found = lesson("confusion", **takumar)
            self.assertEqual(status, 200)
            self.assertEqual(len(found["plots"]), 2)
            for name, fields in (("none", takumar), ("depth", {}), ("depth", {**takumar, "focus": "auto"}),
                                 ("depth", {**takumar, "focus": "3cm"}), ("depth", {**takumar, "fstop": "wide"}),
                                 ("bokeh", {**takumar, "aperture": "/etc/passwd"}),
                                 ("spherical", {**takumar, "lens": "singlet:NONE"}), ("depth", {**takumar, "lens": "/etc/passwd"})):
                status, found = lesson(name, **fields)
                self.assertEqual(status, 400, (name, fields))
                self.assertTrue(found["error"])
            for body in ("", "[]", "{}", '{"lesson": 1, "fields": {}}', '{"lesson": "depth", "fields": []}'):
                self.assertEqual(live.ask("POST", "/api/lesson", body)[0], 400, body)
            page = Page(live)
            page.ask(1, **takumar, **SMALL)
            self.assertEqual(page.end(1)["stage"], "done")
            page.close()

    def test_a_scene_or_the_page_to_learn_from(self):
        for words in (["--learn", SCENE], []):
            done = subprocess.run([PROGRAM, "live", *words], capture_output=True, text=True, check=False, timeout=60)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn("SCENE", done.stderr)

    def test_with_listen_an_address_has_a_token(self):
        with Live(PROGRAM, SCENE, "--listen", "127.0.0.1") as live:
            self.assertEqual(len(live.folder), 34)
            self.assertEqual(live.ask("GET", "/")[0], 200)
            live.folder = "/"
            self.assertEqual(live.ask("GET", "/")[0], 403)

    def test_ctrl_c_ends_it_with_a_page_open(self):
        live = Live(PROGRAM, SCENE)
        page = Page(live)
        page.ask(1, size="640x360", spp="100000")
        page.next("status")
        start = time.monotonic()
        live.__exit__()
        self.assertLess(time.monotonic() - start, 30)
        self.assertEqual(live.process.returncode, 0)

    def test_a_scene_that_changes_is_told(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder, "scene.glb")
            scene.write_bytes(pathlib.Path(SCENE).read_bytes())
            with Live(PROGRAM, str(scene)) as live:
                page = Page(live)
                page.ask(1, **SMALL)
                self.assertEqual(page.end(1)["stage"], "done")
                whole = scene.read_bytes()
                scene.write_bytes(whole[:1000])
                page.ask(2, orbit="10", **SMALL)
                self.assertEqual(page.end(2)["stage"], "failed")
                scene.write_bytes(whole)
                page.ask(3, orbit="20", **SMALL)
                end = page.end(3)
                self.assertEqual(end["stage"], "done", end)
                self.assertTrue(any("changed" in notice for notice in end["notices"]), end)
                scene.unlink()
                page.ask(4, orbit="30", **SMALL)
                self.assertIn("scene.glb", page.end(4)["error"])
                page.close()


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
