// Counts, and two forms of a report.
#include "tools/bus/profibus_load.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/log/candump.hpp"
#include "runtime/bus/profibus/frame_text.hpp"
#include "runtime/bus/profibus/timing.hpp"

namespace ipos::tools {

namespace {

using runtime::kSecond;
using runtime::Time;

}  // namespace

void ProfibusLoad::Count::add(Time time, uint64_t more) {
  if (frames++ == 0) first = time;
  last = std::max(last, time);
  bits += more;
}

void ProfibusLoad::add(const profibus::Reception& reception) {
  const auto& [frame, octets, time, end] = reception;
  last_bits_ = profibus::kCharacterBits * octets.size();
  all_.add(time, last_bits_);
  const auto window = static_cast<size_t>((all_.last - all_.first) / kSecond);
  // A log may have gaps of hours: so many windows are kept, the rest counts in the last one (ours).
  constexpr size_t kMostWindows = 100'000;
  windows_.resize(std::max(windows_.size(), std::min(window, kMostWindows - 1) + 1));
  windows_.back().add(time, last_bits_);
  kinds_[frame ? profibus::frame_kind(*frame) : "void"].add(time, last_bits_);
}

Time ProfibusLoad::span() const { return all_.last - all_.first + profibus::time_of(last_bits_, baud_); }

double ProfibusLoad::percent(uint64_t bits, Time span) const {
  return span == 0 ? 0 : 100.0 * static_cast<double>(bits) * 1e9 / baud_ / static_cast<double>(span);
}

std::string ProfibusLoad::text() const {
  std::string text =
      fmt::format("{:<32} {:>8} {:>10} {:>8} {:>9}\n", "window from", "frames", "bits", "%", "every ms");
  const auto row = [&](const std::string& what, const Count& count, Time span) {
    text += fmt::format(
        "{:<32} {:>8} {:>10} {:>8.2f} {:>9}\n", what, count.frames, count.bits, percent(count.bits, span),
        count.frames < 2 ? "-" : fmt::format("{:.3f}", static_cast<double>(count.every()) / 1e6));
  };
  for (size_t n = 0; n < windows_.size(); ++n) {
    const Time from = all_.first + static_cast<Time>(n) * kSecond + runtime::kCandumpEpoch;
    row(fmt::format("{}.{:03}", from / kSecond, from % kSecond / runtime::kMillisecond), windows_[n],
        kSecond);
  }
  row("all", all_, span());
  text += "\nframes\n";
  for (const auto& [kind, count] : kinds_) row(kind, count, span());
  return text;
}

nlohmann::ordered_json ProfibusLoad::json() const {
  using Json = nlohmann::ordered_json;
  const auto row = [&](const Count& count, Time span) {
    return Json{{"frames", count.frames},
                {"bits", count.bits},
                {"percent", percent(count.bits, span)},
                {"every_us", count.every() / runtime::kMicrosecond}};
  };
  Json report{{"baud", baud_}, {"windows", Json::array()}};
  for (size_t n = 0; n < windows_.size(); ++n) {
    Json window = row(windows_[n], kSecond);
    window["from_us"] = (all_.first + static_cast<Time>(n) * kSecond) / runtime::kMicrosecond;
    report["windows"].push_back(std::move(window));
  }
  report["all"] = row(all_, span());
  report["frames"] = Json::array();
  for (const auto& [kind, count] : kinds_) {
    Json entry = row(count, span());
    entry["kind"] = kind;
    report["frames"].push_back(std::move(entry));
  }
  return report;
}

}  // namespace ipos::tools
