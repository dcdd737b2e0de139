// What was done on the page as a test: its text to look at and change, its file, and the run of all tests of the plant.
import { useEffect, useState } from "preact/hooks";

import { request } from "../server/connection";
import { hello } from "../server/live";
import { pinned } from "../watch/watch_list";
import { Dialog, FileRow } from "./dialog";
import { TestReport, type Report } from "./test_report";

function textOf(reason: unknown): string {
  return reason instanceof Error ? reason.message : String(reason);
}

export function TestDialog({ onClose }: { onClose: () => void }) {
  const [text, setText] = useState("");
  const [leftOut, setLeftOut] = useState<string[]>([]);
  const [file, setFile] = useState(`${(hello.peek()?.title ?? "plant").replace(/\.[^.]*$/, "")}-kept.test.toml`);
  const [said, setSaid] = useState("");
  const [wrong, setWrong] = useState("");
  const [report, setReport] = useState<Report | null>(null);
  useEffect(() => {
    request({ do: "keep.test", pinned: pinned.peek().map((one) => one.name) })
      .then((reply) => {
        setText(reply.text as string);
        setLeftOut(reply.left_out as string[]);
      })
      .catch((reason) => setWrong(textOf(reason)));
  }, []);
  const carryOut = async (what: string, work: () => Promise<string>) => {
    setWrong("");
    setSaid(what);
    try {
      setSaid(await work());
    } catch (reason) {
      setSaid("");
      setWrong(textOf(reason));
    }
  };
  const save = () =>
    carryOut("", async () => `Saved as ${(await request({ do: "file.write", name: file, text })).name as string}`);
  const run = () =>
    carryOut("The tests run.", async () => {
      setReport((await request({ do: "tests.run" })).report as Report);
      return "";
    });
  return (
    <Dialog name="Keep as test" onClose={onClose}>
      <textarea
        class="mono"
        aria-label="Test"
        rows={14}
        spellcheck={false}
        value={text}
        onInput={(event) => setText(event.currentTarget.value)}
      />
      {leftOut.length > 0 && (
        <div class="left-out">
          <p>Not in the test:</p>
          <ul>
            {leftOut.map((reason) => (
              <li key={reason}>{reason}</li>
            ))}
          </ul>
        </div>
      )}
      <FileRow file={file} setFile={setFile} save={text === "" ? undefined : () => void save()}>
        <button type="button" title="All tests of this plant, beside it" onClick={() => void run()}>
          Run tests
        </button>
      </FileRow>
      {wrong && <p role="alert">{wrong}</p>}
      <p role="status">{said}</p>
      {report && <TestReport report={report} onOpen={onClose} />}
    </Dialog>
  );
}
