// A running `ipos serve` with a plant in a folder of its own, for tests of the page and for its pictures.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";

import WebSocket from "ws";

export const program = process.env.IPOS_PROGRAM;
// The examples of the project; tests may run in a copy of this package.
export const examples = process.env.IPOS_EXAMPLES ?? fileURLToPath(new URL("../../examples", import.meta.url));

// Token, port and settings are kept in the folder `state`, by default in one that no other server has.
export async function serve(plant, options = [], folder = ".", state = undefined) {
  const own = state ?? mkdtempSync(join(tmpdir(), "ipos-state-"));
  // Without a plant it is the only one of the folder, or the gallery.
  const child = spawn(program, ["serve", ...(plant ? [plant] : []), ...options], {
    cwd: folder,
    stdio: ["ignore", "pipe", "inherit"],
    env: { ...process.env, XDG_STATE_HOME: own },
  });
  const ended = new Promise((done) =>
    child.on("exit", (code, signal) => {
      if (!state) rmSync(own, { recursive: true });
      done(code ?? signal);
    }),
  );
  const address = await new Promise((done, failed) => {
    createInterface(child.stdout).once("line", done);
    void ended.then((code) => failed(new Error(`ipos serve ended with ${code}`)));
  });
  return {
    address,
    ended,
    kill: () => child.kill("SIGKILL"),
    async stop() {
      child.kill("SIGINT");
      return ended;
    },
  };
}

// Writes the files into a new folder; `remove` takes it away again.
export function folderOf(files) {
  const folder = mkdtempSync(join(tmpdir(), "ipos-web-"));
  for (const [name, text] of Object.entries(files)) writeFileSync(join(folder, name), text);
  return { folder, remove: () => rmSync(folder, { recursive: true }) };
}

// A command as a script gives it: to the millisecond, whatever the clock does.
export function order(server, command) {
  const address = new URL("/ws", server.address);
  address.protocol = "ws:";
  address.search = new URL(server.address).search;
  return new Promise((done, failed) => {
    const socket = new WebSocket(address);
    socket.on("error", failed);
    socket.on("open", () => socket.send(JSON.stringify({ id: 1, ...command })));
    socket.on("message", (data, binary) => {
      const reply = binary ? {} : JSON.parse(data);
      if (reply.re !== 1) return;
      socket.close();
      if (reply.error) failed(new Error(reply.error));
      else done(reply);
    });
  });
}

// The plant runs to that moment and stands there, whatever the clock does, and the page shows it.
export async function standAt(server, page, ms) {
  const shown = async () => Math.round(Number.parseFloat(await page.getByRole("timer", { name: "Time" }).textContent()) * 1000);
  await order(server, { do: "step", ms: ms - (await shown()) });
  for (const end = Date.now() + 20_000; (await shown()) !== ms; ) {
    if (Date.now() > end) throw new Error(`the page does not show ${ms} ms`);
    await new Promise((done) => setTimeout(done, 20));
  }
}
