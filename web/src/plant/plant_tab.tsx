// The plant: its drawing, its ports, a card a station, and the faults of its lines.
import { useEffect } from "preact/hooks";

import { hello, plant } from "../server/live";
import { Drawing } from "./drawing";
import { Jog } from "./jog";
import { LineFaults } from "./line_faults";
import { Ports } from "./ports";
import { followPlant } from "./state";
import { StationCard } from "./station_card";

export function PlantTab() {
  const description = plant.value;
  useEffect(followPlant, [description]);
  if (!description) return <p class="empty">The server has not said yet what the plant has.</p>;
  return (
    <>
      {hello.value?.mode === "device" && <Jog />}
      {description.buses.length + description.wires.length > 0 && <Drawing plant={description} />}
      <Ports />
      <div class="stations">
        {description.stations.map((station) => (
          <StationCard key={station.name} station={station} plant={description} />
        ))}
      </div>
      {description.buses.some((bus) => bus.faults.length > 0) && <LineFaults buses={description.buses} />}
    </>
  );
}
