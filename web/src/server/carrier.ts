// Who carries the page's messages to its host and back: a WebSocket to `ipos serve`, or a worker that has the host in it.

// What the carrier tells. `lost` may be followed by `opened` again.
export interface Ends {
  opened(): void;
  text(text: string): void;
  frame(frame: DataView): void;
  lost(): void;
}

export interface Carrier {
  isOpen(): boolean;
  send(text: string): void;
}

export type Carry = (ends: Ends) => Carrier;
