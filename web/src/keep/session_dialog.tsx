// The session as a file beside the plant; `ipos serve FILE` opens it at the same moment.
import { useState } from "preact/hooks";

import { standsAlone } from "../alone/packed";
import { request } from "../server/connection";
import { hello } from "../server/live";
import { Dialog, FileRow } from "./dialog";

export function SessionDialog({ onClose }: { onClose: () => void }) {
  const [file, setFile] = useState(`${(hello.peek()?.title ?? "plant").replace(/\.[^.]*$/, "")}.ipos`);
  const [said, setSaid] = useState("");
  const [wrong, setWrong] = useState("");
  const save = async () => {
    setWrong("");
    try {
      const settings = (await request({ do: "settings" })).settings;
      const session = await request({ do: "session", settings });
      const saved = await request({ do: "file.write", name: file, text: session.text });
      setSaid(standsAlone ? "Saved. Open it by the button Files." : `Saved. Open it by: ipos serve ${saved.name as string}`);
    } catch (reason) {
      setWrong(reason instanceof Error ? reason.message : String(reason));
    }
  };
  return (
    <Dialog name="Save session" onClose={onClose}>
      <p>The plant and its programs, what was done, this moment and this layout.</p>
      <FileRow file={file} setFile={setFile} save={() => void save()} />
      {wrong && <p role="alert">{wrong}</p>}
      <p role="status">{said}</p>
    </Dialog>
  );
}
