// A trace that is dropped anywhere on the page.
export const trace_ending = ".ipos-trace";

export function takeDrops(take: (file: File) => Promise<void>): void {
  const isFile = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;
  addEventListener("dragover", (event) => {
    if (isFile(event)) event.preventDefault();
  });
  addEventListener("drop", (event) => {
    const file = event.dataTransfer?.files[0];
    if (!file?.name.endsWith(trace_ending)) return;
    event.preventDefault();
    void take(file);
  });
}
