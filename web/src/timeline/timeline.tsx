// The timeline under all views: a slider from 0 to the furthest moment, and the marks of what has happened.
import { useEffect } from "preact/hooks";

import { secondsText, time } from "../server/live";
import { Coming } from "../plant/story";
import { MarkDots, MarkList } from "./marks";
import { dropped, followTimeline, furthestMs, goTo, marks, noPast, nowMs } from "./moments";

const page_ms = 100;

function keyMoves(event: KeyboardEvent): void {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  const now = nowMs.peek();
  const to = {
    ArrowLeft: now - 1,
    ArrowDown: now - 1,
    ArrowRight: now + 1,
    ArrowUp: now + 1,
    PageDown: now - page_ms,
    PageUp: now + page_ms,
    Home: 0,
    End: furthestMs.peek(),
  }[event.key];
  if (to === undefined) return;
  event.preventDefault();
  goTo(to);
}

function clicksText(count: number): string {
  return count === 1 ? "1 click" : `${count} clicks`;
}

// What running on from here would drop.
function Past() {
  const now_us = time.value.us;
  if (noPast.value || time.value.running || Math.floor(now_us / 1000) >= furthestMs.value) return null;
  const later = marks.value.filter((mark) => mark.kind === "click" && mark.us > now_us).length;
  return (
    <span class="quiet">
      in the past, {secondsText(furthestMs.value * 1000)} was reached
      {later > 0 && `; running on or a click here drops ${clicksText(later)}`}
    </span>
  );
}

export function Timeline() {
  useEffect(followTimeline, []);
  const now = nowMs.value;
  const text = secondsText(now * 1000);
  return (
    <footer class="timeline">
      <div class="track">
        <MarkDots />
        <input
          type="range"
          aria-label="Timeline"
          min={0}
          max={furthestMs.value}
          step={1}
          value={now}
          aria-valuenow={now}
          aria-valuetext={text}
          aria-describedby={noPast.value ? "no-past" : undefined}
          disabled={noPast.value !== ""}
          onInput={(event) => goTo(Number(event.currentTarget.value))}
          onKeyDown={keyMoves}
        />
      </div>
      {noPast.value ? (
        <p id="no-past" class="quiet">
          {noPast.value}
        </p>
      ) : (
        <>
          <MarkList />
          <p class="told">
            <Past />
            <Coming />
            <span role="status">
              {dropped.value && `${clicksText(dropped.value.clicks)} after ${secondsText(dropped.value.us)} dropped: the plant went on from there.`}
            </span>
          </p>
        </>
      )}
    </footer>
  );
}
