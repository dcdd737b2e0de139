// Everything is looked at before it is believed: checksums say that a block is as it was written, not that ipos wrote it.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "tools/recording/trace_file.hpp"
#include "tools/recording/trace_numbers.hpp"

namespace ipos::tools {
namespace {

using nlohmann::json;
using runtime::Time;

constexpr int64_t kMostDecimals = 17, kMostBits = 64;

std::string string_of(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}
bool flag_of(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_boolean() && found->get<bool>();
}
std::optional<int64_t> number_of(const json& object, const char* key, int64_t most) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_integer()) return std::nullopt;
  const auto number = found->get<int64_t>();
  if (number < 0 || number > most) return std::nullopt;
  return number;
}

std::optional<Signal> signal_of(const json& row) {
  if (!row.is_object()) return std::nullopt;
  Signal signal;
  signal.name = string_of(row, "name");
  signal.unit = string_of(row, "unit");
  signal.station = string_of(row, "station");
  signal.is_status = flag_of(row, "status");
  const auto decimals = number_of(row, "decimals", kMostDecimals), bits = number_of(row, "bits", kMostBits);
  const auto factor = row.find("factor");
  if (signal.name.empty() || !decimals || !bits || factor == row.end() || !factor->is_number()) return std::nullopt;
  if (!signal.station.empty() && !signal.name.starts_with(signal.station + ".")) return std::nullopt;
  signal.decimals = static_cast<int>(*decimals);
  signal.bits = static_cast<size_t>(*bits);
  signal.factor = factor->get<double>();
  if (!std::isfinite(signal.factor)) return std::nullopt;
  return signal;
}

// The content of a block of rows. Each function is what is wrong, or nothing.
class RowsReader {
 public:
  using Wrong = std::optional<std::string>;

  RowsReader(std::string_view content, const std::vector<FrameTrack>& tracks, RecordedPart& part)
      : in_(content), tracks_(tracks), part_(part) {}

  Wrong read(size_t signals, Time& last_row) {
    part_.times.clear();
    part_.changes.clear();
    part_.events.clear();
    part_.frames.clear();
    if (auto wrong = read_times(last_row)) return wrong;
    for (size_t n = 0; n < signals; ++n)
      if (auto wrong = read_column(n)) return wrong;
    if (auto wrong = read_events()) return wrong;
    if (auto wrong = read_frames()) return wrong;
    if (!in_.good()) return "the block ends within a number or a text";
    if (!in_.at_end()) return "the block goes on behind its frames";
    return std::nullopt;
  }

 private:
  // Adds a span of time; false where that is beyond all times.
  static bool add(Time& time, uint64_t span) {
    if (span > static_cast<uint64_t>(std::numeric_limits<Time>::max() - time)) return false;
    time += static_cast<Time>(span);
    return true;
  }

  Wrong read_times(Time& last_row) {
    Time time = 0;
    for (uint64_t runs = in_.number(); runs > 0 && in_.good(); --runs) {
      const uint64_t gap = in_.number(), step = in_.number(), count = in_.number();
      if (count == 0 || count > kMostRows - part_.times.size()) return "the block has a number of rows that it cannot have";
      for (uint64_t n = 0; n < count; ++n) {
        if (!add(time, n == 0 ? gap : step) || time <= last_row) return "the times of the rows do not rise";
        part_.times.push_back(last_row = time);
      }
    }
    return std::nullopt;
  }

  Wrong read_column(size_t signal) {
    NumberReader runs(in_.text());
    if (!in_.good()) return std::nullopt;  // which read() tells
    uint64_t value = unfolded(runs.number());
    const uint64_t count = runs.number();
    NumberReader steps = runs;
    for (uint64_t n = 0; n < 2 * count && steps.good(); ++n) steps.number();
    uint64_t row = 0;
    for (uint64_t run = 0; run < count && runs.good() && steps.good(); ++run) {
      const uint64_t skipped = runs.number(), changes = runs.number(), rows = part_.times.size();
      if (skipped > rows - row || changes > rows - row - skipped || changes == 0)
        return fmt::format("column {} changes in rows that are not there", signal + 1);
      row += skipped;
      uint64_t step = 0;
      for (uint64_t n = 0; n < changes && steps.good(); ++n, ++row) {
        step += unfolded(steps.number());
        value += step;
        part_.changes.push_back({static_cast<size_t>(row), signal, static_cast<int64_t>(value)});
      }
    }
    if (!steps.good() || !steps.at_end()) return fmt::format("column {} has another length than it says", signal + 1);
    return std::nullopt;
  }

