// What goes on as long as at least one view wants it: a subscription, a timer. Views may be open twice.
export function shared(start: () => () => void): () => () => void {
  let users = 0;
  let stop: (() => void) | undefined;
  return () => {
    if (users++ === 0) stop = start();
    return () => {
      if (--users > 0) return;
      stop?.();
      stop = undefined;
    };
  };
}
