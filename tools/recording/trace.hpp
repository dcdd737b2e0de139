// A recording as text for other tools. docs/guide/recording.md describes the forms.
#pragma once

#include <ostream>

#include "tools/recording/recording.hpp"

namespace ipos::tools {

// `time_ms`, then one column a signal with its unit in the header and one a bus; one row a millisecond.
void write_csv(std::ostream& out, const Recording& recording);

// Value change dump (IEEE 1364-2005 chapter 18): changes only, a scope for each station and bus.
void write_vcd(std::ostream& out, const Recording& recording);

// JSON lines: the signals, then one object for each change, frame and event in order of time.
void write_jsonl(std::ostream& out, const Recording& recording);

}  // namespace ipos::tools
