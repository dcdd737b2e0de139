// Telegrams as dots that run from their sender to all ends of the line, in slow motion; a click reads one. Where motion is not
// wanted they stand at their sender as long as they are on the line.
import { useEffect, useRef } from "preact/hooks";

import { secondsText, time } from "../server/live";
import { pointOn, waysFrom, type Layout, type Point } from "./drawing_layout";
import { pressed } from "./drawing_lines";
import { followTelegrams, onLines, read, shownUs, type OnLine } from "./telegrams";

function Dot({ one, layout }: { one: OnLine; layout: Layout }) {
  const group = useRef<SVGGElement>(null);
  const { frame } = one;
  const { running } = time.value;
  useEffect(() => {
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const known = waysFrom(layout, frame.bus, frame.sender ?? "");
    // Nobody of the drawing has sent it: it comes in at the end of the line.
    const cable = layout.rows.flatMap((row) => row.cables).find((part) => part.line.name === frame.bus);
    const ways: Point[][] = known.length > 0 || !cable ? known : [[{ x: cable.fromX, y: cable.y }, { x: cable.toX, y: cable.y }]];
    let handle = 0;
    const draw = () => {
      const part = (shownUs() - one.began_us) / Math.max(1, one.took_us);
      const element = group.current;
      if (element) {
        element.style.display = part >= 0 && part <= 1 ? "" : "none";
        [...element.querySelectorAll("circle")].forEach((circle, n) => {
          const way = ways[n];
          if (!way) return;
          const { x, y } = pointOn(way, still ? 0 : part);
          circle.setAttribute("cx", x.toFixed(1));
          circle.setAttribute("cy", y.toFixed(1));
        });
      }
      if (part <= 1 && running) handle = requestAnimationFrame(draw);
    };
    draw();
    return () => cancelAnimationFrame(handle);
  }, [one, layout, running]);
  const count = Math.max(1, waysFrom(layout, frame.bus, frame.sender ?? "").length);
  const show = () => (read.value = frame);
  return (
    <g
      ref={group}
      class={`telegram${frame.error ? " error" : ""}`}
      role="button"
      tabindex={0}
      aria-label={`Telegram ${frame.text || frame.data}`}
      style={{ display: "none" }}
      onPointerDown={show}
      onClick={show}
      onKeyDown={pressed(show)}
    >
      <title>{frame.text || frame.data}</title>
      {Array.from({ length: count }, (_unused, n) => (
        <circle key={n} r="6" />
      ))}
    </g>
  );
}

export function TelegramDots({ layout }: { layout: Layout }) {
  useEffect(followTelegrams, []);
  return (
    <>
      {onLines.value.map((one) => (
        <Dot key={one.frame.n} one={one} layout={layout} />
      ))}
    </>
  );
}

// The last telegram that somebody has clicked.
export function TelegramWords() {
  const frame = read.value;
  return (
    <p role="status" class="telegram-words">
      {frame && (
        <>
          <span class="mono">{secondsText(frame.us)}</span> {frame.bus}
          {frame.sender && `, ${frame.sender}`}: {frame.text} <span class="mono quiet">{frame.data.match(/../g)?.join(" ")}</span>{" "}
          <button class="small" aria-label="Close telegram" onClick={() => (read.value = null)}>
            ✕
          </button>
        </>
      )}
    </p>
  );
}
