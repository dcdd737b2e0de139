// Leads from a place that a text names ("HOIST.IPC:20:13") to its line in the view Program.
import { signal } from "@preact/signals";

import { plant } from "../server/live";
import { open } from "../shell/desk";
import { files, openFile, station } from "./program_state";

export interface Place {
  file: string; // as the text has it: the end of the name of a file of the program
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

// The files of a program come after it was chosen.
files.subscribe((all) => {
  const place = wantedLine.peek();
  const found = place && all.find((file) => isFile(file.name, place.file));
  if (found) openFile.value = found.name;
});
wantedLine.subscribe((place) => {
  const found = place && files.peek().find((file) => isFile(file.name, place.file));
  if (found) openFile.value = found.name;
});
