// Columns grow part by part as small numbers: what moves evenly has equal steps, so the changes of its steps are near 0. A
// block is closed after some rows, and whenever the file is brought up to date.
#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tools/cli/failure.hpp"
#include "tools/recording/channel_json.hpp"
#include "tools/recording/trace_file.hpp"
#include "tools/recording/trace_numbers.hpp"

namespace ipos::tools {
namespace {

using nlohmann::json;
using runtime::Time;

// Of columns, before they are packed: a block is closed beyond it (ours).
constexpr size_t kFullBlock = size_t{1} << 18U;

std::string head_text(const std::vector<Signal>& signals, const std::vector<FrameTrack>& tracks) {
  json head{{"program", "ipos " IPOS_VERSION}, {"signals", json::array()}, {"tracks", json::array()}};
  for (const Signal& signal : signals) {
    json row = channel_json(signal);
    row["factor"] = signal.factor;
    row["station"] = signal.station;
    row["status"] = signal.is_status;
    head["signals"].push_back(std::move(row));
  }
  for (const FrameTrack& track : tracks) head["tracks"].push_back({{"bus", track.bus}, {"can", track.is_can}});
  return head.dump(-1, ' ', false, json::error_handler_t::replace);
}

// Runs of rows that are equally far from each other.
class RowTimes {
 public:
  void add(Time time) {
    if (count_ == 1) step_ = time - last_;
    if (count_ != 0 && time - last_ == step_) {
      ++count_;
    } else {
      close();
      gap_ = time - last_;
      step_ = 0;
      count_ = 1;
    }
    last_ = time;
  }
  // Those of the block, which ends here.
  void write(std::string& out) {
    close();
    add_number(out, runs_);
    out += text_;
    *this = {};
  }

 private:
  void close() {
    if (count_ == 0) return;
    for (const Time number : {gap_, step_, count_}) add_number(text_, static_cast<uint64_t>(number));
    ++runs_;
    count_ = 0;
  }
  std::string text_;
  uint64_t runs_ = 0;
  Time last_ = 0, gap_ = 0, step_ = 0, count_ = 0;
};

// The changes of a signal: runs of rows in each of which it changes, and how much its step differs from the one before.
class Column {
 public:
  size_t size() const { return runs_.size() + steps_.size(); }

  // The changes of it that stand here; their rows count from the row `first` of the block. Where the next column's begin. `scratch`
  // has room for all.
  const Change* add(const Change* change, const Change* end, size_t signal, size_t first, char* scratch) {
    char* at = scratch;
    for (; change != end && change->signal == signal; ++change) {
      const size_t row = first + change->row;
      if (row != next_row_) {
        close();
        skipped_ = row - next_row_;
        step_ = 0;
      }
      ++count_;
      next_row_ = row + 1;
      const uint64_t step = static_cast<uint64_t>(change->sample) - value_;
      at = put_number(at, folded(step - step_));
      step_ = step;
      value_ = static_cast<uint64_t>(change->sample);
    }
    steps_.append(scratch, at);
    return change;
  }

  void write(std::string& out, std::string& scratch) {
    close();
    scratch.clear();
    add_number(scratch, folded(base_));
    add_number(scratch, run_count_);
    scratch += runs_;
    scratch += steps_;
    add_number(out, scratch.size());
    out += scratch;
    runs_.clear();
    steps_.clear();
    base_ = value_;
    next_row_ = skipped_ = run_count_ = 0;
    step_ = 0;
  }

 private:
  void close() {
    if (count_ == 0) return;
    add_number(runs_, skipped_);
    add_number(runs_, count_);
    ++run_count_;
    count_ = skipped_ = 0;
  }

  std::string runs_, steps_;
  uint64_t base_ = 0, value_ = 0, step_ = 0;
  size_t next_row_ = 0, skipped_ = 0, count_ = 0, run_count_ = 0;
};

// Entries with a time, each counted from the one before.
class Entries {
 public:
  size_t size() const { return text_.size(); }
  std::string& begin(Time time) {
    ++count_;
    add_number(text_, static_cast<uint64_t>(time - last_));
    last_ = time;
    return text_;
  }
  void write(std::string& out) {
    add_number(out, count_);
    out += text_;
    text_.clear();
    count_ = 0;
    last_ = 0;
  }