  Wrong read_events() {
    Time time = 0;
    for (uint64_t count = in_.number(); count > 0 && in_.good(); --count) {
      if (!add(time, in_.number())) return "an event is later than any time";
      const uint8_t fault = in_.byte();
      if (fault > 1) return "an event is neither a fault nor none";
      part_.events.push_back({time, std::string(in_.text()), fault != 0});
    }
    return std::nullopt;
  }

  Wrong read_frames() {
    Time time = 0;
    for (uint64_t count = in_.number(); count > 0 && in_.good(); --count) {
      if (!add(time, in_.number())) return "a frame is later than any time";
      const uint64_t track = in_.number();
      const uint8_t flags = in_.byte();
      const uint64_t id = in_.number();
      const std::string_view bytes = in_.text();
      if (track >= tracks_.size()) return "a frame is of a bus that is not there";
      if (flags > 7 || id > 0x1FFF'FFFF) return "a frame has an identifier or marks that no frame has";
      RecordedFrame frame{time, static_cast<size_t>(track), static_cast<uint32_t>(id), (flags & 1) != 0, (flags & 2) != 0, {bytes.begin(), bytes.end()}, {}};
      if ((flags & 4) != 0)
        frame.text = in_.text();
      else if (tracks_[frame.track].is_can)
        frame.text = usual_text(frame);
      part_.frames.push_back(std::move(frame));
    }
    return std::nullopt;
  }

  NumberReader in_;
  const std::vector<FrameTrack>& tracks_;
  RecordedPart& part_;
};

}  // namespace

std::optional<TraceMistake> TraceReader::begin() {
  if (auto mistake = blocks_.begin()) return mistake;
  const auto block = blocks_.next();
  if (!block) return block.error();
  if (!*block) return TraceMistake{*blocks_.ends_early(), "the file ends before it says what was recorded"};
  if ((*block)->kind != BlockKind::Head) return TraceMistake{(*block)->offset, "the first block is not the head"};
  if (const auto wrong = read_head((*block)->content)) return TraceMistake{(*block)->offset, *wrong};
  return std::nullopt;
}

std::optional<std::string> TraceReader::read_head(std::string_view text) {
  const json head = json::parse(text, nullptr, false);
  const auto rows_of = [&](const char* key) {
    const auto found = head.is_object() ? head.find(key) : head.end();
    return head.is_object() && found != head.end() && found->is_array() ? &*found : nullptr;
  };
  const json* signals = rows_of("signals");
  const json* tracks = rows_of("tracks");
  if (signals == nullptr || tracks == nullptr) return "the head is no JSON with signals and tracks";
  for (const json& row : *signals) {
    auto signal = signal_of(row);
    if (!signal) return fmt::format("signal {} of the head is not described as a signal is", signals_.size() + 1);
    signals_.push_back(std::move(*signal));
    channels_.push_back(row);
    for (const char* own : {"factor", "station"}) channels_.back().erase(own);  // what no picture asks for
  }
  for (const json& row : *tracks) {
    if (!row.is_object() || string_of(row, "bus").empty()) return fmt::format("track {} of the head has no bus", tracks_.size() + 1);
    tracks_.push_back({string_of(row, "bus"), flag_of(row, "can")});
  }
  return std::nullopt;
}

tl::expected<bool, TraceMistake> TraceReader::next(RecordedPart& part) {
  const auto block = blocks_.next();
  if (!block) return tl::unexpected(block.error());
  if (!*block) return false;
  const auto wrong = [&](std::string text) { return tl::unexpected(TraceMistake{(*block)->offset, std::move(text)}); };
  if ((*block)->kind == BlockKind::Head) return wrong("there is a second head");
  if ((*block)->kind == BlockKind::End) {
    if (!(*block)->content.empty()) return wrong("the last block has a content");
    const auto behind = blocks_.next();
    if (!behind) return tl::unexpected(behind.error());
    return false;
  }
  if (auto mistake = RowsReader((*block)->content, tracks_, part).read(signals_.size(), last_row_)) return wrong(std::move(*mistake));
  return true;
}

}  // namespace ipos::tools
