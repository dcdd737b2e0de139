// The sheet of keys, opened with "?".
import { signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";

import { request } from "../server/connection";
import { keyGroups, keysOn } from "./keys";

export const helpOpen = signal(false);
const notices = signal("");

async function askNotices(): Promise<void> {
  notices.value = String((await request({ do: "licences" })).text);
}

function shown(key: string): string {
  return key === " " ? "Space" : key.replace("Arrow", "");
}

export function Help() {
  const dialog = useRef<HTMLDialogElement>(null);
  const open = helpOpen.value;
  useEffect(() => {
    if (open) dialog.current?.showModal();
    else dialog.current?.close();
  }, [open]);
  return (
    <dialog class="help" ref={dialog} aria-label="Keys" onClose={() => (helpOpen.value = false)}>
      {open && (
        <>
          <div class="row">
            <h2>Keys</h2>
            <button class="spread" onClick={() => (helpOpen.value = false)}>
              Close
            </button>
          </div>
          <div class="columns">
            {keyGroups.value.map((group) => (
              <section key={group.title}>
                <h3>{group.title}</h3>
                <table>
                  <tbody>
                    {group.keys.map((key) => (
                      <tr key={key.key}>
                        <td>
                          <kbd>{shown(key.key)}</kbd>
                        </td>
                        <td>{key.text}</td>
                      </tr>
                    ))}
                  </tbody>
                </table>
              </section>
            ))}
          </div>
          <p class="quiet">
            Tab goes to every control; Enter or Space acts. In a table of values Enter sets, Escape leaves the field.
          </p>
          {notices.value ? <pre tabIndex={0}>{notices}</pre> : <button onClick={askNotices}>Licences</button>}
          <p>
            <label class="field">
              <input
                type="checkbox"
                checked={keysOn.value}
                onChange={(event) => (keysOn.value = event.currentTarget.checked)}
              />
              <span>Single letters are commands</span>
            </label>
          </p>
        </>
      )}
    </dialog>
  );
}
