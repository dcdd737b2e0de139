// Types are those of the standard alone, so that every viewer takes them: numbers with decimals are `real`,
// whole ones `integer`, bit fields `reg`, and a frame is an `event` with the values of the frame beside it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <limits>

#include "runtime/bus/log/unique_names.hpp"
#include "tools/cli/failure.hpp"
#include "tools/recording/trace.hpp"

namespace ipos::tools {
namespace {

// A Verilog identifier (IEEE 1364-2005, 3.7): anything but letters, digits, _ and $ needs the escaped form.
std::string reference(std::string_view name) {
  std::string text;
  bool simple = !name.empty() && std::isdigit(static_cast<unsigned char>(name[0])) == 0 && name[0] != '$';
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    simple = simple && (std::isalnum(byte) != 0 || c == '_' || c == '$');
    text += byte > ' ' && byte < 0x7F ? c : '_';  // no white space, printable
  }
  return simple ? text : "\\" + text;
}

// Readers fill a short vector up with zeros (IEEE 1364-2005, 18.2.1).
std::string binary(uint64_t value) { return fmt::format("b{:b}", value); }

// Written and read again, and gone with this process.
class TemporaryFile {
 public:
  TemporaryFile() : file_(std::tmpfile()) { check(file_ != nullptr); }
  ~TemporaryFile() {
    if (file_ != nullptr) std::fclose(file_);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(std::string_view text) { check(std::fwrite(text.data(), 1, text.size(), file_) == text.size()); }
  void copy_to(std::ostream& out) {
    std::array<char, 1 << 16> buffer{};
    check(std::fflush(file_) == 0);
    std::rewind(file_);
    while (const size_t count = std::fread(buffer.data(), 1, buffer.size(), file_))
      out.write(buffer.data(), static_cast<std::streamsize>(count));
    check(std::ferror(file_) == 0);
  }

 private:
  static void check(bool good) {
    if (!good) throw Failure(kIoError, fmt::format("temporary file of the trace: {}", std::strerror(errno)));
  }
  std::FILE* file_;
};

class VcdTrace final : public TraceWriter {
 public:
  VcdTrace(std::ostream& out, const std::vector<Signal>& signals, const std::vector<FrameTrack>& tracks)
      : out_(out), signals_(signals), tracks_(tracks), columns_(signals.size()), lines_(tracks.size()) {
    for (const size_t n : in_scopes()) columns_[n].code = next_code();
    for (Line& line : lines_) {
      line.event = next_code();
      if (tracks_[static_cast<size_t>(&line - lines_.data())].is_can) line.id = next_code();
      line.length = next_code();
      line.data = next_code();
    }
  }

  void take(const RecordedPart& part) override {
    auto frame = part.frames.begin();
    const std::vector<Change>& changes = by_row_.of(part);
    auto change = changes.begin();
    for (size_t row = 0; row < part.times.size(); ++row) {
      for (; frame != part.frames.end() && frame->time <= part.times[row]; ++frame) add(*frame);
      for (; change != changes.end() && change->row == row; ++change) {
        at(part.times[row]);
        add(*change);
      }
    }
    for (; frame != part.frames.end(); ++frame) add(*frame);
    if (!part.times.empty()) last_ = part.times.back();
    body_.write(text_);
    text_.clear();
  }

  void finish() override {
    // So that viewers show the whole run.
    if (last_ > now_) at(last_);
    body_.write(text_);
    header();
    out_ << "#0\n$dumpvars\n" << unknown_ << "$end\n";
    body_.copy_to(out_);
  }

 private:
  struct Column {
    std::string code;
    bool is_wide = false;  // an integer beyond 32 bits
  };
  struct Line {
    std::string event, id, length, data;  // codes
    size_t longest = 8;
  };

  bool is_real(const Signal& signal) const {
    return signal.bits == 0 && (signal.factor != 1 || signal.decimals != 0);
  }

  // The signals of a station together, the stations in order of their first ones.
  std::vector<size_t> in_scopes() const {
    std::vector<size_t> order;
    std::vector<std::string> written;
    for (const Signal& first : signals_) {
      if (std::find(written.begin(), written.end(), first.station) != written.end()) continue;
      written.push_back(first.station);
      for (size_t n = 0; n < signals_.size(); ++n)
        if (signals_[n].station == first.station) order.push_back(n);
    }
    return order;
  }

  // An identifier code is a number to the base of the 94 printable characters.
  std::string next_code() {
    std::string code;
    for (size_t rest = ++variables_; rest != 0; rest /= 94) code += static_cast<char>('!' + rest % 94);
    return code;
  }

