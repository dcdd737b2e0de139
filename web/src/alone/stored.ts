// Files in the browser's storage: what the worker's file system has is written here, and read at the next start. Where a
// browser offers no storage (a private window) they live as long as the page.

export type Files = Record<string, Uint8Array<ArrayBuffer>>; // by path

const database_name = "ipos";
const store_name = "files";

function finished<Value>(request: IDBRequest<Value>): Promise<Value> {
  return new Promise((done, failed) => {
    request.onsuccess = () => done(request.result);
    request.onerror = () => failed(request.error);
  });
}

let opened: Promise<IDBDatabase> | undefined;

function database(): Promise<IDBDatabase> {
  opened ??= (async () => {
    const request = indexedDB.open(database_name, 1);
    request.onupgradeneeded = () => request.result.createObjectStore(store_name);
    return finished(request);
  })();
  return opened;
}

export async function storedFiles(): Promise<Files> {
  try {
    const store = (await database()).transaction(store_name).objectStore(store_name);
    const [keys, values] = await Promise.all([finished(store.getAllKeys()), finished(store.getAll())]);
    return Object.fromEntries(keys.map((key, n) => [String(key), values[n] as Uint8Array<ArrayBuffer>]));
  } catch {
    return {};
  }
}

// Files that have changed; null: it is gone. False: they are there until the page goes.
export async function storeFiles(changed: Record<string, Uint8Array<ArrayBuffer> | null>): Promise<boolean> {
  try {
    const transaction = (await database()).transaction(store_name, "readwrite");
    const store = transaction.objectStore(store_name);
    for (const [path, bytes] of Object.entries(changed)) {
      if (bytes) store.put(bytes, path);
      else store.delete(path);
    }
    const stored = new Promise<boolean>((done) => {
      transaction.oncomplete = () => done(true);
      transaction.onabort = () => done(false);
    });
    transaction.commit(); // also if the page is left now
    return await stored;
  } catch {
    return false;
  }
}
