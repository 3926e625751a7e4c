#!/usr/bin/env python3
"""Checks the house rules that a machine can check. Prints file:line of each breach; exit 1.

usage: check_house.py [ROOT]

Files of at most 600 lines, functions of at most 80, lines of at most 110 columns, no tabs, no file
named utils, common or misc, no path of somebody's machine in the sources, no OpenMP in the program outside
src/exec. Pages: README of at most 120 lines, prose of at most 100 columns (not code, tables, equations),
Japanese of at most 120 bytes, no passage about a program that was not kept; each decision has a number of
its own and a status. Theory has sentences of at most 25 words; a formula counts as one word, a colon ends
a sentence.
"""
import ast
import pathlib
import re
import sys

FILE_LINES = 600
FUNCTION_LINES = 80
COLUMNS = 110          # C and Lua; scripts and scenes may be wider
WIDE_COLUMNS = 150
FOLDERS = ["include", "src", "app", "bench", "test", "tools", "scenes", "cmake", "docs", ".ci"]
C_SUFFIXES = {".c", ".h", ".cu", ".def", ".inc"}
CODE_SUFFIXES = C_SUFFIXES | {".py", ".sh", ".lua", ".cmake", ".txt", ".json"}
SCRIPT_SUFFIXES = {".sh", ".py", ".txt", ".cmake"}
FORBIDDEN = re.compile(r"(^|[_.-])(utils?|common|misc)([_.-]|$)", re.IGNORECASE)
MACHINE_PATH = re.compile(r"""(?<![\w.$})/-])/(work|root|tmp|home)(/|\b)""")
ARRAYS = re.compile(r"\b(malloc|realloc|aligned_alloc)\s*\(")
ARRAY_FOLDERS = {("src", "sph"), ("src", "linear")}
OPENMP = re.compile(r"pragma\s+omp|_Pragma\s*\(\s*\"\s*omp|\bomp_|\bomp\.h")
OPENMP_FOLDERS = ("include", "src", "app", "bench")     # tests may call the library from threads of their own
README_LINES = 120
PROSE_COLUMNS = 100
JAPANESE_BYTES = 120   # 40 characters, as wide as 80 columns
NOT_PROSE = re.compile(r"\s*\||<!--")      # tables, comments
NOT_KEPT = re.compile(r"\b(programs?|scenes?|runs?)\b.*\bnot kept\b", re.IGNORECASE)
SENTENCE_WORDS = 25
GENERATED_PAGE = re.compile(r"\.ja\.md$|^docs/(scene\.md|validation/)")      # or Japanese, which has no words
TEST_FOLDER = re.compile(r"/tmp/\w*XXXXXX")      # mkdtemp in a test


def source_files(root):
    """Text files people write. Meshes, pictures and recorded data are not among them."""
    found = [p for p in root.glob("*") if p.name in ("CMakeLists.txt", "demo.sh", "test.sh")]
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts:
                found.append(path)
    return found


def belongs_to_head(line):
    return line.strip() and not line.startswith(("}", "#", "/*", "//")) and not line.rstrip().endswith("*/")


def c_functions(lines):
    """(first line, length, name) of each function: a brace in column 0 opens and closes its body."""
    start = None
    for number, line in enumerate(lines, 1):
        if line.startswith("{") and start is None:
            first = number
            while first > 1 and belongs_to_head(lines[first - 2]):
                first -= 1
            start = first
        elif start is None and line.rstrip().endswith(") {") and line[:1].isalpha():
            start = number
        elif line.startswith("}") and start is not None:
            name = re.search(r"(\w+)\s*\(", " ".join(lines[start - 1:number]))
            yield start, number - start + 1, name.group(1) if name else "?"
            start = None


