// A server with the protocol of docs/reference/serve.md and a plant of cardboard: for work on the page without the
// program, and for tests of what the program does not do at will (a line that goes away, a drive that refuses).
//   node mock/server.mjs [PORT]      then open the address it prints
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { fileURLToPath } from "node:url";

import { WebSocketServer } from "ws";

import { answer, event, newPlant, tick } from "./plant.mjs";

const page = fileURLToPath(new URL("../dist/index.html", import.meta.url));
const tick_ms = 50;

export async function startMock({ port = 0, token = "mock", mode = "plant", writable = true } = {}) {
  const plant = newPlant();
  const http = createServer((request, response) => {
    const address = new URL(request.url, "http://127.0.0.1");
    if (address.searchParams.get("token") !== token) {
      response.writeHead(401).end();
      return;
    }
    requests.push(address.pathname);
    response.writeHead(address.pathname === "/" ? 200 : 404, {
      "Content-Type": "text/html; charset=utf-8",
      "Content-Security-Policy":
        "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; connect-src 'self'; img-src data: blob:",
    });
    response.end(address.pathname === "/" ? readFileSync(page) : "");
  });
  const requests = [];
  const received = [];
  const sockets = new WebSocketServer({ noServer: true });
  http.on("upgrade", (request, socket, head) => {
    if (new URL(request.url, "http://127.0.0.1").searchParams.get("token") !== token) socket.destroy();
    else sockets.handleUpgrade(request, socket, head, greet);
  });

  function greet(client) {
    const topics = new Map();
    const send = (message) => client.send(JSON.stringify(message));
    send({ event: "hello", protocol: 1, version: "0", mode, title: "mock.toml", writable });
    send(event(plant, "time", {}, true));
    client.on("message", (text) => {
      const command = JSON.parse(text);
      received.push(command);
      if (command.do === "subscribe") {
        topics.set(command.topic, command);
        send({ re: command.id, ok: true });
        const first = event(plant, command.topic, command, true);
        if (first) send(first);
        return;
      }
      if (command.do === "unsubscribe") topics.delete(command.topic);
      const reply = answer(plant, command);
      if (Buffer.isBuffer(reply)) client.send(reply);
      else send({ re: command.id, ...reply });
      for (const [topic, options] of [["time", {}], ...topics]) {
        const next = event(plant, topic, options, command.do === "restart" || command.do === "watch");
        if (next) send(next);
      }
    });
    const timer = setInterval(() => {
      if (!plant.running) return;
      for (const [topic, options] of [["time", {}], ...topics]) {
        const next = event(plant, topic, options, false);
        if (next) send(next);
      }
    }, tick_ms);
    client.on("close", () => clearInterval(timer));
  }

  const clock = setInterval(() => plant.running && tick(plant, tick_ms), tick_ms);
  await new Promise((done) => http.listen(port, "127.0.0.1", done));
  return {
    address: `http://127.0.0.1:${http.address().port}/?token=${token}`,
    port: http.address().port,
    plant,
    requests,
    received,
    // To all tabs, unasked.
    announce(message) {
      for (const client of sockets.clients) client.send(JSON.stringify(message));
    },
    async stop() {
      clearInterval(clock);
      for (const client of sockets.clients) client.terminate();
      http.closeAllConnections();
      await new Promise((done) => http.close(done));
    },
  };
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const mock = await startMock({ port: Number(process.argv[2] ?? 8080), mode: process.argv[3] ?? "plant" });
  console.log(mock.address);
}
