// The head of the page: whose plant it is, its time, and the buttons that let time pass.
import { FilesBar } from "../alone/files_bar";
import { standsAlone } from "../alone/packed";
import { request } from "../server/connection";
import { hello, secondsText, time } from "../server/live";
import { helpOpen } from "./help";
import { offerKeys } from "./keys";
import { command, complain } from "./notice";
import { WriteArm } from "./write_arm";

const speeds = [0.001, 0.01, 0.1, 0.5, 1, 2, 10, 100, 0];

const run = () => void command({ do: "run" });
const pause = () => void command({ do: "pause" });
const step = () => void command({ do: "step", ms: 1 });
const telegram = () => void command({ do: "step", telegram: true });
const back = (ms: number) => void command({ do: "back", ms });
const restart = () => void command({ do: "restart" });

// What the keys have asked for last: the next one may come before the server has said it.
let asked: number | null = null;
time.subscribe(({ speed }) => {
  if (speed === asked) asked = null;
});

function changeSpeed(by: number): void {
  const position = speeds.indexOf(asked ?? time.peek().speed);
  const to = speeds[Math.max(0, Math.min(speeds.length - 1, (position < 0 ? speeds.indexOf(1) : position) + by))];
  if (to === undefined || to === (asked ?? time.peek().speed)) return;
  asked = to;
  void command({ do: "speed", speed: to }).then((reply) => {
    if (!reply) asked = null;
  });
}

export function offerTimeKeys(): void {
  offerKeys("Time", [
    { key: "r", text: "Run", act: run },
    { key: "p", text: "Pause", act: pause },
    { key: " ", text: "Run or pause", act: () => (time.peek().running ? pause() : run()) },
    { key: "s", text: "Step a millisecond", act: step },
    { key: "t", text: "On to the next telegram", act: telegram },
    { key: ",", text: "Back a millisecond", act: () => back(1) },
    { key: "<", text: "Back a second", act: () => back(1000) },
    { key: "-", text: "Slower", act: () => changeSpeed(-1) },
    { key: "+", text: "Faster", act: () => changeSpeed(1) },
    { key: "0", text: "Begin anew at 0 s", act: restart },
  ]);
}

function speedText(speed: number): string {
  return speed === 0 ? "as fast as it goes" : `× ${speed}`;
}

function Clock() {
  const now = time.value;
  const stopped = now.stopped;
  const where = stopped?.file ? ` ${stopped.file.slice(stopped.file.lastIndexOf("/") + 1)}:${stopped.line}` : "";
  const cost = stopped?.cost;
  const told = cost ? `${cost.us / 1000} ms and ${cost.commands} commands since the plant stood before` : undefined;
  const count = cost ? ` · ${cost.commands} cmd` : "";
  return (
    <div class="clock">
      <span class={`lamp${now.running ? " on" : ""}`} />
      <span class="pace" title={told}>
        {now.running ? `× ${now.rate.toFixed(2)}` : stopped ? `${stopped.reason}${where}${count}` : now.over ? "ended" : "paused"}
      </span>
      <span role="timer" aria-label="Time">
        {secondsText(now.us)}
      </span>
    </div>
  );
}

function TimeControls() {
  const { speed } = time.value;
  // The time of a real drive is nobody's to stop, nor that of a plant with real ports.
  const live = hello.value?.live ?? false;
  const drive = live || hello.value?.mode === "device";
  const listed = speeds.includes(speed) ? speeds : [speed, ...speeds];
  return (
    <div class="row controls">
      <span class="group">
        <button disabled={drive} class={time.value.running || drive ? "" : "primary"} onClick={run}>
          Run
        </button>
        <button disabled={drive} class={time.value.running && !drive ? "primary" : ""} onClick={pause}>
          Pause
        </button>
        <button disabled={drive} title="A millisecond" onClick={step}>
          Step
        </button>
        <button disabled={drive} title="On to the end of the next telegram" onClick={telegram}>
          Telegram
        </button>
      </span>
      <span class="group">
        <button disabled={drive} aria-label="−1 s, back a second" title="Back 1 second" onClick={() => back(1000)}>
          −1 s
        </button>
        <button disabled={drive} aria-label="−1 ms, back a millisecond" title="Back 1 millisecond" onClick={() => back(1)}>
          −1 ms
        </button>
        <button disabled={drive} aria-label="0 s, begin anew" title="Back to 0 s, everything as at power-on" onClick={restart}>
          0 s
        </button>
      </span>
      <select
        aria-label="Speed"
        disabled={drive}
        value={String(speed)}
        onChange={(event) => {
          request({ do: "speed", speed: Number(event.currentTarget.value) }).catch(complain);
        }}
      >
        {listed.map((value) => (
          <option key={value} value={String(value)}>
            {speedText(value)}
          </option>
        ))}
      </select>
      <WriteArm />
      {live && <span class="quiet">real ports: in step with the clock</span>}
      {standsAlone && <FilesBar />}
      <button class="keys" aria-label="Keys" title="Keys (?)" onClick={() => (helpOpen.value = true)}>
        ?
      </button>
    </div>
  );
}

export function TimeBar() {
  return (
    <div class="time-bar">
      <h1>
        <span>ipos</span> {hello.value?.title ?? ""}
      </h1>
      <TimeControls />
      <Clock />
    </div>
  );
}
