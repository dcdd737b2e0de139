// What happens in this plant: the story of its file, what it plans, and what of that is next.
import { computed } from "@preact/signals";

import { plant, secondsText, time } from "../server/live";
import type { Planned } from "../server/protocol";
import { setting } from "../shell/settings";

const announced_us = 2_000_000; // so long before its time

const closed = setting("plant.story", false);

// The next time after this one.
function nextTime(act: Planned, us: number): number | null {
  if (act.us > us) return act.us;
  if (act.every_us === 0) return null;
  const turn = Math.floor((us - act.us) / act.every_us) + 1;
  return act.times === 0 || turn < act.times ? act.us + turn * act.every_us : null;
}

const next = computed(() => {
  const now = time.value.us;
  const coming = (plant.value?.planned ?? []).flatMap((act) => {
    const us = nextTime(act, now);
    return us === null ? [] : [{ us, text: act.text }];
  });
  const us = Math.min(...coming.map((act) => act.us));
  return coming.length > 0 ? { us, text: coming.filter((act) => act.us === us).map((act) => act.text).join(", ") } : null;
});

// Under all views, when it is near.
export function Coming() {
  const act = next.value;
  const near = act && act.us - time.value.us <= announced_us;
  return (
    <span role="status" aria-label="Planned">
      {near && `Planned at ${secondsText(act.us)}: ${act.text}`}
    </span>
  );
}

export function Story() {
  const story = plant.value?.story;
  const planned = plant.value?.planned ?? [];
  if (!story && planned.length === 0) return null;
  return (
    <details class="panel" open={!closed.value} onToggle={(event) => (closed.value = !event.currentTarget.open)}>
      <summary>What happens here</summary>
      <p>{story}</p>
      {planned.length > 0 && (
        <ul aria-label="Planned">
          {planned.map((act) => (
            <li>
              {secondsText(act.us)} {act.text}
              {act.every_us > 0 && `, every ${act.every_us / 1e6} s`}
              {act.every_us > 0 && act.times > 0 && `, ${act.times} times`}
            </li>
          ))}
        </ul>
      )}
    </details>
  );
}
