// A recording as a file for other tools, written as it comes. docs/guide/recording.md describes the forms.
#pragma once

#include <memory>
#include <ostream>
#include <vector>

#include "tools/recording/recording.hpp"

namespace ipos::tools {

// What it was made with must outlive it.
class TraceWriter : public PartReader {
 public:
  virtual void flush() {}   // what was taken is to be in the stream
  virtual void finish() {}  // after the last part
};

using TraceForm = std::unique_ptr<TraceWriter> (*)(std::ostream& out, const std::vector<Signal>& signals,
                                                   const std::vector<FrameTrack>& tracks);

// `time_ms`, then one column a signal with its unit in the header and one a bus; one row a millisecond.
std::unique_ptr<TraceWriter> csv_trace(std::ostream& out, const std::vector<Signal>& signals,
                                       const std::vector<FrameTrack>& tracks);

// Value change dump (IEEE 1364-2005 chapter 18): changes only, a scope for each station and bus. Its head tells what
// only the end of the run shows (widths), so it stands in a temporary file until then.
std::unique_ptr<TraceWriter> vcd_trace(std::ostream& out, const std::vector<Signal>& signals,
                                       const std::vector<FrameTrack>& tracks);

// JSON lines: the signals, then one object for each change, frame and event in order of time.
std::unique_ptr<TraceWriter> jsonl_trace(std::ostream& out, const std::vector<Signal>& signals,
                                         const std::vector<FrameTrack>& tracks);

// A whole recording in the form.
void write_trace(TraceForm form, std::ostream& out, const Recording& recording);
inline void write_csv(std::ostream& out, const Recording& recording) {
  write_trace(csv_trace, out, recording);
}
inline void write_vcd(std::ostream& out, const Recording& recording) {
  write_trace(vcd_trace, out, recording);
}
inline void write_jsonl(std::ostream& out, const Recording& recording) {
  write_trace(jsonl_trace, out, recording);
}

}  // namespace ipos::tools
