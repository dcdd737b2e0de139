// ipos dap as an editor meets it: a process, driven by the package VS Code tests its debug adapters with.
//   IPOS_PROGRAM=.../ipos node --test dap.test.mjs
import assert from "node:assert";
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import test from "node:test";

import support from "@vscode/debugadapter-testsupport";

const program = process.env.IPOS_PROGRAM;
assert.ok(program, "IPOS_PROGRAM names the ipos to test");

const source = `long lCount;
long lWrong;
main()
{
  while (1)
  {
    lCount++;
    if (lCount == 300) lWrong = 1;
    _Wait(2);
  }
}
`;

// Under wine the root of this machine is the drive Z:.
const here = (path) => path.replace(/^Z:/i, "").replaceAll("\\", "/");

// A client with a program launched and stopped at its beginning.
async function session(use, port) {
  const folder = mkdtempSync(join(tmpdir(), "ipos-dap-"));
  const path = join(folder, "MAIN.IPC");
  writeFileSync(path, source);
  const client = new support.DebugClient(program, "dap", "ipos");
  let child;
  // The client starts adapters written for node; ours is a program.
  if (port) {
    child = spawn(program, ["dap", "--port", "0"], { stdio: ["ignore", "ignore", "pipe"] });
    const number = await new Promise((resolve) =>
      child.stderr.on("data", (text) => resolve(Number(/127\.0\.0\.1:(\d+)/.exec(text)[1]))),
    );
    await client.start(number);
  } else {
    child = spawn(program, ["dap"], { stdio: ["pipe", "pipe", "inherit"] });
    client.connect(child.stdout, child.stdin);
  }
  const ended = new Promise((resolve) => child.on("exit", resolve));
  try {
    await client.initializeRequest();
    await client.launchRequest({ program: path, unit: "mdxb", stopOnEntry: true });
    const entry = client.waitForEvent("stopped");
    await client.configurationDoneRequest();
    const threadId = (await entry).body.threadId;
    const stopped = async (request) => (await Promise.all([client.waitForEvent("stopped"), request]))[0].body;
    const top = async () => (await client.stackTraceRequest({ threadId })).body.stackFrames[0];
    const value = async (expression) =>
      (await client.evaluateRequest({ expression, frameId: (await top()).id, context: "watch" })).body.result;
    await use({ client, path, threadId, stopped, top, value });
    await client.disconnectRequest();
    assert.strictEqual(await ended, 0);
  } finally {
    child.kill();
    rmSync(folder, { recursive: true });
  }
}

for (const port of [false, true])
  test(`a breakpoint stops, a step goes on (${port ? "port" : "stdio"})`, () =>
    session(async ({ client, path, threadId, stopped, top, value }) => {
      const { body } = await client.setBreakpointsRequest({ source: { path }, breakpoints: [{ line: 8, condition: "lCount == 3" }] });
      assert.strictEqual(body.breakpoints[0].verified, true);
      assert.strictEqual((await stopped(client.continueRequest({ threadId }))).reason, "breakpoint");
      assert.strictEqual((await top()).line, 8);
      assert.strictEqual(here((await top()).source.path), path);
      assert.strictEqual(await value("lCount"), "3");
      await stopped(client.nextRequest({ threadId }));
      assert.strictEqual((await top()).line, 9);
    }, port));

test("a data breakpoint and reverse steps lead to the cause of a wrong value", () =>
  session(async ({ client, threadId, stopped, top, value }) => {
    const scopes = (await client.scopesRequest({ frameId: (await top()).id })).body.scopes;
    const { variablesReference } = scopes.find((scope) => scope.name === "Variables");
    const { dataId } = (await client.send("dataBreakpointInfo", { variablesReference, name: "lWrong" })).body;
    await client.send("setDataBreakpoints", { breakpoints: [{ dataId }] });
    const stop = await stopped(client.continueRequest({ threadId }));
    assert.strictEqual(stop.reason, "data breakpoint");
    assert.match(stop.text, /lWrong: 0 -> 1/);
    assert.strictEqual(await value("lWrong"), "1");
    await stopped(client.reverseContinueRequest({ threadId }));
    assert.strictEqual(await value("lWrong"), "0");
    assert.strictEqual(await value("lCount"), "300");
    assert.strictEqual((await top()).line, 8);
    await stopped(client.stepBackRequest({ threadId }));
    assert.strictEqual((await top()).line, 8);
    await stopped(client.stepBackRequest({ threadId }));
    assert.strictEqual((await top()).line, 7);
    assert.strictEqual(await value("lCount"), "299");
  }));

test("pause stops a plant that runs", () =>
  session(async ({ client, threadId, stopped }) => {
    await client.continueRequest({ threadId });
    await new Promise((resolve) => setTimeout(resolve, 100));
    assert.strictEqual((await stopped(client.pauseRequest({ threadId }))).reason, "pause");
  }));
