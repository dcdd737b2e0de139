// The table.
#include "tools/recording/trace_forms.hpp"

#include "tools/recording/trace_file.hpp"

namespace ipos::tools {
namespace {

struct Row {
  std::string_view ending;
  TraceForm form;
};
constexpr Row kTraceForms[] = {{".csv", csv_trace}, {".vcd", vcd_trace}, {".jsonl", jsonl_trace}, {".ipos-trace", packed_trace}};

}  // namespace

TraceForm trace_form(std::string_view ending) {
  for (const Row& row : kTraceForms)
    if (row.ending == ending) return row.form;
  return csv_trace;
}

}  // namespace ipos::tools
