// Manual operation of a real drive: it moves only while the button is held. The server stops it 300 ms after the
// last word from here.
import { useEffect, useRef, useState } from "preact/hooks";

import { request } from "../server/connection";
import { complain } from "../shell/notice";
import { armed } from "../shell/write_arm";

const repeat_ms = 100;

export function Jog() {
  const [rpm, setRpm] = useState("100");
  const timer = useRef<ReturnType<typeof setInterval> | undefined>(undefined);
  const release = () => {
    if (timer.current === undefined) return;
    clearInterval(timer.current);
    timer.current = undefined;
    request({ do: "jog", direction: "stop", rpm: 0 }).catch(complain);
  };
  const hold = (direction: "cw" | "ccw") => {
    release();
    const say = () =>
      request({ do: "jog", direction, rpm: Number(rpm) }).catch((reason: unknown) => {
        clearInterval(timer.current);
        timer.current = undefined;
        complain(reason);
      });
    timer.current = setInterval(say, repeat_ms);
    void say();
  };
  useEffect(() => {
    // A window that loses the focus cannot see the button go up.
    window.addEventListener("blur", release);
    return () => {
      window.removeEventListener("blur", release);
      release();
    };
  }, []);
  const button = (direction: "cw" | "ccw", text: string) => (
    <button
      disabled={!armed.value}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        hold(direction);
      }}
      onPointerUp={release}
      onPointerCancel={release}
      onKeyDown={(event) => {
        if (event.key === " " && !event.repeat) hold(direction);
      }}
      onKeyUp={release}
      onBlur={release}
    >
      {text}
    </button>
  );
  return (
    <section class="panel row" aria-label="Manual operation" style="margin-bottom:14px">
      <h2 class="caption">Manual operation</h2>
      {button("ccw", "⟲ Hold for CCW")}
      {button("cw", "⟳ Hold for CW")}
      <label class="field">
        Speed, rpm
        <input type="text" size={6} value={rpm} onInput={(event) => setRpm(event.currentTarget.value)} />
      </label>
      {!armed.value && <span class="quiet">Needs --write and “Allow writing” above.</span>}
    </section>
  );
}
