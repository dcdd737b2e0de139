// Types are those of the standard alone, so that every viewer takes them: numbers with decimals are `real`,
// whole ones `integer`, bit fields `reg`, and a frame is an `event` with the values of the frame beside it.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>

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

class Dump {
 public:
  Dump(std::ostream& out, const Recording& recording) : out_(out), recording_(recording) {}

  void write() {
    header();
    out_ << "#0\n$dumpvars\n" << unknown_ << "$end\n";
    auto frame = recording_.frames.begin();
    for (size_t row = 0; row < recording_.times.size(); ++row) {
      const runtime::Time time = recording_.times[row];
      for (; frame != recording_.frames.end() && frame->time <= time; ++frame) change(*frame);
      for (size_t n = 0; n < recording_.signals.size(); ++n)
        if (const auto& samples = recording_.samples[n]; row == 0 || samples[row] != samples[row - 1]) {
          at(time);
          out_ << value(n, samples[row]) << ' ' << codes_[n] << '\n';
        }
    }
    for (; frame != recording_.frames.end(); ++frame) change(*frame);
    // So that viewers show the whole run.
    if (!recording_.times.empty() && recording_.times.back() > now_) at(recording_.times.back());
  }

 private:
  struct TrackCodes {
    std::string event, id, length, data;
  };

  void header() {
    out_ << "$version ipos $end\n$timescale 1 ns $end\n";
    for (const Signal& signal : recording_.signals)
      if (!signal.unit.empty()) out_ << fmt::format("$comment {} in {} $end\n", signal.name, signal.unit);
    codes_.resize(recording_.signals.size());
    std::vector<std::string> written;
    for (const Signal& first : recording_.signals) {
      if (std::find(written.begin(), written.end(), first.station) != written.end()) continue;
      written.push_back(first.station);
      scope(first.station);
      for (size_t n = 0; n < recording_.signals.size(); ++n)
        if (recording_.signals[n].station == first.station) declare(n);
      if (!first.station.empty()) out_ << "$upscope $end\n";
    }
    for (size_t n = 0; n < recording_.tracks.size(); ++n) declare_track(n);
    out_ << "$enddefinitions $end\n";
  }

  void scope(const std::string& name) {
    if (!name.empty()) out_ << fmt::format("$scope module {} $end\n", reference(name));
  }

  void declare(size_t n) {
    const Signal& signal = recording_.signals[n];
    const auto& samples = recording_.samples[n];
    std::string_view name = signal.name;
    if (!signal.station.empty()) name.remove_prefix(signal.station.size() + 1);
    if (signal.bits != 0) {
      codes_[n] = variable("reg", signal.bits, fmt::format("{} [{}:0]", reference(name), signal.bits - 1));
    } else if (signal.factor != 1 || signal.decimals != 0) {
      codes_[n] = variable("real", 64, reference(name), false);
    } else {
      // An unsigned parameter may be beyond the 32 bits of an integer.
      const bool fits = std::all_of(samples.begin(), samples.end(), [](int64_t sample) {
        return sample >= std::numeric_limits<int32_t>::min() && sample <= std::numeric_limits<int32_t>::max();
      });
      codes_[n] = variable("integer", fits ? 32 : 64, reference(name));
      if (!fits) wide_.push_back(n);
    }
  }

  void declare_track(size_t n) {
    const FrameTrack& track = recording_.tracks[n];
    size_t longest = 8;
    for (const RecordedFrame& frame : recording_.frames)
      if (frame.track == n) longest = std::max(longest, frame.bytes.size());
    scope(track.bus);
    TrackCodes& codes = tracks_.emplace_back();
    codes.event = variable("event", 1, "frame", false);
    if (track.is_can) codes.id = variable("reg", 29, "id [28:0]");
    codes.length = variable("integer", 32, "length");
    codes.data = variable("reg", 8 * longest, fmt::format("data [{}:0]", 8 * longest - 1));
    out_ << "$upscope $end\n";
  }

  // Returns the identifier code: a number to the base of the 94 printable characters.
  std::string variable(std::string_view type, size_t size, const std::string& name, bool has_unknown = true) {
    std::string code;
    for (size_t rest = ++variables_; rest != 0; rest /= 94) code += static_cast<char>('!' + rest % 94);
    out_ << fmt::format("$var {} {} {} {} $end\n", type, size, code, name);
    if (has_unknown) unknown_ += fmt::format("bx {}\n", code);
    return code;
  }

  void at(runtime::Time time) {
    if (time == now_) return;
    now_ = time;
    out_ << '#' << time << '\n';
  }

  std::string value(size_t n, int64_t sample) const {
    const Signal& signal = recording_.signals[n];
    if (signal.bits == 0 && (signal.factor != 1 || signal.decimals != 0)) return "r" + signal.text(sample);
    auto bits = static_cast<uint64_t>(sample);
    const bool wide = std::find(wide_.begin(), wide_.end(), n) != wide_.end();
    const size_t width = signal.bits != 0 ? signal.bits : wide ? 64 : 32;
    if (width < 64) bits &= (uint64_t{1} << width) - 1;
    return binary(bits);
  }

  void change(const RecordedFrame& frame) {
    const TrackCodes& codes = tracks_[frame.track];
    at(frame.time);
    if (!codes.id.empty()) out_ << binary(frame.id) << ' ' << codes.id << '\n';
    out_ << binary(frame.bytes.size()) << ' ' << codes.length << '\n';
    std::string data = "b";
    for (const uint8_t byte : frame.bytes) data += fmt::format("{:08b}", byte);
    out_ << (frame.bytes.empty() ? "b0" : data) << ' ' << codes.data << "\n1" << codes.event << '\n';
  }

  std::ostream& out_;
  const Recording& recording_;
  size_t variables_ = 0;
  std::vector<std::string> codes_;  // as the signals
  std::vector<size_t> wide_;        // integers of 64 bits
  std::vector<TrackCodes> tracks_;
  std::string unknown_;  // before the first sample
  runtime::Time now_ = 0;
};

}  // namespace

void write_vcd(std::ostream& out, const Recording& recording) { Dump(out, recording).write(); }

}  // namespace ipos::tools
