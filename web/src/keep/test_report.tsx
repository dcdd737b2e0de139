// The report of tests: a row a test, and under a failed one what was wrong, with a way to its line.
import { PlaceLink } from "../program/open_line";

export interface Finding {
  file: string;
  line: number;
  message: string;
  note: string;
  values: string[];
}

export interface Result {
  name: string;
  file: string;
  outcome: "passed" | "failed" | "error" | "not_run";
  checks: number;
  time_us: number;
  messages: string;
  findings: Finding[];
}

export interface Report {
  tests: number;
  passed: number;
  results: Result[];
}

function Wrong({ result, onOpen }: { result: Result; onOpen: () => void }) {
  return (
    <>
      {result.messages && <pre>{result.messages}</pre>}
      <ul>
        {result.findings.map((finding) => (
          <li key={`${finding.line} ${finding.message}`}>
            <PlaceLink place={finding} text={`${finding.file}:${finding.line}`} onOpen={onOpen} />{" "}
            {finding.message}
            {finding.note && ` (${finding.note})`}
            {finding.values.map((value) => (
              <div class="quiet" key={value}>
                {value}
              </div>
            ))}
          </li>
        ))}
      </ul>
    </>
  );
}

export function TestReport({ report, onOpen }: { report: Report; onOpen: () => void }) {
  return (
    <div class="scroll" tabIndex={0}>
      <p>
        {report.passed} of {report.tests} passed
      </p>
      <table class="values" aria-label="Tests">
        <thead>
          <tr>
            <th scope="col">Test</th>
            <th scope="col">Result</th>
            <th scope="col">What was wrong</th>
          </tr>
        </thead>
        <tbody>
          {report.results.map((result) => (
            <tr key={result.name}>
              <th scope="row" class="mono">
                {result.name}
              </th>
              <td class={result.outcome === "passed" ? "good" : "bad"}>{result.outcome.replace("_", " ")}</td>
              <td>{result.outcome === "passed" ? `${result.checks} checks, ${(result.time_us / 1e6).toFixed(3)} s` : <Wrong result={result} onOpen={onOpen} />}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}
