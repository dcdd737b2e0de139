// What a page without a server has in its head in addition: where the files are opened from and saved to, and the link.
import { signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";

import { request } from "../server/connection";
import { time } from "../server/live";
import { download } from "../shell/download";
import { complain, forgive } from "../shell/notice";
import { archiveOf, filesOf } from "./archive";
import { chosenFolder, filesIn, hasFolders, writeInto, type FolderHandle } from "./disk_folder";
import { filesBelow, openGallery, openPlant, runVerb } from "./plant_worker";
import { linkOf, longest_link } from "./share";
import { canBeOpened, home, open, openFolder, placeFiles } from "./start";
import type { Files } from "./stored";

const filesOpen = signal(false);
const plants = signal<string[]>([]); // and sessions, of the storage, by path
const link = signal<string | null>(null);
const report = signal<string | null>(null);
let from_disk: FolderHandle | undefined; // of the open plant

function act(what: () => Promise<void>): () => void {
  return () => {
    forgive();
    void what().catch(complain);
  };
}

function openFolderName(): string {
  return openPlant.peek()?.split("/")[2] ?? "";
}

// The files of the open plant's folder, by their names in it.
async function ownFiles(): Promise<Files> {
  const folder = `${home}/${openFolderName()}`;
  const files = await filesBelow(folder);
  return Object.fromEntries(Object.entries(files).map(([path, bytes]) => [path.slice(folder.length + 1), bytes]));
}

async function take(name: string, files: Files): Promise<void> {
  await openFolder(await placeFiles(name, files));
  filesOpen.value = false;
}

const fromDisk = act(async () => {
  const folder = await chosenFolder();
  if (!folder) return;
  await take(folder.name, await filesIn(folder));
  from_disk = folder;
});

const toDisk = act(async () => {
  const folder = from_disk ?? (await chosenFolder());
  if (folder) await writeInto(folder, await ownFiles());
});

const toArchive = act(async () => download(`${openFolderName()}.zip`, await archiveOf(await ownFiles())));

async function fromArchive(file: File): Promise<void> {
  await take(file.name.replace(/\.zip$/i, ""), await filesOf(new Uint8Array(await file.arrayBuffer())));
}

const runTests = act(async () => {
  report.value = "…";
  const { out, err } = await runVerb(`${home}/${openFolderName()}`, ["test", "."]);
  report.value = out + err;
});

// With all that was done the one who opens the link has to do it again, which takes its time: a minute of the plant is soon done.
const soon_done_us = 60e6;
const withMoment = signal(true);
const session_file = "shared.ipos";

const share = act(async () => {
  const path = openPlant.peek();
  if (path === null) return;
  const name = openFolderName();
  const files = await ownFiles();
  let plant = path.slice(home.length + name.length + 2);
  if (withMoment.peek()) {
    const { settings } = await request({ do: "settings" });
    const { text } = await request({ do: "session", settings });
    files[session_file] = new TextEncoder().encode(text as string);
    plant = session_file;
  }
  link.value = await linkOf({ name, plant, files });
});

function beginSharing(): void {
  withMoment.value = time.peek().us <= soon_done_us;
  share();
}

const toGallery = act(async () => {
  await openGallery();
  filesOpen.value = false;
});

async function listPlants(): Promise<void> {
  plants.value = Object.keys(await filesBelow(home)).filter(canBeOpened);
}

// What a link brings along may come after a quick hand has opened the list.
openPlant.subscribe(() => {
  if (filesOpen.peek()) void listPlants().catch(complain);
});

const showFiles = act(async () => {
  await listPlants();
  report.value = null;
  filesOpen.value = true;
});

function useModal(open: boolean) {
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    if (open) dialog.current?.showModal();
    else dialog.current?.close();
  }, [open]);
  return dialog;
}

function FilesDialog() {
  const dialog = useModal(filesOpen.value);
  return (
    <dialog class="help" ref={dialog} aria-label="Files" onClose={() => (filesOpen.value = false)}>
      {filesOpen.value && (
        <>
          <div class="row">
            <h2>Files</h2>
            <button class="spread" onClick={() => (filesOpen.value = false)}>
              Close
            </button>
          </div>
          <p class="quiet">They live in the storage of this browser.</p>
          <ul aria-label="Plants">
            {plants.value.map((path) => (
              <li key={path}>
                <button
                  class="small"
                  onClick={act(async () => {
                    await open(path);
                    filesOpen.value = false;
                  })}
                >
                  {path.slice(home.length + 1)}
                </button>
              </li>
            ))}
          </ul>
          <div class="row">
            {hasFolders && <button onClick={fromDisk}>Open folder</button>}
            {hasFolders && <button onClick={toDisk}>Save to folder</button>}
            <label>
              Open archive{" "}
              <input
                type="file"
                accept=".zip"
                onChange={(event) => {
                  const file = event.currentTarget.files?.[0];
                  if (file) act(() => fromArchive(file))();
                }}
              />
            </label>
            <button onClick={toArchive}>Save archive</button>
            <button onClick={toGallery}>Gallery</button>
            <button onClick={runTests}>Test all</button>
          </div>
          {report.value !== null && (
            <pre role="status" aria-label="Test report">
              {report.value}
            </pre>
          )}
        </>
      )}
    </dialog>
  );
}

function ShareDialog() {
  const text = link.value;
  const dialog = useModal(text !== null);
  return (
    <dialog class="help" ref={dialog} aria-label="Share" onClose={() => (link.value = null)}>
      {text !== null && (
        <>
          <div class="row">
            <h2>Share</h2>
            <button class="spread" onClick={() => (link.value = null)}>
              Close
            </button>
          </div>
          <p>Who opens this link has the plant with its programs and tests. Nothing is sent to a server.</p>
          <input type="text" readOnly aria-label="Link" value={text} onFocus={(event) => event.currentTarget.select()} />
          <label class="field">
            <input
              type="checkbox"
              checked={withMoment.value}
              onChange={(event) => {
                withMoment.value = event.currentTarget.checked;
                share();
              }}
            />
            <span>With what was done, this moment and this layout</span>
          </label>
          <div class="row">
            <button onClick={act(() => navigator.clipboard.writeText(text))}>Copy</button>
            {text.length > longest_link && <button onClick={toArchive}>Save archive</button>}
          </div>
          {text.length > longest_link && (
            <p role="status">
              The link has {Math.ceil(text.length / 1024)} kB. Mail programs and chats cut links longer than{" "}
              {longest_link / 1024} kB: save an archive and send that.
            </p>
          )}
        </>
      )}
    </dialog>
  );
}

export function FilesBar() {
  return (
    <span class="group">
      <button onClick={showFiles}>Files</button>
      <button onClick={beginSharing}>Share</button>
      <FilesDialog />
      <ShareDialog />
    </span>
  );
}
