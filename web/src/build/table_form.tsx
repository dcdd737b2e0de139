// The fields of a new table: those every one needs, lines with addresses that are free, and any other key that the readers
// know, as TOML.
import type { Dispatch, StateUpdater } from "preact/hooks";
import { useEffect, useState } from "preact/hooks";

import { request } from "../server/connection";
import { empty, type Filled, type Form, type Line, type Table } from "./form";

const template_of_none = "";

function Choice({ name, value, words, onChange }: { name: string; value: string; words: string[]; onChange: (word: string) => void }) {
  return (
    <label class="field">
      <span>{name}</span>
      <select aria-label={name} value={value} onChange={(event) => onChange(event.currentTarget.value)}>
        {words.map((word) => (
          <option key={word} value={word}>
            {word || "none"}
          </option>
        ))}
      </select>
    </label>
  );
}

function Text({ name, value, onInput }: { name: string; value: string; onInput: (text: string) => void }) {
  return (
    <label class="field">
      <span>{name}</span>
      <input type="text" aria-label={name} value={value} onInput={(event) => onInput(event.currentTarget.value)} />
    </label>
  );
}

interface Part {
  form: Form;
  filled: Filled;
  setFilled: Dispatch<StateUpdater<Filled>>;
}

// Joining a line sets what makes the station heard there.
function Lines({ form, filled, setFilled }: Part) {
  const toggle = (line: Line, on: boolean) => {
    setFilled((before) => {
      const { [line.key]: _gone, ...values } = before.values;
      const parameters = { ...before.parameters };
      for (const setting of line.parameters) delete parameters[setting.number];
      for (const key of Object.keys(line.values)) delete values[key];
      if (!on) return { ...before, values, parameters };
      for (const setting of line.parameters) parameters[setting.number] = setting.value;
      return { ...before, values: { ...values, ...line.values, [line.key]: line.bus }, parameters };
    });
  };
  return (
    <>
      {form.lines?.map((line) => {
        const on = filled.values[line.key] === line.bus;
        return (
          <fieldset key={`${line.key} ${line.bus}`}>
            <label class="field">
              <input type="checkbox" checked={on} onChange={(event) => toggle(line, event.currentTarget.checked)} />
              <span>
                {line.bus} ({line.key})
              </span>
            </label>
            {on &&
              line.parameters.map((setting) => (
                <Text
                  key={setting.number}
                  name={`${setting.number} ${setting.name}`}
                  value={filled.parameters[setting.number] ?? ""}
                  onInput={(text) => setFilled((now) => ({ ...now, parameters: { ...now.parameters, [setting.number]: text } }))}
                />
              ))}
            {on &&
              Object.keys(line.values).map((key) => (
                <Text
                  key={key}
                  name={key}
                  value={String(filled.values[key] ?? "")}
                  onInput={(text) => setFilled((now) => ({ ...now, values: { ...now.values, [key]: Number(text) } }))}
                />
              ))}
          </fieldset>
        );
      })}
    </>
  );
}

function Program({ form, filled, setFilled }: Part) {
  if (!form.runs_programs) return null;
  const news = (form.templates ?? []).map((name) => `new, from ${name}`);
  const chosen = filled.program ? `new, from ${filled.template}` : String(filled.values.program ?? template_of_none);
  const choose = (word: string) => {
    const { program: _gone, ...values } = filled.values;
    if (news.includes(word)) {
      const template = (form.templates ?? [])[news.indexOf(word)] ?? "";
      const program = `${String(filled.values.name ?? "NEW").toUpperCase()}.IPC`;
      setFilled({ ...filled, template, program, values: { ...values, program } });
    } else setFilled({ ...filled, template: "", program: "", values: word ? { ...values, program: word } : values });
  };
  return (
    <>
      <Choice name="Program" value={chosen} words={["", ...(form.programs ?? []), ...news]} onChange={choose} />
      {filled.program && (
        <Text
          name="Program file"
          value={filled.program}
          onInput={(program) => setFilled({ ...filled, program, values: { ...filled.values, program } })}
        />
      )}
    </>
  );
}

