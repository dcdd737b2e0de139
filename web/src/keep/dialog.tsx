// A dialog over the page: it takes the focus, Escape closes it, and what had the focus before has it again. And its row that
// saves under a name, by Enter, too.
import type { ComponentChildren } from "preact";
import { useLayoutEffect, useRef } from "preact/hooks";

interface Shown {
  name: string;
  onClose: () => void;
  wide?: boolean; // as wide as the page
  children: ComponentChildren;
}

export function Dialog({ name, onClose, wide, children }: Shown) {
  const dialog = useRef<HTMLDialogElement>(null);
  useLayoutEffect(() => {
    const element = dialog.current;
    element?.showModal();
    return () => element?.close();
  }, []);
  return (
    <dialog class={wide ? "help keep wide" : "help keep"} ref={dialog} aria-label={name} onClose={onClose}>
      <div class="row">
        <h2>{name}</h2>
        <button class="spread" onClick={() => dialog.current?.close()}>
          Close
        </button>
      </div>
      {children}
    </dialog>
  );
}

interface Saving {
  file: string;
  setFile: (file: string) => void;
  save: (() => void) | undefined; // none: there is nothing to save yet
  children?: ComponentChildren;
}

export function FileRow({ file, setFile, save, children }: Saving) {
  return (
    <form
      class="row"
      onSubmit={(event) => {
        event.preventDefault();
        save?.();
      }}
    >
      <input type="text" aria-label="File" value={file} onInput={(event) => setFile(event.currentTarget.value)} />
      <button class="primary" type="submit" disabled={!save}>
        Save
      </button>
      {children}
    </form>
  );
}
