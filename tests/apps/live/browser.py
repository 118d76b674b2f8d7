#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The page of `petzval live` in Chromium, used as a person uses it: browser.py PROGRAM SCENE [FOLDER]

FOLDER gets pictures of the page. AXE names axe-core's axe.min.js; without it accessibility is not looked at.
"""
import json
import os
import pathlib
import shlex
import signal
import subprocess
import sys
import tempfile
import time
import unittest

try:
    from selenium import webdriver
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select, WebDriverWait
except ImportError:
    print("skipped: no selenium (Debian's python3-selenium)")
    sys.exit(77)

from live import Live

PROGRAM, SCENE = sys.argv[1], sys.argv[2]
PICTURES = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None
DRIVER = "/usr/bin/chromedriver"
START = ("--size", "96x64", "--spp", "4", "--threads", "2")


def open_browser(width=1280, height=900, **preferences):
    options = webdriver.ChromeOptions()
    for word in ("--headless=new", "--no-sandbox", "--disable-gpu", f"--window-size={width},{height}", "--lang=en",
                 "--force-prefers-reduced-motion"):
        options.add_argument(word)
    options.add_experimental_option("prefs", preferences)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=webdriver.chrome.service.Service(DRIVER), options=options)


class Driven(unittest.TestCase):
    """A page in a browser."""

    WORDS = (SCENE, *START)

    def setUp(self):
        self.live = Live(PROGRAM, *self.WORDS)
        self.addCleanup(self.live.__exit__)
        self.downloads = tempfile.TemporaryDirectory()
        self.addCleanup(self.downloads.cleanup)
        self.browser = open_browser(**{"download.default_directory": self.downloads.name})
        self.addCleanup(self.browser.quit)
        self.browser.get(self.live.address)
        self.wait_done()

    def tearDown(self):
        for entry in self.browser.get_log("browser"):
            # A fetch that the server refuses on purpose is told as SEVERE too.
            if entry["level"] == "SEVERE" and "Failed to load resource" not in entry["message"] and \
                    "net::ERR" not in entry["message"]:
                self.fail(entry["message"])

    def find(self, name):
        return self.browser.find_element(By.ID, name)

    def field(self, name):
        return self.browser.find_element(By.CSS_SELECTOR, f"form > fieldset [name='{name}']")

    def wait(self, condition, seconds=60):
        return WebDriverWait(self.browser, seconds, 0.05).until(condition)

    def shot(self, name):
        if PICTURES:
            self.browser.save_screenshot(str(PICTURES / f"{name}.png"))

    def is_too_wide(self):
        return self.browser.execute_script(
            "return document.documentElement.scrollWidth > document.documentElement.clientWidth")

    def dark(self):
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                     {"features": [{"name": "prefers-color-scheme", "value": "dark"}]})

    def serious_faults(self):
        """What axe-core finds."""
        axe = os.environ.get("AXE")
        if not axe:
            self.skipTest("AXE does not name axe-core's axe.min.js")
        # The page's policy lets no foreign script in but by the driver.
        self.browser.execute_script(pathlib.Path(axe).read_text(encoding="utf-8"))
        found = self.browser.execute_async_script(
            "const done = arguments[arguments.length - 1]; axe.run().then((r) => done(r.violations))")
        return [f"{one['id']}: {node['html']}" for one in found if one["impact"] in ("serious", "critical")
                for node in one["nodes"]]


class Browser(Driven):
    def wait_done(self):
        self.wait(lambda _: not self.find("save-exr").get_property("disabled"))

    def command(self):
        return self.find("command").get_property("value")

    def picture(self):
        """Colours of a few points of the canvas, and its size."""
        return self.browser.execute_script("""
            const canvas = document.getElementById("picture"), all = [];
            const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
            for (let i = 0; i < data.length; i += 404) all.push(data[i]);
            return [canvas.width, canvas.height, all];""")

    def drag(self, dx, dy):
        ActionChains(self.browser, duration=20).move_to_element(self.find("picture")).click_and_hold().move_by_offset(
            dx // 2, dy // 2).move_by_offset(dx - dx // 2, dy - dy // 2).release().perform()

    def test_a_person_looks_for_a_picture(self):
        self.assertEqual(self.picture()[:2], [96, 64])
        first = self.picture()
        self.shot("first")
        self.drag(120, 30)
        self.wait(lambda _: "--pose" in self.command())
        self.wait_done()
        self.assertNotEqual(self.picture(), first)

        Select(self.field("lens")).select_by_value("takumar-50mm-f1.2")
        self.wait(lambda _: "--lens takumar-50mm-f1.2" in self.command())
        self.wait(lambda _: self.find("drawing").get_property("naturalWidth") > 0)
        self.wait_done()

        picture = self.find("picture")
        size = picture.size
        ActionChains(self.browser).move_to_element_with_offset(picture, size["width"] // 8, size["height"] // 8).click(
        ).perform()
        # The pixel that was clicked becomes the distance that lies there.
        self.wait(lambda _: self.field("focus").get_property("value").count(".") == 1)
        self.wait_done()
        distance = self.field("focus").get_property("value")
        self.assertIn(f"--focus {distance}", self.command())
        pixel = [round((0.5 + 1 / 8) * 96 - 0.5), round((0.5 + 1 / 8) * 64 - 0.5)]
        # Depths count from the film's side of the lens, focus from its entrance pupil.
        self.assertAlmostEqual(self.depth_at(*pixel), float(distance), delta=0.1)

        self.browser.find_element(By.XPATH, "//div[@class='ring']/button[text()='f/4']").click()
        self.wait(lambda _: "--fstop 4" in self.command())
        self.wait_done()
        self.shot("lens")
        self.saved_is_the_commands()

        for _ in range(3):
            self.find("undo").click()
        self.wait(lambda _: "--lens" not in self.command())
        self.find("redo").click()
        self.wait(lambda _: "--lens takumar" in self.command())
        self.wait(lambda _: "lens=takumar" in self.browser.current_url)
        self.wait_done()

    def depth_at(self, x, y):
        """Depth by a render of the layer, at a pixel."""
        with tempfile.TemporaryDirectory() as folder:
            words = shlex.split(self.command())
            words[0] = PROGRAM
            words[words.index("picture.exr")] = f"{folder}/depth.exr"
            subprocess.run(words + ["--aov", "depth", "--fstop", "16", "--quiet"], check=True)
            pixel = f"{folder}/pixel.exr"
            subprocess.run(["oiiotool", f"{folder}/depth.exr", "--ch", "depth.Z", "--cut", f"1x1+{x}+{y}", "-o", pixel],
                           check=True)
            text = subprocess.run(["oiiotool", "--stats", pixel], capture_output=True, text=True, check=True).stdout
            return float(text.split("Stats Avg:")[1].split()[0])

    def saved_is_the_commands(self):
        self.find("save-exr").click()
        saved = pathlib.Path(self.downloads.name, "picture.exr")
        self.wait(lambda _: saved.exists() and saved.stat().st_size > 0)
        with tempfile.TemporaryDirectory() as folder:
            words = shlex.split(self.command())
            words[0] = PROGRAM
            words[words.index("picture.exr")] = f"{folder}/picture.exr"
            subprocess.run(words + ["--quiet"], check=True)
            self.assertEqual(saved.read_bytes(), pathlib.Path(folder, "picture.exr").read_bytes())

    def test_saving_is_told_while_it_lasts(self):
        self.browser.execute_script("""
            const ask = window.fetch;
            window.fetch = async (...of) => {
                if (of[0].startsWith("api/file")) await new Promise((done) => (window.letSave = done));
                return ask(...of);
            };""")
        done = self.find("stage").text
        self.find("save-exr").click()
        self.wait(lambda _: "Saving" in self.find("stage").text)
        self.browser.execute_script("window.letSave()")
        self.wait(lambda _: self.find("stage").text == done)
        saved = pathlib.Path(self.downloads.name, "picture.exr")
        self.wait(lambda _: saved.exists() and saved.stat().st_size > 0)

    def test_keys_alone(self):
        self.find("picture").send_keys(Keys.ARROW_LEFT, Keys.ARROW_UP, "+")
        self.wait(lambda _: "--pose" in self.command())
        before = self.command()
        self.find("picture").send_keys(Keys.SHIFT, Keys.ARROW_LEFT)
        self.wait(lambda _: self.command() != before)
        self.find("picture").send_keys(Keys.ENTER)
        self.wait(lambda _: "pinhole" in self.find("error").text)
        self.field("fstop").send_keys("2", Keys.TAB)
        self.wait(lambda _: "--fstop 2" in self.command())
        self.wait_done()
        self.assertFalse(self.find("error").is_displayed())
        self.find("picture").send_keys(Keys.ENTER)
        self.wait(lambda _: "--focus" in self.command())
        self.find("picture").send_keys(Keys.CONTROL, "z")
        self.wait(lambda _: "--focus" not in self.command())
        # From the picture every control is reached by Tab.
        reached = set()
        self.wait_done()  # before that there is nothing to save
        self.browser.execute_script("document.getElementById('picture').focus()")
        for _ in range(40):
            ActionChains(self.browser).send_keys(Keys.TAB).perform()
            active = self.browser.switch_to.active_element
            reached.add(active.get_attribute("id") or active.get_attribute("name") or active.tag_name)
        for name in ("drag", "save-exr", "command", "copy", "set-lens", "set-fstop", "set-focus", "set-size", "set-env"):
            self.assertIn(name, reached)
        self.wait_done()

    def test_looking_closely(self):
        self.browser.get(self.live.address + "#size=96x64")
        self.browser.refresh()
        self.wait_done()
        self.field("noise").send_keys("20%", Keys.TAB)
        self.wait(lambda _: "--noise" in self.command())
        self.wait_done()
        shown = self.picture()
        picture = self.find("picture")
        ActionChains(self.browser).move_to_element_with_offset(picture, 30, -20).perform()
        self.wait(lambda _: "nits" in self.find("pixel").text)
        where, rest = self.find("pixel").text.split(": ", 1)
        self.assertIn("xy ", rest)
        self.assertIn("samples.N", rest)
        self.find("save-exr").click()
        saved = pathlib.Path(self.downloads.name, "picture.exr")
        self.wait(lambda _: saved.exists() and saved.stat().st_size > 0)
        x, y = where.split(",")
        pixel = f"{self.downloads.name}/pixel.exr"
        subprocess.run(["oiiotool", str(saved), "--ch", "R,G,B", "--cut", f"1x1+{x}+{y}", "-o", pixel], check=True)
        stats = subprocess.run(["oiiotool", "--stats", pixel], capture_output=True, text=True, check=True).stdout
        truth = [float(word) for word in stats.split("Stats Avg:")[1].split()[:3]]
        for read, true in zip(rest.split(" nits")[0].split(", "), truth):
            self.assertAlmostEqual(float(read), true, delta=1e-3 * true + 1e-6)
        self.assertIn("clipped", self.find("histogram").text)

        Select(self.find("show")).select_by_value("samples.N")
        self.wait(lambda _: "samples.N: from" in self.find("scale").text)
        self.assertNotEqual(self.picture(), shown)
        self.shot("false_colours")
        Select(self.find("show")).select_by_value("")
        self.wait(lambda _: self.picture() == shown)

        self.find("keep").click()
        Select(self.field("aperture")).select_by_value("star:5")
        self.wait(lambda _: self.browser.execute_script("return document.getElementById('kept').hidden") is False)
        self.browser.find_element(By.XPATH, "//div[@class='ring']/button[text()='f/2']").click()
        self.wait_done()
        self.shot("compared")
        Select(self.find("zoom")).select_by_value("8")
        self.shot("zoomed")

    def test_a_spectrum_under_the_pointer(self):
        self.browser.get(self.live.address + "#size=48x32&spp=16&bins=400:700:50")
        self.browser.refresh()
        self.wait_done()
        ActionChains(self.browser).move_to_element_with_offset(self.find("picture"), 5, 60).perform()
        self.wait(lambda _: "nm, at most" in self.find("spectrum").text)
        self.assertIn("from 425 to 675 nm", self.find("spectrum").text)
        self.shot("spectrum")

    def test_a_lens_on_the_bench(self):
        self.browser.get(self.live.address + "#size=96x64&spp=4&lens=cooke-triplet-50mm-f5&focus=1")
        self.browser.refresh()
        self.wait_done()
        self.browser.execute_script("document.getElementById('bench').open = true")
        self.wait(lambda _: "50.02 mm" in self.find("figures").text)
        # The point under the pointer.
        ActionChains(self.browser).move_to_element_with_offset(self.find("picture"), 200, 0).perform()
        self.wait(lambda _: "field" in self.find("figures").text and "field\n0.00" not in self.find("figures").text)
        self.assertIn("distortion", self.find("figures").text)
        self.assertGreater(len(self.browser.find_elements(By.CSS_SELECTOR, "#section .ray")), 12)
        self.assertEqual(self.browser.execute_script("""
            const dots = [...document.querySelectorAll("#bench .dots")].map((one) => getComputedStyle(one).stroke);
            return new Set(dots).size"""), 3, "colours of the lines")
        self.shot("bench")
        shown = self.picture()
        # Another number: section, figures and picture follow.
        box = self.browser.find_element(By.CSS_SELECTOR, "[aria-label='radius, mm, surface 1']")
        box.clear()
        box.send_keys("30", Keys.TAB)
        self.wait(lambda _: "50.02 mm" not in self.find("figures").text)
        self.wait(lambda _: "lens-" in self.command())
        self.wait_done()
        self.assertNotEqual(self.picture(), shown)
        self.saved_is_the_commands()
        # A face is dragged: the glass becomes thicker.
        thickness = self.browser.find_element(By.CSS_SELECTOR, "[aria-label='thickness, mm, surface 1']")
        before = float(thickness.get_property("value"))
        face = self.browser.find_element(By.CSS_SELECTOR, "#section [data-face='1']")
        ActionChains(self.browser, duration=20).move_to_element(face).click_and_hold().move_by_offset(8, 0).release().perform()
        self.wait(lambda _: float(self.browser.find_element(
            By.CSS_SELECTOR, "[aria-label='thickness, mm, surface 1']").get_property("value")) > before)
        self.wait_done()
        self.find("save-lens").click()
        saved = pathlib.Path(self.downloads.name, "cooke-triplet-50mm-f5-changed.json")
        self.wait(lambda _: saved.exists() and saved.stat().st_size > 0)
        done = subprocess.run([PROGRAM, "lens", "show", str(saved)], capture_output=True, text=True, check=True)
        self.assertIn(" 30 ", done.stdout)
        # Nonsense is said, and the next number mends it.
        glass = self.browser.find_element(By.CSS_SELECTOR, "[aria-label='glass, surface 1']")
        glass.clear()
        glass.send_keys("schott:NO-SUCH", Keys.TAB)
        self.wait(lambda _: "NO-SUCH" in self.find("bench-fault").text)
        self.find("restore-lens").click()
        self.wait(lambda _: "50.02 mm" in self.find("figures").text)
        self.assertIn("--lens cooke-triplet-50mm-f5 ", self.command())

    def test_what_is_wrong_is_said(self):
        box = self.field("fstop")
        box.send_keys("wide", Keys.TAB)
        self.wait(lambda _: self.find("error").is_displayed())
        self.assertIn("--fstop", self.find("error").text)
        self.assertIn("wrong", box.get_attribute("class"))
        self.shot("wrong")
        self.find("undo").click()
        self.wait_done()
        self.wait(lambda _: not self.find("error").is_displayed())

    def test_the_address_holds_the_state(self):
        self.browser.get(self.live.address + "#size=48x32&spp=2&orbit=90")
        self.browser.refresh()
        self.wait_done()
        self.assertEqual(self.picture()[:2], [48, 32])
        self.assertIn("--orbit 90", self.command())
        self.browser.get(self.live.address + "#size=48x32&spp=2&lens=%3Cimg%20src%3Dx%20onerror%3Dalert(1)%3E")
        self.browser.refresh()
        self.wait(lambda _: self.find("error").is_displayed())
        self.assertEqual(self.browser.find_elements(By.CSS_SELECTOR, "img[src='x']"), [])

    def test_the_server_is_lost_and_comes_back(self):
        port = self.live.port
        self.live.__exit__()
        self.wait(lambda _: "does not answer" in self.find("stage").text)
        self.shot("lost")
        self.live = Live(PROGRAM, SCENE, *START, "--port", str(port))
        self.addCleanup(self.live.__exit__)
        self.wait_done()
        self.assertIn("Done", self.find("stage").text)

    def test_two_pages_do_not_disturb_each_other(self):
        first = self.picture()
        self.browser.switch_to.new_window("window")
        self.browser.get(self.live.address + "#size=48x32&spp=3&orbit=120")
        self.wait_done()
        self.assertEqual(self.picture()[:2], [48, 32])
        self.browser.close()
        self.browser.switch_to.window(self.browser.window_handles[0])
        self.wait_done()
        self.assertEqual(self.picture(), first)

    def test_other_windows(self):
        for name, (width, height) in {"phone": (390, 844), "wide": (1600, 900)}.items():
            self.browser.set_window_size(width, height)
            self.wait_done()
            self.assertFalse(self.is_too_wide(), name)
            self.shot(name)
        self.dark()
        self.shot("dark")

    def test_a_storm_of_moves(self):
        picture = self.find("picture")
        box = picture.rect
        before = self.live.memory_bytes()
        self.browser.execute_script("""
            const picture = document.getElementById("picture"), box = picture.getBoundingClientRect();
            const send = (type, i) => picture.dispatchEvent(new PointerEvent(type, {pointerId: 1, button: 0, buttons: 1,
                clientX: box.left + box.width * (0.5 + 0.3 * Math.sin(i / 17)),
                clientY: box.top + box.height * (0.5 + 0.2 * Math.cos(i / 23)), bubbles: true}));
            picture.setPointerCapture = () => {};
            send("pointerdown", 0);
            let i = 0;
            window.storm = setInterval(() => {
                if (++i < 600) return send("pointermove", i);
                clearInterval(window.storm);
                send("pointerup", i);
                document.body.dataset.storm = "over";
            }, 10);""")
        self.wait(lambda _: self.browser.execute_script("return document.body.dataset.storm") == "over")
        self.wait_done()
        self.assertLess(self.live.memory_bytes() - before, 60e6)
        self.assertGreater(box["width"], 0)
        self.saved_is_the_commands()

    def test_nothing_serious_for_those_who_cannot_see(self):
        Select(self.field("lens")).select_by_value("takumar-50mm-f1.2")
        self.browser.execute_script("for (const one of document.querySelectorAll('details')) one.open = true")
        self.wait(lambda _: "focal length" in self.find("figures").text)
        self.assertEqual(self.serious_faults(), [])


class Learn(Driven):
    WORDS = ("--learn", "--size", "96x64", "--spp", "1", "--threads", "2")

    def lessons(self):
        return self.browser.find_elements(By.CSS_SELECTOR, "section[data-fields]")

    def wait_done(self):
        self.wait(lambda _: all(one.get_attribute("data-stage") == "done" for one in self.lessons()), 240)

    def state(self, lesson):
        """Paths of the drawings, figures, command line and colours of the picture."""
        return self.browser.execute_script("""
            const [lesson] = arguments, canvas = lesson.querySelector("canvas");
            return [[...lesson.querySelectorAll("figure svg path")].map((one) => one.getAttribute("d")).join(),
              lesson.querySelector("dl").textContent, lesson.querySelector("code.command").textContent,
              [...canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data].join()]""", lesson)

    def test_every_control_moves_drawing_and_picture(self):
        self.assertEqual(len(self.lessons()), 8)
        for lesson in self.lessons():
            for control in lesson.find_elements(By.CSS_SELECTOR, "input[type=range]"):
                name = f"{lesson.get_attribute('id')} {control.get_attribute('name')}"
                before = self.state(lesson)
                self.assertIn("petzval render", before[2], name)
                self.browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", control)
                width = control.size["width"]
                value = control.get_property("value")
                # From the middle towards an end, by the pointer.
                ActionChains(self.browser, duration=20).move_to_element(control).click_and_hold().move_by_offset(
                    -width // 4, 0).release().perform()
                self.assertNotEqual(control.get_property("value"), value, name)
                self.wait(lambda _: self.state(lesson)[2] != before[2])
                self.wait_done()
                after = self.state(lesson)
                self.assertNotEqual(after[3], before[3], f"{name}: picture")
                # The points of a triangle have nothing to do with the iris.
                if lesson.get_attribute("id") != "triangle":
                    self.wait(lambda _: self.state(lesson)[0] != before[0])
                self.assertEqual(lesson.find_element(By.CLASS_NAME, "fault").text, "", name)
        self.command_gives_the_picture()

    def command_gives_the_picture(self):
        """What is seen is what the command line renders."""
        lesson = self.lessons()[0]
        with tempfile.TemporaryDirectory() as folder:
            words = shlex.split(lesson.find_element(By.CSS_SELECTOR, "code.command").text)
            words[0] = PROGRAM
            words[words.index("picture.exr")] = f"{folder}/picture.png"
            subprocess.run(words + ["--quiet"], check=True)
            subprocess.run(["oiiotool", f"{folder}/picture.png", "--ch", "R,G,B", "-d", "uint8", "-o",
                            f"{folder}/picture.ppm"], check=True)
            truth = pathlib.Path(folder, "picture.ppm").read_bytes()[-96 * 64 * 3:]
        seen = [int(n) for n in self.state(lesson)[3].split(",")]
        self.assertEqual([n for i, n in enumerate(seen) if i % 4 < 3], list(truth))

    def test_keys_alone(self):
        lesson = self.lessons()[0]
        controls = self.browser.find_elements(By.CSS_SELECTOR, "main input, main nav a")
        reached = []
        for _ in controls:
            ActionChains(self.browser).send_keys(Keys.TAB).perform()
            reached.append(self.browser.switch_to.active_element)
        self.assertEqual(reached, controls)
        control = lesson.find_element(By.NAME, "focus")
        before = self.state(lesson)
        control.send_keys(*[Keys.ARROW_RIGHT] * 10)
        self.assertEqual(control.get_attribute("aria-valuetext"), "1.5 m")
        self.wait(lambda _: "--focus 1.5" in self.state(lesson)[2])
        self.wait(lambda _: self.state(lesson)[0] != before[0])
        self.wait_done()
        self.shot("learn_keys")

    def test_screens_and_nothing_serious_for_those_who_cannot_see(self):
        self.shot("learn")
        self.dark()
        self.shot("learn_dark")
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                     {"width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": True})
        self.assertFalse(self.is_too_wide())
        self.browser.execute_script("document.getElementById('bokeh').scrollIntoView()")
        self.shot("learn_phone")
        self.assertEqual(self.serious_faults(), [])

    def test_what_is_wrong_is_said_and_mended(self):
        lesson = self.browser.find_element(By.ID, "spherical")
        control = lesson.find_element(By.NAME, "fstop")
        self.browser.execute_script("arguments[0].min = 0.3; arguments[0].value = 0.3;"
                                    "arguments[0].dispatchEvent(new Event('input'))", control)
        self.wait(lambda _: lesson.find_element(By.CLASS_NAME, "fault").text)
        self.wait(lambda _: lesson.get_attribute("data-stage") == "failed")
        self.browser.execute_script("arguments[0].value = 4; arguments[0].dispatchEvent(new Event('input'))", control)
        self.wait_done()
        self.wait(lambda _: lesson.find_element(By.CLASS_NAME, "fault").text == "")

    def test_the_server_is_lost_and_comes_back(self):
        self.live.__exit__()
        self.wait(lambda _: "does not answer" in self.find("stage").text)
        self.live = Live(PROGRAM, *self.WORDS, "--port", str(self.live.port))
        self.addCleanup(self.live.__exit__)
        self.wait(lambda _: self.find("stage").text == "")
        control = self.lessons()[0].find_element(By.NAME, "focus")
        control.send_keys(Keys.ARROW_RIGHT)
        self.wait(lambda _: "--focus 1.05" in self.state(self.lessons()[0])[2])
        self.wait_done()


if __name__ == "__main__":
    if not pathlib.Path(DRIVER).exists():
        print(f"skipped: no {DRIVER} (Debian's chromium-driver)")
        sys.exit(77)
    if PICTURES:
        PICTURES.mkdir(parents=True, exist_ok=True)
    unittest.main(argv=sys.argv[:1], verbosity=2)
