// The table below the picture: values under the pointer and at the two cursors, and what is measured between them.
import { effect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";

import { Legend } from "../picture/legend";
import { pointer, valuesAtPointer } from "./picture";
import { atCursor, measures } from "./recording";
import { activeCursor, cursors, scope, toggleCursor } from "./window";

export function Readings() {
  const frame = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const element = frame.current;
    if (!element) return undefined;
    const legend = new Legend(element, toggleCursor);
    let known = "";
    return effect(() => {
      const channels = scope.value?.channels ?? [];
      const names = JSON.stringify(channels);
      if (names !== known) legend.setChannels(channels);
      known = names;
      legend.show(channels, {
        pointer_us: pointer.value,
        cursors: cursors.value,
        active: activeCursor.value,
        at: { pointer: valuesAtPointer(), A: atCursor.value.A, B: atCursor.value.B },
        measures: measures.value,
      });
    });
  }, []);
  return <div ref={frame} />;
}
