// With real drives: writing is confirmed on the page before the first value goes out.
import { signal } from "@preact/signals";

import { link } from "../server/connection";
import { hello } from "../server/live";
import { command } from "./notice";

export const armed = signal(false);
link.subscribe((state) => {
  // The server knows the confirmation of a connection only.
  if (state !== "open") armed.value = false;
});

async function arm(): Promise<void> {
  if (!confirm("Real drives are written and can move from now on. Is nobody in their way?")) return;
  if (await command({ do: "arm", yes: true })) armed.value = true;
}

export function WriteArm() {
  if (hello.value?.mode !== "device") return null;
  if (!hello.value.writable) return <span class="quiet">read only</span>;
  if (armed.value) return <strong class="bad">writing</strong>;
  return <button onClick={() => void arm()}>Allow writing</button>;
}
