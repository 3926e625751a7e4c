#!/usr/bin/env python3
"""Help of the program and of its commands, and the man pages, in English and in Japanese.

usage: help.py PROGRAM      exit 1 with a line for each fault
"""
import fcntl
import os
import pty
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import termios
import unicodedata

TEXT_AT = 29                            # the column at which the meanings of options begin
LINE, PAGE = 79, 100                    # columns: of lines that the program breaks in a pipe; of any line
OPTION = re.compile(r'(  -\w, |      )(--[a-z]+)(=".*?"|=\S*| ?)( *)(.*)')
NEW_LINE_NOT_BEFORE = "、。）」：；ー"
HAS_JAPANESE = re.compile("[ぁ-ん]|[ァ-ヶ一-龠]{2}")
# Words that are no English in a Japanese text: names of files, formats, programs, methods, values and units.
NAMES = re.compile(r'"?tobiuo( [a-z]+)?( COMMAND)?"?|--[a-z]+|[A-Za-z_*/<>\[\].0-9]*[._/=][A-Za-z_*/<>\[\].0-9=]*|(?<![A-Za-z])[A-Z_]{2,}(?![a-z])'
                   r"|svg|png|vtp|obj|ply|stl|glb|[wie]*i?sph|dfsph|mlsmpm|fish|bodies|particle_id|speed|line|points|box|fluid|history"
                   r"|Tobiuo|Taichi|ParaView|Blender|Python|JSON|gnuplot|ffmpeg|passive|max|min|run|check|small|tank|ball|cut|frame|surface"
                   r"|Ctrl|NaN|ffsq|cell|plot|LANG|sqrt|spacing|goes|mm")


def columns(text):
    return sum(2 if unicodedata.east_asian_width(c) in "WF" else 1 for c in text)


def run(program, language, *words):
    done = subprocess.run([program, *words], capture_output=True, text=True, encoding="utf-8",
                          env=dict(os.environ, LC_ALL={"ja": "ja_JP.UTF-8", "en": "C.UTF-8"}[language]))
    return done.returncode, done.stdout, done.stderr


def on_terminal(program, width, *words):
    """Lines of a terminal so wide."""
    leader, follower = pty.openpty()
    fcntl.ioctl(follower, termios.TIOCSWINSZ, struct.pack("HHHH", 24, width, 0, 0))
    process = subprocess.Popen([program, *words], stdout=follower, env=dict(os.environ, LC_ALL="ja_JP.UTF-8"))
    os.close(follower)
    text = b""
    try:
        while piece := os.read(leader, 4096):
            text += piece
    except OSError:                     # the end of a terminal on Linux
        pass
    process.wait()
    os.close(leader)
    return re.sub(r"\033\[[0-9;]*m", "", text.decode()).splitlines()


def english_words(text):
    return [word for word in re.findall(r"[A-Za-z]{3,}", NAMES.sub(" ", text))]


def options_of(text):
    """(name, text) of each option; the lines between the options and their places are checked."""
    found, faults = [], []
    for line in text.splitlines():
        option = OPTION.fullmatch(line)
        if option:
            found.append([option[2], option[5]])
            head = columns("".join(option.groups()[:4]))
            if option[5] and head != TEXT_AT:
                faults.append(f"begins at column {head}: {line}")
        elif found and line:
            if not re.match(" " * TEXT_AT + r"\S", line):
                faults.append(f"is not below the meanings: {line}")
            found[-1][1] += line.strip()
    return found, faults


def check_lines(text, most):
    for line in text.splitlines():
        if columns(line) > most:
            yield f"{columns(line)} columns: {line}"
        if line.strip().startswith(tuple(NEW_LINE_NOT_BEFORE)):
            yield f"a line begins with a mark: {line}"
        if line.endswith(" "):
            yield f"blanks at the end: {line}"


def check_command(program, name):
    texts = {}
    for language in "en", "ja":
        code, text, said = run(program, language, name, "--help")
        if code or said:
            yield f"{language}: exit code {code}: {said}"
        options, faults = options_of(text[text.index("\n\n"):] if name != "bench" else text[text.rindex("\n\n"):])
        yield from faults + list(check_lines(text, PAGE if name == "bench" else LINE))
        texts[language] = options
        if language == "ja":
            if english_words(text):
                yield f"English: {english_words(text)}"
            yield from (f"no Japanese: {option}" for option in options if not HAS_JAPANESE.search(option[1]))
    if [name for name, _ in texts["en"]] != [name for name, _ in texts["ja"]] or not texts["en"]:
        yield "other options in Japanese"
    if "--language" not in dict(texts["en"]):
        yield "no --language"


