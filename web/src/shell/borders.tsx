// The borders between panes, to be moved by pointer and by arrow keys.
import { layout, paneId, setLayout, showLayout } from "./desk";
import { bordersOf, greatest_share, least_share, moveBorder, placed, type Border } from "./layout";

const step = 2; // percent

function drag(event: PointerEvent, border: Border): void {
  const line = event.currentTarget;
  const desk = line instanceof HTMLElement && line.parentElement;
  if (!desk || event.button !== 0) return;
  event.preventDefault();
  line.focus();
  line.setPointerCapture(event.pointerId);
  const box = desk.getBoundingClientRect();
  const { both, path, position } = border;
  const follow = (at: PointerEvent) => {
    const part =
      border.direction === "row"
        ? ((at.clientX - box.left) / box.width - both.x) / both.width
        : ((at.clientY - box.top) / box.height - both.y) / both.height;
    showLayout(moveBorder(layout.peek(), path, position, 100 * part));
  };
  const end = () => {
    line.removeEventListener("pointermove", follow);
    line.removeEventListener("lostpointercapture", end);
    setLayout(layout.peek());
  };
  line.addEventListener("pointermove", follow);
  line.addEventListener("lostpointercapture", end);
}

function moveByKey(event: KeyboardEvent, border: Border): void {
  const [less, more] = border.direction === "row" ? ["ArrowLeft", "ArrowRight"] : ["ArrowUp", "ArrowDown"];
  const to = { [less ?? ""]: border.share - step, [more ?? ""]: border.share + step, Home: least_share, End: greatest_share }[event.key];
  if (to === undefined || event.ctrlKey || event.altKey || event.metaKey) return;
  event.preventDefault();
  setLayout(moveBorder(layout.peek(), border.path, border.position, to));
}

export function Borders() {
  return (
    <>
      {bordersOf(layout.value).map((border) => (
        <div
          key={`${border.path.join(".")} ${border.position}`}
          role="separator"
          tabIndex={0}
          aria-label={`Between ${border.before} and ${border.behind}`}
          aria-orientation={border.direction === "row" ? "vertical" : "horizontal"}
          aria-controls={paneId(border.before)}
          aria-valuemin={least_share}
          aria-valuemax={greatest_share}
          aria-valuenow={border.share}
          style={placed(border.rect)}
          onPointerDown={(event) => drag(event, border)}
          onKeyDown={(event) => moveByKey(event, border)}
        />
      ))}
    </>
  );
}
