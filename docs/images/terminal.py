#!/usr/bin/env python3
"""Draws what a program printed on a terminal as an SVG picture for a page.

    ipos test broken.test.toml --color always | docs/images/terminal.py "ipos test broken.test.toml" > report.svg

Understands the colours of SGR sequences (bold, dim, 30..37, 90..97); every other sequence is left out.
"""
import html
import re
import sys

CELL_WIDTH, LINE_HEIGHT, MARGIN, FONT_SIZE = 8.0, 18, 14, 13
BACKGROUND, TEXT = "#1e1e24", "#d8d8d8"
COLOURS = {30: "#6b6b6b", 31: "#e8615a", 32: "#6cc070", 33: "#d9b84a", 34: "#6aa0e8", 35: "#c586c0",
           36: "#5cc2c2", 37: "#f0f0f0"}


def spans(line):
    """Yields (column, text, colour, bold) of a line."""
    colour, bold, column = TEXT, False, 0
    for part in re.split(r"(\x1b\[[0-9;]*[A-Za-z])", line):
        if part.startswith("\x1b["):
            if not part.endswith("m"):
                continue
            for code in [int(n or 0) for n in part[2:-1].split(";")]:
                if code == 0:
                    colour, bold = TEXT, False
                elif code == 1:
                    bold = True
                elif code == 2:
                    colour = COLOURS[30]
                elif 30 <= code <= 37 or 90 <= code <= 97:
                    colour = COLOURS[30 + code % 10]
                elif code == 39:
                    colour = TEXT
            continue
        if part:
            yield column, part, colour, bold
            column += len(part)


def draw(command, text):
    lines = [f"\x1b[1;32m$\x1b[0m \x1b[1m{command}\x1b[0m"] + text.rstrip("\n").split("\n")
    columns = max(sum(len(part) for _, part, _, _ in spans(line)) for line in lines)
    width, height = columns * CELL_WIDTH + 2 * MARGIN, len(lines) * LINE_HEIGHT + 2 * MARGIN
    print(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
          f'font-family="DejaVu Sans Mono, Consolas, monospace" font-size="{FONT_SIZE}">')
    print(f'<rect width="100%" height="100%" rx="6" fill="{BACKGROUND}"/>')
    for row, line in enumerate(lines):
        y = MARGIN + (row + 0.75) * LINE_HEIGHT
        for column, part, colour, bold in spans(line):
            if not part.strip():
                continue
            weight = ' font-weight="bold"' if bold else ""
            # The length keeps columns where they are, whatever font there is.
            print(f'<text x="{MARGIN + column * CELL_WIDTH:.1f}" y="{y:.1f}" fill="{colour}"{weight} xml:space="preserve" '
                  f'textLength="{len(part) * CELL_WIDTH:.1f}">{html.escape(part)}</text>')
    print("</svg>")


if __name__ == "__main__":
    draw(sys.argv[1], sys.stdin.read())
