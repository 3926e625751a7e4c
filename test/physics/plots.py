"""Line plots as SVG, three in a row. Only the standard library is needed."""
import html
import math

COLOURS = ["#1f6fa8", "#c0392b", "#2e8b57", "#8e44ad", "#d68910", "#555555", "#16a0a0", "#a0522d"]
WIDTH, AXES, BESIDE, BELOW, LINE = 460, 260, 60, 45, 14      # of a plot; height of its axes; margins; a line of text


def ticks(low, high):
    """Round numbers within low to high, some five of them, and how to write them."""
    span = high - low
    step = 10.0**math.floor(math.log10(span/4))
    step *= next(m for m in (1, 2, 5, 10) if span/(m*step) <= 6)
    first, last = math.ceil(low/step - 1e-9), math.floor(high/step + 1e-9)
    largest = max(abs(first), abs(last))*step
    if largest >= 1e5 or largest < 1e-3:
        digits = max(0, math.floor(math.log10(largest) + 1e-9) - math.floor(math.log10(step) + 1e-9))
        return [(k*step, f"{k*step:.{digits}e}".replace("e+0", "e").replace("e-0", "e-") if k else "0") for k in range(first, last + 1)]
    digits = max(0, -math.floor(math.log10(step) + 1e-9))
    return [(k*step, f"{k*step:.{digits}f}") for k in range(first, last + 1)]


def bounds(values, margin):
    low, high = min(values), max(values)
    more = margin*(high - low) if high > low else abs(low)*0.1 or 1
    return low - more, high + more


def legend_lines(curves):
    """Labels wrapped to the width of a plot: lists of (index, label)."""
    lines, used = [[]], 0
    for index, (label, *_) in enumerate(curves):
        need = 6*len(label) + 34
        if used and used + need > WIDTH - BESIDE:
            lines.append([])
            used = 0
        lines[-1].append((index, label, used))
        used += need
    return lines


def draw_plot(title, x_label, y_label, curves, top):
    """One plot, its axes `top` below its upper edge."""
    (x0, x1), (y0, y1) = bounds([x for c in curves for x in c[1]], 0), bounds([y for c in curves for y in c[2] if y == y], 0.05)
    right, bottom = WIDTH - 20, top + AXES

    def at(x, y):
        return BESIDE + (x - x0)/(x1 - x0)*(right - BESIDE), bottom - (y - y0)/(y1 - y0)*AXES
    part = [f'<text x="{WIDTH/2}" y="20" text-anchor="middle" font-weight="bold">{html.escape(title)}</text>']
    for x, text in ticks(x0, x1):
        part += [f'<path d="M{at(x, y0)[0]:.1f} {top}V{bottom}" stroke="#e4e4e4"/>',
                 f'<text x="{at(x, y0)[0]:.1f}" y="{bottom + 16}" text-anchor="middle">{text}</text>']
    for y, text in ticks(y0, y1):
        part += [f'<path d="M{BESIDE} {at(x0, y)[1]:.1f}H{right}" stroke="#e4e4e4"/>',
                 f'<text x="{BESIDE - 5}" y="{at(x0, y)[1] + 4:.1f}" text-anchor="end">{text}</text>']
    part += [f'<rect x="{BESIDE}" y="{top}" width="{right - BESIDE}" height="{AXES}" fill="none" stroke="#888"/>',
             f'<text x="{(BESIDE + right)/2}" y="{bottom + 34}" text-anchor="middle">{html.escape(x_label)}</text>',
             f'<text x="12" y="{top + AXES/2}" text-anchor="middle" transform="rotate(-90 12 {top + AXES/2})">'
             f'{html.escape(y_label)}</text>']
    for index, (_, xs, ys, points) in enumerate(curves):
        colour, pairs = COLOURS[index % len(COLOURS)], [at(x, y) for x, y in zip(xs, ys) if y == y]
        if points:
            part += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.5" fill="{colour}"/>' for x, y in pairs]
        else:
            line = " ".join(f"{x:.1f},{y:.1f}" for x, y in pairs)
            part.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="1.3"/>')
    for number, line in enumerate(legend_lines(curves)):
        for index, label, x in line:
            colour, left, y = COLOURS[index % len(COLOURS)], BESIDE + x, 38 + LINE*number
            part.append(f'<circle cx="{left + 9}" cy="{y - 4}" r="2.5" fill="{colour}"/>' if curves[index][3] else
                        f'<path d="M{left} {y - 4}h18" stroke="{colour}" stroke-width="2"/>')
            part.append(f'<text x="{left + 22}" y="{y}" fill="{colour}">{html.escape(label)}</text>')
    return part


def draw(plots):
    """The SVG of plots, each (title, x label, y label, curves), a curve (label, xs, ys, points instead of a line?)."""
    in_row = min(3, len(plots))
    tops = [32 + LINE*max(len(legend_lines(p[3])) for p in plots[k:k + in_row]) for k in range(0, len(plots), in_row)]
    parts, above = [], 0
    for number, plot in enumerate(plots):
        row, column = divmod(number, in_row)
        parts += [f'<g transform="translate({column*WIDTH},{sum(tops[:row]) + row*(AXES + BELOW)})">', *draw_plot(*plot, tops[row]), "</g>"]
    height = sum(tops) + len(tops)*(AXES + BELOW)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{in_row*WIDTH}" height="{height}" '
            f'font-family="sans-serif" font-size="11">\n<rect width="100%" height="100%" fill="white"/>\n'
            + "\n".join(parts) + "\n</svg>\n")