  void header() {
    out_ << "$version ipos $end\n$timescale 1 ns $end\n";
    for (const Signal& signal : signals_)
      if (!signal.unit.empty()) out_ << fmt::format("$comment {} in {} $end\n", signal.name, signal.unit);
    const std::string* station = nullptr;
    const auto end_scope = [&] {
      if (station != nullptr && !station->empty()) out_ << "$upscope $end\n";
    };
    for (const size_t n : in_scopes()) {
      if (station == nullptr || signals_[n].station != *station) {
        end_scope();
        station = &signals_[n].station;
        scope(*station);
      }
      declare(n);
    }
    end_scope();
    for (size_t n = 0; n < tracks_.size(); ++n) declare_track(n);
    out_ << "$enddefinitions $end\n";
  }

  void scope(const std::string& name) {
    if (!name.empty()) out_ << fmt::format("$scope module {} $end\n", modules_.of(name, reference(name)));
  }

  void declare(size_t n) {
    const Signal& signal = signals_[n];
    const Column& column = columns_[n];
    std::string_view name = signal.name;
    if (!signal.station.empty()) name.remove_prefix(signal.station.size() + 1);
    if (signal.bits != 0)
      variable("reg", signal.bits, column.code, fmt::format("{} [{}:0]", reference(name), signal.bits - 1));
    else if (is_real(signal))
      variable("real", 64, column.code, reference(name), false);
    else
      variable("integer", column.is_wide ? 64 : 32, column.code, reference(name));
  }

  void declare_track(size_t n) {
    const Line& line = lines_[n];
    scope(tracks_[n].bus);
    variable("event", 1, line.event, "frame", false);
    if (tracks_[n].is_can) variable("reg", 29, line.id, "id [28:0]");
    variable("integer", 32, line.length, "length");
    variable("reg", 8 * line.longest, line.data, fmt::format("data [{}:0]", 8 * line.longest - 1));
    out_ << "$upscope $end\n";
  }

  void variable(std::string_view type, size_t size, const std::string& code, const std::string& name,
                bool has_unknown = true) {
    out_ << fmt::format("$var {} {} {} {} $end\n", type, size, code, name);
    if (has_unknown) unknown_ += fmt::format("bx {}\n", code);
  }

  void at(runtime::Time time) {
    if (time == now_) return;
    now_ = time;
    text_ += fmt::format("#{}\n", time);
  }

  void add(const Change& change) {
    const Signal& signal = signals_[change.signal];
    Column& column = columns_[change.signal];
    if (is_real(signal)) {
      text_ += 'r';
      signal.append_text(text_, change.sample);
    } else {
      // An unsigned parameter may be beyond the 32 bits of an integer; then it is never negative.
      const bool fits = change.sample >= std::numeric_limits<int32_t>::min() &&
                        change.sample <= std::numeric_limits<int32_t>::max();
      column.is_wide = column.is_wide || (signal.bits == 0 && !fits);
      auto bits = static_cast<uint64_t>(change.sample);
      const size_t width = signal.bits != 0 ? signal.bits : column.is_wide ? 64 : 32;
      if (width < 64) bits &= (uint64_t{1} << width) - 1;
      text_ += binary(bits);
    }
    text_.append(1, ' ').append(column.code).append(1, '\n');
  }

  void add(const RecordedFrame& frame) {
    Line& line = lines_[frame.track];
    line.longest = std::max(line.longest, frame.bytes.size());
    at(frame.time);
    if (!line.id.empty()) text_ += binary(frame.id) + ' ' + line.id + '\n';
    text_ += binary(frame.bytes.size()) + ' ' + line.length + '\n';
    std::string data = "b";
    for (const uint8_t byte : frame.bytes) data += fmt::format("{:08b}", byte);
    text_ += (frame.bytes.empty() ? "b0" : data) + ' ' + line.data + "\n1" + line.event + '\n';
  }

  runtime::UniqueNames modules_{std::string::npos};  // where letters were replaced
  std::ostream& out_;
  const std::vector<Signal>& signals_;
  const std::vector<FrameTrack>& tracks_;
  size_t variables_ = 0;
  std::vector<Column> columns_;  // as the signals
  std::vector<Line> lines_;      // as the tracks
  TemporaryFile body_;
  std::string text_;     // of this part
  ByRow by_row_;
  std::string unknown_;  // before the first sample
  runtime::Time now_ = 0;
  runtime::Time last_ = 0;  // row
};

}  // namespace

std::unique_ptr<TraceWriter> vcd_trace(std::ostream& out, const std::vector<Signal>& signals,
                                       const std::vector<FrameTrack>& tracks) {
  return std::make_unique<VcdTrace>(out, signals, tracks);
}

}  // namespace ipos::tools
