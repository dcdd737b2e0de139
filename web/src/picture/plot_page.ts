// The page of `ipos run --plot x.html`, of a failed test and of the scope's HTML file: the recording stands in the document,
// and the picture of the scope shows it. A `.ipos-trace` that is dropped on it takes its place. It loads nothing.
import uplotStyle from "uplot/dist/uPlot.min.css";

import coloursStyle from "../style/colours.css";
import pictureStyle from "../style/picture.css";
import { takeDrops } from "./drop";
import { element, Plot, type Recorded, type RecordedChannel } from "./plot";
import plotStyle from "./plot_page.css";
import type { Samples } from "./points";
import { readTrace } from "./trace_file";

// As tools/recording/plot_html.cpp writes it.
interface Data extends Omit<Recorded, "samples" | "signals"> {
  samples: number;
  signals: (RecordedChannel & { changes: number[] })[]; // number of the sample, value
}

function samplesOf(data: Data): Samples {
  const values = data.signals.map(({ changes }) => {
    const all = new Float64Array(data.samples);
    for (let n = 0, at = 0, value = NaN; n < data.samples; ++n) {
      if (changes[at] === n) {
        value = changes[at + 1] as number;
        at += 2;
      }
      all[n] = value;
    }
    return all;
  });
  return { first_us: data.begin * 1000, values };
}

for (const style of [uplotStyle, coloursStyle, pictureStyle, plotStyle]) element("style", style, document.head);
const place = element("div", "", document.body);
let plot: Plot;

function show(recorded: Recorded): void {
  place.replaceChildren();
  document.title = recorded.title;
  plot = new Plot(recorded, place);
}

// A report leads to a millisecond by the part behind #.
function goToMoment(): void {
  const ms = Number(location.hash.slice(1));
  if (ms > 0) plot.goTo(ms);
}

const data = JSON.parse(document.getElementById("data")?.textContent ?? "") as Data;
show({ ...data, samples: samplesOf(data) });
goToMoment();
addEventListener("hashchange", goToMoment);
document.addEventListener("keydown", (event) => {
  if (!event.defaultPrevented && event.target === document.body) plot.key(event);
});
takeDrops(async (file) => {
  try {
    show(await readTrace(await file.arrayBuffer(), file.name));
  } catch (reason) {
    alert(`${file.name}: ${reason instanceof Error ? reason.message : String(reason)}`);
  }
});
