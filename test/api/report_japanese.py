#!/usr/bin/env python3
"""tobiuo report, plot and run in Japanese: the page has what the English one has, and nothing is left in English.

usage: report_japanese.py PROGRAM     works in a fresh folder that it removes; without gnuplot and ffmpeg
"""
import html.parser
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ENGLISH = re.compile(r"[A-Za-z]{2,}(?:[ ,.;:]+[A-Za-z]+){2,}")      # three words
PLOT_ENGLISH = re.compile(r"[A-Za-z]{2,}[ ,]+[A-Za-z]{2,}")         # names of columns are one word
PLOT_TEXT = re.compile(r'(?:title|set [xy]label) "(.*)"')
QUANTITY = re.compile(r'set ylabel "([a-z][a-z_]+[^"]*)"')
NUMBER = re.compile(r"-?\d[-+.e\d]*")
OPTIONAL_END = {"tr", "td", "th", "p"}
VOID = {"meta", "img", "br"}

TANK = {"domain": {"min": [0, 0, 0], "max": [1, 1, 1]}, "spacing": 0.1, "end_time": 0.06,
        "fluids": [{"name": "water", "fill": [{"box": {"min": [0, 0, 0], "max": [0.5, 1, 0.5]}}]}],
        "bodies": [{"name": "box & co", "box": {"min": [0.6, 0.4, 0.4], "max": [0.8, 0.6, 0.6]}, "dynamics": "free",
                    "density": 500},
                   {"name": "plate", "box": {"min": [0.6, 0.4, 0.8], "max": [0.62, 0.6, 0.9]}},
                   {"name": "wall", "box": {"min": [0.9, 0.1, 0], "max": [1, 0.3, 0.2]}}],
        "probes": [{"name": "P", "position": [0.1, 0.5, 0.1]},
                   {"name": "H", "kind": "level", "position": [0.2, 0.5, 0]},
                   {"name": "V", "kind": "volume", "position": [0.2, 0.5, 0.2], "length": 0.3, "width": 0.3,
                    "height": 0.3}],
        "output": {"interval": 0.02}}
BARGE = {"method": "isph", "dimension": 2, "domain": {"min": [0, 0], "max": [2, 0.6]}, "spacing": 0.04,
         "end_time": 0.04,
         "fluids": [{"name": "water", "fill": [{"box": {"min": [0.02, 0], "max": [1.6, 0.32]}}]}],
         "bodies": [{"name": "barge", "box": {"min": [0.8, 0.24], "max": [1.12, 0.4]}, "dynamics": "free",
                     "density": 500}],
         "lines": [{"name": "rope", "body": "barge", "point": [0.8, 0.24], "to": [0.4, 0], "stiffness": 200}],
         "porous_zones": [{"name": "mound", "box": {"min": [1.3, 0], "max": [1.5, 0.2]},
                           "stones": {"size": 0.02, "porosity": 0.45}}],
         "output": {"interval": 0.02}}
JELLY = {"method": "mlsmpm", "dimension": 2, "domain": {"min": [0, 0], "max": [1, 1]}, "spacing": 0.05,
         "end_time": 0.01, "output": {"interval": 0.005},
         "solids": [{"name": name, "youngs_modulus": 1e4,
                     "fill": [{"box": {"min": [x, 0.2], "max": [x + 0.2, 0.4]}}]} for name, x in (("a", 0.2), ("b", 0.6))]}


