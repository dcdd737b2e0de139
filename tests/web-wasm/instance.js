// A verb of ipos in WebAssembly as a process: an instance of its own, with some files, run to its end. For node and for a page.
// `ipos` is emscripten's function of tools/ipos.js.
globalThis.runVerb = async function runVerb(ipos, wasm, { folder, files, words, texts = true }) {
  const out = [];
  const err = [];
  const instance = await ipos({
    instantiateWasm: (imports, done) => {
      WebAssembly.instantiate(wasm, imports).then(done);
      return {};
    },
    stdin: () => null,
    stdout: (byte) => byte !== null && out.push(byte & 0xff),
    stderr: (byte) => byte !== null && err.push(byte & 0xff),
    take: () => undefined,
  });
  const { FS } = instance;
  for (const [path, text] of Object.entries(files)) {
    FS.mkdirTree(path.slice(0, path.lastIndexOf("/")));
    FS.writeFile(path, Uint8Array.from(atob(text), (c) => c.charCodeAt(0)));
  }
  FS.chdir(folder);
  const began = performance.now();
  const code = instance.callMain(words);
  const ms = performance.now() - began;
  const text = (bytes) => new TextDecoder().decode(new Uint8Array(bytes));
  return texts ? { code, out: text(out), err: text(err), ms } : { code, ms };
};
