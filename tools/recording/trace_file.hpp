// A recording as a `.ipos-trace`: columns of numbers in packed blocks, a tenth of the size of a text. It is
// read again part by part, so that each text can be made of it. docs/reference/trace-file.md describes the bytes.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "tools/recording/recording.hpp"
#include "tools/recording/trace.hpp"
#include "tools/recording/trace_blocks.hpp"

namespace ipos::tools {

// Rows after which a block is closed, at the latest with the part in which they come; and the most of a block (ours).
inline constexpr size_t kBlockRows = 1000;
inline constexpr size_t kMostRows = size_t{1} << 20U;

std::unique_ptr<TraceWriter> packed_trace(std::ostream& out, const std::vector<Signal>& signals,
                                          const std::vector<FrameTrack>& tracks);

// What a CAN frame is in candump's words, which therefore are not written.
std::string usual_text(const RecordedFrame& frame);

class TraceReader {
 public:
  // The bytes must outlive it.
  explicit TraceReader(std::string_view bytes) : blocks_(bytes) {}

  // First: what was recorded.
  std::optional<TraceMistake> begin();
  // As text writers want them: names, units and how their numbers are shown.
  const std::vector<Signal>& signals() const { return signals_; }
  const std::vector<FrameTrack>& tracks() const { return tracks_; }
  // How they are drawn (channel_json.hpp), as the file says.
  const std::vector<nlohmann::json>& channels() const { return channels_; }

  // The next part. False: there is none.
  tl::expected<bool, TraceMistake> next(RecordedPart& part);
  // At the end: where the file ends within a block, or without its last one.
  std::optional<size_t> ends_early() const { return blocks_.ends_early(); }

 private:
  std::optional<std::string> read_head(std::string_view text);

  BlockReader blocks_;
  std::vector<Signal> signals_;
  std::vector<nlohmann::json> channels_;
  std::vector<FrameTrack> tracks_;
  runtime::Time last_row_ = -1;
};

}  // namespace ipos::tools