// A key, and what stands behind its equals sign.
function Further({ form, filled, setFilled }: Part) {
  const [key, setKey] = useState("");
  const known = form.keys.map((row) => row.key).filter((one) => !(one in filled.values) && one !== "parameters");
  const words = form.keys.find((row) => row.key === key)?.words ?? [];
  return (
    <>
      {Object.entries(filled.written).map(([name, text]) => (
        <Text key={name} name={name} value={text} onInput={(value) => setFilled({ ...filled, written: { ...filled.written, [name]: value } })} />
      ))}
      <div class="row">
        <Choice name="Further key" value={key} words={["", ...known]} onChange={setKey} />
        <button
          disabled={key === ""}
          onClick={() => {
            setFilled({ ...filled, written: { ...filled.written, [key]: words[0] ? JSON.stringify(words[0]) : "" } });
            setKey("");
          }}
        >
          Add key
        </button>
        {words.length > 0 && <span class="quiet">{words.join(", ")}</span>}
      </div>
    </>
  );
}

const first_of: Record<Table, Record<string, unknown>> = {
  station: { name: "", unit: "mdxb" },
  bus: { name: "", kind: "can", baud: 500000 },
  wire: { from: "", to: "" },
  control: { name: "" },
};

export function useForm(table: Table): [Form | null, Filled, Dispatch<StateUpdater<Filled>>, string] {
  const [form, setForm] = useState<Form | null>(null);
  const [filled, setFilled] = useState<Filled>(empty(table));
  const [wrong, setWrong] = useState("");
  const unit = table === "station" ? String(filled.values.unit ?? "mdxb") : "";
  useEffect(() => {
    let here = true;
    request({ do: "form", table, ...(unit ? { unit } : {}) })
      .then((reply) => {
        if (!here) return;
        const next = reply as unknown as Form;
        setForm(next);
        setFilled((before) => {
          const fresh = before.table !== table || Object.keys(before.values).length === 0;
          if (!fresh) return { ...empty(table), values: { name: before.values.name, unit: before.values.unit } };
          const values = { ...first_of[table] };
          if ("name" in values) values.name = next.name;
          if ("from" in values) Object.assign(values, { from: next.from?.[0] ?? "", to: next.to?.[0] ?? "" });
          return { ...empty(table), values };
        });
      })
      .catch((reason: unknown) => setWrong(reason instanceof Error ? reason.message : String(reason)));
    return () => {
      here = false;
    };
  }, [table, unit]);
  return [form, filled, setFilled, wrong];
}

export function TableForm({ form, filled, setFilled }: Part) {
  const set = (key: string, value: unknown) => setFilled({ ...filled, values: { ...filled.values, [key]: value } });
  const words = (key: string) => form.keys.find((row) => row.key === key)?.words ?? [];
  return (
    <div class="form">
      {"name" in filled.values && <Text name="Name" value={String(filled.values.name)} onInput={(name) => set("name", name)} />}
      {filled.table === "station" && (
        <>
          <Choice name="Unit" value={String(filled.values.unit)} words={form.units ?? []} onChange={(unit) => set("unit", unit)} />
          <Program form={form} filled={filled} setFilled={setFilled} />
          <Lines form={form} filled={filled} setFilled={setFilled} />
        </>
      )}
      {filled.table === "bus" && (
        <>
          <Choice name="Kind" value={String(filled.values.kind)} words={words("kind")} onChange={(kind) => set("kind", kind)} />
          <Text name="Baud" value={String(filled.values.baud ?? "")} onInput={(text) => set("baud", Number(text))} />
        </>
      )}
      {filled.table === "wire" && (
        <>
          <Choice name="From" value={String(filled.values.from)} words={form.from ?? []} onChange={(word) => set("from", word)} />
          <Choice name="To" value={String(filled.values.to)} words={form.to ?? []} onChange={(word) => set("to", word)} />
        </>
      )}
      <Further form={form} filled={filled} setFilled={setFilled} />
    </div>
  );
}
