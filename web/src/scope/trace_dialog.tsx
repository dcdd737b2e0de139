// A trace of a run that is over, `run.ipos-trace`, opened by the button of the scope or dropped on the page: a picture of its own
// over the page. Nothing of it goes to the plant.
import { signal } from "@preact/signals";
import { useLayoutEffect, useRef } from "preact/hooks";

import { Dialog } from "../keep/dialog";
import { Plot, type Recorded } from "../picture/plot";
import { trace_ending } from "../picture/drop";
import { readTrace } from "../picture/trace_file";
import { complain, forgive } from "../shell/notice";

const opened = signal<Recorded | null>(null);

export async function openTrace(file: File): Promise<void> {
  forgive();
  try {
    opened.value = await readTrace(await file.arrayBuffer(), file.name);
  } catch (reason) {
    complain(new Error(`${file.name}: ${reason instanceof Error ? reason.message : String(reason)}`));
  }
}

function TracePlot({ recorded }: { recorded: Recorded }) {
  const place = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => {
    const plot = new Plot(recorded, place.current as HTMLDivElement);
    const key = (event: KeyboardEvent) => {
      if (!event.defaultPrevented && event.target === place.current?.closest("dialog")) plot.key(event);
    };
    addEventListener("keydown", key);
    return () => removeEventListener("keydown", key);
  }, [recorded]);
  return <div class="trace-plot" ref={place} />;
}

export function TraceDialog() {
  const recorded = opened.value;
  if (!recorded) return null;
  return (
    <Dialog name="Trace" wide onClose={() => (opened.value = null)}>
      <TracePlot recorded={recorded} />
    </Dialog>
  );
}

export function OpenTrace() {
  return (
    <label title="A trace of ipos run --trace run.ipos-trace; it can be dropped on the page, too">
      Open trace{" "}
      <input
        type="file"
        accept={trace_ending}
        onChange={(event) => {
          const file = event.currentTarget.files?.[0];
          event.currentTarget.value = "";
          if (file) void openTrace(file);
        }}
      />
    </label>
  );
}
