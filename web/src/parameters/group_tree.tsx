// The groups of the parameters as a tree, as the manual's list has them: P1, P13 and what is in them.
import type { Signal } from "@preact/signals";

import type { ParameterGroup } from "../server/protocol";
import { groups } from "./parameter_list";

function Branch({ parent, group, onChoose }: { parent: string; group: Signal<string>; onChoose: () => void }) {
  const numbers = new Set(groups.value.map((one) => one.number));
  const children = groups.value.filter((one) => {
    for (let end = one.number.length - 1; end > 0; --end) {
      const above = one.number.slice(0, end);
      if (numbers.has(above)) return above === parent;
    }
    return parent === "";
  });
  if (children.length === 0) return null;
  return (
    <ul>
      {children.map((one: ParameterGroup) => (
        <li key={one.number}>
          <button
            aria-current={group.value === one.number}
            title={one.name}
            onClick={() => {
              group.value = one.number;
              onChoose();
            }}
          >
            <span class="mono quiet">{one.number}</span> {one.name}
          </button>
          {group.value.startsWith(one.number) && <Branch parent={one.number} group={group} onChoose={onChoose} />}
        </li>
      ))}
    </ul>
  );
}

export function GroupTree({ group, onChoose }: { group: Signal<string>; onChoose: () => void }) {
  return (
    <nav class="panel tree" aria-label="Groups">
      <button
        aria-current={group.value === ""}
        onClick={() => {
          group.value = "";
          onChoose();
        }}
      >
        All parameters
      </button>
      <Branch parent="" group={group} onChoose={onChoose} />
    </nav>
  );
}
