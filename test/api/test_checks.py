"""The checks must find what they look for: a small wrong tree for each rule."""
import pathlib
import subprocess
import sys
import tempfile

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"
BAD = "/" + "work/somebody"      # written in two pieces: this file is checked too

CASES = [
    # tool, file, text, expected words (None: the tree is right)
    ("check_layers.py", "src/base/a.c", '#include "exec/x.h"\n', "base includes exec"),
    ("check_layers.py", "src/sph/a.c", '#include "io/x.h"\n', "sibling io"),
    ("check_layers.py", "src/rigid/a.h", '\n  #  include "world/x.h"\n', "src/rigid/a.h:2:"),
    ("check_layers.py", "app/tobiuo/a.c", '#include "world/x.h"\n', "not a public header"),
    ("check_layers.py", "include/tobiuo/a.h", '#include "base/x.h"\n', "public header includes"),
    ("check_layers.py", "src/odd/a.c", "\n", "unknown room"),
    ("check_layers.py", "src/world/a.c", '#include "sph/x.h"\n#include "tobiuo/base.h"\n', None),
    ("check_methods.py", "src/world/methods.def", "METHOD(new)\n", "method new lacks src/ROOM/new.c"),
    ("check_methods.py", "src/world/methods.def", "\n", "no methods found"),
    ("check_house.py", "src/base/a.c", "int a;\n"*601, "601 lines"),
    ("check_house.py", "src/base/a.c", "int f(void)\n{\n" + "    f();\n"*80 + "}\n", "a.c:1: function f"),
    ("check_house.py", "tools/a.py", "def f():\n" + "    f()\n"*80, "function f"),
    ("check_house.py", "src/base/utils.c", "int a;\n", "says nothing"),
    ("check_house.py", "src/base/mesh_common.h", "int a;\n", "says nothing"),
    ("check_house.py", "src/base/a.c", "\tint a;\n", "src/base/a.c:1: tab"),
    ("check_house.py", "src/base/a.c", "// " + "x"*110 + "\n", "113 columns"),
    ("check_house.py", "src/base/a.c", f'const char *p = "{BAD}";\n', "path of a machine"),
    ("check_house.py", "src/base/a.c", "/* Half. */\nint f(void)\n{\n    return 1/2;\n}\n", None),
    ("check_house.py", "src/geom/a.c", "#pragma omp parallel for\n", "a.c:1: names OpenMP"),
    ("check_house.py", "src/core/a.h", '#define F \\\n  _Pragma("omp for")\n', "a.h:2: names OpenMP"),
    ("check_house.py", "app/tobiuo/a.c", "int n = omp_get_max_threads();\n", "a.c:1: names OpenMP"),
    ("check_house.py", "src/io/a.c", "#include <omp.h>\n", "a.c:1: names OpenMP"),
    ("check_house.py", "src/sph/a.c", "float *q = malloc(4);\n", "a.c:1: arrays of kernels belong to exec"),
    ("check_house.py", "src/exec/a.c", "/* Loops. */\n#pragma omp parallel for\n", None),
    ("check_house.py", "src/exec/a.c", "#include <math.h>\n", "a.c:1: no comment that says"),
    ("check_layers.py", "src/view/a.c", '#include "world/x.h"\n', "view includes world; it may include base, exec, include/tobiuo"),
    ("check_layers.py", "src/view/a.c", '#include "core/x.h"\n', "view includes core"),
    ("check_layers.py", "src/view/a.c", '#include "exec/x.h"\n#include "tobiuo/picture.h"\n', None),
    ("check_house.py", "README.md", "line\n"*121, "README.md:120: 121 lines, at most 120"),
    ("check_house.py", "README.md", "Line.\n"*120, None),
    ("check_house.py", "docs/a.md", "word "*21 + "\n", "docs/a.md:1: 105 columns of prose"),
    ("check_house.py", "docs/a.ja.md", "\u6c34"*41 + "\n", "docs/a.ja.md:1: 123 bytes of Japanese, at most 120"),
    ("check_house.py", "scenes/x/README.md", "- a\n  " + "word "*21 + "\n", "README.md:2: 107 columns of prose"),
    ("check_house.py", "docs/a.md", "| " + "word "*30 + "|\n```\n" + "word "*30 + "\n```\n$$" + "x "*80 + "$$\n\n    " +
     "word "*30 + "\n", None),
    ("check_house.py", "docs/a.md", "Seen with programs that were not kept.\n", "a.md:1: tells of a program"),
    ("check_house.py", "docs/theory/a.md", "# A\n\n" + "word\n"*26, "theory/a.md: a sentence of 26 words"),
    ("check_house.py", "docs/theory/a.md", "Word " + "word\n"*24 + "$a b c$.\nWord\n$$" + "x "*30 + "$$\n" + "word\n"*20 + "\n" +
     "    " + "word "*30 + "\n", "theory/a.md: a sentence of 26 words"),
    ("check_house.py", "docs/theory/a.md", "Word " + "word\n"*23 + "$a b c$.\nWord\n$$" + "x "*30 + "$$\n" + "word\n"*20 + "\n" +
     "    " + "word "*30 + "\n", None),
    ("check_house.py", "docs/decisions/0001-a.md", "# 1. A\n", "0001-a.md:1: a decision without a line"),
    ("check_house.py", "docs/decisions/0001-a.md", "# 1. A\n\nStatus: accepted.\n", None),
    ("check_layers.py", "src/geom/a.c", '#include "exec/exec.h"\n', None),
    ("check_layers.py", "src/exec/a.c", '#include "geom/x.h"\n', "exec includes geom"),
    ("check_layers.py", "src/sph/a.c", '#include "sph/isph/solve.h"\n', 'a.c:1: "sph/isph/solve.h" is of one method'),
    ("check_layers.py", "src/sph/isph/a.c", '#include "sph/isph/solve.h"\n', None),
    ("check_layers.py", "src/sph/a.k.h", "#include <math.h>\n", "a.k.h:1: includes a header of the system"),
    ("check_layers.py", "src/sph/a.k.h", "\nvoid f(int a,\n       int b);\n", "a.k.h:2: declares a function,"),
    ("check_layers.py", "src/sph/a.k.h", "typedef int (*f)(int);\n", "a.k.h:1: declares a function pointer"),
    ("check_layers.py", "src/sph/a.k.h", "TOBI_FN int f(int a) { return g(a); }\n/* int g(int); */\n", None),
    ("check_layers.py", "src/exec/a.k.h", "#include <math.h>\n", None),
]


def main():
    failed = 0
    for tool, name, text, expected in CASES:
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
            run = subprocess.run([sys.executable, TOOLS / tool, folder], capture_output=True, text=True)
        right = run.returncode == 0 if expected is None else run.returncode == 1 and expected in run.stdout
        if not right:
            failed += 1
            print(f"{tool} on {name}: expected {expected!r}, exit code {run.returncode}, said:")
            print(run.stdout + run.stderr)
    print(f"{len(CASES) - failed} of {len(CASES)} wrong trees judged rightly")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