def check_program(program):
    """The list of commands; returned by its names."""
    _, english, _ = run(program, "en", "--help")
    _, japanese, _ = run(program, "ja", "--help")
    names = re.findall(r"^  (?!tobiuo)([a-z]+) ", english, re.M)
    assert len(names) >= 20, names
    assert names == re.findall(r"^  (?!tobiuo)([a-z]+) ", japanese, re.M) and english.startswith("usage: tobiuo")
    assert japanese.startswith("使い方：tobiuo") and run(program, "en", "--language", "ja", "--help")[1] == japanese
    for line in japanese.splitlines()[2:]:
        if re.match("  [a-z]+ ", line) and "&&" not in line:
            assert re.match(r"  [a-z]+ +(\S+( \S+)?)? +", line).end() == 22 or HAS_JAPANESE.search(line), line
            assert HAS_JAPANESE.search(line), line
    assert not [*check_lines(japanese, LINE), *check_lines(english, LINE)]
    return names


def check_wrong_usage(program):
    for words, english, japanese in (
            (["run", "--nonsense"], "unrecognized option '--nonsense'", "オプション'--nonsense'はない"),
            (["run", "--forse"], "'--forse'; did you mean --force?", "'--forse'はない。もしかして--force?"),
            (["run", "-x"], "unrecognized option '-x'", "オプション'-x'はない"),
            (["run", "-qx"], "unrecognized option '-x'", "オプション'-x'はない"),
            (["run", "--s", "1"], "option '--s' is ambiguous", "'--s'に当てはまるものが複数ある"),
            (["run", "x", "--until"], "option '--until' wants a value", "オプション'--until'には値が必要である"),
            (["run", "x", "-qo"], "option '-o' wants a value", "オプション'-o'には値が必要である"),
            (["run", "x", "--quiet=1"], "option '--quiet' takes no value", "オプション'--quiet'は値を取らない"),
            (["info", "x"], "one argument too many: 'x'", "引数'x'は余分である"),
            (["check", "x", "--language", "fr"], "--language: 'fr' is neither ja nor en", "'fr'はjaでもenでもない"),
            (["--language", "fr", "info"], "--language: 'fr' is neither ja nor en", "'fr'はjaでもenでもない"),
            (["--language"], "--language: '' is neither ja nor en", "''はjaでもenでもない")):
        for language, text in ("en", english), ("ja", japanese):
            code, out, said = run(program, language, *words)
            if code != 2 or out or text not in said:
                yield f"{words}: exit code {code}, no '{text}': {said}"
    for words in (["check", "--usage"], ["--language=ja", "check", "--usage"], ["check", "--lang", "ja", "--usage"]):
        text = run(program, "en", *words)[1]
        if text != f"{'使い方：' if len(words) > 2 else 'Usage: '}tobiuo check [OPTION...] SCENE\n":
            yield f"{words}: {text}"


def check_man_pages(program):
    pages = {language: run(program, language, "--man")[1] for language in ("en", "ja")}
    requests = {language: re.findall(r"^\.(?:TH|SS|TP|B .*|I .*|SH|nf|fi)", page, re.M) for language, page in pages.items()}
    if requests["en"] != requests["ja"] or len(requests["en"]) < 100:
        yield "the Japanese page has other parts"
    for term, text in re.findall(r"^\.TP\n(.*)\n(.*)", pages["ja"].replace("\\:", "").replace("\\-", "-"), re.M):
        if not HAS_JAPANESE.search(text) or english_words(text):
            yield f"English: {term}: {text}"
    if not shutil.which("man"):
        return
    with tempfile.TemporaryDirectory() as folder:
        for language, page in pages.items():
            path = os.path.join(folder, f"{language}.1")
            with open(path, "w", encoding="utf-8") as out:
                out.write(page)
            done = subprocess.run(["man", "--warnings", "-l", path], capture_output=True, text=True,
                                  env=dict(os.environ, LC_ALL="C.UTF-8", MANWIDTH="80"))
            if done.returncode or done.stderr:
                yield f"man, {language}: {done.stderr}"
            yield from check_lines(re.sub(" +$", "", done.stdout, flags=re.M), PAGE)


def check_itself():
    assert columns("粒子 (m)") == 8 and not english_words("ja（日本語）、scene.json、--out") and english_words("the 粒子")
    assert list(check_lines("  。\n", 80)) and list(check_lines("あ" * 41, 81)) and not list(check_lines("あ" * 40, 80))
    assert options_of("      --until=S              時刻\n      --set=A       値\n   x")[1] != []


def main(program):
    check_itself()
    faults = []
    for name in check_program(program):
        faults += [f"{name}: {fault}" for fault in check_command(program, name)]
    faults += [*check_wrong_usage(program), *check_man_pages(program)]
    for width, most in (200, 100), (100, 100), (70, 70):
        lines = on_terminal(program, width, "sample", "--help")
        faults += [*check_lines("\n".join(lines), most)]
        if max(map(columns, lines)) < most - 6:
            faults.append(f"lines of {max(map(columns, lines))} columns on a terminal of {width}")
    print("\n".join(faults + [f"{len(faults)} faults"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(os.path.realpath(sys.argv[1])) if len(sys.argv) == 2 else __doc__)