def python_functions(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield node.lineno, node.end_lineno - node.lineno + 1, node.name


def check_lines(where, suffix, lines, errors):
    for number, line in enumerate(lines, 1):
        if "\t" in line:
            errors.append(f"{where}:{number}: tab")
        limit = COLUMNS if str(where).endswith((".c", ".h", ".lua")) else WIDE_COLUMNS
        if len(line) > limit:
            errors.append(f"{where}:{number}: {len(line)} columns, at most {limit}")
        if where.parts[0] in OPENMP_FOLDERS and where.parts[:2] != ("src", "exec") and OPENMP.search(line):
            errors.append(f"{where}:{number}: names OpenMP; only src/exec may, see tobi_loop in exec/exec.h")
        if where.parts[:2] in ARRAY_FOLDERS and ARRAYS.search(line):
            errors.append(f"{where}:{number}: arrays of kernels belong to exec, see tobi_array_make in exec/exec.h")
        if suffix not in SCRIPT_SUFFIXES and MACHINE_PATH.search(line) and not TEST_FOLDER.search(line):
            errors.append(f"{where}:{number}: path of a machine: {line.strip()[:60]}")
        if line != line.rstrip() and suffix in C_SUFFIXES:
            errors.append(f"{where}:{number}: blanks at the end of the line")


def check_file(root, path, errors, longest):
    where = path.relative_to(root)
    if any(FORBIDDEN.search(part) for part in (path.stem, path.parent.name)):
        errors.append(f"{where}:1: a name that says nothing (utils, common, misc)")
    if path.suffix not in CODE_SUFFIXES or path.name.endswith(".schema.json"):
        return      # the schema is written by the program
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines()
    if path.suffix != ".json" and len(lines) > FILE_LINES:
        errors.append(f"{where}:{len(lines)}: {len(lines)} lines, at most {FILE_LINES}")
    check_lines(where, path.suffix, lines, errors)
    if path.suffix == ".c" and not text.startswith("/*"):
        errors.append(f"{where}:1: no comment that says what the file is")
    functions = []
    if path.suffix in C_SUFFIXES:
        functions = list(c_functions(lines))
    elif path.suffix == ".py":
        functions = list(python_functions(text))
    for number, length, name in functions:
        longest.append((length, f"{where}:{number}: {name}"))
        if length > FUNCTION_LINES:
            errors.append(f"{where}:{number}: function {name} has {length} lines, at most {FUNCTION_LINES}")


def prose_lines(text):
    """(number, line) of what is neither code nor table nor equation."""
    fence = equation = indented = False
    before = ""
    for number, line in enumerate(text.splitlines(), 1):
        indented = line.startswith("    ") and (indented or not before.strip()) or (indented and not line.strip())
        if line.strip().startswith("```"):
            fence = not fence
        elif not fence and "$$" in line:
            equation ^= line.count("$$") % 2
        elif not fence and not equation and not indented and not NOT_PROSE.match(line):
            yield number, line
        before = line


def long_sentences(text):
    """Sentences of prose with too many words: (words, how it begins)."""
    text = re.sub(r"```.*?```|^    .*$", "\n\n", text.split("\n## Sources")[0], flags=re.S | re.M)
    text = re.sub(r"\$\$.*?\$\$", " EQUATION. ", text, flags=re.S)
    text = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", re.sub(r"\$[^$]*\$|`[^`]*`", "X", text))
    text = re.sub(r"\[[^]]*\d{4}[^]]*\]", "X", text).replace("et al.", "et al").replace("eq.", "eq")
    for paragraph in re.split(r"\n\s*\n|\n(?=[-*] |\d+\. |\|)", text):
        if paragraph.strip().startswith(("|", "#")):
            continue
        for sentence in re.split(r"(?<=[.:;?!])\**\s+(?=[A-Z(*])|(?<=:)\s|EQUATION\.", " ".join(paragraph.split())):
            words = sum(bool(re.search(r"\w", word)) for word in sentence.split())
            if words > SENTENCE_WORDS:
                yield words, sentence.strip()[:40]


def check_page(root, path, errors):
    where = path.relative_to(root)
    text = path.read_text(encoding="utf-8")
    if where.name.startswith("README.") and len(where.parts) == 1 and text.count("\n") > README_LINES:
        errors.append(f"{where}:{README_LINES}: {text.count(chr(10))} lines, at most {README_LINES}")
    for number, line in prose_lines(text):
        if where.name.endswith(".ja.md") and len(line.encode()) > JAPANESE_BYTES:
            errors.append(f"{where}:{number}: {len(line.encode())} bytes of Japanese, at most {JAPANESE_BYTES}")
        if len(line) > PROSE_COLUMNS:
            errors.append(f"{where}:{number}: {len(line)} columns of prose, at most {PROSE_COLUMNS}")
        if NOT_KEPT.search(line):
            errors.append(f"{where}:{number}: tells of a program that was not kept; what nobody can repeat is no fact")
    for words, begin in [] if GENERATED_PAGE.search(where.as_posix()) else long_sentences(text):
        errors.append(f"{where}: a sentence of {words} words, at most {SENTENCE_WORDS}: {begin}...")
    if where.parts[:2] == ("docs", "decisions") and not re.search(r"^Status: ", text, re.MULTILINE):
        errors.append(f"{where}:1: a decision without a line that begins with \"Status: \"")


def check_pages(root, errors):
    pages = sorted(root.glob("*.md")) + [p for f in ("docs", "scenes", "test") for p in sorted((root / f).rglob("*.md"))]
    for path in pages:
        check_page(root, path, errors)
    numbers = [p.name[:4] for p in pages if p.parent.name == "decisions"]
    for number in sorted({n for n in numbers if numbers.count(n) > 1}):
        errors.append(f"docs/decisions/{number}:1: two decisions of one number")


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[1]).resolve()
    errors, longest = [], []
    paths = source_files(root)
    for path in paths:
        check_file(root, path, errors, longest)
    check_pages(root, errors)
    longest.sort(reverse=True)
    lengths = sorted(length for length, _ in longest)
    if lengths:
        print(f"functions: {len(lengths)}, 90 % have at most {lengths[len(lengths)*9//10]} lines; longest:")
        for length, where in longest[:5]:
            print(f"  {length:3d} lines  {where}")
    print("\n".join(errors + [f"{len(paths)} files, {len(errors)} breaches of the house rules"]))
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
