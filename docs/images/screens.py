#!/usr/bin/env python3
"""Makes the screenshots of the monitor's table, of an HTML plot and of an editor anew: screens.py IPOS

It needs Chromium, vim, pngquant and optipng; the pictures are what these draw, so no test compares them.
"""
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def shoot(page, picture, width, height):
    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    if chromium is None:
        sys.exit("there is no Chromium here")
    subprocess.run([chromium, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                    f"--window-size={width},{height}", "--virtual-time-budget=3000",
                    f"--screenshot={HERE / picture}", page.as_uri()], check=True, capture_output=True)
    subprocess.run([HERE / "smaller.sh", HERE / picture], check=True)


def monitor(ipos, folder):
    plant, log = ROOT / "examples/sbus-line/line.toml", folder / "bus.log"
    subprocess.run([ipos, "run", plant, "--for", "2s", "--log", log], capture_output=True, check=False)
    table = subprocess.run([ipos, "bus", "monitor", "--table", log, "--plant", plant], capture_output=True, text=True,
                           check=True).stdout
    rows = [line[:128] for line in table.split("\n")]
    svg = subprocess.run([HERE / "terminal.py", "ipos bus monitor --table bus.log --plant line.toml"],
                         input="\n".join(rows), text=True, capture_output=True, check=True).stdout
    page = folder / "monitor.html"
    page.write_text(f"<body style='margin:0'>{svg}</body>")
    shoot(page, "monitor-table.png", 1290, 40 + 22 * len(rows))


def plot(ipos, folder):
    page = folder / "plot.html"
    subprocess.run([ipos, "run", ROOT / "examples/isync/isync.toml", "--for", "4s", "--plot", page, "--signals",
                    "master.speed,slave.speed,master.position,slave.position,master.DI0*"], check=False, capture_output=True)
    shoot(page, "plot-html.png", 1280, 680)


def editor(_ipos, folder):
    page = folder / "editor.html"
    subprocess.run(["vim", "-es", "-u", "NONE", "-i", "NONE", "-N", "--cmd", f"set rtp^={ROOT}/tools/editors/vim",
                    "-c", "set t_Co=256", "-c", "filetype on", "-c", "syntax on",
                    "-c", "runtime plugin/tohtml.vim", "-c", "let g:html_number_lines=1", "-c", "let g:html_no_progress=1",
                    "-c", f"edit {ROOT}/examples/scom/SCOM1.IPC", "-c", "TOhtml", "-c", f"write! {page}", "-c", "qa!"],
                   check=False, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    shoot(page, "editor-vim.png", 640, 570)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        for picture in (monitor, plot, editor):
            picture(str(Path(sys.argv[1]).resolve()), Path(name))
