// The one WebSocket of the page, opened again and again when the server is lost.
import type { Carrier, Ends } from "./carrier";

const first_pause_ms = 300;
const longest_pause_ms = 3000;

export function overSocket(ends: Ends): Carrier {
  let socket: WebSocket | undefined;
  let pause_ms = first_pause_ms;
  const connect = () => {
    const address = new URL("/ws", location.href);
    address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    address.search = location.search;
    socket = new WebSocket(address);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      pause_ms = first_pause_ms;
      ends.opened();
    };
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => {
      if (typeof event.data === "string") ends.text(event.data);
      else ends.frame(new DataView(event.data));
    };
    socket.onclose = () => {
      ends.lost();
      setTimeout(connect, pause_ms);
      pause_ms = Math.min(pause_ms * 2, longest_pause_ms);
    };
  };
  connect();
  return {
    isOpen: () => socket?.readyState === WebSocket.OPEN,
    send: (text) => socket?.send(text),
  };
}
