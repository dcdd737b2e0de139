// The page without a plant: the examples with their stories, the plants of the folder, and a new plant.
import { useEffect, useState } from "preact/hooks";

import { standsAlone } from "../alone/packed";
import { home, open as openAlone } from "../alone/start";
import { insertion } from "../build/form";
import { TableForm, useForm } from "../build/table_form";
import { Dialog } from "../keep/dialog";
import { request, type Message } from "../server/connection";
import { hello } from "../server/live";

interface Example {
  name: string;
  story: string;
  kind: string;
}

interface Shown {
  examples: Example[];
  here: string[];
}

// The server goes on with that plant, and the page begins anew; a page that stands alone opens it itself.
async function openAs(command: Message): Promise<void> {
  const { opened } = await request(command);
  history.replaceState(null, "", "#Desk");
  if (standsAlone) return openAlone(`${home}/${(opened as string).replace(/^\.\//, "")}`);
  location.reload();
}

function textOf(reason: unknown): string {
  return reason instanceof Error ? reason.message : String(reason);
}

function CopyDialog({ example, onClose }: { example: Example; onClose: () => void }) {
  const [folder, setFolder] = useState(`./${example.name}`);
  const [wrong, setWrong] = useState("");
  const open = () => openAs({ do: "gallery.open", name: example.name, folder }).catch((reason) => setWrong(textOf(reason)));
  return (
    <Dialog name={`Open ${example.name}`} onClose={onClose}>
      <p>{example.story}</p>
      <form
        class="row"
        onSubmit={(event) => {
          event.preventDefault();
          void open();
        }}
      >
        <label class="field">
          <span>Copy into</span>
          <input type="text" aria-label="Folder" value={folder} onInput={(event) => setFolder(event.currentTarget.value)} />
        </label>
        <button class="primary" type="submit">
          Open
        </button>
      </form>
      {wrong && <p role="alert">{wrong}</p>}
    </Dialog>
  );
}

function NewPlantDialog({ onClose }: { onClose: () => void }) {
  const [form, filled, setFilled, unasked] = useForm("station");
  const [file, setFile] = useState("plant.toml");
  const [wrong, setWrong] = useState("");
  const make = () => openAs({ do: "gallery.new", file, ...insertion(filled) }).catch((reason) => setWrong(textOf(reason)));
  return (
    <Dialog name="New plant" onClose={onClose}>
      <p>A plant with an SBus and its first station{standsAlone ? "" : ", in this folder"}.</p>
      <label class="field">
        <span>Plant file</span>
        <input type="text" aria-label="Plant file" value={file} onInput={(event) => setFile(event.currentTarget.value)} />
      </label>
      {form && <TableForm form={form} filled={filled} setFilled={setFilled} />}
      {(wrong || unasked) && <p role="alert">{wrong || unasked}</p>}
      <button class="primary" disabled={!form} onClick={() => void make()}>
        Make plant
      </button>
    </Dialog>
  );
}

export function Gallery() {
  const [shown, setShown] = useState<Shown | null>(null);
  const [chosen, setChosen] = useState<Example | null>(null);
  const [making, setMaking] = useState(false);
  const [wrong, setWrong] = useState("");
  useEffect(() => {
    request({ do: "gallery" })
      .then((reply) => setShown(reply as unknown as Shown))
      .catch((reason) => setWrong(textOf(reason)));
  }, []);
  return (
    <main>
      <section class="gallery" aria-label="Gallery">
      <div class="row">
        <h1>
          <span>ipos</span> Gallery
        </h1>
        <button class="spread" disabled={!hello.value?.writable} onClick={() => setMaking(true)}>
          New plant
        </button>
      </div>
      {!hello.value?.writable && <p>Nothing is written from here: start ipos serve with --write.</p>}
      {wrong && <p role="alert">{wrong}</p>}
      {shown && shown.here.length > 0 && (
        <section>
          <h2>{standsAlone ? "In this browser" : "In this folder"}</h2>
          <ul class="here">
            {shown.here.map((path) => (
              <li key={path}>
                <a
                  href={`#${path}`}
                  onClick={(event) => {
                    event.preventDefault();
                    openAs({ do: "gallery.open", here: path }).catch((reason) => setWrong(textOf(reason)));
                  }}
                >
                  {path}
                </a>
              </li>
            ))}
          </ul>
        </section>
      )}
      <h2>Examples</h2>
      <ul class="cards">
        {shown?.examples.map((example) => (
          <li key={example.name}>
            <a
              href={`#${example.name}`}
              onClick={(event) => {
                event.preventDefault();
                setChosen(example);
              }}
            >
              {example.name}
            </a>
            <span class="quiet">{example.kind}</span>
            <p>{example.story}</p>
          </li>
        ))}
      </ul>
      {chosen && <CopyDialog example={chosen} onClose={() => setChosen(null)} />}
      {making && <NewPlantDialog onClose={() => setMaking(false)} />}
      </section>
    </main>
  );
}