class Page(html.parser.HTMLParser):
    """Its tags, and its texts outside of code; tags that need an end have one."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.texts, self.open, self.language = [], [], [], None
        self.feed(text)
        self.close()
        assert not self.open, f"not closed: {self.open}"

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        if tag == "html":
            self.language = dict(attributes)["lang"]
        if tag not in VOID | OPTIONAL_END:
            self.open.append(tag)

    def handle_endtag(self, tag):
        self.tags.append("/" + tag)
        if tag not in OPTIONAL_END:
            assert self.open and self.open.pop() == tag, f"</{tag}> without its begin"

    def handle_data(self, data):
        if not {"pre", "code", "style", "title"} & set(self.open) and data.strip():
            self.texts.append(data.strip())


def english_of(page):
    return [found.group() for text in page.texts for found in ENGLISH.finditer(text)]


def english_of_plots(folder):
    """Of all titles and labels, and of quantities at axes: gnuplot is not there, but its script is."""
    script = pathlib.Path(folder, "plots", "plots.gnuplot").read_text(encoding="utf-8")
    return [text for text in PLOT_TEXT.findall(script) if PLOT_ENGLISH.search(text)] + QUANTITY.findall(script)


def run(program, *arguments, **variables):
    """What it answers; variables: those of the language."""
    others = {k: v for k, v in os.environ.items() if not k.startswith(("LC_", "LANG")) and k != "PATH"}
    return subprocess.run([program, *arguments], env={**others, "PATH": "/nonexistent", **variables},
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def page_of(program, folder, *arguments, **variables):
    done = run(program, "report", folder, "--force", *arguments, **variables)
    assert done.returncode == 0, done.stderr.decode()
    return Page(pathlib.Path(folder, "report.html").read_bytes().decode("utf-8"))


def check_pages(program, name, scene):
    pathlib.Path(name + ".json").write_text(json.dumps(scene))
    done = run(program, "run", name + ".json", "--out", name, "--quiet", OMP_WAIT_POLICY="passive")
    assert done.returncode == 0, done.stderr.decode()
    for more in ([], ["--from", str(scene["end_time"]/2)]):
        english = page_of(program, name, "--language", "en", *more)
        assert len(english_of_plots(name)) > 10, english_of_plots(name)
        japanese = page_of(program, name, "--language", "ja", *more)
        assert not english_of_plots(name), english_of_plots(name)
        assert (english.language, japanese.language) == ("en", "ja")
        assert len(english_of(english)) > 20, english_of(english)
        assert not english_of(japanese), english_of(japanese)
        assert english.tags == japanese.tags
        numbers = [[text for text in page.texts if NUMBER.fullmatch(text)] for page in (english, japanese)]
        assert numbers[0] == numbers[1] and len(numbers[0]) > 20, numbers


def check_choice(program, folder):
    """The option, or the first variable that says anything."""
    for arguments, variables, language in [
            ([], {}, "en"), ([], {"LANG": "ja_JP.UTF-8"}, "ja"), ([], {"LANG": "ja_JP.UTF-8", "LC_ALL": "C"}, "en"),
            ([], {"LC_MESSAGES": "ja", "LANG": "C"}, "ja"), ([], {"LANG": "ja", "LC_ALL": "", "LC_MESSAGES": ""}, "ja"),
            (["--language", "en"], {"LC_ALL": "ja_JP.UTF-8"}, "en"), (["--language", "ja"], {"LC_ALL": "C"}, "ja")]:
        found = page_of(program, folder, *arguments, **variables).language
        assert found == language, (arguments, variables, found)
        run(program, "plot", folder, *arguments, **variables)
        assert bool(english_of_plots(folder)) == (language == "en"), (arguments, variables)
    for command, bad in (("report", "fr"), ("report", ""), ("report", "japanese"), ("plot", "fr")):
        done = run(program, command, folder, "--language", bad)
        assert done.returncode == 2 and f"--language: '{bad}' is neither ja nor en".encode() in done.stderr, done.stderr


def check_end_of_run(program):
    """The warnings and the line at the end; what else is said is English."""
    hard = ["run", "tank.json", "--out", "hard", "--force", "--set", "dfsph.density_iterations_max=2"]
    for arguments, variables, language in [([], {}, "en"), ([], {"LANG": "ja_JP.UTF-8"}, "ja"),
                                           (["--language", "en"], {"LANG": "ja_JP.UTF-8"}, "en")]:
        done = run(program, *hard, *arguments, OMP_WAIT_POLICY="passive", **variables)
        said = (done.stdout + done.stderr).decode()
        want = {"en": ["the solver did not converge in", "done at t = 0.06 s"],
                "ja": ["反復解法が", "計算終了：t = 0.06 s"]}
        assert done.returncode == 0 and all(text in said for text in want[language]), said
        assert (language == "ja") == (not ENGLISH.search(said)), said
    done = run(program, "resume", "hard", "--until", "0.08", "--language", "ja")
    assert done.returncode == 0 and "計算終了：t = 0.08 s" in done.stdout.decode(), done.stdout.decode()
    for arguments in (["run", "tank.json"], ["resume", "hard"]):
        done = run(program, *arguments, "--language", "fr")
        assert done.returncode == 2 and b"--language: 'fr' is neither ja nor en" in done.stderr, done.stderr


def main(program):
    program = os.path.realpath(program)
    assert english_of(Page("<p>The run ended.")) and not english_of(Page("<p>dfsph、<code>a run ended</code> box & co"))
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for name, scene in (("tank", TANK), ("barge", BARGE), ("jelly", JELLY)):
            check_pages(program, name, scene)
        check_choice(program, "jelly")
        check_end_of_run(program)
        os.chdir("/")
    print("all pages are Japanese")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