 private:
  std::string text_;
  uint64_t count_ = 0;
  Time last_ = 0;
};

void add_text(std::string& out, std::string_view text) {
  add_number(out, text.size());
  out += text;
}

class PackedTrace final : public TraceWriter {
 public:
  PackedTrace(std::ostream& out, const std::vector<Signal>& signals, const std::vector<FrameTrack>& tracks)
      : blocks_(out), tracks_(tracks), columns_(signals.size()) {
    blocks_.write(BlockKind::Head, head_text(signals, tracks));
  }

  void take(const RecordedPart& part) override {
    if (part.times.size() > kMostRows) throw Failure(kInternal, "a part of a trace has more rows than a block may have");
    if (rows_ + part.times.size() > kMostRows) flush();
    const Change* change = part.changes.data();
    const Change* const end = change + part.changes.size();
    size_t bytes = events_.size() + frames_.size();
    if (scratch_.size() < part.changes.size() * kMostNumberBytes) scratch_.resize(part.changes.size() * kMostNumberBytes);
    for (size_t n = 0; n < columns_.size(); ++n) {
      change = columns_[n].add(change, end, n, rows_, scratch_.data());
      bytes += columns_[n].size();
    }
    for (const Time time : part.times) times_.add(time);
    rows_ += part.times.size();
    for (const RecordedEvent& event : part.events) add(event);
    for (const RecordedFrame& frame : part.frames) add(frame);
    waits_ = waits_ || !part.times.empty() || !part.events.empty() || !part.frames.empty();
    if (rows_ >= kBlockRows || bytes >= kFullBlock) flush();
  }

  void flush() override {
    if (!std::exchange(waits_, false)) return;
    content_.clear();
    times_.write(content_);
    for (Column& column : columns_) column.write(content_, scratch_);
    events_.write(content_);
    frames_.write(content_);
    rows_ = 0;
    blocks_.write(BlockKind::Rows, content_);
  }

  void finish() override {
    flush();
    blocks_.write(BlockKind::End, {});
  }

 private:
  void add(const RecordedEvent& event) {
    std::string& out = events_.begin(event.time);
    out += static_cast<char>(event.is_fault);
    add_text(out, event.text);
  }

  void add(const RecordedFrame& frame) {
    std::string& out = frames_.begin(frame.time);
    const bool usual = frame.text == (tracks_[frame.track].is_can ? usual_text(frame) : std::string());
    add_number(out, frame.track);
    out += static_cast<char>((frame.extended ? 1 : 0) | (frame.remote ? 2 : 0) | (usual ? 0 : 4));
    add_number(out, frame.id);
    add_text(out, {reinterpret_cast<const char*>(frame.bytes.data()), frame.bytes.size()});
    if (!usual) add_text(out, frame.text);
  }

  BlockWriter blocks_;
  const std::vector<FrameTrack>& tracks_;
  RowTimes times_;
  std::vector<Column> columns_;  // as the signals
  Entries events_, frames_;
  size_t rows_ = 0;     // of the block
  bool waits_ = false;  // it has something
  std::string content_, scratch_;
};

}  // namespace

std::string usual_text(const RecordedFrame& frame) {
  std::string text = fmt::format("{:0{}X}#", frame.id, frame.extended ? 8 : 3);
  if (frame.remote) return text + "R";
  return text + fmt::format("{:02X}", fmt::join(frame.bytes, ""));
}

std::unique_ptr<TraceWriter> packed_trace(std::ostream& out, const std::vector<Signal>& signals,
                                          const std::vector<FrameTrack>& tracks) {
  return std::make_unique<PackedTrace>(out, signals, tracks);
}

}  // namespace ipos::tools
