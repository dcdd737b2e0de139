// The values under the pointer and at the two cursors, and what lies between them.
import { atCursor } from "./recording";
import { pointer } from "./picture";
import { activeCursor, cursors, putCursor, scope, shownWindow, type CursorName } from "./window";

function valueText(value: number | null | undefined, decimals: number): string {
  return value === null || value === undefined ? "–" : value.toFixed(Math.min(decimals, 6));
}

function timeText(us: number | null): string {
  return us === null ? "–" : `${(us / 1e6).toFixed(3)} s`;
}

function CursorHead({ name }: { name: CursorName }) {
  const set = cursors.value[name] !== null;
  return (
    <th scope="col">
      <button
        class="small"
        aria-label={`Cursor ${name}`}
        aria-pressed={activeCursor.value === name}
        title={`A click in the picture puts ${name}; again to take it away`}
        onClick={() => {
          const { from_us, to_us } = shownWindow.peek();
          if (activeCursor.peek() === name || !set) putCursor(name, set ? null : from_us + (to_us - from_us) * (name === "A" ? 0.4 : 0.6));
          else activeCursor.value = name;
        }}
      >
        {name}
      </button>
    </th>
  );
}

export function Readings() {
  const channels = scope.value?.channels ?? [];
  const { A, B } = cursors.value;
  const values = atCursor.value;
  const between = A !== null && B !== null ? (B - A) / 1e6 : null;
  return (
    <div style="overflow-x:auto" tabIndex={0}>
      <table class="readings mono" aria-label="Readings">
        <thead>
          <tr>
            <th scope="col" style="text-align:left">
              Channel
            </th>
            <th scope="col">pointer</th>
            <CursorHead name="A" />
            <CursorHead name="B" />
            <th scope="col">B − A</th>
          </tr>
        </thead>
        <tbody>
          <tr>
            <th scope="row">time</th>
            <td>{timeText(pointer.value?.us ?? null)}</td>
            <td>{timeText(A)}</td>
            <td>{timeText(B)}</td>
            <td>
              {between === null ? "–" : `${between.toFixed(3)} s`}
              {between ? <span class="quiet"> {(1 / Math.abs(between)).toPrecision(4)} Hz</span> : ""}
            </td>
          </tr>
          {channels.map((channel, position) => {
            const a = values.A?.[position];
            const b = values.B?.[position];
            const difference = typeof a === "number" && typeof b === "number" ? b - a : null;
            return (
              <tr key={channel.name}>
                <th scope="row">
                  <span class="swatch" style={`display:inline-block;background:var(--s${position + 1})`} /> {channel.name}
                  {channel.unit && <span class="quiet"> {channel.unit}</span>}
                </th>
                <td>{valueText(pointer.value?.values[position], channel.decimals)}</td>
                <td>{valueText(a, channel.decimals)}</td>
                <td>{valueText(b, channel.decimals)}</td>
                <td>{valueText(difference, channel.decimals)}</td>
              </tr>
            );
          })}
        </tbody>
      </table>
    </div>
  );
}
