#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The page to learn from as a page of the docs: prints docs/guide/learn.md, made of assets/live/learn.html.

learn_page.py --pictures PROGRAM makes docs/pictures/learn too, in headless Chromium.
"""
import html.parser
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]
PICTURES = ROOT / "docs/pictures/learn"
HEAD = """# What lenses do: formulas, and where they fail

    build/bin/petzval live --learn

This command shows what follows in the browser, with controls to drag. The pictures below are its first state, with 64
samples; each command renders one of them. The limits are those of [where methods fail](../measured/stability.md) and
[the thin lens in closed form](../design/thin_lens.md). `tests/make/learn_page.py` wrote this page.
"""
MARKS = {"h2": ("\n## ", "\n"), "p": ("\n", "\n"), "li": ("- ", "\n"), "ul": ("\n", ""), "code": ("`", "`"),
         "strong": ("**", "**"), "sub": ("<sub>", "</sub>"), "sup": ("<sup>", "</sup>")}


class Lessons(html.parser.HTMLParser):
    """Markdown of the sections of the page."""

    def __init__(self):
        super().__init__()
        self.text, self.fields, self.inputs, self.inside, self.silent = "", None, {}, False, False

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        if tag == "main":
            self.inside = True
        elif tag == "section":
            self.fields, self.inputs, self.name = attrs["data-fields"], {}, attrs["id"]
        elif tag == "input":
            value = attrs["value"]
            self.inputs[attrs["name"]] = attrs["data-values"].split()[int(value)] if "data-values" in attrs else value
        elif tag in ("nav", "label"):
            self.silent = True
        elif self.inside and attrs.get("class") == "formula":
            self.text += "\n> "
        elif self.inside and tag in MARKS:
            self.text += MARKS[tag][0]

    def handle_endtag(self, tag):
        if tag in ("nav", "label"):
            self.silent = False
        elif tag == "main":
            self.inside = False
        elif tag == "section":
            settings = urllib.parse.parse_qsl(re.sub(r"{(\w+)}", lambda found: self.inputs[found[1]], self.fields))
            options = " ".join(f"--{name} {value}" for name, value in settings)
            self.text += f"\n![The picture, and traced rays](../pictures/learn/{self.name}.jpg)\n\n"
            self.text += "".join(f"    {line}\n" for line in textwrap.wrap(
                "build/bin/petzval render assets/scenes/ornaments.glb --size 480x320 --spp 64 " + options +
                f" -o out/{self.name}.png", 112, break_on_hyphens=False)).replace("\n    ", " \\\n        ")
        elif self.inside and tag in MARKS:
            self.text += MARKS[tag][1]

    def handle_data(self, data):
        if self.inside and not self.silent:
            self.text += re.sub(r"\s+", " ", data) if data.strip() else ""


def page():
    lessons = Lessons()
    lessons.feed((ROOT / "assets/live/learn.html").read_text(encoding="utf-8"))
    blocks = []
    for line in lessons.text.split("\n"):
        blocks += [line] if line.startswith(("    ", "#", "!", ">")) else textwrap.wrap(
            line, 120, subsequent_indent="  " if line.startswith("- ") else "", break_on_hyphens=False) or [""]
    return HEAD + re.sub(r"\n{3,}", "\n\n", "\n".join(blocks)).rstrip() + "\n"


def make_pictures(program):
    sys.path.insert(0, str(ROOT / "tests/apps/live"))
    sys.argv = ["", program, ""]
    from browser import Live, open_browser, By
    PICTURES.mkdir(exist_ok=True)
    with Live(program, "--learn", "--spp", "64") as live, tempfile.TemporaryDirectory() as folder:
        browser = open_browser(1120, 1000)
        browser.get(live.address)
        for lesson in browser.find_elements(By.CSS_SELECTOR, "section[data-fields]"):
            while lesson.get_attribute("data-stage") != "done":
                pass
            shot = f"{folder}/shot.png"
            lesson.find_element(By.CLASS_NAME, "plots").screenshot(shot)
            subprocess.run(["oiiotool", shot, "--ch", "R,G,B", "--compression", "jpeg:85", "-o",
                            str(PICTURES / f"{lesson.get_attribute('id')}.jpg")], check=True)
        browser.quit()


if __name__ == "__main__":
    if sys.argv[1:2] == ["--pictures"]:
        make_pictures(sys.argv[2])
    print(page(), end="")
