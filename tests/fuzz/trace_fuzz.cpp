// Any bytes as a `.ipos-trace`, or as the content of its blocks of rows behind a good head: a mistake has its place and a text,
// and what is read is written as texts, and as a trace that is read as the same.
#include <sstream>

#include "tests/fuzz/fuzz.hpp"
#include "tools/recording/trace_file.hpp"

using namespace ipos;         // NOLINT
using namespace ipos::tools;  // NOLINT
using namespace ipos::tests;  // NOLINT

namespace {

// Rows cost a byte where they are equally far from each other: more than these take their time, and show nothing new.
constexpr size_t kMostRowsAtOnce = 20'000;

struct Read {
  std::vector<RecordedPart> parts;
  bool whole = false;  // without a mistake
  bool too_long = false;
};

Read read(TraceReader& reader, size_t size) {
  Read all;
  size_t rows = 0;
  const auto good = [&](const TraceMistake& mistake) {
    require(mistake.offset <= size && !mistake.text.empty(), "a mistake has its place and a text");
  };
  if (const auto mistake = reader.begin()) {
    good(*mistake);
    return all;
  }
  for (;;) {
    RecordedPart part;
    const auto more = reader.next(part);
    if (!more) {
      good(more.error());
      return all;
    }
    if (!*more) break;
    for (const Change& change : part.changes)
      require(change.row < part.times.size() && change.signal < reader.signals().size(), "a change is of a row and a signal");
    for (const RecordedFrame& frame : part.frames) require(frame.track < reader.tracks().size(), "a frame is of a track");
    rows += part.times.size();
    if (rows > kMostRowsAtOnce) {
      all.too_long = true;
      return all;
    }
    all.parts.push_back(std::move(part));
  }
  if (const auto offset = reader.ends_early()) require(*offset <= size, "the early end has its place");
  all.whole = true;
  return all;
}

std::string written(TraceForm form, const TraceReader& reader, const Read& all) {
  std::ostringstream out;
  const auto writer = form(out, reader.signals(), reader.tracks());
  for (const RecordedPart& part : all.parts) {
    writer->take(part);
    writer->flush();
  }
  writer->finish();
  return out.str();
}

void look(std::string_view bytes) {
  TraceReader reader(bytes);
  const Read all = read(reader, bytes.size());
  if (!all.whole) return;
  for (const TraceForm form : {csv_trace, jsonl_trace}) {
    const std::string text = written(form, reader, all);
    const std::string packed = written(packed_trace, reader, all);
    TraceReader again(packed);
    const Read same = read(again, packed.size());
    require(same.whole && !again.ends_early(), "what is written is a trace without mistakes");
    require(written(form, again, same) == text, "a trace that was read is written as the same");
  }
}

// Two signals, a CAN bus and a line.
std::string with_head(std::string_view content) {
  std::ostringstream out;
  BlockWriter blocks(out);
  blocks.write(BlockKind::Head,
               R"({"program":"","signals":[{"name":"u.speed","unit":"rpm","decimals":3,"bits":0,"factor":0.001,"station":"u"},)"
               R"({"name":"u.DI00","unit":"","decimals":0,"bits":1,"factor":1,"station":"u"}],)"
               R"("tracks":[{"bus":"sbus","can":true},{"bus":"line","can":false}]})");
  blocks.write(BlockKind::Rows, content);
  blocks.write(BlockKind::End, {});
  return out.str();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view bytes = text_of(data, size);
  look(bytes);
  look(with_head(bytes));
  return 0;
}
