// The programs of a message's page, as `ipos explain` prints it: the failing one stands behind "Wrong:", the mended one behind
// "Right:", each with four spaces in front of its lines.
const indent = "    ";

// `version`: "wrong" or "right". Undefined: the page has none that the editor can open.
export function programOfMessage(page: string, version: string): string | undefined {
  const lines = page.split("\n");
  const heading = lines.findIndex((line) => line.toLowerCase() === `${version}:`);
  if (heading < 0) return undefined;
  const rest = lines.slice(heading + 1);
  const first = rest.findIndex((line) => line.startsWith(indent));
  const end = rest.findIndex((line, at) => at > first && !line.startsWith(indent));
  if (first < 0) return undefined;
  return rest.slice(first, end < 0 ? undefined : end).map((line) => line.slice(indent.length) + "\n").join("");
}
