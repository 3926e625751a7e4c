#!/usr/bin/env python3
"""The table and the plot of docs/benchmarks.md, from the rows of docs/benchmarks/*.csv.

usage: draw_benchmarks.py [check]

Writes the lines between the two comments of the page, and docs/benchmarks/steps.svg. With `check` it only
compares, exit 1. A file is MACHINE_COMMIT.csv, made by `tobiuo bench CASE --csv FILE`; its commit says when.
Rows without particles have their time per step. A load above 0.3 before the start means that other programs ran.
"""
import csv
import html
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDER = ROOT / "docs" / "benchmarks"
PAGE = ROOT / "docs" / "benchmarks.md"
BEGIN, END = "<!-- tools/draw_benchmarks.py writes this -->\n", "<!-- until here -->\n"
COLOURS = ["#3465a4", "#cc6600", "#4e9a06", "#75507b", "#a40000", "#555753"]


def read_rows():
    """Of all files: (machine, commit, row)."""
    for path in sorted(FOLDER.glob("*.csv")):
        machine, _, commit = path.stem.rpartition("_")
        with path.open(newline="") as file:
            for row in csv.DictReader(file):
                yield machine, commit, row


def cost(row):
    """ns per particle and step on all its cores: of wall clock, of processor time; or None."""
    count = int(row["particles"])
    return tuple(1e6*float(row[key])*scale/count if count else None
                 for key, scale in (("step_ms", 1), ("processor_ms", 1/int(row["threads"]))))


def table(rows):
    lines = ["| case | machine, commit | threads | particles | ms per step | ns per particle and step | of processor time |"
             " bytes per particle | load |", "|---|---|---|---|---|---|---|---|---|"]
    for machine, commit, row in rows:
        wall, processor = cost(row)
        count = int(row["particles"])
        lines.append(f"| `{row['case']}` | {machine}, {commit} | {row['threads']} of {row['cores']} | {count or ''} | "
                     f"{float(row['step_ms']):.3g} | {f'{wall:.0f}' if wall else ''} | {f'{processor:.0f}' if wall else ''} | "
                     f"{f'''{float(row['bytes'])/count:.0f}''' if count else ''} | {row['load']} |")
    return "\n".join(lines) + "\n"


def plot(rows):
    """A bar per row with particles: ns of processor time per particle and step."""
    bars = [(machine, commit, row, cost(row)[1]) for machine, commit, row in rows if cost(row)[1]]
    sources = sorted({bar[:2] for bar in bars})
    most, left, wide = max((bar[3] for bar in bars), default=1), 150, 560
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="800" height="{24*len(bars) + 70}" font-family="sans-serif" '
           'font-size="13">', '<rect width="100%" height="100%" fill="white"/>',
           '<text x="10" y="22" font-size="15">Processor time per particle and step, ns, on all cores used</text>']
    for k, (machine, commit, row, value) in enumerate(bars):
        y = 40 + 24*k
        colour = COLOURS[sources.index((machine, commit)) % len(COLOURS)]
        out += [f'<text x="{left - 8}" y="{y + 14}" text-anchor="end">{html.escape(row["case"])}</text>',
                f'<rect x="{left}" y="{y}" width="{wide*value/most:.1f}" height="18" fill="{colour}"/>',
                f'<text x="{left + wide*value/most + 6:.1f}" y="{y + 14}">{value:.0f}</text>']
    for k, (machine, commit) in enumerate(sources):
        x = 10 + 260*k
        y = 40 + 24*len(bars) + 16
        out += [f'<rect x="{x}" y="{y - 11}" width="12" height="12" fill="{COLOURS[k % len(COLOURS)]}"/>',
                f'<text x="{x + 18}" y="{y}">{html.escape(machine)}, {commit}</text>']
    return "\n".join([*out, "</svg>"]) + "\n"


def main():
    rows = sorted(read_rows(), key=lambda found: (found[2]["case"], found[0]))
    text = PAGE.read_text()
    written = BEGIN + "\n" + table(rows) + "\n![Processor time of each case](benchmarks/steps.svg)\n\n" + END
    page = re.sub(re.escape(BEGIN) + ".*?" + re.escape(END), lambda match: written, text, flags=re.S)
    picture = FOLDER / "steps.svg"
    if len(sys.argv) == 2 and sys.argv[1] == "check":
        stale = page != text or not picture.exists() or picture.read_text() != plot(rows)
        print(f"{len(rows)} rows" + (": docs/benchmarks.md is out of date: tools/draw_benchmarks.py" if stale else ""))
        return 1 if stale or BEGIN not in text or not rows else 0
    if len(sys.argv) != 1:
        sys.exit(__doc__)
    PAGE.write_text(page)
    picture.write_text(plot(rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
