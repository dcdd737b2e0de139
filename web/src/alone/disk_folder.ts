// A folder of the disk, where the browser offers it (File System Access API).
import type { Files } from "./stored";

interface FileHandle {
  kind: "file";
  getFile(): Promise<File>;
  createWritable(): Promise<{ write(data: BufferSource): Promise<void>; close(): Promise<void> }>;
}
export interface FolderHandle {
  kind: "directory";
  name: string;
  entries(): AsyncIterable<[string, FileHandle | FolderHandle]>;
  getDirectoryHandle(name: string, options: { create: boolean }): Promise<FolderHandle>;
  getFileHandle(name: string, options: { create: boolean }): Promise<FileHandle>;
}
interface WithPicker {
  showDirectoryPicker?: (options: { mode: "readwrite" }) => Promise<FolderHandle>;
}

export const hasFolders = typeof (window as WithPicker).showDirectoryPicker === "function";

// Nothing: the person has chosen none.
export async function chosenFolder(): Promise<FolderHandle | undefined> {
  try {
    return await (window as WithPicker).showDirectoryPicker?.({ mode: "readwrite" });
  } catch (reason) {
    if (reason instanceof DOMException && reason.name === "AbortError") return undefined;
    throw reason;
  }
}

const most_bytes = 1 << 20; // of a file: sources and plants, and no recordings
const deepest = 4;

export async function filesIn(folder: FolderHandle, before = "", depth = 0): Promise<Files> {
  const files: Files = {};
  for await (const [name, entry] of folder.entries()) {
    if (name.startsWith(".")) continue;
    if (entry.kind === "directory") {
      if (depth < deepest) Object.assign(files, await filesIn(entry, `${before}${name}/`, depth + 1));
      continue;
    }
    const file = await entry.getFile();
    if (file.size <= most_bytes) files[before + name] = new Uint8Array(await file.arrayBuffer());
  }
  return files;
}

export async function writeInto(folder: FolderHandle, files: Files): Promise<void> {
  for (const [path, bytes] of Object.entries(files)) {
    const names = path.split("/");
    const name = names.pop() as string;
    let place = folder;
    for (const one of names) place = await place.getDirectoryHandle(one, { create: true });
    const stream = await (await place.getFileHandle(name, { create: true })).createWritable();
    await stream.write(bytes);
    await stream.close();
  }
}
