// The seven-segment display of a drive, drawn as its strokes light up.

// Strokes a (above) to g (middle), clockwise as usual, bit 0 = a.
const strokes: Record<string, number> = {
  "0": 0x3f, "1": 0x06, "2": 0x5b, "3": 0x4f, "4": 0x66, "5": 0x6d, "6": 0x7d, "7": 0x07, "8": 0x7f, "9": 0x6f,
  A: 0x77, b: 0x7c, C: 0x39, c: 0x58, d: 0x5e, E: 0x79, F: 0x71, H: 0x76, h: 0x74, i: 0x10, J: 0x1e, L: 0x38,
  n: 0x54, o: 0x5c, P: 0x73, r: 0x50, S: 0x6d, t: 0x78, U: 0x3e, u: 0x1c, y: 0x6e, "-": 0x40, _: 0x08,
};

const paths = [
  "M5 3H17L14.5 6H7.5Z",
  "M18.5 4.5V15L17 16.5L15 14.5V7.5Z",
  "M18.5 29.5V19L17 17.5L15 19.5V26.5Z",
  "M5 31H17L14.5 28H7.5Z",
  "M3.5 29.5V19L5 17.5L7 19.5V26.5Z",
  "M3.5 4.5V15L5 16.5L7 14.5V7.5Z",
  "M5.5 17L7.5 15.5H14.5L16.5 17L14.5 18.5H7.5Z",
];

function strokesOf(character: string): number {
  return strokes[character] ?? strokes[character.toUpperCase()] ?? strokes[character.toLowerCase()] ?? 0;
}

export function SevenSegment({ text, label }: { text: string; label: string }) {
  const places: { character: string; point: boolean }[] = [];
  for (const character of text) {
    const last = places[places.length - 1];
    if (character === "." && last && !last.point) last.point = true;
    else places.push({ character: character === "." ? " " : character, point: character === "." });
  }
  if (places.length === 0) places.push({ character: " ", point: false });
  return (
    <svg
      class="seven-segment"
      role="img"
      aria-label={`${label}: ${text.trim() || "dark"}`}
      viewBox={`0 0 ${places.length * 24 + 2} 34`}
      height="46"
    >
      {places.map((place, position) => (
        <g key={position} transform={`translate(${position * 24 + 1} 0) skewX(-4)`}>
          {paths.map((path, stroke) => (
            <path key={stroke} d={path} class={(strokesOf(place.character) >> stroke) & 1 ? "lit" : "unlit"} />
          ))}
          <circle cx="22" cy="30" r="1.8" class={place.point ? "lit" : "unlit"} />
        </g>
      ))}
    </svg>
  );
}
