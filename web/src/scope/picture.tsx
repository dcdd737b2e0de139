// The picture of the scope in the page: what the server has sent, and where the cursors stand.
import { computed, effect, signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";

import type { Mark } from "../picture/control";
import { Picture } from "../picture/picture";
import { pointAt } from "../picture/points";
import { time } from "../server/live";
import { places, placesOf } from "./channels";
import { pictureWidth, points } from "./recording";
import { control, cursors, lastRecorded, scope, triggerTime } from "./window";

// Where the pointer is, in us.
export const pointer = signal<number | null>(null);
let shown: Picture | undefined;

// Of the point below it: that of the last millisecond where it stands for many.
export function valuesAtPointer(): (number | null)[] | null {
  const data = points.value;
  if (pointer.value === null || !data) return null;
  const at = pointAt(data, pointer.value);
  return at < 0 ? null : data.greatest.map((channel) => channel[at] ?? null);
}

export function pictureFile(): Blob | undefined {
  return shown?.png();
}

// What was recorded later stands beyond this moment.
const isPast = computed(() => lastRecorded.value > time.value.us);

function marksNow(): Mark[] {
  const marks: Mark[] = [];
  if (triggerTime.value !== null) marks.push({ us: triggerTime.value, text: "T", colour: "--bad" });
  return marks;
}

export function ScopePicture() {
  const frame = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const element = frame.current;
    if (!element) return undefined;
    const picture = new Picture(element, control);
    shown = picture;
    picture.onPointer = (us) => (pointer.value = us);
    picture.onWidth = (pixels) => (pictureWidth.value = pixels);
    let known = "";
    const stops = [
      effect(() => {
        const channels = scope.value?.channels ?? [];
        const where = placesOf(channels.map((channel) => channel.name));
        void places.value;
        const layout = JSON.stringify([channels, where]);
        if (layout === known) return;
        known = layout;
        picture.show(channels, where);
      }),
      effect(() => {
        const data = points.value;
        if (data && data.recording === scope.value?.recording) picture.setPoints(data);
      }),
      effect(() => picture.setMarks(marksNow())),
      effect(() => picture.setPresent(isPast.value ? time.value.us : null)),
      effect(() => {
        void cursors.value;
        picture.redraw();
      }),
    ];
    return () => {
      for (const stop of stops) stop();
      picture.destroy();
      if (shown === picture) shown = undefined;
      pointer.value = null;
    };
  }, []);
  return <div class="picture" ref={frame} />;
}
