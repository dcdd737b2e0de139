// Leads from a place that a text names ("HOIST.IPC:20:13", "hoist.test.toml:12") to its line in the view Program.
import { signal } from "@preact/signals";

import { plant } from "../server/live";
import { open } from "../shell/desk";
import { plantFiles } from "./documents";
import { files, openFile, station } from "./program_state";

export interface Place {
  file: string; // as the text has it: the end of the name of a file of the program, the plant or its tests
  line: number;
}

// The line that the source view shall show, until another one is wanted.
export const wantedLine = signal<Place | null>(null);

export function isFile(name: string, wanted: string): boolean {
  return name === wanted || name.endsWith(`/${wanted}`) || wanted.endsWith(`/${name}`);
}

export function openLine(of: string, place: Place): void {
  if (plant.peek()?.stations.some((one) => one.name === of && one.program)) station.value = of;
  wantedLine.value = place;
  open("Program");
}

// The files come after the view was opened, those of a program after it was chosen.
function openWanted(): void {
  const place = wantedLine.peek();
  const found = place && [...files.peek(), ...plantFiles.peek()].find((file) => isFile(file.name, place.file));
  if (found) openFile.value = found.name;
}
for (const source of [files, plantFiles, wantedLine]) source.subscribe(openWanted);

export function PlaceLink({ of = "", place, text, onOpen }: { of?: string; place: Place; text: string; onOpen?: () => void }) {
  return (
    <button
      class="link mono"
      title="Show this line in Program"
      onClick={() => {
        onOpen?.();
        openLine(of, place);
      }}
    >
      {text}
    </button>
  );
}

const place_words = /([\w./-]+\.(?:ipc|h|toml):\d+(?::\d+)?)/i;

export function placeIn(text: string): Place | undefined {
  const [file, line] = place_words.exec(text)?.[1]?.split(":") ?? [];
  return file && line ? { file, line: Number(line) } : undefined;
}

// Each place in the text is a way to its line.
export function TextWithPlaces({ of, text }: { of: string; text: string }) {
  return (
    <>
      {text.split(place_words).map((part, n) => {
        const place = n % 2 === 1 ? placeIn(part) : undefined;
        return place ? <PlaceLink key={n} of={of} place={place} text={part} /> : part;
      })}
    </>
  );
}
