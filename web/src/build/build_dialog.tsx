// A new station, line, wire or control: a table in the plant file, and then the plant is built and begins at 0 s.
import { useState } from "preact/hooks";

import { request } from "../server/connection";
import { Dialog } from "../keep/dialog";
import { insertion, type Table } from "./form";
import { TableForm, useForm } from "./table_form";

interface BuildMessage {
  file: string;
  line: number;
  text: string;
}

function textOf(messages: BuildMessage[]): string {
  return messages.map((one) => `${one.file}:${one.line}: ${one.text}`).join("\n");
}

const tables: { table: Table; text: string }[] = [
  { table: "station", text: "station" },
  { table: "bus", text: "line" },
  { table: "wire", text: "wire" },
  { table: "control", text: "control" },
];

export function BuildDialog({ onClose }: { onClose: () => void }) {
  const [table, setTable] = useState<Table>("station");
  return (
    <Dialog name="New station" onClose={onClose}>
      <div class="row" role="radiogroup" aria-label="What is new">
        {tables.map((one) => (
          <label class="field" key={one.table}>
            <input type="radio" name="table" checked={one.table === table} onChange={() => setTable(one.table)} />
            <span>{one.text}</span>
          </label>
        ))}
      </div>
      <Insertion key={table} table={table} onDone={onClose} />
    </Dialog>
  );
}

function Insertion({ table, onDone }: { table: Table; onDone: () => void }) {
  const [form, filled, setFilled, unasked] = useForm(table);
  const [wrong, setWrong] = useState("");
  const insert = async () => {
    setWrong("");
    try {
      await request({ do: "form.insert", ...insertion(filled) });
      const built = await request({ do: "build" });
      if (!built.good) throw new Error(textOf(built.messages as BuildMessage[]));
      await request({ do: "restart" });
      onDone();
    } catch (reason) {
      setWrong(reason instanceof Error ? reason.message : String(reason));
    }
  };
  return (
    <>
      {form && <TableForm form={form} filled={filled} setFilled={setFilled} />}
      {(wrong || unasked) && <p role="alert">{wrong || unasked}</p>}
      <div class="row">
        <button class="primary" disabled={!form} onClick={() => void insert()}>
          Insert
        </button>
        <span class="quiet">It stands at the end of the plant file; the plant begins at 0 s.</span>
      </div>
    </>
  );
}
