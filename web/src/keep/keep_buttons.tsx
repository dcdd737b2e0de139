// Beside the tabs: keep what was done as a test, keep the session, and a new station.
import { signal } from "@preact/signals";

import { BuildDialog } from "../build/build_dialog";
import { hello } from "../server/live";
import { offerKeys } from "../shell/keys";
import { SessionDialog } from "./session_dialog";
import { TestDialog } from "./test_dialog";

const open = signal<"test" | "session" | "station" | null>(null);

export function offerKeepKeys(): void {
  offerKeys("Keep", [
    { key: "k", text: "Keep as test", act: () => (open.value = "test") },
    { key: "K", text: "Save session", act: () => (open.value = "session") },
    { key: "N", text: "New station", act: () => (open.value = "station") },
  ]);
}

export function KeepButtons() {
  if (hello.value?.mode !== "plant") return null;
  const close = () => (open.value = null);
  return (
    <span class="row keep-buttons">
      <button class="small" title="What was done here as the steps of a test" onClick={() => (open.value = "test")}>
        Keep as test
      </button>
      <button class="small" title="The plant, what was done, this moment and this layout as a file" onClick={() => (open.value = "session")}>
        Save session
      </button>
      <button class="small" title="A station, a line, a wire or a control in the plant file" onClick={() => (open.value = "station")}>
        New station
      </button>
      {open.value === "test" && <TestDialog onClose={close} />}
      {open.value === "session" && <SessionDialog onClose={close} />}
      {open.value === "station" && <BuildDialog onClose={close} />}
    </span>
  );
}
